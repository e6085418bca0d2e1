// Help, flags, and errors that are found before the work.
#include <sstream>

#include "cli/cli_fixture.h"

namespace pbnbrdf {
namespace {

constexpr const char* kCommands[] = {"fit",     "measure",  "info",      "eval", "export",
#ifdef PBNBRDF_HAS_RENDER
                                     "report",  "render",   "fit-scene",
#endif
                                     "compare", "fit-model"};

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// The first lines of those that explain a flag, "  --name    help".
std::vector<std::string> FlagLines(const std::string& help) {
  std::vector<std::string> lines = Lines(help);
  std::erase_if(lines, [](const std::string& line) {
    return !line.starts_with("  --") || line.find("  ", 2) == line.npos;
  });
  return lines;
}

std::string NameOfFlag(const std::string& line) { return line.substr(2, line.find(' ', 2) - 2); }

TEST_F(Cli, HelpTeaches) {
  const Result overview = Run("--help");
  EXPECT_EQ(overview.status, 0);
  std::size_t at = 0;
  for (const char* command : kCommands) {
    const std::size_t next = overview.out.find(StrCat("\n  ", command, " "));
    ASSERT_NE(next, overview.out.npos) << command;
    EXPECT_LT(at, next) << command;  // in the order that people need
    at = next;
    const Result help = Run(StrCat(command, " --help"));
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr(StrCat("  pbnbrdf ", command, " ")));
    EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done, 1 bad input or output, 2 wrong usage."));
  }
  EXPECT_THAT(Run("--version").out, StartsWith("pbnbrdf 0."));
}

TEST_F(Cli, HelpShowsADozenFlagsAndWhereTheRestAre) {
  for (const char* command : kCommands) {
    const std::string help = Run(StrCat(command, " --help")).out;
    const std::string all = Run(StrCat(command, " --help=all")).out;
    const std::vector<std::string> shown = FlagLines(help), flags = FlagLines(all);
    EXPECT_LE(shown.size(), 14u) << command;
    EXPECT_EQ(shown.size() < flags.size(), help.find("--help=all shows all flags") != help.npos)
        << command;
    EXPECT_THAT(all, Not(HasSubstr("--help=all"))) << command;
    for (const std::string& line : shown) {
      EXPECT_THAT(all, HasSubstr("\n  " + NameOfFlag(line) + " ")) << command;
    }
    for (const std::string& text : {help, all}) {
      for (const std::string& line : Lines(text)) EXPECT_LE(line.size(), 100u) << line;
    }
  }
  EXPECT_GE(FlagLines(Run("fit --help").out).size(), 10u);
  EXPECT_GE(FlagLines(Run("fit --help=all").out).size(), 30u);
}

TEST_F(Cli, EveryFlagHasAHelpLine) {
  for (const char* command : kCommands) {
    for (const std::string& line : FlagLines(Run(StrCat(command, " --help=all")).out)) {
      const std::string help(Trim(line.substr(2 + NameOfFlag(line).size())));
      EXPECT_GT(help.size(), 5u) << command << " " << line;
      EXPECT_FALSE(help.starts_with("[")) << command << " " << line;
    }
  }
}

TEST_F(Cli, HelpNamesEveryChoice) {
  std::string help;  // as one line
  for (const std::string& line : Lines(Run("fit --help=all").out)) help.append(Trim(line)) += " ";
  for (const char* choice : {"cartesian", "reciprocal", "multiscale", "merl", "anisotropic",
                             "tanh | relu", "l2 | soft_l1 | absolute", "uniform | highlight",
                             "single | double", "lm", "ceres_lm", "ceres_lbfgs", "adam", "autodiff",
                             "log (eq. 6)", "chromaticity (eq. 7)", "energy (eq. 5)"}) {
    EXPECT_THAT(help, HasSubstr(choice));
  }
}

TEST_F(Cli, OldNamesTellTheNewOnes) {
  ExpectError("tabulate --material=x --out=y", 2, "tabulate is now export --format=merl");
  ExpectError("values --material=x", 2, "values is now eval");
  ExpectError("eval --fit=x --material=y", 2, "eval --fit is now measure --fit");
  ExpectError("measure --fit=x --eval_samples=5", 2, "--eval_samples is now --samples");
  const std::string fit = "fit --material=builtin:satin-gold --out=" + Path("out");
  ExpectError(fit + " --model=ggx", 2, "fit --model is now fit-model");
  ExpectError("fit --scene=x --out_dir=y", 2, "fit --scene is now fit-scene");
  ExpectError(fit + " --solver=tiny_lm", 2, "--solver=tiny_lm is now --solver=lm");
  ExpectError(fit + " --solver tiny_lm", 2, "--solver=tiny_lm is now --solver=lm");
  ExpectError(fit + " --solver=lbfgs", 2, "--solver=lbfgs is now --solver=ceres_lbfgs");
  ExpectError(fit + " --log_weight=2", 2, "--log_weight=W is now --terms=log:W");
  ExpectError(fit + " --chromaticity_weight=2", 2, "is now --terms=log,chromaticity:W");
  ExpectError(fit + " --energy_weight=2", 2, "is now --terms=log,energy:W");
  ExpectError(fit + " --jacobian=autodiff", 2, "--jacobian=autodiff is now --solver=autodiff");
  WriteBytes(Path("old.flags"), "--jacobian=condensed\n");
  ExpectError(fit + " --flagfile=" + Path("old.flags"), 2, "old.flags: --jacobian=condensed is");
}

TEST_F(Cli, WrongUsageExitsWith2) {
  ExpectError("", 2, "no command given: fit | measure");
  ExpectError("fitt", 2,
              "'fitt' is not a command: fit | measure | info | eval | export | report | render | "
              "fit-scene | "
              "compare | fit-model | prior | plan; see pbnbrdf --help");
  ExpectError("fit", 2, "--material is required");
  ExpectError("fit --material=builtin:satin-gold", 2, "--out or --out_dir is required");
  ExpectError("info builtin: --all", 2, "--all is not a flag");
  const std::string fit = "fit --material=builtin:satin-gold --out=" + Path("out");
  ExpectError(fit + " --sample=3", 2, "--sample is not a flag; did you mean --samples?");
  ExpectError(fit + " --json", 2, "--json is not a flag");
  ExpectError(fit + " --samples=many", 2, "--samples: 'many' is not a whole number");
  ExpectError(fit + " --samples=0", 2, "--samples = 0; must be 1 to");
  ExpectError(fit + " --samples", 2, "--samples needs a value");
  ExpectError(fit + " --loss=hubr", 2, "--loss=hubr is not one of l2 | soft_l1 | absolute");
  ExpectError(fit + " --terms=log,colour", 2, "--terms=colour is not one of log | chromaticity");
  ExpectError(fit + " --terms=energy", 2, "--terms: log or chromaticity must be among them");
  ExpectError(fit + " --encoding=polar", 2, "--encoding=polar is not one of auto | cartesian");
  ExpectError(fit + " --activation=gelu", 2, "--activation=gelu is not one of tanh | relu");
  ExpectError(fit + " --hidden=21,x", 2, "--hidden: 'x' is not a whole number");
  ExpectError(fit + " --hidden=21,-3", 2, "--hidden = -3; must be 1 to 256");
  ExpectError(fit + " --hidden=5000", 2, "--hidden = 5000; must be 1 to 256");
  ExpectError(fit + " --loss_scale=0", 2, "--loss_scale = 0; must be finite and > 0");
  ExpectError(fit + " --max_seconds=-1", 2, "--max_seconds = -1; must be finite and > 0");
  ExpectError(fit + " --loss=absolute", 2, "--loss: absolute isn't a sum of squares");
  ExpectError(fit + " --solver=adam --energy_angles=0", 2,
              "--energy_angles = 0; must be 1 to 1024");
  ExpectError(fit + " --starts=0", 2, "--starts = 0; must be >= 1");
  ExpectError(fit + " --threads=-1", 2, "--threads = -1; must be >= 0");
  ExpectError(fit + " --scale_to_albedo=-0.5", 2,
              "--scale_to_albedo = -0.5; must be finite and >= 0");
  for (const char* scale : {"nan", "inf"}) {
    ExpectError(fit + " --scale_to_albedo=" + scale, 2,
                StrCat("--scale_to_albedo: '", scale, "' is not a finite number"));
  }
  ExpectError(fit + " --terms=log,chromaticity:0", 2,
              "--terms: the weight of chromaticity = 0; must be finite and > 0");
  ExpectError(fit + " --terms=log,log:2", 2, "--terms: log is there twice");
  ExpectError(fit + " --solver=newton", 2, "--solver=newton is not one of lm | ceres_lm");
  ExpectError(fit + " gold.binary", 2, "'gold.binary' is not a flag");
  ExpectError("info", 2, "a file or another source is missing");
}

TEST_F(Cli, FlagfileErrorsNameTheFile) {
  WriteBytes(Path("x.flags"), "# a comment\n--loss=l2\n--los=l2\n");
  ExpectError("fit --flagfile=" + Path("x.flags") + " --out=" + Path("out"), 2,
              "x.flags: --los is not a flag; did you mean --loss?");
  WriteBytes(Path("y.flags"), "--flagfile=" + Path("x.flags") + "\n");
  ExpectError("fit --flagfile=" + Path("y.flags"), 2, "y.flags: " + Path("x.flags") + ": --los");
  WriteBytes(Path("z.flags"), "--flagfile=" + Path("z.flags") + "\n");
  ExpectError("fit --flagfile=" + Path("z.flags"), 2, "flagfiles are nested too deep");
  WriteBytes(Path("w.flags"), "loss=l2\n");
  ExpectError("fit --flagfile=" + Path("w.flags"), 2, "w.flags: 'loss=l2' is not a flag");
  ExpectError("fit --flagfile=" + Path("none.flags") + " --out=" + Path("out"), 1, "no such file");
}

TEST_F(Cli, UnwritableOutputsAreFoundBeforeTheWork) {
  ExpectError("fit --material=builtin:satin-gold --out=" + Path("none/x"), 1,
              "x: cannot write: no folder");
  ExpectError(
      "fit --material=builtin:satin-gold --out=" + Path("out") + " --summary=" + Path("none/s"), 1,
      "s: cannot write");
  ExpectError("export --format=merl --material=builtin:satin-gold --out=" + Path(""), 1,
              "is a folder");
}

TEST_F(Cli, AStandardOutputThatCantBeWrittenIsAnError) {
  const std::string fit =
      "fit --material=builtin:spectralon" + kQuick + "--out=" + Path("a.safetensors");
  for (const std::string& arguments :
       {std::string("--help"), std::string("fit --help=all"), std::string("--version"),
        std::string("info builtin:spectralon"), fit,
        "measure --samples=1000 --material=builtin:spectralon --fit=" + Path("a.safetensors")}) {
    const Result result = Run(arguments + " > /dev/full");
    EXPECT_EQ(result.status, 1) << arguments;
    EXPECT_THAT(result.err, StartsWith("pbnbrdf: standard output: cannot write: No space left"))
        << arguments;
  }
}

TEST_F(Cli, ASummaryOnStandardOutputIsJsonAlone) {
  const std::string fit = "fit --material=builtin:spectralon" + kQuick + "--summary=- --out=";
  EXPECT_TRUE(json::parse(Run(fit + Path("a.safetensors")).out).contains("mean_abs_log_error"));
}

TEST_F(Cli, TheManualAndWhatBashCompletesHaveEveryFlag) {
  const std::string manual = Run("--manual").out, completion = Run("--completion").out;
  EXPECT_THAT(manual, StartsWith(".TH PBNBRDF 1"));
  for (const char* command : kCommands) {
    const std::string escaped = Join(Split(command, '-'), "\\-");
    EXPECT_THAT(manual, HasSubstr(StrCat("\n.SS ", escaped, "\n")));
    EXPECT_THAT(completion, HasSubstr(StrCat("    ", command, ")\n")));
    for (const std::string& line : FlagLines(Run(StrCat(command, " --help=all")).out)) {
      const std::string flag = line.substr(2, line.find(' ', 2) - 2);
      EXPECT_THAT(completion, HasSubstr(flag)) << command;
    }
  }
  // No line that troff would take for a request of its own.
  for (const std::string& line : Lines(manual)) {
    if (!line.starts_with(".")) continue;
    const std::string request = line.substr(0, line.find(' '));
    EXPECT_THAT(
        (std::vector<std::string>{".TH", ".SH", ".SS", ".PP", ".TP", ".nf", ".fi", ".B", ".I"}),
        testing::Contains(request))
        << line;
  }
  EXPECT_THAT(completion, HasSubstr("--activation) choices=\"tanh relu\""));
}

}  // namespace
}  // namespace pbnbrdf

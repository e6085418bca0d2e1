// `fit` of many materials to one folder.
#include <csignal>

#include "cli/cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

class CliFitCollection : public Cli {
 protected:
  // A scan of a diffuse material.
  void WriteMaterial(const std::string& name, double value) const {
    std::string csv = "theta_i,phi_i,theta_o,phi_o,value\n";
    for (int k = 0; k < 60; ++k) {
      csv += StrCat(0.02 * k, ",0,", 0.3 + 0.015 * k, ",", 0.1 * k, ",", value, "\n");
    }
    WriteBytes(Path(name), csv);
  }

  std::string Fit(const std::string& material, const std::string& more = "") const {
    return "fit --material='" + material + "'" + kQuick + "--out_dir=" + Path("fits") + " " + more;
  }

  std::string Bytes(const std::string& file) const { return ReadFile(Path(file), 1 << 24); }

  json Table() const { return json::parse(Bytes("fits/fits.json")); }

  // The states by name.
  std::map<std::string, std::string> States() const {
    std::map<std::string, std::string> states;
    const json table = Table();
    for (const json& fit : table["fits"]) {
      states[fit["name"]] = fit["state"];
    }
    return states;
  }
};

using Names = std::map<std::string, std::string>;

TEST_F(CliFitCollection, KeepsWhatIsThereAndTheSame) {
  WriteMaterial("a.csv", 0.2);
  WriteMaterial("b.csv", 0.3);
  const std::string fit = Fit(Path("*.csv") + ";builtin:spectralon");
  const Result result = Run(fit);
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 fitted, 0 kept, 0 failed"));
  EXPECT_EQ(States(), (Names{{"a", "fitted"}, {"b", "fitted"}, {"spectralon", "fitted"}}));
  EXPECT_GT(Table()["job_seconds_in_fits"], 0.0);
  const std::string b = Bytes("fits/b.safetensors");
  // The same as alone.
  ASSERT_EQ(
      Run("fit --material=" + Path("b.csv") + kQuick + "--out=" + Path("b.safetensors")).status, 0);
  EXPECT_EQ(NeuralBrdf::Read(Path("b.safetensors")).weights(),
            NeuralBrdf::Read(Path("fits/b.safetensors")).weights());

  ASSERT_EQ(Run(fit).status, 0);
  EXPECT_EQ(States(), (Names{{"a", "kept"}, {"b", "kept"}, {"spectralon", "kept"}}));
  EXPECT_EQ(Table()["job_seconds_in_fits"], 0.0);
  WriteMaterial("a.csv", 0.25);
  std::filesystem::remove(Path("fits/spectralon.json"));
  ASSERT_EQ(Run(fit).status, 0);
  EXPECT_EQ(States(), (Names{{"a", "fitted"}, {"b", "kept"}, {"spectralon", "fitted"}}));
  EXPECT_EQ(Bytes("fits/b.safetensors"), b);
  ASSERT_EQ(Run(fit + "--seed=2").status, 0);
  EXPECT_EQ(States(), (Names{{"a", "fitted"}, {"b", "fitted"}, {"spectralon", "fitted"}}));
}

TEST_F(CliFitCollection, AMaterialThatFailsDoesNotStopTheOthers) {
  WriteMaterial("a.csv", 0.2);
  WriteBytes(Path("bad, or not.csv"), "theta_i,phi_i,theta_o,phi_o,value\n0,0,0\n");
  const Result result = Run(Fit(Path("*.csv"), "--progress=json --jobs=2"));
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(States(), (Names{{"a", "fitted"}, {"bad, or not", "failed"}}));
  EXPECT_THAT(Bytes("fits/fits.csv"),
              HasSubstr("\"bad, or not\",\"" + Path("bad, or not.csv") + "\",failed,"));
  EXPECT_FALSE(std::filesystem::exists(Path("fits/bad, or not.safetensors")));
  std::istringstream lines(result.err);
  std::string line;
  for (int done = 1; done <= 2; ++done) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(json::parse(line)["done"], done);
    EXPECT_EQ(json::parse(line)["of"], 2);
  }
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_THAT(line, HasSubstr("pbnbrdf: 1 of 2 materials failed; "));
}

TEST_F(CliFitCollection, SeveralRunsFillAFolderAndTheLastMakesTheTable) {
  WriteMaterial("a.csv", 0.2);
  WriteMaterial("b.csv", 0.3);
  WriteBytes(Path("c.csv"), "theta_i,phi_i,theta_o,phi_o,value\n0,0,0\n");
  const std::string fit = Fit(Path("*.csv"));
  EXPECT_EQ(Run(fit + "--list").out, "a\nb\nc\n");
  EXPECT_FALSE(std::filesystem::exists(Path("fits")));
  ASSERT_EQ(Run(fit + "--only=b").status, 0);
  EXPECT_TRUE(std::filesystem::exists(Path("fits/b.safetensors")));
  EXPECT_FALSE(std::filesystem::exists(Path("fits/a.safetensors")));
  EXPECT_FALSE(std::filesystem::exists(Path("fits/fits.csv")));
  ExpectError(fit + "--quiet '--only=a;c'", 1, "1 of 2 materials failed; c: " + Path("c.csv"));
  EXPECT_EQ(Run(fit).status, 1);
  EXPECT_EQ(States(), (Names{{"a", "kept"}, {"b", "kept"}, {"c", "failed"}}));
  ExpectError(fit + "--only=d", 1, "only: no material is named 'd'");
  ExpectError("fit --material=" + Path("a.csv") + " --only=a --out=" + Path("out"), 2,
              "--list and --only are for --out_dir");
}

TEST_F(CliFitCollection, RefusesWhatCannotBeAFolderOfFits) {
  const std::string a = Path("a.csv"), out = " --out=" + Path("out");
  WriteMaterial("a.csv", 0.2);
  std::filesystem::create_directory(Path("more"));
  WriteMaterial("more/a.csv", 0.2);
  WriteMaterial("fits.csv", 0.2);
  ExpectError("fit --material=" + a, 2, "--out or --out_dir is required");
  ExpectError(Fit(a, out), 2, "--out or --out_dir is required");
  ExpectError(Fit(a, "--trace=" + Path("out")), 2, "--summary and --trace are for --out");
  ExpectError(Fit(Path("none*.csv")), 1, "none*.csv: nothing has a name like this");
  std::filesystem::create_directories(Path("other/more"));
  WriteMaterial("other/more/a.csv", 0.2);
  ExpectError(Fit(Path("more/a.csv") + ";" + Path("other/more/a.csv")), 1,
              "would both be named more-a");
  ExpectError(Fit(Path("fits.csv")), 1, "its files can't be named 'fits'");
  ExpectError(Fit(a, "--out_dir=" + a + "/fits"), 1, "cannot write");
}

TEST_F(CliFitCollection, KilledAtAnyMomentItGoesOn) {
  for (const char name : {'a', 'b', 'c', 'd'})
    WriteMaterial(StrCat(std::string(1, name), ".csv"), 0.001 * name);
  const std::string whole = Fit(Path("*.csv"), "--jobs=2 --quiet");
  ASSERT_EQ(Run(whole).status, 0);
  std::filesystem::rename(Path("fits"), Path("undisturbed"));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> seconds(0.05, 1.0);
  for (int k = 0; k < 20; ++k) {
    // In the foreground timeout waits until the process is gone.
    const std::string killed = StrCat("timeout --foreground -s KILL ", seconds(random), " ",
                                      PBNBRDF_PROGRAM, " ", whole, " > ", Path("log"), " 2>&1");
    std::ignore = std::system(killed.c_str());
  }
  char host[256] = {};
  gethostname(host, sizeof(host) - 1);
  const std::string elsewhere = Path("fits/.pbnbrdf.another-machine.999999999.0.part");
  WriteBytes(elsewhere, "being written");
  WriteBytes(Path(StrCat("fits/.pbnbrdf.", host, ".999999999.0.part")),
             "left by a process that was killed");
  ASSERT_EQ(Run(whole).status, 0);
  EXPECT_TRUE(std::filesystem::remove(elsewhere));
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(Path("fits"))) {
    ++files;
    if (file.path().extension() != ".safetensors") continue;
    const std::string name = file.path().filename();
    EXPECT_EQ(Bytes("fits/" + name), Bytes("undisturbed/" + name)) << name;
  }
  EXPECT_EQ(files, 4u * 2u + 2u);
}

}  // namespace
}  // namespace pbnbrdf

// pbnbrdf report: what the page holds, and what it refuses. How it looks and moves: interop/report_test.py.
#include "cli/cli_fixture.h"

namespace pbnbrdf {
namespace {

class CliReport : public Cli {
 protected:
  void Fit(const std::string& material, const std::string& flags) const {
    const Result result = Run("fit --material=" + material + kQuick + flags);
    ASSERT_EQ(result.status, 0) << result.err;
  }

  // The data within a page.
  json DataOf(const std::string& page) const {
    const std::string text = ReadFile(Path(page), 1 << 26);
    const std::string begin = "id=\"report-data\">";
    const std::size_t first = text.find(begin) + begin.size();
    return json::parse(text.substr(first, text.find("</script>", first) - first));
  }

  const std::string kSmall = " --film_width=16 --samples_per_pixel=2 ";
};

TEST_F(CliReport, HoldsAllThatItShowsAndNeedsNothingElse) {
  Fit("builtin:satin-gold",
      "--out=" + Path("gold.safetensors") + " --summary=" + Path("gold.json"));
  const Result result =
      Run("report --fit=" + Path("gold.safetensors") + kSmall + "--out=" + Path("a.html"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("a.html: 1 fit, "));
  const json data = DataOf("a.html");
  ASSERT_EQ(data["materials"].size(), 1u);
  const json& gold = data["materials"][0];
  EXPECT_EQ(gold["name"], "gold");
  EXPECT_EQ(gold["source"], "builtin:satin-gold");
  EXPECT_THAT(gold["command"].get<std::string>(), HasSubstr("--hidden=5"));
  EXPECT_EQ(gold["history"].size(), 5u);  // the start and 4 iterations
  EXPECT_EQ(gold["measures"][0]["key"], "mean_abs_log_error");
  EXPECT_THAT(gold["pictures"]["fit"].get<std::string>(), StartsWith("data:image/png;base64,"));
  EXPECT_EQ(gold["curves"]["in_plane"].size(), 4u);
  EXPECT_THAT(gold["sphere"]["glsl"].get<std::string>(), HasSubstr("vec3 fitted_eval("));
  EXPECT_EQ(gold["sphere"]["table"]["size"], json({64, 32, 32}));
  EXPECT_GT(data["lights"].size(), 20u);
  const std::string text = ReadFile(Path("a.html"), 1 << 26);
  EXPECT_THAT(text, Not(HasSubstr("{{")));
  for (const char* remote : {"src=\"http", "href=\"http", "url(http", "import("}) {
    EXPECT_THAT(text, Not(HasSubstr(remote)));
  }
}

TEST_F(CliReport, ShowsAFolderAndTheSameFilesGiveTheSamePage) {
  Fit("'builtin:*gold;builtin:spectralon'", "--out_dir=" + Path("fits"));
  const std::string report = "report --fits=" + Path("fits") + kSmall + "--quiet --out=";
  ASSERT_EQ(Run(report + Path("a.html")).out, "");
  ASSERT_EQ(Run(report + Path("b.html")).status, 0);
  EXPECT_EQ(ReadFile(Path("a.html"), 1 << 26), ReadFile(Path("b.html"), 1 << 26));
  const json data = DataOf("a.html");
  ASSERT_EQ(data["materials"].size(), 2u);
  EXPECT_EQ(data["materials"][1]["name"], "spectralon");
  EXPECT_EQ(data["materials"][1]["history"].size(), 5u);
  // A fit's measures are the same whether its summary has them or not.
  const json known = data["materials"][1]["measures"];
  std::filesystem::remove(Path("fits/spectralon.json"));
  ASSERT_EQ(Run(report + Path("c.html")).status, 0);
  const json measured = DataOf("c.html")["materials"][1]["measures"];
  ASSERT_EQ(measured.size(), known.size());
  for (std::size_t n = 0; n < known.size(); ++n) EXPECT_EQ(known[n]["key"], measured[n]["key"]);
  EXPECT_EQ(known[0]["value"], measured[0]["value"]);
}

TEST_F(CliReport, IsMadeWithAFolderOfFits) {
  const std::string fit =
      "fit --material='builtin:satin-gold'" + kQuick + "--quiet --out_dir=" + Path("fits");
  ASSERT_EQ(Run(fit + " --report").status, 0);
  EXPECT_EQ(DataOf("fits/fits.html")["materials"][0]["name"], "satin-gold");
  ExpectError("fit --material=builtin:satin-gold --report --out=" + Path("out"), 2, "--out_dir");
}

TEST_F(CliReport, ShowsAnalyticModelsAndMaterialsWithoutATable) {
  ASSERT_EQ(Run("fit-model --material=builtin:satin-gold --model=ggx --samples=300 --out=" +
                Path("m.json"))
                .status,
            0);
  ASSERT_EQ(Run("report --fit=" + Path("m.json") + " --material=builtin:satin-gold" + kSmall +
                "--out=" + Path("a.html"))
                .status,
            0);
  EXPECT_TRUE(DataOf("a.html")["materials"][0]["sphere"]["glsl"].is_null());
}

TEST_F(CliReport, Refuses) {
  Fit("builtin:satin-gold", "--out=" + Path("gold.safetensors"));
  const std::string out = " --out=" + Path("out");
  const std::string gold = "report --fit=" + Path("gold.safetensors");
  ExpectError("report" + out, 2, "--fit=FILE or --fits=DIR is required");
  ExpectError(gold + " --material=builtin:spectralon" + out, 1,
              "was fitted to builtin:satin-gold, not to builtin:spectralon");
  ExpectError(gold + " --material=" + Path("no.binary") + " --any_material" + out, 1, "no.binary");
  ExpectError("report --fit=" + Path("no.safetensors") + out, 1, "no.safetensors");
  std::filesystem::create_directory(Path("empty"));
  ExpectError("report --fits=" + Path("empty") + out, 1, "has no fits");
  ExpectError("report --fits=" + Path("nowhere") + out, 1, "nowhere");
  ExpectError(gold + " --summary=" + Path("gold.safetensors") + out, 1, "not a summary");
  ExpectError(gold + " --film_width=4" + out, 1, "at least 11 pixels");
  ExpectError(gold + " --out=" + Path("nowhere/out"), 1, "nowhere/out");
  WriteBytes(Path("a.csv"), "theta_i,phi_i,theta_o,phi_o,value\n0.1,0,0.2,3,0.5\n");
  ExpectError("report --fit=" + Path("a.csv") + " --material=builtin:spectralon" + out, 1,
              "neither a fitted network nor an analytic model");
}

}  // namespace
}  // namespace pbnbrdf

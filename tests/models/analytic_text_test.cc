// Analytic models from texts and files.
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

std::string TextError(const std::string& text) {
  return ErrorOf([&] { OpenBrdf(text); });
}

TEST(AnalyticText, GivesParametersByName) {
  const AnalyticBrdf brdf =
      AnalyticBrdf::FromText("ggx: rho_d=0.1, f0=1/0.8/0.3, alpha_x=0.05, alpha_y=0.25");
  EXPECT_EQ(brdf.model().name, "ggx");
  EXPECT_EQ(brdf.lobes(), 1);
  EXPECT_THAT(brdf.parameters(),
              testing::ElementsAre(0.1, 0.1, 0.1, 1, 1, 1, 1, 0.8, 0.3, 0.05, 0.25));
  EXPECT_EQ(brdf.Text(), "ggx:rho_d=0.1,rho_s=1,f0=1/0.8/0.3,alpha_x=0.05,alpha_y=0.25");
  EXPECT_THAT(brdf.Description(), HasSubstr("Walter et al. 2007"));
}

TEST(AnalyticText, PairsAndSecondLobes) {
  const AnalyticBrdf brdf = AnalyticBrdf::FromText("ward:alpha=0.1,alpha_2=0.4,rho_s_2=0.2");
  EXPECT_EQ(brdf.lobes(), 2);
  EXPECT_TRUE(brdf.IsIsotropic());
  EXPECT_THAT(brdf.parameters(),
              testing::ElementsAre(0, 0, 0, 1, 1, 1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.4, 0.4));
  EXPECT_FALSE(AnalyticBrdf::FromText("ward:alpha=0.1,alpha_x_2=0.3").IsIsotropic());
  EXPECT_FALSE(AnalyticBrdf::FromText("disney:anisotropic=0.3").IsIsotropic());
}

TEST(AnalyticText, InitialValuesAreWithinTheirBounds) {
  for (const AnalyticModel& model : AnalyticModels()) {
    EXPECT_FALSE(model.paper.empty());
    const std::string text = StrCat(model.name, ":");
    EXPECT_EQ(TextError(text), "") << text;
    const AnalyticBrdf brdf = AnalyticBrdf::FromText(text);
    EXPECT_TRUE(brdf.IsIsotropic()) << text;
    EXPECT_EQ(AnalyticBrdf::FromText(brdf.Text()).parameters(), brdf.parameters()) << text;
  }
}

TEST(AnalyticText, MistakesAreNamed) {
  EXPECT_THAT(TextError("ggx:alpa=0.1"),
              HasSubstr("ggx: no parameter 'alpa'; did you mean alpha? It has rho_d, rho_s, f0"));
  EXPECT_THAT(TextError("ggxx:alpha=0.1"), HasSubstr("model 'ggxx' is unknown; did you mean ggx?"));
  EXPECT_THAT(TextError("lambert:rho_d_2=0.1"), HasSubstr("no parameter 'rho_d_2'"));
  EXPECT_THAT(TextError("ggx:alpha"), HasSubstr("ggx: 'alpha': expected NAME=VALUE"));
  EXPECT_THAT(TextError("ggx:alpha=wide"), HasSubstr("ggx: alpha: 'wide' is not a finite number"));
  EXPECT_THAT(TextError("ggx:alpha=nan"), HasSubstr("ggx: alpha: 'nan' is not a finite number"));
  EXPECT_THAT(TextError("ggx:alpha=0"), HasSubstr("ggx: alpha_x = 0; must be 0.0001 to 4"));
  EXPECT_THAT(TextError("ggx:f0=1.5"), HasSubstr("ggx: f0 = 1.5; must be 0 to 1"));
  EXPECT_THAT(TextError("ggx:f0=1/0.5"), HasSubstr("ggx: f0: 2 numbers, expected 1 or 3"));
  EXPECT_THAT(TextError("ggx:alpha=1/1/1"), HasSubstr("ggx: alpha: 3 numbers, expected 1"));
  EXPECT_THAT(TextError("ggx:alpha=0.1,alpha=0.2"), HasSubstr("ggx: alpha is given twice"));
  EXPECT_THAT(TextError("ggx:alpha=0.1,alpha_x=0.2"), HasSubstr("ggx: alpha_x is given twice"));
  EXPECT_THAT(TextError("none.binary"), HasSubstr("no such file"));
}

TEST(AnalyticText, ConstructorChecksItsParameters) {
  const AnalyticModel& phong = FindAnalyticModel("phong");
  EXPECT_THAT(ErrorOf([&] { AnalyticBrdf(phong, 1, std::vector<double>(6, 1.0)); }),
              HasSubstr("phong: 6 parameters, expected 7"));
  EXPECT_THAT(ErrorOf([&] { AnalyticBrdf(phong, 3, std::vector<double>(15, 1.0)); }),
              HasSubstr("phong: 3 lobes; must be 1 to 2"));
  EXPECT_THAT(
      ErrorOf([&] { AnalyticBrdf(FindAnalyticModel("lambert"), 1, std::vector<double>(3, 1.0)); }),
      HasSubstr("lambert: 1 lobes; must be 0 to 0"));
}

TEST(AnalyticFile, ReadsWhatItWrites) {
  const TemporaryFolder folder;
  const std::string path = folder / "f.json";
  const AnalyticBrdf brdf = AnalyticBrdf::FromText(
      "ggx:rho_d=0.1/0.2/0.30000000000000004,alpha=0.1,alpha_2=0.3,f0_2=0.04");
  WriteBytes(path, brdf.Json());
  const std::unique_ptr<Brdf> read = OpenBrdf(path);
  const auto* model = dynamic_cast<const AnalyticBrdf*>(read.get());
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->Text(), brdf.Text());
  EXPECT_EQ(model->parameters(), brdf.parameters());
}

TEST(AnalyticFile, KeepsWhatElseItSays) {
  const TemporaryFolder folder;
  const std::string path = folder / "f.json";
  WriteBytes(path,
             R"({"model": "lambert", "parameters": {"rho_d": [0.1, 0.2, 0.3]}, "version": "1",
                 "errors": {"rmse": 0.5}})");
  const AnalyticBrdf brdf = AnalyticBrdf::Read(path);
  EXPECT_EQ(brdf.metadata().at("version"), "1");
  EXPECT_EQ(brdf.metadata().at("errors"), R"({"rmse":0.5})");
}

TEST(AnalyticFile, BadOnesAreNamed) {
  const TemporaryFolder folder;
  const std::string path = folder / "f.json";
  const auto error = [&](const std::string& text) {
    WriteBytes(path, text);
    return TextError(path);
  };
  EXPECT_THAT(TextError(path), HasSubstr("f.json: no such file"));
  EXPECT_THAT(error(""), HasSubstr("f.json: not a JSON file"));
  EXPECT_THAT(error("{\"model\": \"\xff\"}"), HasSubstr("f.json: not a JSON file"));
  EXPECT_THAT(error("[]"), HasSubstr("f.json: not an analytic model"));
  EXPECT_THAT(error("{\"model\": 3, \"parameters\": {}}"), HasSubstr("not an analytic model"));
  EXPECT_THAT(error("{\"model\": \"lambert\", \"parameters\": []}"),
              HasSubstr("not an analytic model"));
  EXPECT_THAT(error(R"({"model": "lamber", "parameters": {}})"),
              HasSubstr("f.json: model 'lamber' is unknown; did you mean lambert?"));
  EXPECT_THAT(error(R"({"model": "lambert", "parameters": {"rho": 1}})"),
              HasSubstr("f.json: lambert: no parameter 'rho'; did you mean rho_d?"));
  EXPECT_THAT(error(R"({"model": "lambert", "parameters": {"rho_d": "x"}})"),
              HasSubstr("f.json: parameter rho_d: expected a number or three"));
  EXPECT_THAT(error(R"({"model": "lambert", "parameters": {"rho_d": [1, null, 1]}})"),
              HasSubstr("f.json: parameter rho_d: expected a number or three"));
  const std::string whole = AnalyticBrdf::FromText("ggx:").Json();
  for (int part = 0; part < 20; ++part) {
    EXPECT_THAT(error(whole.substr(0, whole.size() * part / 20)), HasSubstr("f.json: not a JSON"));
  }
}

}  // namespace
}  // namespace pbnbrdf

// The programs of experiments/ that render pictures, with tiny settings.

#include <cmath>
#include <set>

#include "base/text.h"
#include "experiments/run_experiment.h"
#include "metrics/lpips_weights.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/png.h"
#include "picture_grid.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kTinyImages = {"--film_width=16", "--samples_per_pixel=2",
                                              "--max_seconds=0.1", "--threads=1"};

TEST(SceneFit, WritesEveryFitAndTheTable) {
  const TemporaryFolder folder;
  std::vector<std::string> flags = kTinyImages;
  flags.insert(flags.end(),
               {"--scenes=" PBNBRDF_SCENES "/sphere.json," PBNBRDF_SCENES "/one_of_many.json",
                "--samples=300", "--seeds=1,2", "builtin:blue-plastic", "lambert:rho_d=0.5"});
  const ProgramResult run = RunIn(folder, "scene_fit", flags);
  ASSERT_EQ(run.status, 0);
  const auto rows =
      ReadRows(folder / "results/scene_fit.csv", "scene,material,method,samples,seed,rmse,flip");
  ASSERT_EQ(rows.size(), 2u * 2u * 3u * 2u);
  std::set<std::string> images;
  for (const auto& row : rows) {
    EXPECT_GT(ParseNumber("rmse", row[5]), 0.0);
    images.insert(row[5]);
  }
  EXPECT_EQ(images.size(), rows.size());  // each fit has its own
  for (const char* text :
       {"| sphere ", "| one_of_many ", "| blue-plastic ", "**median**", "**worst**"}) {
    EXPECT_THAT(run.output, HasSubstr(text));
  }
}

TEST(SceneFit, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  for (const char* flag : {"--samples=2", "--film_width=5", "--scenes=absent.json", "--seeds=a",
                           "--slot=absent", "--scene_floor=2"}) {
    std::vector<std::string> flags = kTinyImages;
    flags.insert(flags.end(), {"--scenes=" PBNBRDF_SCENES "/one_of_many.json", "--samples=300",
                               flag, "lambert:rho_d=0.5"});
    EXPECT_EQ(RunIn(folder, "scene_fit", flags).status, 1) << flag;
  }
}

// From the table of `picture`.
double Psnr(const std::string& output, const std::string& material, const std::string& network) {
  for (const std::string& line : Split(output, '\n')) {
    const std::vector<std::string> cells = Split(line, '|');
    if (cells.size() > 5 && cells[1] == material && cells[2] == network) {
      return ParseNumber("PSNR", cells[5]);
    }
  }
  ADD_FAILURE() << material << ", " << network << " not in\n" << output;
  return 0.0;
}

TEST(Picture, WritesThePictureAndItsNumbers) {
  const TemporaryFolder folder;
  std::vector<std::string> flags = kTinyImages;
  flags.insert(flags.end(), {"--scene=" PBNBRDF_SCENES "/sphere.json", "--epochs=0",
                             "builtin:satin-gold", "builtin:wall-plaster"});
  const ProgramResult run = RunIn(folder, "picture", flags);
  ASSERT_EQ(run.status, 0);
  const Image picture = ReadPng(folder / "results/picture.png");
  EXPECT_GE(picture.width, 5 * 16);  // more where labels have been written
  EXPECT_GE(picture.height, 2 * 16);
  // A network that hasn't been trained, and ours.
  EXPECT_GT(Psnr(run.output, "satin-gold", "fit"),
            Psnr(run.output, "satin-gold", "published recipe"));
}

TEST(PictureGrid, HoldsThePicturesSideBySideWhereThereIsNothingToWriteLabelsWith) {
  const TemporaryFolder folder;
  Image dark(16, 8), bright(16, 8);
  bright.rgb.assign(bright.rgb.size(), 1.0f);
  PictureGrid grid(2);
  for (const Image& image : {dark, bright, bright, dark}) grid.Add("label", image);
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const std::string why = grid.Write(folder / "grid.png");
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(why, HasSubstr("no labels"));
  const Image all = ReadPng(folder / "grid.png");
  ASSERT_EQ(all.width, 32);
  ASSERT_EQ(all.height, 16);
  EXPECT_EQ(all.pixel(20, 2)[0], 1.0f);
  EXPECT_EQ(all.pixel(2, 12)[0], 1.0f);
  EXPECT_EQ(all.pixel(20, 12)[0], 0.0f);
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(FlipPicture, IsBlackWhereNothingDiffers) {
  Image a(32, 32), b(32, 32);
  a.rgb.assign(a.rgb.size(), 0.5f);
  b.rgb = a.rgb;
  for (int x = 20; x < 32; ++x) {
    for (int y = 0; y < 32; ++y) b.pixel(x, y)[0] = 1.0f;
  }
  const Image map = FlipPicture(a, b, 0.2);
  EXPECT_LT(map.pixel(2, 16)[0], 0.05f);
  EXPECT_EQ(map.pixel(28, 16)[0], 1.0f);
}

TEST(Paper, RegeneratesTheTablesAndGoesOnWhereItWas) {
  const TemporaryFolder folder;
  const std::vector<std::string> flags = {"--scene=" PBNBRDF_SCENES "/sphere.json",
                                          "--cove=" PBNBRDF_SCENES "/cove.json",
                                          "--film_width=32",
                                          "--samples_per_pixel=1",
                                          "--max_iterations=20",
                                          "--samples=600",
                                          "builtin:spectralon"};
  const ProgramResult run = RunIn(folder, "paper", flags);
  ASSERT_EQ(run.status, 0);
  for (const char* text : {"### Table 1", "### Table 2", "### Table 3", "| + chromaticity ",
                           "| ours ", "paper_figure2.png", "paper_figure3.png"}) {
    EXPECT_THAT(run.output, HasSubstr(text));
  }
  EXPECT_THAT(run.output, Not(HasSubstr("| LPIPS")));
  EXPECT_GT(ReadPng(folder / "results/paper_figure2.png").width, 32);
  const std::string kept = Read(folder / "results/fits/ours/spectralon.safetensors");
  const auto before =
      std::filesystem::last_write_time(folder / "results/fits/ours/spectralon.safetensors");
  EXPECT_EQ(RunIn(folder, "paper", flags).output, run.output);
  EXPECT_EQ(std::filesystem::last_write_time(folder / "results/fits/ours/spectralon.safetensors"),
            before);
  EXPECT_EQ(Read(folder / "results/fits/ours/spectralon.safetensors"), kept);
  // A published network whose material isn't there.
  std::filesystem::create_directory(folder / "networks");
  ASSERT_EQ(RunProgram({PBNBRDF_EXPERIMENTS "/pbnbrdf", "export",
                        "--fit=" + (folder / "results/fits/nbrdf/spectralon.safetensors"),
                        "--format=h5", "--out=" + (folder / "networks/spectralon.h5")})
                .status,
            0);
  std::vector<std::string> with_networks = flags;
  with_networks.push_back("--networks=" + (folder / "networks"));
  WriteFile(folder / "alex.safetensors", SafetensorsBytes(LpipsFile(RandomLpipsWeights(1))));
  with_networks.push_back("--lpips=" + (folder / "alex.safetensors"));
  const ProgramResult more = RunIn(folder, "paper", with_networks);
  EXPECT_EQ(more.status, 0);
  EXPECT_THAT(more.output, HasSubstr("| published network, without its material "));
  EXPECT_THAT(more.output, HasSubstr("| LPIPS"));
}

// Measured towards many directions from each of five angles.
void WriteMeasurements(const std::string& path) {
  std::string csv = "theta_i,phi_i,theta_o,phi_o,value\n";
  for (double theta_i : {0.1, 0.4, 0.7, 1.0, 1.3}) {
    for (int k = 0; k < 60; ++k) {
      const double theta_o = 0.02 * k, phi_o = std::fmod(2.4 * k, 6.28);
      const double value = 0.2 + std::exp(-8.0 * std::pow(theta_o - theta_i, 2)) * (k % 2);
      csv += StrCat(theta_i, ",0,", theta_o, ",", phi_o, ",", value, "\n");
    }
  }
  WriteBytes(path, csv);
}

TEST(Measured, HasATableForEachQuantity) {
  const TemporaryFolder folder;
  std::vector<std::string> flags = kTinyImages;
  flags.insert(flags.end(), {"--scene=" PBNBRDF_SCENES "/sphere.json", "--epochs=0", "--adam",
                             "--analytic", "builtin:satin-gold"});
  const ProgramResult run = RunIn(folder, "measured", flags);
  ASSERT_EQ(run.status, 0);
  for (const char* text :
       {"### Error at measured directions", "### Error at all directions",
        "### Largest directional albedo", "### Mean Delta E 2000", "### CPU seconds",
        "### PSNR to the material, dB", "### SSIM to the material", "### FLIP to its reciprocal",
        "### PSNR to what our fit aims at, dB", "| floor ", "| our Adam ", "| analytic ", "| ours ",
        "| satin-gold ", "- ours over analytic: median "}) {
    EXPECT_THAT(run.output, HasSubstr(text));
  }
  EXPECT_THAT(run.output, Not(HasSubstr("left out")));  // a formula has no angles
  EXPECT_EQ(Read(folder / "results/measured.md"), run.output);
}

TEST(Measured, LeavesOutEachInteriorAngleOfAList) {
  const TemporaryFolder folder;
  WriteMeasurements(folder / "list.csv");
  std::vector<std::string> flags = kTinyImages;
  flags.insert(flags.end(), {"--scene=" PBNBRDF_SCENES "/sphere.json", folder / "list.csv"});
  const ProgramResult run = RunIn(folder, "measured", flags);
  ASSERT_EQ(run.status, 0);
  EXPECT_THAT(run.output, Not(HasSubstr("PSNR")));  // a list has no picture
  EXPECT_THAT(run.output, HasSubstr("### Error at incident angles left out"));
  EXPECT_THAT(run.output, testing::ContainsRegex("below 1 at [0-3] of 3 angles"));
}

TEST(Measured, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  for (const char* flag : {"--film_width=5", "--scene=absent.json", "--epochs=-1", "absent.bsdf"}) {
    std::vector<std::string> flags = kTinyImages;
    flags.insert(flags.end(), {"--scene=" PBNBRDF_SCENES "/sphere.json", flag});
    EXPECT_EQ(RunIn(folder, "measured", flags).status, 1) << flag;
  }
  EXPECT_EQ(RunIn(folder, "measured", {"--scene=" PBNBRDF_SCENES "/sphere.json"}).status, 1);
}

}  // namespace
}  // namespace pbnbrdf

// pbnbrdf compare: its output, its error map, its errors.
#include <array>
#include <cstring>

#include "cli/cli_fixture.h"
#include "image/images.h"
#include "metrics/lpips_weights.h"
#include "network/safetensors.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf {
namespace {

class Compare : public Cli {
 protected:
  Compare() {
    WriteExr(Path("reference.exr"), reference_);
    WriteExr(Path("test.exr"), test_);
  }

  std::string Command(const std::string& reference, const std::string& test) const {
    return "compare " + Path(reference) + " " + Path(test);
  }

  const Image reference_ = RandomImage(30, 20, 0.0, 2.0, 1),
              test_ = RandomImage(30, 20, 0.0, 2.0, 2);
};

TEST_F(Compare, JsonHoldsEveryMeasure) {
  const Result result = Run(Command("reference.exr", "test.exr") + " --json");
  ASSERT_EQ(result.status, 0) << result.err;
  const ImageErrors errors = CompareImages(reference_, test_);
  const nlohmann::ordered_json expected = {
      {"mae", errors.mae},           {"mse", errors.mse},
      {"rmse", errors.rmse},         {"psnr", errors.psnr},
      {"ssim", errors.ssim},         {"flip", errors.flip},
      {"hdr_flip", errors.hdr_flip}, {"delta_e_2000", errors.delta_e_2000}};
  EXPECT_EQ(result.out, expected.dump(2) + "\n");
}

TEST_F(Compare, TextNamesEveryMeasure) {
  const Result result = Run(Command("reference.exr", "test.exr"));
  for (const char* key :
       {"mae ", "mse ", "rmse ", "psnr ", "ssim ", "flip ", "hdr_flip ", "delta_e_2000 "}) {
    EXPECT_THAT(result.out, HasSubstr(key));
  }
  EXPECT_THAT(Run("compare --help").out, HasSubstr("99th percentile"));
}

TEST_F(Compare, EqualImages) {
  const Result result = Run(Command("test.exr", "test.exr") + " --json");
  const json measures = json::parse(result.out);
  EXPECT_TRUE(measures.at("psnr").is_null());
  EXPECT_EQ(measures.at("rmse"), 0.0);
  EXPECT_EQ(measures.at("flip"), 0.0);
  EXPECT_THAT(Run(Command("test.exr", "test.exr")).out, HasSubstr("psnr          inf"));
}

// The bytes of an OpenEXR file, one of its windows replaced.
std::string WithWindow(std::string bytes, const std::string& name,
                       std::array<std::int32_t, 4> window) {
  const std::size_t header = bytes.find(name) + name.size() + sizeof("box2i") + 5;
  std::memcpy(&bytes[header], window.data(), sizeof(window));
  return bytes;
}

// Where a file stores nothing its image is unknown, not black.
TEST_F(Compare, PartsOfAnImageAreComparedWhereBothAreKnown) {
  const PixelRegion part = {5, 0, 25, 16};
  const Image cropped = Crop(reference_, part);
  std::string bytes = WithWindow(ExrBytes(cropped), "dataWindow", {5, 0, 24, 15});
  bytes = WithWindow(bytes, "displayWindow", {0, 0, 29, 19});
  WriteBytes(Path("part.exr"), bytes);
  const Result same = Run(Command("reference.exr", "part.exr"));
  EXPECT_THAT(same.out, HasSubstr("psnr          inf"));
  EXPECT_THAT(same.out, HasSubstr("Compared where both files have pixels: 20 x 16 from (5, 0)."));
  const json other = json::parse(Run(Command("part.exr", "test.exr") + " --json").out);
  EXPECT_EQ(other.at("rmse"), CompareImages(cropped, Crop(test_, part)).rmse);
  EXPECT_EQ(other.at("region"), json({5, 0, 20, 16}));

  WriteBytes(Path("moved.exr"),
             WithWindow(WithWindow(ExrBytes(test_), "dataWindow", {7, 0, 36, 19}), "displayWindow",
                        {7, 0, 36, 19}));
  ExpectError(Command("reference.exr", "moved.exr"), 1, "its display window begins at (7, 0)");
}

TEST_F(Compare, ErrorMap) {
  const std::string map = " --error_map=" + Path("map.exr");
  ASSERT_EQ(Run(Command("reference.exr", "test.exr") + map).status, 0);
  EXPECT_EQ(ReadExr(Path("map.exr")).rgb, AbsoluteDifference(reference_, test_).rgb);
}

TEST_F(Compare, TakesPng) {
  WritePng(Path("reference.png"), reference_);
  const Result result = Run(Command("reference.png", "reference.exr") + " --json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).at("mae"),
            MeasureLinearErrors(ReadPng(Path("reference.png")), reference_).mae);
}

TEST_F(Compare, Errors) {
  ExpectError("compare", 2, "the reference image is missing");
  ExpectError("compare " + Path("test.exr"), 2, "the test image is missing");
  ExpectError(Command("test.exr", "test.exr") + " third.exr", 2, "'third.exr' is not a flag");
  ExpectError(Command("test.exr", "no.exr"), 1, "no.exr: no such file");
  ExpectError(Command("test.exr", "test.exr") + " --error_map=" + Path("none/out"), 1,
              "cannot write: no folder");

  WriteExr(Path("small.exr"), Image(29, 20));
  ExpectError(Command("reference.exr", "small.exr"), 1, "small.exr: 29 x 20 pixels, but ");
  WriteBytes(Path("cut.exr"), ExrBytes(test_).substr(0, 3000));
  ExpectError(Command("reference.exr", "cut.exr"), 1, "cut.exr: truncated");
  WriteBytes(Path("text.exr"), "no image");
  ExpectError(Command("text.exr", "test.exr"), 1, "text.exr: neither an OpenEXR nor a PNG file");
  Image bad = test_;
  bad.rgb[0] = std::nanf("");
  WriteExr(Path("nan.exr"), bad);
  ExpectError(Command("reference.exr", "nan.exr"), 1, "nan.exr: R of pixel (0, 0) is nan");
}

class CompareLpips : public Compare {
 protected:
  CompareLpips() {
    WriteExr(Path("large_reference.exr"), large_reference_);
    WriteExr(Path("large_test.exr"), large_test_);
  }

  void ExpectLpipsError(const std::string& file, const std::string& message) const {
    ExpectError(large_ + " --lpips=" + Path(file), 1, Path(file) + ": " + message);
  }

  const Image large_reference_ = RandomImage(45, 33, 0.0, 2.0, 3),
              large_test_ = RandomImage(45, 33, 0.0, 2.0, 4);
  const LpipsWeights weights_ = RandomLpipsWeights(1);
  const std::string large_ = Command("large_reference.exr", "large_test.exr");
};

TEST_F(CompareLpips, IsThatOfTheShownImages) {
  WriteFile(Path("alex.safetensors"), SafetensorsBytes(LpipsFile(weights_)));
  const std::string command = large_ + " --lpips=" + Path("alex.safetensors");
  const Result result = Run(command + " --json"), without = Run(large_ + " --json");
  ASSERT_EQ(result.status, 0) << result.err;
  const double exposure = DisplayExposure(large_reference_);
  auto expected = nlohmann::ordered_json::parse(without.out);
  EXPECT_FALSE(expected.contains("lpips"));
  expected["lpips"] = Lpips(DisplayImage(large_reference_, exposure),
                            DisplayImage(large_test_, exposure), weights_);
  EXPECT_GT(expected["lpips"], 0.01);
  EXPECT_EQ(result.out, expected.dump(2) + "\n");
  EXPECT_THAT(Run(command).out, HasSubstr("\nlpips "));
  EXPECT_THAT(Run(large_).out, Not(HasSubstr("lpips")));
}

TEST_F(CompareLpips, Misuse) {
  ExpectError(large_ + " --lpips", 2, "--lpips needs a value");
  ExpectError(large_ + " --lpips=", 2, "--lpips= needs a file");
  WriteFile(Path("alex.safetensors"), SafetensorsBytes(LpipsFile(weights_)));
  ExpectError(Command("reference.exr", "test.exr") + " --lpips=" + Path("alex.safetensors"), 1,
              "reference.exr: 30 x 20 pixels; LPIPS needs at least 31 x 31");
}

TEST_F(CompareLpips, UnusableFiles) {
  ExpectLpipsError("none.safetensors", "no such file");
  ExpectLpipsError("test.exr", "not a safetensors file");

  SafetensorsFile file = LpipsFile(weights_);
  const std::string bytes = SafetensorsBytes(file);
  WriteBytes(Path("cut.safetensors"), bytes.substr(0, bytes.size() / 2));
  ExpectLpipsError("cut.safetensors", "tensor ");
  WriteBytes(Path("header.safetensors"), bytes.substr(0, 100));
  ExpectLpipsError("header.safetensors", "not a safetensors file");

  for (const auto& [name, tensor] : LpipsFile(weights_).tensors) {
    if (name.starts_with("lins.") || name.starts_with("scaling_layer")) continue;
    file = LpipsFile(weights_);
    file.tensors.erase(name);
    WriteFile(Path("less.safetensors"), SafetensorsBytes(file));
    ExpectLpipsError("less.safetensors", StrCat("no tensor ", name, " (", ShapeText(tensor.shape)));
  }

  file = LpipsFile(weights_);
  file.tensors["net.slice3.6.weight"].shape = {192, 384, 3, 3};
  WriteFile(Path("turned.safetensors"), SafetensorsBytes(file));
  ExpectLpipsError(
      "turned.safetensors",
      "tensor net.slice3.6.weight: shape 192 x 384 x 3 x 3, expected 384 x 192 x 3 x 3");
  file = LpipsFile(weights_);
  file.tensors["lin4.model.1.weight"].shape = {256};
  WriteFile(Path("flat.safetensors"), SafetensorsBytes(file));
  ExpectLpipsError("flat.safetensors",
                   "tensor lin4.model.1.weight: shape 256, expected 1 x 256 x 1 x 1");
  file = LpipsFile(weights_);
  file.tensors["net.slice1.0.bias"].values[3] = std::nan("");
  WriteFile(Path("nan.safetensors"), SafetensorsBytes(file));
  ExpectLpipsError("nan.safetensors", "tensor net.slice1.0.bias: holds a value that is not finite");
  file = LpipsFile(weights_);
  for (double& weight : file.tensors["net.slice2.3.weight"].values) weight *= 1e300;
  WriteFile(Path("huge.safetensors"), SafetensorsBytes(file));
  ExpectLpipsError("huge.safetensors", "LPIPS isn't finite: ");
}

}  // namespace
}  // namespace pbnbrdf

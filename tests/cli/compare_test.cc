// pbnbrdf compare: its output, its error map, its errors.
#include "cli/cli_fixture.h"
#include "image/images.h"
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
  ExpectError(Command("test.exr", "test.exr") + " --lpips=weights.bin", 1, "LPIPS isn't supported");
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

}  // namespace
}  // namespace pbnbrdf

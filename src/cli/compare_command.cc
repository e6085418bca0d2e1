// pbnbrdf compare
#include <gflags/gflags.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/base/text.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/open_image.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "shared_flags.h"

DEFINE_string(error_map, "", "OpenEXR file to write: |test - reference|, linear RGB");
DEFINE_string(lpips, "", "not supported: LPIPS needs the weights of an image network");

namespace pbnbrdf::cli {
namespace {

struct Measure {
  const char* key;
  double ImageErrors::*value;
  const char* meaning;
};

constexpr Measure kMeasures[] = {
    {"mae", &ImageErrors::mae, "mean absolute error of the linear values"},
    {"mse", &ImageErrors::mse, "mean square error of the linear values"},
    {"rmse", &ImageErrors::rmse, "its root"},
    {"psnr", &ImageErrors::psnr, "dB, peak 1, shown images; inf (JSON: null) if they are equal"},
    {"ssim", &ImageErrors::ssim, "shown images, 11 x 11 Gaussian window of sigma 1.5; 1 if equal"},
    {"flip", &ImageErrors::flip, "mean FLIP of the shown images at 67 pixels per degree, 0 to 1"},
    {"hdr_flip", &ImageErrors::hdr_flip, "mean HDR-FLIP: the largest FLIP over many exposures"},
    {"delta_e_2000", &ImageErrors::delta_e_2000, "mean CIE Delta E 2000 of the shown colours"}};

nlohmann::ordered_json ToJson(const ImageErrors& errors) {
  nlohmann::ordered_json json;
  for (const Measure& measure : kMeasures) {
    const double value = errors.*measure.value;
    json[measure.key] = value;
    if (std::isinf(value)) json[measure.key] = nullptr;  // JSON has no infinity
  }
  return json;
}

void PrintText(const ImageErrors& errors) {
  for (const Measure& measure : kMeasures) {
    std::cout << std::left << std::setw(14) << measure.key << std::setw(13) << errors.*measure.value
              << measure.meaning << "\n";
  }
  std::cout << "Shown: sRGB of " << errors.exposure << " times the linear value, cut to [0, 1].\n";
}

int RunCompare(const std::vector<std::string>& arguments) {
  if (!FLAGS_lpips.empty()) {
    Fail("--lpips=", FLAGS_lpips,
         ": LPIPS isn't supported: it needs the weights of an image network, which can't be read");
  }
  if (!FLAGS_error_map.empty()) CheckWritable(FLAGS_error_map);
  const std::string& reference_path = arguments[0];
  const std::string& test_path = arguments[1];
  const Image reference = OpenImage(reference_path), test = OpenImage(test_path);
  CheckComparable(reference, test, reference_path, test_path);
  const ImageErrors errors = CompareImages(reference, test);
  if (!FLAGS_error_map.empty()) {
    WriteExr(FLAGS_error_map, AbsoluteDifference(reference, test),
             {{"reference", reference_path},
              {"test", test_path},
              {"rmse", FormatNumber(errors.rmse)},
              {"software", StrCat("pbnbrdf ", PBNBRDF_VERSION)}});
  }
  if (FLAGS_json) {
    std::cout << ToJson(errors).dump(2) << "\n";
  } else {
    PrintText(errors);
  }
  return 0;
}

}  // namespace

Command CompareCommand() {
  Command command;
  command.name = "compare";
  command.summary = "measures how far an image is from a reference";
  command.usage =
      "  pbnbrdf compare reference.exr test.exr\n"
      "  pbnbrdf compare reference.exr test.exr --json --error_map=err.exr\n";
  command.notes =
      "Images are OpenEXR (channels R, G, B: half, float or integer) or PNG (8 or 16 bits, taken "
      "as\n"
      "sRGB); both of the same size, at least 11 x 11. Nothing is rounded on the way.\n"
      "mae, mse, rmse are of the linear values. psnr, ssim, flip, delta_e_2000 are of what a "
      "screen\n"
      "shows: both images times one exposure, 1 / the 99th percentile of the reference's "
      "luminance,\n"
      "cut to [0, 1]; sRGB values for psnr and ssim. hdr_flip looks at exposures from that for "
      "the\n"
      "reference's brightest pixel to that for its median, so that highlights count.\n"
      "JSON keys: mae mse rmse psnr ssim flip hdr_flip delta_e_2000; psnr is null if the shown\n"
      "images are equal.\n";
  command.flags = {{"", {"json", "error_map", "lpips"}}};
  command.arguments = {"the reference image", "the test image"};
  command.run = RunCompare;
  return command;
}

}  // namespace pbnbrdf::cli

// pbnbrdf compare
#include <gflags/gflags.h>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/text.h"
#include "commands.h"
#include "lpips_weights.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/open_image.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "shared_flags.h"

DEFINE_string(error_map, "", "OpenEXR file to write: |test - reference|, linear RGB");
DEFINE_string(lpips, "",
              "safetensors file of the weights of LPIPS with AlexNet: measures that, too");

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

constexpr char kLpipsMeaning[] = "shown images, features of AlexNet; 0 if equal";

struct Measured {
  ImageErrors errors;
  std::optional<double> lpips;  // if it is asked for
};

nlohmann::ordered_json ToJson(const Measured& measured) {
  nlohmann::ordered_json json;
  for (const Measure& measure : kMeasures) {
    const double value = measured.errors.*measure.value;
    json[measure.key] = value;
    if (std::isinf(value)) json[measure.key] = nullptr;  // JSON has no infinity
  }
  if (measured.lpips) json["lpips"] = *measured.lpips;
  return json;
}

void PrintText(const Measured& measured) {
  const auto print = [](const char* key, double value, const char* meaning) {
    std::cout << std::left << std::setw(14) << key << std::setw(13) << value << meaning << "\n";
  };
  for (const Measure& measure : kMeasures) {
    print(measure.key, measured.errors.*measure.value, measure.meaning);
  }
  if (measured.lpips) print("lpips", *measured.lpips, kLpipsMeaning);
  std::cout << "Shown: sRGB of " << measured.errors.exposure
            << " times the linear value, cut to [0, 1].\n";
}

// The weights if --lpips is given. Throws Error.
std::optional<LpipsWeights> RequestedLpipsWeights() {
  if (!IsGiven("lpips")) return std::nullopt;
  if (FLAGS_lpips.empty()) throw UsageError("--lpips= needs a file");
  return ReadLpipsWeights(FLAGS_lpips);
}

// Of the shown images. Throws Error, which names the file of weights.
double ShownLpips(const Image& reference, const Image& test, double exposure,
                  const LpipsWeights& weights) {
  const Image shown_reference = DisplayImage(reference, exposure);
  const Image shown_test = DisplayImage(test, exposure);
  try {
    return Lpips(shown_reference, shown_test, weights);
  } catch (const Error& error) {
    Fail(FLAGS_lpips, ": ", error.what());
  }
}

int RunCompare(const std::vector<std::string>& arguments) {
  if (!FLAGS_error_map.empty()) CheckWritable(FLAGS_error_map);
  const std::optional<LpipsWeights> lpips = RequestedLpipsWeights();
  const std::string& reference_path = arguments[0];
  const std::string& test_path = arguments[1];
  const Image reference = OpenImage(reference_path), test = OpenImage(test_path);
  CheckComparable(reference, test, reference_path, test_path);
  if (lpips) CheckLargeEnoughForLpips(reference, reference_path);
  Measured measured{CompareImages(reference, test), std::nullopt};
  if (lpips) measured.lpips = ShownLpips(reference, test, measured.errors.exposure, *lpips);
  if (!FLAGS_error_map.empty()) {
    WriteExr(FLAGS_error_map, AbsoluteDifference(reference, test),
             {{"reference", reference_path},
              {"test", test_path},
              {"rmse", FormatNumber(measured.errors.rmse)},
              {"software", StrCat("pbnbrdf ", PBNBRDF_VERSION)}});
  }
  if (FLAGS_json) {
    std::cout << ToJson(measured).dump(2) << "\n";
  } else {
    PrintText(measured);
  }
  return 0;
}

constexpr char kNotes[] =
    "Images are OpenEXR (channels R, G, B: half, float or integer) or PNG (8 or 16 bits, taken as\n"
    "sRGB); both of the same size, at least 11 x 11. Nothing is rounded on the way.\n"
    "mae, mse, rmse are of the linear values. psnr, ssim, flip, delta_e_2000, lpips are of what a\n"
    "screen shows: both images times one exposure, 1 / the 99th percentile of the reference's\n"
    "luminance, cut to [0, 1]; sRGB values for psnr, ssim and lpips. hdr_flip looks at exposures\n"
    "from that for the reference's brightest pixel to that for its median, so that highlights\n"
    "count.\n"
    "JSON keys: mae mse rmse psnr ssim flip hdr_flip delta_e_2000, and lpips with --lpips; psnr\n"
    "is null if the shown images are equal.\n"
    "lpips is LPIPS 0.1 with AlexNet (Zhang et al. 2018), for images of at least 31 x 31. The\n"
    "weights don't come with this program; the Python package lpips has them:\n"
    "  import lpips, safetensors.torch; w = lpips.LPIPS(net='alex').state_dict()\n"
    "  safetensors.torch.save_file({k: v.clone() for k, v in w.items()}, 'alex.safetensors')\n";

}  // namespace

Command CompareCommand() {
  Command command;
  command.name = "compare";
  command.summary = "measures how far an image is from a reference";
  command.usage =
      "  pbnbrdf compare reference.exr test.exr\n"
      "  pbnbrdf compare reference.exr test.exr --json --error_map=err.exr\n"
      "  pbnbrdf compare reference.exr test.exr --lpips=alex.safetensors\n";
  command.notes = kNotes;
  command.flags = {{"", {"json", "error_map", "lpips"}}};
  command.arguments = {"the reference image", "the test image"};
  command.run = RunCompare;
  return command;
}

}  // namespace pbnbrdf::cli

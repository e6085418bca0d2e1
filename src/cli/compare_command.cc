// pbnbrdf compare
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/text.h"
#include "commands.h"
#include "lpips_weights.h"
#include "outputs.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/open_image.h"
#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf::cli {
namespace {

struct CompareOptions {
  bool json = false;
  std::string error_map, lpips;
};

Fields CompareFields(CompareOptions* options) {
  Fields fields;
  fields.AddCommon(Switch("json", &options->json, "print one JSON object"));
  fields.AddCommon(Text("error_map", &options->error_map,
                        "OpenEXR file to write: |test - reference|, linear RGB"));
  fields.AddCommon(Custom(
      "lpips",
      [options](std::string_view text) {
        if (text.empty()) Fail("lpips= needs a file");
        options->lpips = text;
      },
      [options] { return options->lpips; }, [] {},
      "measure LPIPS, too, with the weights of AlexNet in this safetensors file"));
  return fields;
}

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

// Of the shown images. Throws Error, which names the file of weights.
double ShownLpips(const Image& reference, const Image& test, double exposure,
                  const LpipsWeights& weights, const std::string& file) {
  const Image shown_reference = DisplayImage(reference, exposure);
  const Image shown_test = DisplayImage(test, exposure);
  try {
    return Lpips(shown_reference, shown_test, weights);
  } catch (const Error& error) {
    Fail(file, ": ", error.what());
  }
}

// Measures the two images, and writes the map of errors if it is asked for.
Measured Compare(const CompareOptions& options, const std::string& reference_path,
                 const std::string& test_path) {
  std::optional<LpipsWeights> lpips;
  if (!options.lpips.empty()) lpips = ReadLpipsWeights(options.lpips);
  const Image reference = OpenImage(reference_path), test = OpenImage(test_path);
  CheckComparable(reference, test, reference_path, test_path);
  if (lpips) CheckLargeEnoughForLpips(reference, reference_path);
  Measured measured{CompareImages(reference, test), std::nullopt};
  if (lpips) {
    measured.lpips = ShownLpips(reference, test, measured.errors.exposure, *lpips, options.lpips);
  }
  if (!options.error_map.empty()) {
    WriteExr(options.error_map, AbsoluteDifference(reference, test),
             {{"reference", reference_path},
              {"test", test_path},
              {"rmse", FormatNumber(measured.errors.rmse)},
              {"software", StrCat("pbnbrdf ", PBNBRDF_VERSION)}});
  }
  return measured;
}

int RunCompare(const CompareOptions& options, const Arguments& arguments) {
  CheckOutputs({{"error_map", options.error_map}});
  const Measured measured = Compare(options, arguments[0], arguments[1]);
  if (options.json) {
    std::cout << ToJson(measured).dump(2) << "\n";
  } else {
    PrintText(measured);
  }
  return 0;
}

constexpr char kNotes[] =
    "Images are OpenEXR files (channels R, G, B: half, float or integer) or PNG files (8 or 16 "
    "bits, "
    "taken as sRGB). Both must have the same size, at least 11 x 11. Values are never rounded.\n"
    "mae, mse and rmse are errors of the linear values. psnr, ssim, flip, delta_e_2000 and lpips "
    "are "
    "errors of what a screen shows: both images are multiplied by one exposure, 1 / the 99th "
    "percentile of the reference's luminance, and cut to [0, 1]; psnr, ssim and lpips compare "
    "their "
    "sRGB values. hdr_flip covers exposures from one that suits the reference's brightest pixel to "
    "one that suits its median, so that highlights count.\n"
    "JSON keys: mae mse rmse psnr ssim flip hdr_flip delta_e_2000, and lpips with --lpips; psnr is "
    "null if the shown images are equal.\n"
    "lpips is LPIPS 0.1 with AlexNet (Zhang et al. 2018), for images of at least 31 x 31. The "
    "weights "
    "don't come with this program; the Python package lpips has them:\n"
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
  command.arguments = {"the reference image", "the test image"};
  command.Takes(CompareFields, RunCompare);
  return command;
}

}  // namespace pbnbrdf::cli

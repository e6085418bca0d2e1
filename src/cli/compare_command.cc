// pbnbrdf compare
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/text.h"
#include "command_line.h"
#include "measure/shown_lpips.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/metrics/image_metrics.h"
#include "pbnbrdf/metrics/lpips.h"

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
  PixelRegion region;           // that was compared
  bool is_part;                 // of the images
  std::optional<double> lpips;  // if it is asked for
};

Json MeasuredJson(const Measured& measured) {
  Json json;
  for (const Measure& measure : kMeasures) {
    const double value = measured.errors.*measure.value;
    json[measure.key] = value;
    if (std::isinf(value)) json[measure.key] = nullptr;  // JSON has no infinity
  }
  if (measured.lpips) json["lpips"] = *measured.lpips;
  if (measured.is_part) {
    const PixelRegion& region = measured.region;
    json["region"] = {region.left, region.top, region.width(), region.height()};
  }
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
  if (!measured.is_part) return;
  std::cout << "Compared where both files have pixels: " << measured.region.width() << " x "
            << measured.region.height() << " from (" << measured.region.left << ", "
            << measured.region.top << ").\n";
}

// Where both files have pixels. Throws Error if that is nowhere, or if they place the image differently.
PixelRegion CommonRegion(const StoredImage& reference, const StoredImage& test,
                         const std::string& reference_path, const std::string& test_path) {
  if (reference.left != test.left || reference.top != test.top) {
    Fail(test_path, ": its display window begins at (", test.left, ", ", test.top, "), that of ",
         reference_path, " at (", reference.left, ", ", reference.top, ")");
  }
  const PixelRegion &a = reference.stored, &b = test.stored;
  const PixelRegion both = {std::max(a.left, b.left), std::max(a.top, b.top),
                            std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
  if (both.width() <= 0 || both.height() <= 0) {
    Fail(test_path, ": nowhere do both this file and ", reference_path, " have pixels");
  }
  return both;
}

// Measures the two images, and writes the map of errors if it is asked for.
Measured Compare(const CompareOptions& options, const std::string& reference_path,
                 const std::string& test_path) {
  std::optional<ShownLpips> lpips;
  if (!options.lpips.empty()) lpips.emplace(options.lpips);
  const StoredImage reference_file = OpenStoredImage(reference_path);
  const StoredImage test_file = OpenStoredImage(test_path);
  CheckComparable(reference_file.image, test_file.image, reference_path, test_path);
  const PixelRegion region = CommonRegion(reference_file, test_file, reference_path, test_path);
  const bool is_part =
      region.width() < reference_file.image.width || region.height() < reference_file.image.height;
  const Image reference = Crop(reference_file.image, region), test = Crop(test_file.image, region);
  CheckComparable(reference, test, reference_path, test_path);
  if (lpips) CheckLargeEnoughForLpips(reference, reference_path);
  Measured measured{CompareImages(reference, test), region, is_part, std::nullopt};
  if (lpips) measured.lpips = lpips->Of(reference, test, measured.errors.exposure);
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
    std::cout << JsonText(MeasuredJson(measured));
  } else {
    PrintText(measured);
  }
  return 0;
}

}  // namespace

Command CompareCommand() {
  return Command{
      .name = "compare",
      .summary = "measures how far an image is from a reference",
      .usage = R"(  pbnbrdf compare reference.exr test.exr
  pbnbrdf compare reference.exr test.exr --json --error_map=err.exr
  pbnbrdf compare reference.exr test.exr --lpips=alex.safetensors
)",
      .notes =
          R"(Images are OpenEXR files (channels R, G, B: half, float or integer) or PNG files (8 or 16 bits,
taken as sRGB). Both must have the same size, at least 11 x 11. Values are never rounded.
mae, mse and rmse are errors of the linear values. psnr, ssim, flip, delta_e_2000 and lpips are
errors of what a screen shows: both images are multiplied by one exposure, 1 / the 99th percentile
of the reference's luminance, and cut to [0, 1]; psnr, ssim and lpips compare their sRGB values.
hdr_flip covers exposures from one that suits the reference's brightest pixel to one that suits its
median, so that highlights count.
JSON keys: mae mse rmse psnr ssim flip hdr_flip delta_e_2000, and lpips with --lpips; psnr is null
if the shown images are equal; region (left, top, width, height) if only a part was compared.
OpenEXR files of different data windows are compared where both have pixels.
lpips is LPIPS 0.1 with AlexNet (Zhang et al. 2018), for images of at least 31 x 31. The weights
don't come with this program; the Python package lpips has them:
  import lpips, safetensors.torch; w = lpips.LPIPS(net='alex').state_dict()
  safetensors.torch.save_file({k: v.clone() for k, v in w.items()}, 'alex.safetensors')
)",
      .arguments = {"the reference image", "the test image"}}
      .With(CompareFields, RunCompare);
}

}  // namespace pbnbrdf::cli

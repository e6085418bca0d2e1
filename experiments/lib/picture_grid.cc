#include "picture_grid.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/image/png.h"
#include "pbnbrdf/metrics/flip.h"
#include "process.h"

namespace pbnbrdf {
namespace {

std::array<float, 3> Heat(double value) {
  const auto part = [&](double from) {
    return static_cast<float>(std::clamp(3.0 * value - from, 0.0, 1.0));
  };
  return {part(0.0), part(1.0), part(2.0)};
}

}  // namespace

Image Exposed(Image image, double exposure) {
  for (float& value : image.rgb) value = static_cast<float>(exposure * value);
  return image;
}

Image FlipPicture(const Image& reference, const Image& test, double max_flip) {
  const std::vector<double> flip = FlipMap(reference, test);
  Image map(reference.width, reference.height);
  for (std::size_t i = 0; i < flip.size(); ++i) {
    const auto color = Heat(flip[i] / max_flip);
    std::copy(color.begin(), color.end(), map.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return map;
}

Image PictureGrid::SideBySide() const {
  const Image& first = pictures_.at(0).image;
  const std::size_t rows = (pictures_.size() + columns_ - 1) / columns_;
  Image all(first.width * static_cast<int>(columns_), first.height * static_cast<int>(rows));
  for (std::size_t n = 0; n < pictures_.size(); ++n) {
    const int left = first.width * static_cast<int>(n % columns_);
    const int top = first.height * static_cast<int>(n / columns_);
    for (int y = 0; y < first.height; ++y) {
      const float* row = pictures_[n].image.pixel(0, y);
      std::copy(row, row + 3 * first.width, all.pixel(left, top + y));
    }
  }
  return all;
}

std::string PictureGrid::Write(const std::string& png) const {
  WritePng(png, SideBySide());
  const std::string parts = png + ".parts";
  std::filesystem::create_directories(parts);
  // Letters that leave room for 30 of them below a picture.
  const int points = std::max(6, pictures_.at(0).image.width / 19);
  std::vector<std::string> command = {"montage",     "-background", "white",       "-font",
                                      "DejaVu-Sans", "-pointsize",  StrCat(points)};
  for (std::size_t n = 0; n < pictures_.size(); ++n) {
    const std::string file = StrCat(parts, "/", n, ".png");
    WritePng(file, pictures_[n].image);
    command.insert(command.end(), {"-label", pictures_[n].label, file});
  }
  command.insert(command.end(),
                 {"-tile", StrCat(columns_, "x"), "-geometry", "+5+5", "-strip", png});
  const ProgramResult run = RunProgram(command);
  std::filesystem::remove_all(parts);
  return run.status == 0 ? "" : "no labels: ImageMagick's montage isn't there, or failed";
}

}  // namespace pbnbrdf

// picture_grid.h: pictures in rows, with what they show written below each, as one PNG.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// The same picture in other light: each value times the exposure.
Image Exposed(Image image, double exposure);

// FLIP of each pixel of two pictures for a screen: black where there is none, over red and yellow to white at max_flip.
Image FlipPicture(const Image& reference, const Image& test, double max_flip);

class PictureGrid {
 public:
  explicit PictureGrid(std::size_t columns) : columns_(columns) {}

  // Row by row; linear, what is above 1 is white. All have the same size.
  void Add(const std::string& label, const Image& picture) {
    pictures_.push_back({label, picture});
  }

  // Laid out with its labels by ImageMagick's `montage`; where that is missing, without labels, side by side. Returns
  // "" or, in a sentence, why there are no labels. Throws Error if the file can't be written.
  std::string Write(const std::string& png) const;

 private:
  struct Picture {
    std::string label;
    Image image;
  };

  Image SideBySide() const;

  std::size_t columns_;
  std::vector<Picture> pictures_;
};

}  // namespace pbnbrdf

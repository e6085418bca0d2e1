// images.h: what the tests of images and of their measures make.
#pragma once

#include "pbnbrdf/image/image.h"
#include "test_util.h"

namespace pbnbrdf {

// Uniform values in [low, high).
inline Image RandomImage(int width, int height, double low, double high, unsigned seed) {
  Image image(width, height);
  const std::vector<double> numbers = RandomNumbers(image.rgb.size(), low, high, seed);
  std::copy(numbers.begin(), numbers.end(), image.rgb.begin());
  return image;
}

inline Image ConstantImage(int width, int height, float red, float green, float blue) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = red, image.rgb[i + 1] = green, image.rgb[i + 2] = blue;
  }
  return image;
}

// Reads the first 0/20, 1/20, ..., 19/20 of the bytes as a file of that kind, and all but the last
// one: each is an Error that names the file, in one line.
template <typename Reader>
void ExpectEveryTruncationFails(const std::string& bytes, const std::string& path, Reader read) {
  std::vector<std::size_t> lengths = {bytes.size() - 1};
  for (std::size_t part = 0; part < 20; ++part) lengths.push_back(bytes.size() * part / 20);
  for (std::size_t length : lengths) {
    WriteBytes(path, bytes.substr(0, length));
    const std::string error = ErrorOf([&] { read(path); });
    EXPECT_THAT(error, testing::StartsWith(path + ": ")) << length << " of " << bytes.size();
    EXPECT_THAT(error, testing::Not(testing::HasSubstr("\n"))) << length;
  }
}

}  // namespace pbnbrdf

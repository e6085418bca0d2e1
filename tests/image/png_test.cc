// Images through PNG files: our own, and those of other kinds that libpng writes.
#include "pbnbrdf/image/png.h"

#include <png.h>

#include <limits>

#include "image/images.h"
#include "image/srgb.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

TEST(Srgb, KnownValuesAndInverse) {
  EXPECT_EQ(ToSrgb(-1.0), 0.0);
  EXPECT_EQ(ToSrgb(std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(ToSrgb(1.0), 1.0);
  EXPECT_EQ(ToSrgb(1e9), 1.0);
  EXPECT_NEAR(ToSrgb(0.18), 0.461356129500442, 1e-14);  // 1.055 * 0.18^(1/2.4) - 0.055
  EXPECT_DOUBLE_EQ(ToSrgb(0.001), 0.01292);
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(ToSrgb(FromSrgb(i / 1000.0)), i / 1000.0, 1e-7);
}

TEST(Png, RoundsTheEncodedValue) {
  TemporaryFolder folder;
  Image image = RandomImage(31, 17, -0.2, 1.5, 1);
  image.rgb[5] = std::numeric_limits<float>::infinity();
  WritePng(folder / "a.png", image);
  for (const Image& read : {ReadPng(folder / "a.png"), OpenImage(folder / "a.png")}) {
    ASSERT_EQ(read.width, 31);
    ASSERT_EQ(read.height, 17);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
      EXPECT_NEAR(ToSrgb(read.rgb[i]), ToSrgb(image.rgb[i]), 0.5 / 255 + 1e-6);
    }
  }
}

TEST(Png, EveryEightBitValueRoundTrips) {
  TemporaryFolder folder;
  Image image(256, 1);
  for (int i = 0; i < 256; ++i) {
    for (int c = 0; c < 3; ++c) image.pixel(i, 0)[c] = float(FromSrgb((i + 85 * c) % 256 / 255.0));
  }
  WritePng(folder / "a.png", image);
  EXPECT_EQ(ReadPng(folder / "a.png").rgb, image.rgb);
}

TEST(Png, ExposureComesBeforeTheCut) {
  const Image image = RandomImage(16, 16, 0.0, 4.0, 2);
  Image quarter = image;
  for (float& value : quarter.rgb) value *= 0.25f;
  EXPECT_EQ(PngBytes(image, 0.25), PngBytes(quarter));
  EXPECT_NE(PngBytes(image), PngBytes(quarter));
}

// rows: packed as PNG has them (16 bits: the high byte first).
std::string PngOf(int width, int height, int depth, int color_type,
                  std::vector<std::vector<png_byte>> rows, int interlace = PNG_INTERLACE_NONE) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto append = [](png_structp p, png_bytep data, std::size_t count) {
    static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), count);
  };
  png_set_write_fn(png, &bytes, append, nullptr);
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), depth, color_type, interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[2] = {{255, 0, 51}, {0, 102, 255}};
  if (color_type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 2);
  std::vector<png_bytep> pointers;
  for (auto& row : rows) pointers.push_back(row.data());
  png_set_rows(png, info, pointers.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::vector<float> ReadBack(const std::string& png) {
  TemporaryFolder folder;
  WriteBytes(folder / "a.png", png);
  return ReadPng(folder / "a.png").rgb;
}

std::vector<float> Linear(std::initializer_list<double> encoded) {
  std::vector<float> values;
  for (double value : encoded) values.push_back(float(FromSrgb(value)));
  return values;
}

TEST(Png, ReadsEveryKind) {
  // 16 bits aren't cut to 8.
  EXPECT_EQ(ReadBack(PngOf(1, 1, 16, PNG_COLOR_TYPE_RGB, {{0x12, 0x34, 0, 1, 255, 255}})),
            Linear({0x1234 / 65535.0, 1 / 65535.0, 1.0}));
  EXPECT_EQ(ReadBack(PngOf(2, 1, 8, PNG_COLOR_TYPE_GRAY, {{51, 204}})),
            Linear({0.2, 0.2, 0.2, 0.8, 0.8, 0.8}));
  EXPECT_EQ(ReadBack(PngOf(2, 1, 1, PNG_COLOR_TYPE_GRAY, {{0x40}})), Linear({0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(ReadBack(PngOf(1, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {{51, 102, 204, 255}})),
            Linear({0.2, 0.4, 0.8}));
  EXPECT_EQ(ReadBack(PngOf(1, 1, 16, PNG_COLOR_TYPE_GRAY_ALPHA, {{0x33, 0x33, 255, 255}})),
            Linear({0.2, 0.2, 0.2}));
  EXPECT_EQ(ReadBack(PngOf(2, 1, 1, PNG_COLOR_TYPE_PALETTE, {{0x40}})),
            Linear({1.0, 0.0, 0.2, 0.0, 0.4, 1.0}));
  EXPECT_EQ(ReadBack(PngOf(2, 2, 8, PNG_COLOR_TYPE_RGB,
                           {{0, 51, 102, 51, 102, 153}, {102, 153, 204, 153, 204, 255}},
                           PNG_INTERLACE_ADAM7)),
            Linear({0, 0.2, 0.4, 0.2, 0.4, 0.6, 0.4, 0.6, 0.8, 0.6, 0.8, 1}));
}

// What an editor left under transparent pixels isn't seen.
TEST(Png, TransparentPixelsLieOnBlack) {
  EXPECT_EQ(
      ReadBack(PngOf(2, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {{51, 102, 204, 0, 51, 102, 204, 255}})),
      Linear({0, 0, 0, 0.2, 0.4, 0.8}));
  EXPECT_EQ(ReadBack(PngOf(1, 1, 16, PNG_COLOR_TYPE_GRAY_ALPHA, {{0x33, 0x33, 0, 0}})),
            Linear({0, 0, 0}));
}

TEST(Png, ErrorsNameTheFileAndWhatIsWrong) {
  TemporaryFolder folder;
  const std::string path = folder / "a.png";
  const auto error = [&] { return ErrorOf([&] { ReadPng(path); }); };
  EXPECT_EQ(error(), path + ": no such file");
  for (const char* bytes : {"", "\x89PNG", "not an image at all"}) {
    WriteBytes(path, bytes);
    EXPECT_EQ(error(), path + ": not a PNG file");
  }
  std::string png = PngBytes(Image(4, 4));
  png[17] = '\x7f';  // of the width; the header's checksum doesn't fit any more
  WriteBytes(path, png);
  EXPECT_THAT(error(), HasSubstr("damaged PNG file: IHDR: CRC error"));
  EXPECT_NE(ErrorOf([] { PngBytes(Image()); }), "");
}

TEST(Png, SizesAreBoundedBeforeMemoryIsTaken) {
  TemporaryFolder folder;
  const std::vector<png_byte> row(12);
  std::string png = PngOf(4, 1, 8, PNG_COLOR_TYPE_RGB, {row});
  // IHDR's data begin at 16: width and height, the high byte first; its checksum is at 29.
  const auto put = [&](std::size_t at, png_uint_32 value) {
    png_save_uint_32(reinterpret_cast<png_bytep>(&png[at]), value);
  };
  put(16, 900'000);
  put(20, 900'000);
  png_uint_32 crc = 0xffffffff;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= png_byte(png[i]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  put(29, ~crc);
  WriteBytes(folder / "a.png", png);
  EXPECT_THAT(ErrorOf([&] { ReadPng(folder / "a.png"); }),
              HasSubstr("900000 x 900000 pixels, at most 134217728 are read"));
}

TEST(Png, EveryTruncationIsAnError) {
  TemporaryFolder folder;
  ExpectEveryTruncationFails(PngBytes(RandomImage(40, 30, 0.0, 1.0, 5)), folder / "a.png", ReadPng);
}

}  // namespace
}  // namespace pbnbrdf

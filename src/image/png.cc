#include "pbnbrdf/image/png.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <vector>

#include "image/image_size.h"
#include "image/srgb.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

// More than twice kMaxPixels pixels of 16-bit RGB without compression.
constexpr std::uintmax_t kMaxPngBytes = std::uintmax_t(1) << 31;
constexpr std::size_t kSignatureBytes = 8;

// One file being read: what libpng's callbacks see. libpng reports errors by a jump back, so that
// whatever owns memory lives here, outside of the functions that are jumped over.
struct Reader {
  std::string bytes;
  std::size_t at = 0;
  std::string message;
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit Reader(std::string content) : bytes(std::move(content)) {}
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

void TakeBytes(png_structp png, png_bytep to, std::size_t count) {
  auto& reader = *static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader.bytes.size() - reader.at) png_error(png, "truncated");
  std::memcpy(to, reader.bytes.data() + reader.at, count);
  reader.at += count;
}

void NoteError(png_structp png, png_const_charp message) {
  static_cast<Reader*>(png_get_error_ptr(png))->message = message;
  png_longjmp(png, 1);
}

void IgnoreWarning(png_structp, png_const_charp) {}

// False, with reader.message set, if that isn't a PNG's beginning.
bool ReadHeader(Reader& reader) {
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, NoteError, IgnoreWarning);
  if (reader.png != nullptr) reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) {
    reader.message = "libpng couldn't start";
    return false;
  }
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, &reader, TakeBytes);
  png_read_info(reader.png, reader.info);
  png_set_expand(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_color_16 black = {};
  png_set_background(reader.png, &black, PNG_BACKGROUND_GAMMA_SCREEN, 0, 1.0);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

// The rows and what follows them; rows: as many pointers as the image has rows.
bool ReadRows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

Image ToLinear(const std::vector<png_byte>& bytes, int width, int height, bool sixteen_bits) {
  const std::size_t max = sixteen_bits ? 65535 : 255;
  std::vector<float> linear(max + 1);
  for (std::size_t i = 0; i <= max; ++i) {
    linear[i] = static_cast<float>(FromSrgb(static_cast<double>(i) / static_cast<double>(max)));
  }
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = linear[sixteen_bits ? 256u * bytes[2 * i] + bytes[2 * i + 1] : bytes[i]];
  }
  return image;
}

}  // namespace

std::string PngBytes(const Image& image, double exposure) {
  std::vector<png_byte> bytes(image.rgb.size());
  std::transform(image.rgb.begin(), image.rgb.end(), bytes.begin(), [&](float value) {
    return static_cast<png_byte>(std::lround(255.0 * ToSrgb(exposure * value)));
  });
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string png(size, '\0');
  if (!png_image_write_to_memory(&header, png.data(), &size, 0, bytes.data(), 0, nullptr)) {
    Fail("an image of ", image.width, " x ", image.height, " pixels as PNG: ", header.message);
  }
  png.resize(size);
  return png;
}

void WritePng(const std::string& path, const Image& image, double exposure) {
  WriteFile(path, PngBytes(image, exposure));
}

Image ReadPng(const std::string& path) {
  const std::string start = ReadStart(path, kSignatureBytes);
  if (start.size() < kSignatureBytes ||
      png_sig_cmp(reinterpret_cast<png_const_bytep>(start.data()), 0, kSignatureBytes) != 0) {
    Fail(path, ": not a PNG file");
  }
  Reader reader(ReadFile(path, kMaxPngBytes));
  if (!ReadHeader(reader)) Fail(path, ": truncated or damaged PNG file: ", reader.message);
  const std::size_t width = png_get_image_width(reader.png, reader.info);
  const std::size_t height = png_get_image_height(reader.png, reader.info);
  CheckImageSize(path, std::int64_t(width), std::int64_t(height), FileSize(path));
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  std::vector<png_byte> bytes(row_bytes * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = &bytes[y * row_bytes];
  if (!ReadRows(reader, rows.data())) {
    Fail(path, ": truncated or damaged PNG file: ", reader.message);
  }
  return ToLinear(bytes, static_cast<int>(width), static_cast<int>(height),
                  png_get_bit_depth(reader.png, reader.info) == 16);
}

}  // namespace pbnbrdf

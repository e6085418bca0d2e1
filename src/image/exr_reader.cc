#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfVersion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "image/exr_errors.h"
#include "image/image_size.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"

namespace pbnbrdf {
namespace {

constexpr const char* kLuminance = "Y";
constexpr int kMaxSide = 1 << 16;  // pixels, four times the width of a 16K environment map
constexpr std::uintmax_t kMaxExrBytes = std::uintmax_t{4} << 30;
constexpr float kSameChromaticity = 1e-4f;

using Channels = std::array<const char*, 3>;

std::string ChannelNames(const Imf::ChannelList& channels) {
  std::string names;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    names += StrCat(names.empty() ? "" : ", ", c.name());
  }
  return names.empty() ? "none" : names;
}

bool Has(const Imf::Header& header, const char* name) {
  return header.channels().findChannel(name) != nullptr;
}

// The channels of red, green and blue. Throws Error unless they are there at full resolution.
Channels ColorChannels(const std::string& path, const Imf::Header& header) {
  Channels names = {"R", "G", "B"};
  if (!Has(header, "R") && Has(header, kLuminance)) {
    if (Has(header, "RY") || Has(header, "BY")) {
      Fail(path, ": stored as luminance and chroma (Y, RY, BY); save it with channels R, G and B");
    }
    names.fill(kLuminance);
  }
  for (const char* name : names) {
    const Imf::Channel* channel = header.channels().findChannel(name);
    if (channel == nullptr) {
      Fail(path, ": no channel ", name, "; R, G and B are needed, it has ",
           ChannelNames(header.channels()));
    }
    if (channel->xSampling != 1 || channel->ySampling != 1) {
      Fail(path, ": channel ", name, " is stored at a lower resolution than the image");
    }
  }
  return names;
}

// The first part that is an image with colours; where there is none, the first.
int ColorPart(const Imf::MultiPartInputFile& file) {
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    if (header.hasType() && Imf::isDeepData(header.type())) continue;
    if (Has(header, "R") || Has(header, kLuminance)) return part;
  }
  return 0;
}

Image ReadWindow(Imf::InputPart& part, const Channels& channels, const Imath::Box2i& window) {
  Image image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
  constexpr std::size_t kStride = 3 * sizeof(float);
  const std::size_t row = kStride * static_cast<std::size_t>(image.width);
  Imf::FrameBuffer buffer;
  const bool is_grey = channels[0] == channels[1];
  for (std::size_t c = 0; c < (is_grey ? 1 : channels.size()); ++c) {
    buffer.insert(channels[c],
                  Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + c, window, kStride, row));
  }
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  for (std::size_t i = 0; is_grey && i < image.rgb.size(); i += 3) {
    image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
  }
  return image;
}

// What a file stores, moved to where it belongs in its display window: black where nothing is stored.
StoredImage Placed(Image image, const Imath::Box2i& data, const Imath::Box2i& display) {
  const Imath::V2i size = display.max - display.min + Imath::V2i(1), at = data.min - display.min;
  StoredImage placed;
  placed.left = display.min.x;
  placed.top = display.min.y;
  placed.stored = {std::max(at.x, 0), std::max(at.y, 0), std::min(at.x + image.width, size.x),
                   std::min(at.y + image.height, size.y)};
  if (data == display) {
    placed.image = std::move(image);
    return placed;
  }
  placed.image = Image(size.x, size.y);
  for (int y = placed.stored.top; y < placed.stored.bottom && placed.stored.width() > 0; ++y) {
    std::copy_n(image.pixel(placed.stored.left - at.x, y - at.y), 3 * placed.stored.width(),
                placed.image.pixel(placed.stored.left, y));
  }
  return placed;
}

// Linear RGB of some primaries and white to that of sRGB, for row vectors: the white becomes sRGB's white
// (Bradford's adaptation, as ICC profiles do).
Imath::M44f ToLinearSrgb(const Imf::Chromaticities& from) {
  constexpr float kBradford[4][4] = {{0.8951f, -0.7502f, 0.0389f, 0.0f},
                                     {0.2664f, 1.7135f, -0.0685f, 0.0f},
                                     {-0.1614f, 0.0367f, 1.0296f, 0.0f},
                                     {0.0f, 0.0f, 0.0f, 1.0f}};
  const Imath::M44f cones(kBradford), to_xyz = Imf::RGBtoXYZ(from, 1.0f);
  const Imf::Chromaticities srgb;
  const Imath::V3f white(1.0f);
  const Imath::V3f have = white * to_xyz * cones, want = white * Imf::RGBtoXYZ(srgb, 1.0f) * cones;
  Imath::M44f scale;
  scale.setScale(want / have);
  return to_xyz * cones * scale * cones.inverse() * Imf::XYZtoRGB(srgb, 1.0f);
}

bool AreSrgb(const Imf::Chromaticities& those) {
  const Imf::Chromaticities srgb;
  return those.red.equalWithAbsError(srgb.red, kSameChromaticity) &&
         those.green.equalWithAbsError(srgb.green, kSameChromaticity) &&
         those.blue.equalWithAbsError(srgb.blue, kSameChromaticity) &&
         those.white.equalWithAbsError(srgb.white, kSameChromaticity);
}

void ConvertToSrgb(const std::string& path, const Imf::Chromaticities& from, Image* image) {
  const Imath::M44f matrix = ToLinearSrgb(from);
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(matrix[i / 4][i % 4])) {
      Fail(path, ": attribute chromaticities: not those of a colour space");
    }
  }
  for (std::size_t i = 0; i < image->rgb.size(); i += 3) {
    float* rgb = &image->rgb[i];
    const Imath::V3f color = Imath::V3f(rgb[0], rgb[1], rgb[2]) * matrix;
    std::copy_n(&color.x, 3, rgb);
  }
}

StoredImage ReadPart(const std::string& path, Imf::MultiPartInputFile& file, int index) {
  const Imf::Header& header = file.header(index);
  const Channels channels = ColorChannels(path, header);
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  for (const Imath::Box2i& window : {data, display}) {
    CheckImageSize(path, std::int64_t(window.max.x) - window.min.x + 1,
                   std::int64_t(window.max.y) - window.min.y + 1, FileSize(path));
  }
  if (!file.partComplete(index)) Fail(path, ": truncated: pixels are missing");
  Imf::InputPart part(file, index);
  Image image = ReadWindow(part, channels, data);
  if (Imf::hasChromaticities(header) && !AreSrgb(Imf::chromaticities(header)) &&
      channels[0] != channels[1]) {
    ConvertToSrgb(path, Imf::chromaticities(header), &image);
  }
  return Placed(std::move(image), data, display);
}

// Throws Error if an environment map isn't of latitude and longitude.
void CheckLatLong(const std::string& path, const Imf::Header& header) {
  if (Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE) {
    Fail(path, ": a cube map; convert it to latitude-longitude (OpenEXR's exrenvmap -l does)");
  }
}

// A file's bytes, for OpenEXR: so that it may be a pipe.
class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(const std::string& path)
      : IStream(path.c_str()), bytes_(ReadFile(path, kMaxExrBytes)) {}

  bool read(char to[], int count) override {
    if (bytes_.copy(to, std::size_t(count), at_) != std::size_t(count)) {
      throw Iex::InputExc("the file ends early");
    }
    at_ += std::size_t(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = std::min<std::uint64_t>(at, bytes_.size()); }

 private:
  const std::string bytes_;
  std::uint64_t at_ = 0;
};

StoredImage Read(const std::string& path, bool is_environment) {
  const std::string magic = ReadStart(path, 4);
  if (magic.size() < 4 || !Imf::isImfMagic(magic.data())) Fail(path, ": not an OpenEXR file");
  // Of the process: OpenEXR has no other place for limits that hold before it takes memory.
  Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
  Imf::Header::setMaxTileSize(kMaxSide, kMaxSide);
  return TranslateExrErrors(path + ": truncated or damaged OpenEXR file: ", [&] {
    MemoryInput bytes(path);
    Imf::MultiPartInputFile file(bytes);
    const int part = ColorPart(file);
    if (is_environment) CheckLatLong(path, file.header(part));
    return ReadPart(path, file, part);
  });
}

}  // namespace

StoredImage ReadStoredExr(const std::string& path) { return Read(path, /*is_environment=*/false); }

Image ReadExr(const std::string& path) { return ReadStoredExr(path).image; }

Image ReadLatLongExr(const std::string& path) { return Read(path, /*is_environment=*/true).image; }

}  // namespace pbnbrdf

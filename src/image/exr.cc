#include "pbnbrdf/image/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <string_view>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr const char* kChannels[] = {"R", "G", "B"};
constexpr int kMaxSide = 1 << 16;           // pixels, four times the width of a 16K environment map
constexpr std::size_t kMaxNameBytes = 255;  // OpenEXR's own limit

// OpenEXR's messages name the file once or more before they come to the point.
std::string Reason(const std::exception& error) {
  const std::string text = error.what();
  const std::size_t name_end = text.rfind("\". ");
  return name_end == std::string::npos ? text : text.substr(name_end + 3);
}

// Runs functions of OpenEXR. What they throw becomes an Error that begins with `before`.
template <typename Function>
auto Translate(const std::string& before, Function function) {
  try {
    return function();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    Fail(before, Reason(error));
  }
}

// What OpenEXR writes to, as it wants to go back and fill in where the lines are.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("image") {}

  void write(const char c[], int n) override {
    const std::size_t end = at_ + static_cast<std::size_t>(n);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(&bytes_[at_], c, static_cast<std::size_t>(n));
    at_ = end;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t position) override { at_ = position; }

  std::string TakeBytes() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

std::string ChannelNames(const Imf::ChannelList& channels) {
  std::string names;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    names += StrCat(names.empty() ? "" : ", ", c.name());
  }
  return names.empty() ? "none" : names;
}

// Throws Error unless the channels are there at full resolution and the size is one that we read.
void CheckHeader(const std::string& path, const Imf::Header& header) {
  for (const char* name : kChannels) {
    const Imf::Channel* channel = header.channels().findChannel(name);
    if (channel == nullptr) {
      Fail(path, ": no channel ", name, "; R, G and B are needed, it has ",
           ChannelNames(header.channels()));
    }
    if (channel->xSampling != 1 || channel->ySampling != 1) {
      Fail(path, ": channel ", name, " is stored at a lower resolution than the image");
    }
  }
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  if (width < 1 || height < 1) Fail(path, ": an image of ", width, " x ", height, " pixels");
  if (static_cast<std::size_t>(width * height) > kMaxPixels) {
    Fail(path, ": ", width, " x ", height, " pixels, at most ", kMaxPixels, " are read");
  }
}

Image ReadPixels(const std::string& path, Imf::InputFile& file) {
  CheckHeader(path, file.header());
  if (!file.isComplete()) Fail(path, ": truncated: pixels are missing");
  const Imath::Box2i window = file.header().dataWindow();
  Image image(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
  constexpr std::size_t kStride = 3 * sizeof(float);
  Imf::FrameBuffer buffer;
  for (int c = 0; c < 3; ++c) {
    buffer.insert(kChannels[c], Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + c, window, kStride,
                                                 kStride * static_cast<std::size_t>(image.width)));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

Imf::Header MakeHeader(const Image& image, const std::map<std::string, std::string>& metadata) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const char* name : kChannels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  for (const auto& [name, value] : metadata) {
    if (name.empty() || name.size() > kMaxNameBytes || name.find('\0') != std::string::npos) {
      Fail("an image's attribute is called '", name, "'; 1 to ", kMaxNameBytes,
           " bytes are allowed");
    }
    header.insert(name, Imf::StringAttribute(value));
  }
  return header;
}

void WritePixels(const Image& image, const Imf::Header& header, MemoryStream& stream) {
  Imf::OutputFile file(stream, header);
  constexpr std::size_t kStride = 3 * sizeof(float);
  Imf::FrameBuffer buffer;
  for (int c = 0; c < 3; ++c) {
    char* first = const_cast<char*>(reinterpret_cast<const char*>(image.rgb.data() + c));
    buffer.insert(kChannels[c], Imf::Slice(Imf::FLOAT, first, kStride,
                                           kStride * static_cast<std::size_t>(image.width)));
  }
  file.setFrameBuffer(buffer);
  file.writePixels(image.height);
}

}  // namespace

Image ReadExr(const std::string& path) {
  const std::string magic = ReadStart(path, 4);
  if (magic.size() < 4 || !Imf::isImfMagic(magic.data())) Fail(path, ": not an OpenEXR file");
  // Of the process: OpenEXR has no other place for limits that hold before it takes memory.
  Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
  Imf::Header::setMaxTileSize(kMaxSide, kMaxSide);
  return Translate(path + ": truncated or damaged OpenEXR file: ", [&] {
    Imf::InputFile file(path.c_str());
    return ReadPixels(path, file);
  });
}

std::string ExrBytes(const Image& image, const std::map<std::string, std::string>& metadata) {
  MemoryStream stream;
  Translate(StrCat("an image of ", image.width, " x ", image.height, " pixels: "),
            [&] { WritePixels(image, MakeHeader(image, metadata), stream); });
  return stream.TakeBytes();
}

void WriteExr(const std::string& path, const Image& image,
              const std::map<std::string, std::string>& metadata) {
  WriteFile(path, ExrBytes(image, metadata));
}

}  // namespace pbnbrdf

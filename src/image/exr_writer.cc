#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cstring>

#include "image/exr_errors.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"

namespace pbnbrdf {
namespace {

constexpr const char* kChannels[] = {"R", "G", "B"};
constexpr std::size_t kMaxNameBytes = 255;  // OpenEXR's own limit

// What OpenEXR writes to, as it wants to go back and fill in where the lines are.
class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("image") {}

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

void WritePixels(const Image& image, const Imf::Header& header, MemoryOutput& stream) {
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

std::string ExrBytes(const Image& image, const std::map<std::string, std::string>& metadata) {
  MemoryOutput stream;
  TranslateExrErrors(StrCat("an image of ", image.width, " x ", image.height, " pixels: "),
                     [&] { WritePixels(image, MakeHeader(image, metadata), stream); });
  return stream.TakeBytes();
}

void WriteExr(const std::string& path, const Image& image,
              const std::map<std::string, std::string>& metadata) {
  WriteFile(path, ExrBytes(image, metadata));
}

}  // namespace pbnbrdf

// Images through OpenEXR files: our own, and those of other kinds that OpenEXR's library writes.
#include "pbnbrdf/image/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <limits>
#include <optional>

#include "image/images.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

constexpr std::size_t kLargest = std::size_t(1) << 30;

std::vector<float> Values(const Image& image, int channel) {
  std::vector<float> values;
  for (std::size_t i = std::size_t(channel); i < image.rgb.size(); i += 3) {
    values.push_back(image.rgb[i]);
  }
  return values;
}

TEST(Exr, RoundTripsToTheBit) {
  TemporaryFolder folder;
  Image image = RandomImage(37, 21, -3.0, 1e4, 1);
  image.rgb[0] = std::numeric_limits<float>::infinity();
  image.rgb[1] = std::numeric_limits<float>::denorm_min();
  image.rgb[2] = std::numeric_limits<float>::max();
  image.rgb[3] = -0.0f;
  WriteExr(folder / "a.exr", image);
  for (const Image& read : {ReadExr(folder / "a.exr"), OpenImage(folder / "a.exr")}) {
    EXPECT_EQ(read.width, 37);
    EXPECT_EQ(read.height, 21);
    EXPECT_EQ(read.rgb, image.rgb);
    EXPECT_TRUE(std::signbit(read.rgb[3]));
  }
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(Exr, NotANumberStaysOne) {
  TemporaryFolder folder;
  Image image(2, 1);
  image.rgb[4] = std::numeric_limits<float>::quiet_NaN();
  WriteExr(folder / "a.exr", image);
  EXPECT_TRUE(std::isnan(ReadExr(folder / "a.exr").rgb[4]));
}

TEST(Exr, SameImageSameBytes) {
  const Image image = RandomImage(64, 40, 0.0, 2.0, 2);
  const std::map<std::string, std::string> metadata = {{"seed", "1"}};
  EXPECT_EQ(ExrBytes(image, metadata), ExrBytes(image, metadata));
}

TEST(Exr, MetadataAreStringAttributes) {
  TemporaryFolder folder;
  const std::string long_name(60, 'n');
  WriteExr(folder / "a.exr", Image(3, 2),
           {{"scene", "sphere.json"}, {"seed", "7"}, {"comments", ""}, {long_name, "x\ny"}});
  const Imf::InputFile file((folder / "a.exr").c_str());
  const auto text = [&](const std::string& name) {
    return file.header().typedAttribute<Imf::StringAttribute>(name).value();
  };
  EXPECT_EQ(text("scene"), "sphere.json");
  EXPECT_EQ(text("seed"), "7");
  EXPECT_EQ(text("comments"), "");
  EXPECT_EQ(text(long_name), "x\ny");
  EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
}

TEST(Exr, AttributesThatCannotBeAreErrors) {
  const Image image(2, 2);
  EXPECT_THAT(ErrorOf([&] { ExrBytes(image, {{"compression", "much"}}); }), HasSubstr("type"));
  EXPECT_THAT(ErrorOf([&] { ExrBytes(image, {{"", "a"}}); }), HasSubstr("is called ''"));
  EXPECT_THAT(ErrorOf([&] {
                ExrBytes(image, {{std::string(256, 'a'), "a"}});
              }),
              HasSubstr("1 to 255 bytes"));
  EXPECT_NE(ErrorOf([&] { ExrBytes(Image(), {}); }), "");
}

// Small whole numbers, which every pixel type holds.
Image WholeNumbers(int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = float(i * 7 % 1021);
  return image;
}

struct Kind {
  Imf::PixelType type = Imf::FLOAT;
  Imf::Compression compression = Imf::ZIP_COMPRESSION;
  bool tiled = false;
  std::vector<std::string> names = {"R", "G", "B"};
  Imath::V2i corner = {0, 0};  // of the data window
  int sampling = 1;            // of the last channel
  Imf::LevelMode levels = Imf::MIPMAP_LEVELS;
  std::optional<Imath::Box2i> display = {};  // the data window if there is none
  std::optional<Imf::Chromaticities> chromaticities = {};
  std::optional<Imf::Envmap> envmap = {};
};

// The channel in the memory layout of the type.
template <typename T>
std::vector<char> Bytes(const std::vector<float>& values) {
  std::vector<char> bytes(values.size() * sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<T>(values[i]);
    std::memcpy(&bytes[i * sizeof(T)], &value, sizeof(T));
  }
  return bytes;
}

template <typename T>
void WriteAs(const std::string& path, const Image& image, const Kind& kind) {
  const Imath::Box2i window(kind.corner,
                            kind.corner + Imath::V2i(image.width - 1, image.height - 1));
  Imf::Header header(kind.display.value_or(window), window);
  if (kind.chromaticities) Imf::addChromaticities(header, *kind.chromaticities);
  if (kind.envmap) Imf::addEnvmap(header, *kind.envmap);
  header.compression() = kind.compression;
  Imf::FrameBuffer buffer;
  std::vector<std::vector<char>> channels;
  for (std::size_t c = 0; c < kind.names.size(); ++c) {
    const int sampling = c + 1 == kind.names.size() ? kind.sampling : 1;
    header.channels().insert(kind.names[c], Imf::Channel(kind.type, sampling, sampling));
    channels.push_back(Bytes<T>(Values(image, int(c % 3))));
    buffer.insert(kind.names[c],
                  Imf::Slice::Make(kind.type, channels.back().data(), window, sizeof(T),
                                   sizeof(T) * std::size_t(image.width), sampling, sampling));
  }
  if (kind.tiled) {
    header.setTileDescription(Imf::TileDescription(16, 8, kind.levels));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    // The smaller levels hold other values, those of the full image's corner.
    for (int level = 1; level < file.numLevels(); ++level) {
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
  } else {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  }
}

void WriteKind(const std::string& path, const Image& image, const Kind& kind) {
  switch (kind.type) {
    case Imf::HALF:
      return WriteAs<half>(path, image, kind);
    case Imf::UINT:
      return WriteAs<unsigned>(path, image, kind);
    default:
      return WriteAs<float>(path, image, kind);
  }
}

TEST(Exr, ReadsEveryPixelTypeCompressionAndLayout) {
  TemporaryFolder folder;
  const Image image = WholeNumbers(45, 33);
  for (Imf::PixelType type : {Imf::FLOAT, Imf::HALF, Imf::UINT}) {
    for (Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
          Imf::PIZ_COMPRESSION}) {
      for (bool tiled : {false, true}) {
        Kind kind{.type = type, .compression = compression, .tiled = tiled};
        WriteKind(folder / "a.exr", image, kind);
        EXPECT_EQ(ReadExr(folder / "a.exr").rgb, image.rgb) << type << compression << tiled;
      }
    }
  }
}

TEST(Exr, ReadsOnlyRgb) {
  TemporaryFolder folder;
  const Image image = WholeNumbers(12, 9);
  for (bool tiled : {false, true}) {
    const Imath::Box2i window({-7, 30}, {4, 38});
    WriteKind(folder / "a.exr", image,
              {.tiled = tiled,
               .names = {"R", "G", "B", "A", "Z"},
               .corner = window.min,
               .display = window});
    const StoredImage read = ReadStoredExr(folder / "a.exr");
    EXPECT_EQ(read.image.width, 12);
    EXPECT_EQ(read.image.rgb, image.rgb);
    EXPECT_EQ(read.stored, (PixelRegion{0, 0, 12, 9}));
    EXPECT_EQ(read.left, -7);
    EXPECT_EQ(read.top, 30);
  }
}

// An image is its display window, whatever part of it the file stores.
TEST(Exr, TheDisplayWindowIsTheImage) {
  TemporaryFolder folder;
  const Image image = WholeNumbers(12, 9);
  const Imath::Box2i display({10, 20}, {17, 25});  // 8 x 6
  struct Case {
    Imath::V2i corner;
    PixelRegion stored;
  };
  for (const Case& c : {Case{{8, 18}, {0, 0, 8, 6}},        // beyond it on all sides
                        Case{{14, 22}, {4, 2, 8, 6}},       // its lower right
                        Case{{3, 14}, {0, 0, 5, 3}},        // its upper left
                        Case{{100, 100}, {8, 6, 8, 6}}}) {  // nowhere
    WriteKind(folder / "a.exr", image, {.corner = c.corner, .display = display});
    const StoredImage read = ReadStoredExr(folder / "a.exr");
    ASSERT_EQ(read.image.width, 8);
    ASSERT_EQ(read.image.height, 6);
    if (c.corner.x < 100) {
      EXPECT_EQ(read.stored, c.stored);
    }
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 8; ++x) {
        const int from_x = x + display.min.x - c.corner.x, from_y = y + display.min.y - c.corner.y;
        const bool stored = from_x >= 0 && from_x < 12 && from_y >= 0 && from_y < 9;
        EXPECT_EQ(*read.image.pixel(x, y), stored ? *image.pixel(from_x, from_y) : 0.0f);
      }
    }
  }
}

TEST(Exr, LuminanceAloneIsGreyAndChromaIsRefused) {
  TemporaryFolder folder;
  const Image image = WholeNumbers(5, 4);
  WriteKind(folder / "a.exr", image, {.names = {"Y"}});
  const Image grey = ReadExr(folder / "a.exr");
  for (int c = 0; c < 3; ++c) EXPECT_EQ(Values(grey, c), Values(image, 0));
  WriteKind(folder / "a.exr", image, {.names = {"Y", "RY", "BY"}});
  EXPECT_THAT(ErrorOf([&] { ReadExr(folder / "a.exr"); }), HasSubstr("luminance and chroma"));
}

// By the matrix of ITU-R BT.2087 for colours of BT.2020; of equal energy, white stays white.
TEST(Exr, OtherPrimariesAreConverted) {
  TemporaryFolder folder;
  const Image image = ConstantImage(3, 2, 0.2f, 0.5f, 0.1f), white = ConstantImage(3, 2, 1, 1, 1);
  const Imf::Chromaticities bt2020({0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f},
                                   {0.3127f, 0.329f});
  WriteKind(folder / "a.exr", image, {.chromaticities = bt2020});
  const Image read = ReadExr(folder / "a.exr");
  EXPECT_NEAR(read.rgb[0], 1.6605 * 0.2 - 0.5876 * 0.5 - 0.0728 * 0.1, 1e-4);
  EXPECT_NEAR(read.rgb[1], -0.1246 * 0.2 + 1.1329 * 0.5 - 0.0083 * 0.1, 1e-4);
  EXPECT_NEAR(read.rgb[2], -0.0182 * 0.2 - 0.1006 * 0.5 + 1.1187 * 0.1, 1e-4);
  const Imf::Chromaticities aces({0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f},
                                 {0.32168f, 0.33767f});
  WriteKind(folder / "a.exr", white, {.chromaticities = aces});
  for (float value : ReadExr(folder / "a.exr").rgb) EXPECT_NEAR(value, 1.0, 1e-5);
  WriteKind(folder / "a.exr", image, {.chromaticities = Imf::Chromaticities()});
  EXPECT_EQ(ReadExr(folder / "a.exr").rgb, image.rgb);
  const Imath::V2f point(0.3f, 0.3f);
  WriteKind(folder / "a.exr", image,
            {.chromaticities = Imf::Chromaticities(point, point, point, point)});
  EXPECT_THAT(ErrorOf([&] { ReadExr(folder / "a.exr"); }), HasSubstr("a.exr: "));
}

TEST(Exr, CubeMapsAreNoLatitudeLongitude) {
  TemporaryFolder folder;
  const Image image = WholeNumbers(4, 24);
  WriteKind(folder / "a.exr", image, {.envmap = Imf::ENVMAP_CUBE});
  EXPECT_EQ(ReadExr(folder / "a.exr").rgb, image.rgb);
  EXPECT_THAT(ErrorOf([&] { ReadLatLongExr(folder / "a.exr"); }), HasSubstr("a.exr: a cube map"));
  WriteKind(folder / "a.exr", image, {.envmap = Imf::ENVMAP_LATLONG});
  EXPECT_EQ(ReadLatLongExr(folder / "a.exr").rgb, image.rgb);
}

// As compositing programs save depth, before the colours.
TEST(Exr, OfSeveralPartsTheOneWithColoursIsRead) {
  TemporaryFolder folder;
  const Image image = WholeNumbers(6, 5);
  std::vector<Imf::Header> headers;
  for (const char* name : {"depth", "colour"}) {
    Imf::Header& header = headers.emplace_back(image.width, image.height);
    header.setName(name);
    header.setType(Imf::SCANLINEIMAGE);
  }
  headers[0].channels().insert("Z", Imf::Channel(Imf::FLOAT));
  for (const char* name : {"R", "G", "B"}) {
    headers[1].channels().insert(name, Imf::Channel(Imf::FLOAT));
  }
  {
    Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2);
    for (int part = 0; part < 2; ++part) {
      Imf::FrameBuffer buffer;
      std::size_t c = 0;
      constexpr std::size_t kStride = 3 * sizeof(float);
      for (const char* name : {"R", "G", "B"}) {
        char* first = const_cast<char*>(reinterpret_cast<const char*>(image.rgb.data() + c++));
        buffer.insert(part == 0 ? "Z" : name,
                      Imf::Slice(Imf::FLOAT, first, kStride, kStride * std::size_t(image.width)));
      }
      Imf::OutputPart output(file, part);
      output.setFrameBuffer(buffer);
      output.writePixels(image.height);
    }
  }
  EXPECT_EQ(ReadExr(folder / "a.exr").rgb, image.rgb);
}

TEST(Exr, ErrorsNameTheFileAndWhatIsWrong) {
  TemporaryFolder folder;
  const std::string path = folder / "a.exr";
  const auto error = [&] { return ErrorOf([&] { ReadExr(path); }); };
  EXPECT_EQ(error(), path + ": no such file");
  for (const char* bytes : {"", "abc", "not an image at all"}) {
    WriteBytes(path, bytes);
    EXPECT_EQ(error(), path + ": not an OpenEXR file");
  }
  EXPECT_THAT(ErrorOf([&] { OpenImage(path); }), HasSubstr("neither an OpenEXR nor a PNG file"));

  const Image image = WholeNumbers(8, 8);
  WriteKind(path, image, {.names = {"Y", "RY", "BY"}});
  EXPECT_EQ(
      error(),
      path + ": stored as luminance and chroma (Y, RY, BY); save it with channels R, G and B");
  WriteKind(path, image, {.names = {"R", "G", "diffuse.B"}});
  EXPECT_THAT(error(), HasSubstr("no channel B"));
  WriteKind(path, image, {.sampling = 2});
  EXPECT_EQ(error(), path + ": channel B is stored at a lower resolution than the image");
}

TEST(Exr, EveryTruncationIsAnError) {
  TemporaryFolder folder;
  const Image image = WholeNumbers(64, 64);
  ExpectEveryTruncationFails(ExrBytes(image), folder / "a.exr", ReadExr);
  for (bool tiled : {false, true}) {
    // Of a file with several levels the full image may be there while smaller ones are cut off.
    WriteKind(folder / "b.exr", image,
              {.compression = Imf::PIZ_COMPRESSION, .tiled = tiled, .levels = Imf::ONE_LEVEL});
    ExpectEveryTruncationFails(ReadFile(folder / "b.exr", kLargest), folder / "a.exr", ReadExr);
  }
}

// The file with another width and height in its header.
std::string WithSize(std::string bytes, int width, int height) {
  const std::string name("dataWindow\0box2i\0", 17);
  const std::size_t at = bytes.find(name) + name.size() + 4;
  const int window[4] = {0, 0, width - 1, height - 1};
  std::memcpy(&bytes[at], window, sizeof window);  // OpenEXR is little-endian, as we are
  return bytes;
}

TEST(Exr, SizesAreBoundedBeforeMemoryIsTaken) {
  TemporaryFolder folder;
  const std::string bytes = ExrBytes(WholeNumbers(8, 8));
  for (auto [width, height] :
       {std::pair{1 << 30, 1 << 30}, {70000, 1}, {1, 70000}, {60000, 60000}, {0, 8}, {8, -5}}) {
    WriteBytes(folder / "a.exr", WithSize(bytes, width, height));
    EXPECT_THAT(ErrorOf([&] { ReadExr(folder / "a.exr"); }),
                testing::StartsWith(folder / "a.exr: "))
        << width << " x " << height;
  }
  // Long enough for its table of lines.
  WriteBytes(folder / "a.exr", WithSize(bytes, 60000, 60000) + std::string(1 << 19, '\1'));
  EXPECT_THAT(ErrorOf([&] { ReadExr(folder / "a.exr"); }),
              HasSubstr("60000 x 60000 pixels, at most 134217728 are read"));
  // Long enough for its table of lines, and still far too short for a billion bytes of pixels.
  WriteBytes(folder / "a.exr", WithSize(bytes, 60000, 2000) + std::string(1 << 14, '\1'));
  EXPECT_THAT(ErrorOf([&] { ReadExr(folder / "a.exr"); }), HasSubstr(" bytes can't hold them"));
}

TEST(Exr, DamageIsAnErrorOrOtherPixels) {
  TemporaryFolder folder;
  const std::string bytes = ExrBytes(WholeNumbers(24, 24));
  std::mt19937 random(4);
  int errors = 0;
  for (int i = 0; i < 400; ++i) {
    std::string damaged = bytes;
    damaged[random() % bytes.size()] ^= char(1u << random() % 8);
    WriteBytes(folder / "a.exr", damaged);
    errors += ErrorOf([&] { ReadExr(folder / "a.exr"); }) != "";
  }
  EXPECT_GT(errors, 100);
}

TEST(Exr, ReadsAnEnvironmentMap) {
  PBNBRDF_REFERENCE_FILE(path, "envmaps/museum.exr");
  const Image image = ReadExr(path);
  EXPECT_EQ(image.width, 2 * image.height);
  for (float value : image.rgb) ASSERT_TRUE(value >= 0.0f && std::isfinite(value));
}

}  // namespace
}  // namespace pbnbrdf

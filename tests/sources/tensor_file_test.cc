#include "sources/tensor_file.h"

#include "sources/tensor_writer.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class TensorFileTest : public testing::Test {
 protected:
  TensorFile Read(const std::string& bytes) const {
    WriteBytes(path_, bytes);
    return TensorFile::Read(path_);
  }
  std::string ErrorOfReading(const std::string& bytes) const {
    return ErrorOf([&] { Read(bytes); });
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "t.bsdf";
};

TensorWriter Small() {
  TensorWriter file;
  file.AddFloats("grid", {2, 3}, {1, 2, 3, 4, 5, 6}).Add("text", 1, {5}, "words");
  return file;
}

TEST_F(TensorFileTest, GivesBackWhatWasWritten) {
  const TensorFile file = Read(Small().Bytes());
  EXPECT_TRUE(file.Has("grid"));
  EXPECT_FALSE(file.Has("none"));
  EXPECT_THAT(file.FloatShape("grid", 2), ElementsAre(2, 3));
  EXPECT_THAT(file.Floats("grid", std::vector<std::size_t>{2, 3}), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(file.Text("text"), "words");
  EXPECT_EQ(file.Text("grid"), "");
  EXPECT_EQ(file.Text("none"), "");
}

TEST_F(TensorFileTest, OtherFieldsThanAskedForAreNamed) {
  const TensorFile file = Read(Small().Add("doubles", 11, {1}, std::string(8, '\0')).Bytes());
  const auto floats = [&](const std::string& name, const std::vector<std::size_t>& shape) {
    return ErrorOf([&] { file.Floats(name, shape); });
  };
  EXPECT_THAT(floats("none", {2}), HasSubstr("t.bsdf: no field 'none' in it"));
  EXPECT_THAT(floats("grid", {2}), HasSubstr("field 'grid' is 2 x 3, expected 1 sizes"));
  EXPECT_THAT(floats("grid", {3, 2}), HasSubstr("field 'grid' is 2 x 3, expected 3 x 2"));
  EXPECT_THAT(floats("doubles", {1}), HasSubstr("field 'doubles' is of type 11, expected 10"));
}

// Sizes that the file can't hold are refused before memory for them is taken.
TEST_F(TensorFileTest, LiesAboutSizesAreRefused) {
  const std::uint64_t huge = std::uint64_t{1} << 62;
  for (const std::vector<std::uint64_t>& shape :
       {std::vector<std::uint64_t>{huge}, {huge, huge, huge}, {7}, {1, 7}, {huge, 4}}) {
    EXPECT_THAT(ErrorOfReading(Small().Replace("grid", shape, {1, 2, 3, 4}).Bytes()),
                HasSubstr("truncated or damaged: field 'grid', " + ShapeText(shape)));
  }
  EXPECT_THAT(
      ErrorOfReading(Small().Add("deep", 1, std::vector<std::uint64_t>(17, 1), "x").Bytes()),
      HasSubstr("field 'deep' has 17 dimensions; at most 16"));
  EXPECT_THAT(ErrorOfReading(Small().Add("odd", 12, {1}, "x").Bytes()),
              HasSubstr("field 'odd' is of type 12; must be 1 to 11"));
  EXPECT_THAT(ErrorOfReading(Small().Add("grid", 1, {1}, "x").Bytes()),
              HasSubstr("two fields are named 'grid'"));
}

// Its last field, of no bytes, begins where the file ends, or one byte behind.
TEST_F(TensorFileTest, AnEmptyFieldBehindTheEndIsRefused) {
  std::string bytes = Small().Add("empty", 1, {0}, "").Bytes();
  EXPECT_EQ(Read(bytes).Text("empty"), "");
  bytes.pop_back();
  EXPECT_THAT(ErrorOfReading(bytes), HasSubstr("truncated or damaged: field '"));
  bytes = TensorWriter().Add("empty", 1, {0}, "").Bytes();
  const std::size_t offset = 18 + 2 + 5 + 2 + 1;
  ++bytes[offset];
  EXPECT_THAT(ErrorOfReading(bytes), HasSubstr("truncated or damaged: field 'empty'"));
}

TEST_F(TensorFileTest, DamagedHeadersAreRefused) {
  const std::string good = Small().Bytes();
  std::string bytes = good;
  bytes[3] = 'x';
  EXPECT_THAT(ErrorOfReading(bytes), HasSubstr("t.bsdf: not a tensor file"));
  bytes = good;
  bytes[12] = 2;
  EXPECT_THAT(ErrorOfReading(bytes), HasSubstr("a tensor file of version 2.0, expected 1.0"));
  bytes = good;
  bytes[17] = '\x7f';  // two billion fields
  EXPECT_THAT(ErrorOfReading(bytes), HasSubstr("t.bsdf: "));
  for (std::size_t length = 0; length < good.size(); ++length) {
    EXPECT_THAT(ErrorOfReading(good.substr(0, length)), testing::StartsWith(path_ + ": "));
  }
  EXPECT_THAT(ErrorOf([&] { TensorFile::Read(folder_ / "none"); }), HasSubstr("no such file"));
}

// No single byte of the header, changed, does more than an error.
TEST_F(TensorFileTest, ChangedBytesDontCrash) {
  const std::string good = Small().Bytes();
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (char flip : {'\x01', '\x80', '\xff'}) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ flip);
      const std::string error = ErrorOfReading(bytes);
      EXPECT_TRUE(error.empty() || error.starts_with(path_)) << error;
    }
  }
}

}  // namespace
}  // namespace pbnbrdf

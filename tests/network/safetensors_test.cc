#include "network/safetensors.h"

#include <cstring>

#include "pbnbrdf/base/files.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

std::string FileOf(const std::string& header, const std::string& data, std::uint64_t size) {
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &size, 8);
  return bytes + header + data;
}

std::string FileOf(const std::string& header, const std::string& data = "") {
  return FileOf(header, data, header.size());
}

TEST(Safetensors, RoundTrips) {
  TemporaryFolder folder;
  SafetensorsFile file;
  file.tensors["a"] = {{2, 3}, {1.0, -2.0, 0.1, 1e300, 5e-324, 6.0}};
  file.tensors["b"] = {{1}, {7.0}};
  file.metadata["key"] = "a \"quoted\"\nvalue";
  WriteFile(folder / "x", SafetensorsBytes(file));
  const SafetensorsFile read = ReadSafetensors(folder / "x");
  EXPECT_EQ(read.metadata, file.metadata);
  ASSERT_EQ(read.tensors.size(), 2u);
  EXPECT_EQ(read.tensors.at("a").shape, file.tensors["a"].shape);
  EXPECT_EQ(read.tensors.at("a").values, file.tensors["a"].values);
  EXPECT_EQ(read.tensors.at("b").values, file.tensors["b"].values);
}

TEST(Safetensors, ReadsSinglePrecision) {
  TemporaryFolder folder;
  const float values[2] = {0.5f, -3.0f};
  WriteBytes(folder / "x", FileOf(R"({"t":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})",
                                  std::string(reinterpret_cast<const char*>(values), 8)));
  EXPECT_THAT(ReadSafetensors(folder / "x").tensors.at("t").values,
              testing::ElementsAre(0.5, -3.0));
}

TEST(Safetensors, LyingHeadersAreNamed) {
  TemporaryFolder folder;
  const auto read = [&](const std::string& bytes) {
    WriteBytes(folder / "x", bytes);
    return ErrorOf([&] { ReadSafetensors(folder / "x"); });
  };
  const std::string eight(8, '\0');
  EXPECT_THAT(read(""), HasSubstr("x: not a safetensors file"));
  EXPECT_THAT(read(FileOf("{}", "", 1000)),
              HasSubstr("the header has 1000 bytes, the file has 10"));
  EXPECT_THAT(read(FileOf("{}", "", ~0ull)), HasSubstr("not a safetensors file"));
  EXPECT_THAT(read(FileOf("[]")), HasSubstr("its header is not a JSON object"));
  EXPECT_THAT(read(FileOf("{\"t\"")), HasSubstr("its header is not a JSON object"));
  EXPECT_THAT(read(FileOf(R"({"t":{"dtype":"F64"}})")),
              HasSubstr("tensor t: expected dtype, shape and data_offsets"));
  EXPECT_THAT(read(FileOf(R"({"t":{"dtype":"I64","shape":[1],"data_offsets":[0,8]}})", eight)),
              HasSubstr("dtype I64 is not one of F64 | F32"));
  for (const char* lie : {R"([2],"data_offsets":[0,8])", R"([1],"data_offsets":[0,16])",
                          R"([1],"data_offsets":[8,0])", R"([1],"data_offsets":[8,16])",
                          R"([1],"data_offsets":[0])"}) {
    EXPECT_THAT(read(FileOf(StrCat(R"({"t":{"dtype":"F64","shape":)", lie, "}}"), eight)),
                HasSubstr("don't fit shape"))
        << lie;
  }
  for (const char* shape : {"[1000000000,1000000000,1000000000]", "[-1]", "[0]"}) {
    EXPECT_THAT(
        read(FileOf(StrCat(R"({"t":{"dtype":"F64","shape":)", shape, R"(,"data_offsets":[0,8]}})"),
                    eight)),
        HasSubstr("doesn't fit the file"))
        << shape;
  }
  EXPECT_THAT(read(FileOf(R"({"t":{"dtype":"F64","shape":[1],"data_offsets":[0,8]}})",
                          std::string(8, '\xff'))),
              HasSubstr("not finite"));
  EXPECT_THAT(
      read(FileOf(R"({"t":{"dtype":"F64","shape":[1],"data_offsets":[0,8]}})", eight + "x")),
      HasSubstr("its tensors take 8 bytes, but 9 follow the header"));
  EXPECT_THAT(read(FileOf(R"({"__metadata__":{"a":1}})")), HasSubstr("must map names to texts"));
}

}  // namespace
}  // namespace pbnbrdf

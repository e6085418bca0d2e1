#include "sources/npy.h"

#include "sources/npy_writer.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Npy, ReadsBothPrecisionsAndVersions) {
  TemporaryFolder folder;
  const std::string path = folder / "x.npy";
  const std::vector<double> values = {1.5, -2.0, 0.25, 4.0, 0.0, -6.0};
  for (char version : {'\1', '\2', '\3'}) {
    WriteBytes(path, NpyBytes(NpyHeader("<f4", "2, 3"), ElementBytes<float>(values), version));
    EXPECT_THAT(ReadNpy(path).shape, ElementsAre(2, 3));
    EXPECT_EQ(ReadNpy(path).values, values);
    WriteBytes(path, NpyBytes(NpyHeader("<f8", "6,"), ElementBytes<double>(values), version));
    EXPECT_THAT(ReadNpy(path).shape, ElementsAre(6));
    EXPECT_EQ(ReadNpy(path).values, values);
  }
}

TEST(Npy, WhatIsWrittenIsReadAndBeginsAtAMultipleOf64) {
  TemporaryFolder folder;
  const std::string path = folder / "x.npy";
  for (const Tensor& tensor :
       {Tensor{{2, 3}, {1.5, -2.0, 0.25, 4.0, 0.0, -6.0}}, Tensor{{2}, {1, 2}}}) {
    const std::string bytes = NpyBytes(tensor);
    EXPECT_EQ((bytes.size() - tensor.values.size() * sizeof(float)) % 64, 0u);
    WriteBytes(path, bytes);
    EXPECT_EQ(ReadNpy(path).shape, tensor.shape);
    EXPECT_EQ(ReadNpy(path).values, tensor.values);
  }
}

TEST(Npy, FortranOrderIsUndone) {
  TemporaryFolder folder;
  const std::string path = folder / "x.npy";
  WriteBytes(path, NpyBytes(NpyHeader("<f8", "2, 3", "True"),
                            ElementBytes<double>({11, 21, 12, 22, 13, 23})));
  EXPECT_THAT(ReadNpy(path).shape, ElementsAre(2, 3));
  EXPECT_THAT(ReadNpy(path).values, ElementsAre(11, 12, 13, 21, 22, 23));
}

TEST(Npy, BadFilesAreNamed) {
  TemporaryFolder folder;
  const std::string path = folder / "x.npy";
  const auto read = [&](const std::string& bytes) {
    WriteBytes(path, bytes);
    return ErrorOf([&] { ReadNpy(path); });
  };
  const std::string eight(8, '\0');
  EXPECT_EQ(read(NpyBytes(NpyHeader("<f8", "1,"), eight)), "");
  EXPECT_THAT(read(""), HasSubstr("x.npy: not a .npy file"));
  EXPECT_THAT(read("\x89PNG, or something else"), HasSubstr("x.npy: not a .npy file"));
  EXPECT_THAT(read(NpyBytes(NpyHeader("<f8", "1,"), eight, 9)), HasSubstr(".npy version 9"));
  EXPECT_THAT(read(NpyBytes(NpyHeader("<f8", "1,"), "").substr(0, 30)),
              HasSubstr("truncated .npy file: a header of"));
  EXPECT_THAT(read(NpyBytes(NpyHeader("<f8\x01", "1,"), eight)), HasSubstr("it isn't text"));
  EXPECT_THAT(read(NpyBytes("{}", eight)), HasSubstr("'descr' is missing"));
  EXPECT_THAT(read(NpyBytes("{'descr': [('a', '<f4')], }", eight)),
              HasSubstr("'descr' is missing or not what numpy.save writes"));
  for (const char* type : {"<i8", ">f8", "|O", "<f2"}) {
    EXPECT_THAT(read(NpyBytes(NpyHeader(type, "1,"), eight)),
                HasSubstr(StrCat("elements of type '", type, "', expected '<f4' or '<f8'")));
  }
  for (const char* shape : {"2,", "0,", "-1,", "", "4294967296, 4294967296", "2, 2"}) {
    EXPECT_THAT(read(NpyBytes(NpyHeader("<f8", shape), "")), HasSubstr("truncated or damaged"))
        << shape;
  }
  EXPECT_THAT(read(NpyBytes(NpyHeader("<f8", "1,"), eight + "x")),
              HasSubstr("its header says 1 of '<f8', but 9 bytes follow"));
  EXPECT_THAT(read(NpyBytes(NpyHeader("<f8", "1, x"), eight)),
              HasSubstr("'x' is not a whole number"));
  EXPECT_THAT(read(NpyBytes(NpyHeader("<f8", "1, 1, 1", "True"), eight)),
              HasSubstr("save numpy.ascontiguousarray(x)"));
  EXPECT_THAT(read(NpyBytes(NpyHeader("<f8", "1,", "1"), eight)),
              HasSubstr("'fortran_order' is '1'"));
}

TEST(Npy, DamagedFilesGiveAnErrorOrAnArray) {
  TemporaryFolder folder;
  const std::string path = folder / "x.npy";
  const std::string good = NpyBytes(NpyHeader("<f4", "2, 3", "True"), std::string(24, '\x3f'));
  for (std::size_t size = 0; size < good.size(); ++size) {
    WriteBytes(path, good.substr(0, size));
    EXPECT_NE(ErrorOf([&] { ReadNpy(path); }), "") << size;
  }
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::filesystem::remove(path);
    std::string bytes = good;
    bytes[bit / 8] ^= static_cast<char>(1 << bit % 8);
    WriteBytes(path, bytes);
    const std::string error = ErrorOf([&] { ReadNpy(path); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace pbnbrdf

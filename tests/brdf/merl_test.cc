#include "pbnbrdf/brdf/merl.h"

#include <cstring>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/analytic.h"
#include "pbnbrdf/brdf/builtin.h"
#include "pbnbrdf/brdf/sampling.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

constexpr std::size_t kFileBytes = 12 + 3 * 8 * MerlBrdf::kBins;

// A file with the given stored value in each bin.
std::string FileOf(double value) {
  std::string bytes(kFileBytes, '\0');
  const std::int32_t dimensions[3] = {90, 90, 180};
  std::memcpy(bytes.data(), dimensions, sizeof(dimensions));
  for (std::size_t at = 12; at < bytes.size(); at += 8) std::memcpy(&bytes[at], &value, 8);
  return bytes;
}

void SetBin(std::string* bytes, std::size_t bin, double value) {
  for (int c = 0; c < 3; ++c) {
    std::memcpy(&(*bytes)[12 + 8 * (c * MerlBrdf::kBins + bin)], &value, 8);
  }
}

std::size_t Bin(int h, int d, int p) { return (h * 90u + d) * 180u + p; }

// The pair at bin coordinates, fractions allowed.
DirectionPair PairAt(double h, double d, double p) {
  return FromAngles({.theta_h = kPi / 2 * (h / 90) * (h / 90),
                     .theta_d = kPi / 2 * d / 90,
                     .phi_d = kPi * p / 180});
}

Rgb ValueAt(const Brdf& brdf, const DirectionPair& pair) {
  Rgb value;
  brdf.Evaluate({&pair, 1}, {&value, 1});
  return value;
}

TEST(Merl, FilesRoundTripToTheBit) {
  TemporaryFolder folder;
  MerlBrdf::Tabulate(*MakeBuiltin("satin-gold")).Write(folder / "a.binary");
  MerlBrdf::Read(folder / "a.binary").Write(folder / "b.binary");
  std::ifstream a(folder / "a.binary", std::ios::binary), b(folder / "b.binary", std::ios::binary);
  const std::string bytes_a{std::istreambuf_iterator<char>(a), {}};
  const std::string bytes_b{std::istreambuf_iterator<char>(b), {}};
  EXPECT_EQ(bytes_a.size(), kFileBytes);
  EXPECT_TRUE(bytes_a == bytes_b);
}

TEST(Merl, TabulatingMarksWhatIsBelowTheHorizon) {
  // The count that the format's description gives for cos <= 1e-4.
  EXPECT_EQ(MerlBrdf::kBins - MerlBrdf::Tabulate(LambertBrdf({0.5, 0.5, 0.5})).valid_bins(),
            346674u);
}

TEST(Merl, RefusesToTabulateAnAnisotropicMaterial) {
  EXPECT_THAT(ErrorOf([] { MerlBrdf::Tabulate(*MakeBuiltin("rolled-brass")); }),
              HasSubstr("a MERL table has no phi_h: fit it as it is, or"));
}

TEST(Merl, ATabulatedLambertianIsConstant) {
  const MerlBrdf table = MerlBrdf::Tabulate(LambertBrdf({0.9, 0.5, 0.1}));
  for (const DirectionPair& pair : RandomPairs(10000, /*seed=*/1)) {
    if (!table.IsKnown(pair)) continue;
    const Rgb value = ValueAt(table, pair);
    EXPECT_NEAR(value[0], 0.9 / kPi, 1e-14);
    EXPECT_NEAR(value[1], 0.5 / kPi, 1e-14);
    EXPECT_NEAR(value[2], 0.1 / kPi, 1e-14);
  }
}

TEST(Merl, NodesAreExactAndBetweenThemLinear) {
  TemporaryFolder folder;
  std::string bytes = FileOf(1500.0);
  SetBin(&bytes, Bin(10, 20, 30), 3000.0);
  WriteBytes(folder / "t.binary", bytes);
  const MerlBrdf table = MerlBrdf::Read(folder / "t.binary");
  EXPECT_NEAR(ValueAt(table, PairAt(10, 20, 30 + 1e-9))[0], 2.0, 1e-6);
  EXPECT_NEAR(ValueAt(table, PairAt(10.25, 20, 30))[0], 1.75, 1e-6);
  EXPECT_NEAR(ValueAt(table, PairAt(10, 20.5, 30))[0], 1.5, 1e-6);
  EXPECT_NEAR(ValueAt(table, PairAt(10.5, 20.5, 29.5))[0], 1.125, 1e-6);
  EXPECT_NEAR(ValueAt(table, PairAt(10.5, 20.5, 29.5))[1], 1.15 * 1.125, 1e-6);
  EXPECT_NEAR(ValueAt(table, PairAt(10.5, 20.5, 29.5))[2], 1.66 * 1.125, 1e-6);
}

TEST(Merl, PhiDWrapsAroundByReciprocity) {
  TemporaryFolder folder;
  std::string bytes = FileOf(1500.0);
  SetBin(&bytes, Bin(10, 20, 0), 3000.0);
  WriteBytes(folder / "t.binary", bytes);
  const MerlBrdf table = MerlBrdf::Read(folder / "t.binary");
  EXPECT_NEAR(ValueAt(table, PairAt(10, 20, 179.5))[0], 1.5, 1e-6);
  EXPECT_NEAR(ValueAt(table, PairAt(10, 20, 180.5))[0], 1.5, 1e-6);
}

TEST(Merl, InvalidBinsDontLeak) {
  TemporaryFolder folder;
  std::string bytes = FileOf(1500.0);
  SetBin(&bytes, Bin(10, 20, 30), -1.0);
  WriteBytes(folder / "t.binary", bytes);
  const MerlBrdf table = MerlBrdf::Read(folder / "t.binary");
  EXPECT_FALSE(table.IsKnown(PairAt(10.5, 20.5, 30.5)));
  EXPECT_TRUE(table.IsKnown(PairAt(9.5, 20.5, 30.5)));
  for (double h = 9.05; h < 11; h += 0.1) {
    EXPECT_NEAR(ValueAt(table, PairAt(h, 19.6, 29.3))[0], 1.0, 1e-12);
    EXPECT_NEAR(ValueAt(table, PairAt(h, 20.6, 30.3))[0], 1.0, 1e-12);
  }
  for (const BrdfSample& s :
       DrawSamples(table, SampleSet::kTraining, Sampling::kUniform, 5000, 1)) {
    EXPECT_TRUE(table.IsKnown(s.pair));
  }
}

TEST(Merl, BadFilesAreNamed) {
  TemporaryFolder folder;
  const std::string path = folder / "m.binary";
  const auto read = [&](const std::string& bytes) {
    WriteBytes(path, bytes);
    return ErrorOf([&] { MerlBrdf::Read(path); });
  };
  const std::string good = FileOf(1.0);
  EXPECT_EQ(read(good), "");
  EXPECT_THAT(ErrorOf([&] { MerlBrdf::Read(folder / "none"); }), HasSubstr("none: no such file"));
  EXPECT_THAT(read("short"), HasSubstr("m.binary: not a MERL file: 5 bytes"));
  EXPECT_THAT(read(good.substr(0, 1000)), HasSubstr("truncated MERL file: 1000 bytes, expected"));
  EXPECT_THAT(read(good + "x"), HasSubstr("expected 34992012"));
  std::string other = good;
  other[0] = 91;
  EXPECT_THAT(read(other), HasSubstr("its header says 91 x 90 x 180, expected 90 x 90 x 180"));
  std::string nan = good;
  SetBin(&nan, 5, std::nan(""));
  EXPECT_THAT(read(nan), HasSubstr("channel R of bin 5 is not a finite number"));
  EXPECT_THAT(read(FileOf(-1.0)), HasSubstr("no valid bin"));
}

}  // namespace
}  // namespace pbnbrdf

#include "pbnbrdf/sources/merl.h"

#include <cstring>

#include "brdf/direction_pairs.h"
#include "brdf/value_at.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/problem/sampling.h"

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

TEST(Merl, TheCornersAroundAPairAreTheBinsThatItsValueComesFrom) {
  const MerlBrdf table = MerlBrdf::Tabulate(*MakeBuiltin("satin-gold"));
  for (const DirectionPair& pair : {PairAt(20.25, 30.5, 60.75), PairAt(3.0, 50.9, 179.5)}) {
    double total = 0.0, red = 0.0;
    for (const auto& [bin, weight] : CornersOf({}, pair)) {
      total += weight;
      red += weight * ValueAt(table, MerlBrdf::CornerPair(bin))[0];
    }
    EXPECT_NEAR(total, 1.0, 1e-12);
    EXPECT_NEAR(red, ValueAt(table, pair)[0], 1e-9 * red);
  }
}

TEST(Merl, TablesFromValuesHaveThose) {
  const std::vector<std::size_t> bins = MerlBrdf::BinsAboveHorizon();
  EXPECT_EQ(bins.size(), MerlBrdf::kBins - 346674u);
  const MerlBrdf table =
      MerlBrdf::FromValues(std::vector<BinValue>{{bins[1000], {0.5, 0.25, 2.0}}});
  EXPECT_EQ(table.valid_bins(), 1u);
  const Rgb value = ValueAt(table, MerlBrdf::CornerPair(bins[1000]));
  EXPECT_NEAR(value[0], 0.5, 1e-12);
  EXPECT_NEAR(value[2], 2.0, 1e-12);
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

// A single channel below 0 is noise, and so are three different ones.
TEST(Merl, NegativeNoiseIsKnownAndKept) {
  TemporaryFolder folder;
  std::string bytes = FileOf(1500.0);
  const std::size_t bin = Bin(10, 20, 30);
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = -3.0 * static_cast<double>(c + 1);
    std::memcpy(&bytes[12 + 8 * (c * MerlBrdf::kBins + bin)], &value, 8);
  }
  WriteBytes(folder / "t.binary", bytes);
  const MerlBrdf table = MerlBrdf::Read(folder / "t.binary");
  const DirectionPair pair = PairAt(10, 20, 30 + 1e-9);
  EXPECT_TRUE(table.IsKnown(pair));
  Rgb unclipped;
  table.EvaluateUnclipped({&pair, 1}, {&unclipped, 1});
  EXPECT_NEAR(unclipped[0], -0.002, 1e-6);
  EXPECT_NEAR(unclipped[2], -0.006 * 1.66, 1e-6);
  EXPECT_EQ(ValueAt(table, pair)[2], 0.0);
  EXPECT_THAT(table.Description(), HasSubstr("1 with a negative channel"));
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
  EXPECT_THAT(read(other),
              HasSubstr("truncated MERL file: 34992012 bytes, expected 35380812 for the "
                        "header's 91 x 90 x 180"));
  std::string nan = good;
  SetBin(&nan, 5, std::nan(""));
  EXPECT_THAT(read(nan), HasSubstr("channel R of bin 5 is not a finite number"));
  EXPECT_THAT(read(FileOf(-1.0)), HasSubstr("no valid bin"));
}

// A small file of another grid, its bins 1, 2, 3, ... / 1500 in R; G and B 0.
std::string SmallFile(std::int32_t theta_h, std::int32_t theta_d, std::int32_t phi_d) {
  const std::int32_t dimensions[3] = {theta_h, theta_d, phi_d};
  std::vector<double> planes(3u * theta_h * theta_d * phi_d, 0.0);
  for (std::size_t bin = 0; bin < planes.size() / 3; ++bin) planes[bin] = double(bin + 1);
  std::string bytes(reinterpret_cast<const char*>(dimensions), sizeof(dimensions));
  return bytes.append(reinterpret_cast<const char*>(planes.data()), 8 * planes.size());
}

TEST(Merl, OtherGridsAreReadAndWritten) {
  TemporaryFolder folder;
  const std::string bytes = SmallFile(10, 5, 8);
  WriteBytes(folder / "a.binary", bytes);
  const MerlBrdf table = MerlBrdf::Read(folder / "a.binary");
  EXPECT_EQ(table.Description(), "MERL table 10 x 5 x 8, 400 of 400 bins valid");
  // Row 3, column 2, phi_d of bin 5; the corner itself and half the way to bin 6, once more at + pi.
  const double corner = (3 * 5 + 2) * 8 + 5 + 1;
  for (double turn : {0.0, kPi}) {
    const auto value = [&](double p) {
      return 1500.0 * ValueAt(table, FromAngles({.theta_h = kPi / 2 * 0.3 * 0.3,
                                                 .theta_d = kPi / 2 * 2 / 5.0,
                                                 .phi_d = kPi * p / 8 + turn}))[0];
    };
    EXPECT_NEAR(value(5.0), corner, 1e-5);
    EXPECT_NEAR(value(5.5), corner + 0.5, 1e-5);
    EXPECT_NEAR(value(7.5), corner + 2 - 3.5, 1e-5);  // half the way round to bin 0
  }
  table.Write(folder / "b.binary");
  std::ifstream b(folder / "b.binary", std::ios::binary);
  EXPECT_TRUE((std::string{std::istreambuf_iterator<char>(b), {}} == bytes));
}

TEST(Merl, ThreeHundredAndSixtyBinsAreTheWholeCircle) {
  TemporaryFolder folder;
  WriteBytes(folder / "a.binary", SmallFile(1, 2, 360));
  const MerlBrdf table = MerlBrdf::Read(folder / "a.binary");
  for (double degrees : {0.0, 30.5, 179.0, 180.0, 210.5, 359.0}) {
    const DirectionPair pair =
        FromAngles({.theta_h = 0.01, .theta_d = kPi / 4, .phi_d = kPi * degrees / 180});
    EXPECT_NEAR(1500.0 * ValueAt(table, pair)[0], 361.0 + degrees, 1e-5);
  }
}

TEST(Merl, HeadersThatLieAreNamed) {
  TemporaryFolder folder;
  const std::string path = folder / "m.binary", good = SmallFile(2, 3, 4);
  const auto with = [&](std::int32_t theta_h, std::int32_t theta_d, std::int32_t phi_d) {
    const std::int32_t dimensions[3] = {theta_h, theta_d, phi_d};
    std::string bytes = good;
    std::memcpy(bytes.data(), dimensions, sizeof(dimensions));
    WriteBytes(path, bytes);
    return ErrorOf([&] { MerlBrdf::Read(path); });
  };
  EXPECT_EQ(with(2, 3, 4), "");
  EXPECT_EQ(with(4, 3, 2), "");
  EXPECT_THAT(with(0, 3, 4), HasSubstr("its header says 0 x 3 x 4, such as 90 x 90 x 180"));
  EXPECT_THAT(with(-2, -3, 4), HasSubstr("its header says -2 x -3 x 4"));
  EXPECT_THAT(with(2, 3, 3), HasSubstr("588 bytes, expected 444 for the header's 2 x 3 x 3"));
  EXPECT_THAT(with(2, 3, 5), HasSubstr("truncated MERL file: 588 bytes, expected 732"));
  const std::int32_t most = 0x7fffffff;
  EXPECT_THAT(with(most, most, most), HasSubstr("too large a table"));
  EXPECT_THAT(with(most, 1, 1), HasSubstr("too large a table"));
  EXPECT_THAT(with(1 << 16, 1 << 16, 1 << 16), HasSubstr("too large a table"));
  for (std::size_t k = 0; k < 20; ++k) {
    WriteBytes(path, good.substr(0, good.size() * k / 20));
    EXPECT_THAT(ErrorOf([&] { MerlBrdf::Read(path); }), testing::StartsWith(path + ": ")) << k;
  }
}

}  // namespace
}  // namespace pbnbrdf

#include "export/formats.h"

#include <set>

#include "export/networks.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

std::vector<std::vector<std::string>> Rows(const Brdf& brdf) {
  TemporaryFolder folder;
  WriteBytes(folder / "x.csv", CsvTable(brdf));
  return ReadCsvRows(folder / "x.csv");
}

double Number(const std::vector<std::string>& row, int column) {
  return ParseNumber("csv", row[column]);
}

DirectionPair PairOf(const std::vector<std::string>& row) {
  return {FromSpherical(Number(row, 0), Number(row, 1)),
          FromSpherical(Number(row, 2), Number(row, 3))};
}

TEST(CsvTable, ValuesAreThoseAtTheWrittenAngles) {
  for (Encoding encoding : {Encoding::kCartesian, Encoding::kAnisotropic}) {
    const NeuralBrdf network = RandomNetwork(encoding, Activation::kTanh, {5}, 3);
    std::vector<DirectionPair> pairs;
    const auto rows = Rows(network);
    for (const auto& row : rows) {
      ASSERT_EQ(row.size(), 7u);
      pairs.push_back(PairOf(row));
      ASSERT_TRUE(pairs.back().AboveHorizon());
      if (network.IsIsotropic()) {
        ASSERT_EQ(Number(row, 1), 0.0);
      }
    }
    std::vector<Rgb> values(pairs.size());
    network.Evaluate(pairs, values);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      for (int c = 0; c < 3; ++c) ASSERT_EQ(Number(rows[n], 4 + c), values[n][c]) << n;
    }
  }
}

TEST(CsvTable, TheGridIsTheDocumentedOne) {
  const NeuralBrdf network = RandomNetwork(Encoding::kAnisotropic, Activation::kTanh, {5}, 3);
  const auto grid = [](double angle, double step) {
    const double steps = angle / step;
    EXPECT_NEAR(steps, std::round(steps), 1e-5);
    return std::lround(steps);
  };
  std::set<long> theta_h, theta_d, phi_d;
  std::set<std::vector<std::string>> distinct;
  for (const auto& row : Rows(network)) {
    const RusinkiewiczAngles angles = ToAngles(PairOf(row));
    theta_h.insert(grid(std::sqrt(angles.theta_h / (kPi / 2)), 1.0 / 45));
    theta_d.insert(grid(angles.theta_d, kPi / 36));
    // At the poles the azimuth is what rounding makes of it.
    if (angles.theta_h > 1e-6 && angles.theta_d > 1e-6)
      phi_d.insert(grid(angles.phi_d, kPi / 12) % 24);
    EXPECT_TRUE(distinct.insert(row).second) << row[0] << "," << row[1] << "," << row[2];
  }
  EXPECT_EQ(theta_h.size(), 45u);
  EXPECT_EQ(theta_d.size(), 18u);
  EXPECT_EQ(phi_d.size(), 24u);
}

}  // namespace
}  // namespace pbnbrdf

#include <vector>

#include "base/pi.h"
#include "base/text.h"
#include "export/formats.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

constexpr int kThetaH = 45, kThetaD = 18, kPhiD = 24, kPhiH = 12;

struct PairAngles {
  double theta_i, phi_i, theta_o, phi_o;

  DirectionPair Directions() const {
    return {FromSpherical(theta_i, phi_i), FromSpherical(theta_o, phi_o)};
  }
};

// Azimuths as they are, or turned so that phi_i = 0; in [-pi, pi].
PairAngles ToPairAngles(const DirectionPair& pair, bool turn) {
  const double phi_i = std::atan2(pair.wi.y, pair.wi.x), phi_o = std::atan2(pair.wo.y, pair.wo.x);
  const double by = turn ? phi_i : 0.0;
  return {Theta(pair.wi), phi_i - by, Theta(pair.wo), std::remainder(phi_o - by, 2.0 * kPi)};
}

std::vector<PairAngles> Grid(bool isotropic) {
  std::vector<PairAngles> grid;
  for (int h = 0; h < kThetaH; ++h) {
    const double u = double(h) / kThetaH;
    for (int d = 0; d < kThetaD; ++d) {
      // Where h = +z or wi = wo = h, the azimuths don't tell pairs apart, or not both of them.
      const int phi_d_steps = d == 0 || (h == 0 && isotropic) ? 1 : kPhiD;
      for (int p = 0; p < phi_d_steps; ++p) {
        for (int t = 0; t < (isotropic || h == 0 ? 1 : kPhiH); ++t) {
          const DirectionPair pair = FromAngles({.theta_h = 0.5 * kPi * u * u,
                                                 .theta_d = 0.5 * kPi * d / kThetaD,
                                                 .phi_d = 2.0 * kPi * p / kPhiD,
                                                 .phi_h = 2.0 * kPi * t / kPhiH});
          const PairAngles angles = ToPairAngles(pair, isotropic);
          if (angles.Directions().AboveHorizon()) grid.push_back(angles);
        }
      }
    }
  }
  return grid;
}

}  // namespace

std::string CsvTable(const Brdf& brdf) {
  const std::vector<PairAngles> grid = Grid(brdf.IsIsotropic());
  std::vector<DirectionPair> pairs;
  for (const PairAngles& angles : grid) pairs.push_back(angles.Directions());
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  std::string text = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const auto& [theta_i, phi_i, theta_o, phi_o] = grid[n];
    for (double number : {theta_i, phi_i, theta_o, phi_o, values[n][0], values[n][1]}) {
      text += FormatNumber(number) + ",";
    }
    text += FormatNumber(values[n][2]) + "\n";
  }
  return text;
}

}  // namespace pbnbrdf

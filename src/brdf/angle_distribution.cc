#include "pbnbrdf/brdf/angle_distribution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/pi.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr int kThetaH = 32, kThetaD = 18, kPhiD = 18, kPhiH = 18;

// The cell of x in [0, 1], of so many.
int CellOf(double x, int cells) { return std::clamp(static_cast<int>(x * cells), 0, cells - 1); }

}  // namespace

AngleHistogram::AngleHistogram(bool isotropic)
    : azimuths_(isotropic ? 1 : kPhiH),
      weights_(std::size_t(kThetaH) * kThetaD * kPhiD * std::size_t(azimuths_)) {}

void AngleHistogram::Add(const DirectionPair& pair, double weight) {
  const RusinkiewiczAngles angles = ToAngles(pair);
  const int h = CellOf(std::cbrt(angles.theta_h / (0.5 * kPi)), kThetaH);
  const int d = CellOf(angles.theta_d / (0.5 * kPi), kThetaD);
  const int p = CellOf(std::fmod(angles.phi_d, kPi) / kPi, kPhiD);
  const int a = CellOf(angles.phi_h / (2.0 * kPi), azimuths_);
  weights_[std::size_t(((h * kThetaD + d) * kPhiD + p) * azimuths_ + a)] += weight;
}

double AngleHistogram::Total() const {
  return std::accumulate(weights_.begin(), weights_.end(), 0.0);
}

AngleDistribution::AngleDistribution(const AngleHistogram& histogram)
    : azimuths_(histogram.azimuths_) {
  double sum = 0.0;
  const std::size_t cells_of_theta_h = histogram.weights_.size() / kThetaH;
  for (std::size_t cell = 0; cell < histogram.weights_.size(); ++cell) {
    const double h = static_cast<double>(cell / cells_of_theta_h);
    const double uniform = (std::pow(h + 1.0, 3) - std::pow(h, 3)) / std::pow(kThetaH, 3);
    sums_.push_back(sum += std::sqrt(histogram.weights_[cell] * uniform));
  }
  if (!(sum > 0.0)) Fail("a distribution of angles whose weights are all 0");
}

RusinkiewiczAngles AngleDistribution::Draw(const std::array<double, 5>& u) const {
  // The first cell whose sum is above: one of no weight never is.
  const double at = std::min(u[0] * sums_.back(), std::nextafter(sums_.back(), 0.0));
  auto cell = static_cast<int>(std::upper_bound(sums_.begin(), sums_.end(), at) - sums_.begin());
  const int a = cell % azimuths_, p = (cell /= azimuths_) % kPhiD, d = (cell /= kPhiD) % kThetaD,
            h = cell / kThetaD;
  RusinkiewiczAngles angles;
  angles.theta_h = 0.5 * kPi * std::pow((h + u[2]) / kThetaH, 3);
  angles.theta_d = 0.5 * kPi * (d + u[1]) / kThetaD;
  angles.phi_d = kPi * (p + u[3]) / kPhiD;
  if (azimuths_ > 1) angles.phi_h = 2.0 * kPi * (a + u[4]) / azimuths_;
  return angles;
}

}  // namespace pbnbrdf

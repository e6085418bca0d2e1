// piece.h: the integrand of a directional albedo on a small box of directions, and a bound of its integral
// (pbnbrdf/proof/energy_proof.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/pi.h"
#include "proof/network_enclosure.h"

namespace pbnbrdf {

// Variables of the integrand: t and phi, which are integrated over, and theta_i, and phi_i of anisotropic networks.
enum Variable { kT, kPhi, kThetaI, kPhiI };
inline constexpr int kIntegrated = 2;

template <int N>
struct Box {
  std::array<double, N> center, radius;

  Box Half(int d, int side) const {
    Box half = *this;
    half.radius[d] *= 0.5;
    half.center[d] += (side == 0 ? -1.0 : 1.0) * half.radius[d];
    return half;
  }
};

// The integral of a piece, for each channel: at most constant + slope (wi - centre of the cell).
template <int D>
struct Piece {
  Box<kIntegrated> box;
  std::array<double, NetworkShape::kChannels> constant;
  std::array<std::array<double, D - kIntegrated>, NetworkShape::kChannels> slope;
  std::array<float, NetworkShape::kChannels> estimate;
  // What its size costs, in the channel where it costs most: in t and phi, and in each variable of wi.
  float inner_cost = -1.0f;
  std::array<float, D - kIntegrated> outer_cost;
  int longest;  // the side, of t and phi, that costs most
};

// The integrand of all channels is f times this; and the network's inputs.
template <int D>
struct Integrand {
  Enclosure<D> weight;
  Inputs<Enclosure<D>> inputs;
};

// f cos theta_o d(wo) by dt and d(phi), with theta_h = (pi/2) t^2 and wi at azimuth 0, or phi_i.
template <int D>
Integrand<D> IntegrandOn(Encoding encoding, const Box<D>& box) {
  using V = Enclosure<D>;
  const auto variable = [&](int d) { return V::Variable(d, box.center[d], box.radius[d]); };
  const V t = variable(kT), phi = variable(kPhi), theta_i = variable(kThetaI);
  const V theta_h = (kPi / 2.0) * t * t;
  const V sin_h = sin(theta_h), cos_h = cos(theta_h), sin_i = sin(theta_i), cos_i = cos(theta_i);
  const V sin_phi = sin(phi), cos_phi = cos(phi);
  HalfDiffOf<V> v;
  v.sin_theta = sin_h;
  v.cos_theta = cos_h;
  v.cos_phi = V(1.0);
  v.sin_phi = V(0.0);
  if constexpr (D > kPhiI) {
    const V azimuth = phi + variable(kPhiI);
    v.cos_phi = cos(azimuth);
    v.sin_phi = sin(azimuth);
  }
  v.hx = v.sin_theta * v.cos_phi;
  v.hy = v.sin_theta * v.sin_phi;
  v.dx = sin_i * cos_h * cos_phi - cos_i * sin_h;
  v.dy = -(sin_i * sin_phi);
  v.dz = sin_i * sin_h * cos_phi + cos_i * cos_h;
  const V cos_o = Max(2.0 * v.dz * cos_h - cos_i, V(0.0));
  // d(h) = sin theta_h d(theta_h) d(phi), d(theta_h) = pi t dt.
  return {(4.0 * kPi) * v.dz * cos_o * sin_h * t, Encode(encoding, v)};
}

// Slopes that are as good as infinite.
inline constexpr double kSteepest = 1e100;

// A cost, shared among the variables as what each can change the value by.
template <int D>
std::array<double, D> Shares(const std::array<Interval, D>& slopes, const Box<kIntegrated>& box,
                             const Box<D - kIntegrated>& outer, double cost) {
  std::array<double, D> shares;
  double sum = 0.0;
  for (int d = 0; d < D; ++d) {
    const double steepest = std::max(std::abs(slopes[d].low), std::abs(slopes[d].high));
    const double radius = d < kIntegrated ? box.radius[d] : outer.radius[d - kIntegrated];
    shares[d] = radius * (steepest < kSteepest ? steepest : kSteepest);  // also of NaN
    sum += shares[d];
  }
  for (double& share : shares) share *= sum > 0.0 ? cost / sum : 0.0;
  return shares;
}

// From the enclosure of f in its box n, after Run, and of the rest of the integrand there.
template <int D>
Piece<D> MakePiece(const NetworkEnclosure<D>& enclosure, int n, const Enclosure<D>& weight,
                   const Box<kIntegrated>& box, const Box<D - kIntegrated>& outer) {
  Piece<D> piece;
  piece.box = box;
  const double volume = 4.0 * box.radius[0] * box.radius[1];
  for (int c = 0; c < NetworkShape::kChannels; ++c) {
    const Enclosure<D> value = enclosure.Reflectance(n, c) * weight;
    const double mean = enclosure.LargestMean(n, c, kIntegrated) * weight.range.high;
    const double largest = volume * (mean < value.range.high ? mean : value.range.high);
    const double middle = volume * value.center;
    std::array<double, D> costs;
    double linear = middle, reach = 0.0;
    for (int d = 0; d < D; ++d) {
      const Interval& slope = value.slopes[d];
      const double per_radius = (d < kIntegrated ? 0.25 : 0.5) * volume * (slope.high - slope.low);
      costs[d] = per_radius * (d < kIntegrated ? box.radius[d] : outer.radius[d - kIntegrated]);
      linear += costs[d];
      if (d < kIntegrated) continue;
      double& middle_slope = piece.slope[c][d - kIntegrated];
      middle_slope = 0.5 * volume * (slope.low + slope.high);
      reach += std::abs(middle_slope) * outer.radius[d - kIntegrated];
    }
    piece.estimate[c] = static_cast<float>(middle);
    piece.constant[c] = linear;
    if (!(linear + reach < largest)) {  // nothing is known of the slopes, or too little
      piece.constant[c] = largest;
      piece.slope[c].fill(0.0);
      costs = Shares<D>(value.slopes, box, outer, largest - middle);
    }
    if (costs[kT] + costs[kPhi] <= piece.inner_cost) continue;
    piece.inner_cost = static_cast<float>(costs[kT] + costs[kPhi]);
    piece.longest = costs[kPhi] > costs[kT] ? kPhi : kT;
    for (int d = 0; d < D - kIntegrated; ++d) piece.outer_cost[d] = float(costs[kIntegrated + d]);
  }
  return piece;
}

}  // namespace pbnbrdf

// encoding.h: a direction pair as the input of a network.
#pragma once

#include <array>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// With h and d of half_diff.h turned to phi_h = 0 (all materials are isotropic so far),
// s = sqrt(dx^2 + dy^2):
enum class Encoding {
  // (hx, hy, hz, dx, dy, dz), NBRDF's. hy = 0 always.
  kCartesian,
  // (hx, hy, hz, (dx^2 - dy^2) / s, 2 dx dy / s, dz): phi_d doubled, section 4.1 of the paper.
  kReciprocal,
  // (sin th, sqrt(2 th / pi), log(th + 0.001) / 3, dx^2 - dy^2, 2 dx dy, dz), th = theta_h:
  // reciprocal too, smooth where s = 0, and with theta_h on three scales, which resolves lobes of
  // any width.
  kMultiscale,
};

inline constexpr NameTable<Encoding, 3> kEncodings = {{{"cartesian", Encoding::kCartesian},
                                                       {"reciprocal", Encoding::kReciprocal},
                                                       {"multiscale", Encoding::kMultiscale}}};

inline constexpr int kEncodedSize = 6;

// kReciprocal and kMultiscale give the same bits for a pair and for the pair with wi and wo
// exchanged, hence any network behind them is reciprocal exactly.
std::array<double, kEncodedSize> Encode(Encoding encoding, const DirectionPair& pair);

}  // namespace pbnbrdf

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
  // As kMultiscale, with 4 u (1 - u) for sin th: u in [0, 1) is where th lies between two rows of a
  // MERL table, the fraction of 90 sqrt(2 th / pi). A table interpolated linearly has a kink at
  // each row, and across a sharp highlight f changes tenfold from one to the next: there the bends
  // in between are most of what a smooth network misses.
  kMerl,
};

inline constexpr NameTable<Encoding, 4> kEncodings = {{{"cartesian", Encoding::kCartesian},
                                                       {"reciprocal", Encoding::kReciprocal},
                                                       {"multiscale", Encoding::kMultiscale},
                                                       {"merl", Encoding::kMerl}}};

inline constexpr int kEncodedSize = 6;

// Whether networks behind it don't change when wi and wo turn together about the normal.
constexpr bool IsIsotropic(Encoding) { return true; }

// All but kCartesian give the same bits for a pair and for the pair with wi and wo
// exchanged, hence any network behind them is reciprocal exactly.
std::array<double, kEncodedSize> Encode(Encoding encoding, const DirectionPair& pair);

}  // namespace pbnbrdf

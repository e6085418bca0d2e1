// encoding.h: a direction pair as the input of a network.
#pragma once

#include <array>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// With h and d of half_diff.h, h turned to phi_h = 0 by all but kAnisotropic, th = theta_h,
// s = sqrt(dx^2 + dy^2):
enum class Encoding {
  // (hx, hy, hz, dx, dy, dz), NBRDF's. hy = 0 always.
  kCartesian,
  // (hx, hy, hz, (dx^2 - dy^2) / s, 2 dx dy / s, dz): phi_d doubled, section 4.1 of the paper.
  kReciprocal,
  // (sin th, sqrt(2 th / pi), log(th + 0.001) / 3, dx^2 - dy^2, 2 dx dy, dz): reciprocal too,
  // smooth where s = 0, and with theta_h on three scales, which resolves lobes of any width.
  kMultiscale,
  // As kMultiscale, with 4 u (1 - u) for sin th: u in [0, 1) is where th lies between two rows of a
  // MERL table, the fraction of 90 sqrt(2 th / pi). A table interpolated linearly has a kink at
  // each row, and across a sharp highlight f changes tenfold from one to the next: there the bends
  // in between are most of what a smooth network misses.
  kMerl,
  // As kMerl, with sin th for 2 dx dy: f is then the same at phi_d and -phi_d, for any weights, as
  // it is of an isotropic material without chirality. It is there for the symmetry: over eight such
  // materials the errors were 0.9 of kMerl's, which is less than seeds differ by.
  kBilateral,
  // (r cos phi_h, r sin phi_h, log(th + 0.001) / 3, tx^2 - ty^2, 2 tx ty, dz), for anisotropic
  // materials: r = (2 th / pi)^(3/4), (tx, ty) = (dx, dy) turned by phi_h. Reciprocal. The frame of
  // d spins with phi_h, that of t doesn't: all inputs are continuous at h = +z, which lowers the
  // error of a brushed metal fivefold. Powers of th from 1/2 to 1 differ by less than seeds do.
  kAnisotropic,
};

inline constexpr NameTable<Encoding, 6> kEncodings = {{{"cartesian", Encoding::kCartesian},
                                                       {"reciprocal", Encoding::kReciprocal},
                                                       {"multiscale", Encoding::kMultiscale},
                                                       {"merl", Encoding::kMerl},
                                                       {"bilateral", Encoding::kBilateral},
                                                       {"anisotropic", Encoding::kAnisotropic}}};

// Whether a network behind the encoding is isotropic, whatever its weights.
constexpr bool IsIsotropic(Encoding encoding) { return encoding != Encoding::kAnisotropic; }

// The encoding for a material of which nothing else is known: kMerl if it is isotropic, else
// kAnisotropic.
Encoding EncodingFor(const Brdf& material);

inline constexpr int kEncodedSize = 6;

// All but kCartesian give the same bits for a pair and for the pair with wi and wo
// exchanged, hence any network behind them is reciprocal exactly.
std::array<double, kEncodedSize> Encode(Encoding encoding, const DirectionPair& pair);

}  // namespace pbnbrdf

// energy_proof.h: a bound of a network's directional albedo that holds for every direction of the light, and not
// only where a quadrature looked.
//
// The albedo a(wi), the integral of f cos theta_o over the hemisphere of wo, is taken over the half vector h at
// (theta_h, phi), phi counted from wi's azimuth, with d(wo) = 4 (wi . h) d(h) and theta_h = (pi/2) t^2. Directions wi
// are cut into cells, and for each of them the half vectors. In each piece of both, with centre c and half sides r,
// the integrand F of a channel has values F(c) + slope (x - c), where interval arithmetic through the encoding
// and the network bounds the slope [1]: it is known as m +- e. Over t and phi the part m (x - c) integrates to 0, so
// that what is left is the volume times
//
//   F(c) + m (wi - c)  for the cell's wi,   plus or minus  e r (half of it in t and phi),
//
// an error of second order in the piece's size; or a mean of F's largest values, where that is less. The sum over
// the pieces of a cell is linear in wi: its largest value is at a corner. Cells are refined, pieces where they are least
// certain, until all bounds are at most 1 + 1e-6 or the time is over.
//
// What it rests on: the mean value theorem, and double precision, whose rounding (about 1e-12 here) isn't
// included. That f is not negative and, of a reciprocal encoding, the same to the bit for wi and wo exchanged,
// needs no computation: f is max(0, expm1(z)), and the inputs of z are the same bits for both orders
// (encoding.h).
//
// [1] A. Neumaier. Interval Methods for Systems of Equations. Cambridge University Press, 1990: mean value forms.
#pragma once

#include <cstddef>
#include <functional>

#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// What rounding and the solver's own tolerance are allowed.
inline constexpr double kProvedAlbedo = 1.0 + 1e-6;

struct EnergyProofOptions {
  double seconds = 60.0;
  std::size_t max_pieces = 4'000'000;  // about 100 bytes each
  // Called now and then if set.
  std::function<void(double proved_part, double seconds)> on_progress = {};
};

struct EnergyProof {
  double bound = 0.0;     // no directional albedo of any channel is larger
  double estimate = 0.0;  // of the albedo where the bound is largest, by the pieces' centres
  double theta_i = 0.0, phi_i = 0.0;  // of that cell's centre, radians
  // Of all directions of the light, by solid angle: where the bound is at most kProvedAlbedo.
  double proved_part = 0.0;
  std::size_t cells = 0, pieces = 0;  // of wi; and how many were computed, of all cells
  double seconds = 0.0;

  bool IsProved() const { return bound <= kProvedAlbedo; }
};

// On all threads. Ends early if that can't be proved, since the albedo itself is larger.
EnergyProof ProveEnergy(const NeuralBrdf& network, const EnergyProofOptions& options = {});

}  // namespace pbnbrdf

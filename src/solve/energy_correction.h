// energy_correction.h: the last step of a fit that conserves energy.
#pragma once

#include <functional>
#include <vector>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {

// The largest directional albedo that a fit with the energy term may have by its own check, so that
// other checks, at other angles and by other quadratures, find at most 1 + 1e-6.
inline constexpr double kMaxAlbedo = 1.0 - 2e-5;

// What a fit aims at. The check can do without double precision there: 1 is then farther off than
// what single precision may be wrong by (albedo.cc).
inline constexpr double kTargetAlbedo = 1.0 - 5e-5;

struct Correction {
  double change;  // mean |change of log(1 + f)| over directions, in the channel that changed most
  double max_albedo;                    // the largest directional albedo that is left
  std::vector<IncidentAlbedo> profile;  // of all directional albedos, by the finest check
};

// Changes the weights of the last layer until no directional albedo is above kMaxAlbedo. Each step
// takes the direction where an albedo is largest, and lowers it to kTargetAlbedo by the change of the channel's
// weights that changes log(1 + f) least, in the mean square over all angles: near that direction if the
// network can tell it from others. If albedos keep exceeding 1, the whole channel is lowered, which always
// ends. A reciprocal network stays so.
//
// has_time: whether there is time for more than one of the rounds in which that is tried.
Correction LowerToConserve(const NetworkShape& shape, const std::function<bool()>& has_time,
                           std::vector<double>* weights);

}  // namespace pbnbrdf

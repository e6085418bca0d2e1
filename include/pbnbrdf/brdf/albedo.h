// albedo.h: quadrature for the directional albedo a(theta_i) = integral of f cos_o dwo (eq. 2).
#pragma once

#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

struct AlbedoNode {
  DirectionPair pair;  // wi = (sin theta_i, 0, cos theta_i)
  double weight;       // > 0, includes cos_o and the solid angle
};

// Nodes with sum of weight * f(pair) = a(theta_i), theta_i in [0, pi/2). They are stratified in the
// half vector, n_theta * n_phi of them, dense about the mirror direction, where a lobe of 0.1
// degree falls between the points of any grid that is uniform in wo. With theta = theta_max(phi_h)
// u^3, u and phi_h at the midpoints of equal strata, and dwo = 4 (wi.h) dwh.
std::vector<AlbedoNode> AlbedoQuadrature(double theta_i, int n_theta, int n_phi);

Rgb DirectionalAlbedo(const Brdf& brdf, double theta_i, int n_theta = 128, int n_phi = 64);

}  // namespace pbnbrdf

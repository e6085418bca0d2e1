// angle_distribution.h: at which Rusinkiewicz angles a material is asked for, and how much it
// matters there: what a scene shows of it (render/demand.h), for a fit to take its samples from.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {

// Weights of the cells of a grid: 32 x 18 x 18 in (theta_h, theta_d, phi_d), in theta_h narrow near
// the mirror with edges at (pi/2) (i/32)^3. phi_d and phi_d + pi are the same, by reciprocity.
// Materials that aren't isotropic have 18 cells of phi_h besides.
class AngleHistogram {
 public:
  explicit AngleHistogram(bool isotropic);

  // weight: finite, >= 0.
  void Add(const DirectionPair& pair, double weight);

  double Total() const;  // of all weights

 private:
  friend class AngleDistribution;

  int azimuths_;  // cells of phi_h
  std::vector<double> weights_;
};

// Angles at random, half way from uniform angles to the weights: a cell is drawn in proportion to
// sqrt(w u), w its weight and u its probability by uniform (theta_h, theta_d, phi_d, phi_h). Fits to
// samples drawn by the weights themselves go astray wherever these are small. Cells of no weight are
// left out. Within a cell uniform in (theta_h^(1/3), theta_d, phi_d, phi_h), with phi_h = 0 of isotropic
// materials.
class AngleDistribution {
 public:
  // Throws Error if all weights are 0.
  explicit AngleDistribution(const AngleHistogram& histogram);

  // For five uniform numbers in [0, 1), of which u[1] places theta_d within its cell. A direction
  // of the pair may lie below the horizon.
  RusinkiewiczAngles Draw(const std::array<double, 5>& u) const;

 private:
  int azimuths_;
  std::vector<double> sums_;  // of the weights up to and including each cell's
};

}  // namespace pbnbrdf

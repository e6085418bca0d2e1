// plan.h: which directions to measure, given what a database knows.
//
// A measurement says something of a material's code, as far as f depends on the code there: to first order, and with
// normal noise, the code's covariance after some measurements doesn't depend on what they will be. Chosen are, one
// after the other, those directions that take most off the mean square error of log(1 + f cos theta_i) over all
// directions, in the mean over some members of the database: Bayesian A-optimality [1] of the predictions.
// (Nielsen et al. 2015 choose those for which the components' matrix is well conditioned, which leaves out how
// much is known before, and that directions differ in how much they tell.)
//
// [1] K. Chaloner, I. Verdinelli. Bayesian Experimental Design: A Review. Statistical Science 10(3), 1995.
#pragma once

#include <span>
#include <vector>

#include "pbnbrdf/database/code_fit.h"

namespace pbnbrdf {

struct PlanOptions {
  int count = 8;          // directions, >= 1
  double max_theta = 80;  // degrees, of both, in (0, 89]
  double theta_step = 5;  // degrees: directions are on a grid that a goniometer can take, >= 1
  double phi_step = 15;   // degrees
};

// All directions that a plan chooses from: pairs of the grid's angles, each order of a pair once.
std::vector<DirectionPair> CandidatePairs(const PlanOptions& options);

// The directions, best first; wi at azimuth 0. measured: what is known already, of the same material; may be
// empty. Throws Error if the options are out of range.
std::vector<DirectionPair> PlanDirections(const WeightFamily& family,
                                          std::span<const BrdfSample> measured,
                                          const PlanOptions& options);

// The same by principal components. The error is that of the mapped values (table_pca.h), which are linear in the
// code: what was measured matters only by where.
std::vector<DirectionPair> PlanDirections(const TablePca& pca, std::span<const BrdfSample> measured,
                                          const PlanOptions& options);

}  // namespace pbnbrdf

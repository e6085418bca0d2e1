// fit_problem.h: the description of a fit: network, terms, samples. With a material it is a
// complete problem: minimise over the network's weights
//
//   1/2 sum over terms t of weight_t * mean over samples of rho(|r_t|^2)  +  1/2 weight_e |r_e|^2,
//
// r_t the residuals of the log and chromaticity terms (eqs. 6, 7) at a sample, rho the robust loss,
// r_e those of the energy term (eq. 5) over all strata of incident directions. Loss::kAbsolute stands
// for the papers' own sum instead, which isn't one of squares:
//
//   sum over terms t of weight_t * mean over samples and channels of |r_t|  +  weight_e EAL,
//
// EAL the integral over incident directions of max(0, albedo - 1), the mean over channels. At its
// kinks, r = 0 and albedo = 1, the gradient takes the term's part for 0.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/network/network_shape.h"
#include "pbnbrdf/problem/sampling.h"

namespace ceres {
class LossFunction;
}

namespace pbnbrdf {

enum class Loss {
  kL2,
  kSoftL1,
  kHuber,
  kCauchy,
  kAbsolute,  // of first-order solvers only
};

inline constexpr NameTable<Loss, 5> kLosses = {{{"l2", Loss::kL2},
                                                {"soft_l1", Loss::kSoftL1},
                                                {"huber", Loss::kHuber},
                                                {"cauchy", Loss::kCauchy},
                                                {"absolute", Loss::kAbsolute}}};

// Of the network's passes; residuals, their derivatives and all long sums are always double.
enum class Precision { kSingle, kDouble };

inline constexpr NameTable<Precision, 2> kPrecisions = {
    {{"single", Precision::kSingle}, {"double", Precision::kDouble}}};

// Uniform random weights.
enum class Initialization {
  kGlorot,  // Glorot and Bengio 2010; the last layer's biases are the mean of log(1 + f)
  kNbrdf,   // NBRDF's: within +-0.05, biases 0; what Adam gets furthest from
};

inline constexpr NameTable<Initialization, 2> kInitializations = {
    {{"glorot", Initialization::kGlorot}, {"nbrdf", Initialization::kNbrdf}}};

struct FitProblem {
  // The network.
  Encoding encoding = Encoding::kMerl;
  std::vector<int> hidden = {21, 21};
  Activation activation = Activation::kTanh;
  Initialization initialization = Initialization::kGlorot;
  int channels = 3;  // or 1, of materials that have one only: its output is then r = g = b

  // The terms' weights, >= 0; 0: the term is absent. At least one > 0.
  double log_weight = 1.0;
  double chromaticity_weight = 0.0;
  double energy_weight = 1.0;

  Loss loss = Loss::kSoftL1;
  double loss_scale = 0.001;  // > 0, the residual at which rho turns from square to linear

  // The training samples. A fit starts on the first few of them and takes `growth` times as many
  // each time that the cost falls slowly, up to all.
  // `asked`, if not null, says where a scene asks for the material: all but a part of `asked_floor`
  // come from there.
  Sampling sampling = Sampling::kHighlight;
  std::shared_ptr<const AngleDistribution> asked;
  double asked_floor = 0.5;  // in [0, 1]
  std::size_t samples = 60000;
  std::size_t first_samples = 1000;
  double growth = 3.0;     // > 1
  std::uint64_t seed = 1;  // of the samples and of the initial weights

  // The energy term: strata of theta_i, and of phi_i for anisotropic encodings, equal in solid
  // angle; the nodes of the quadrature for each of them (brdf/albedo.h).
  int energy_strata = 16;
  int energy_azimuths = 8;
  int energy_theta = 64;
  int energy_phi = 48;
  bool energy_skip = true;  // to leave out strata far below 1 (energy_term.h)

  Precision precision = Precision::kSingle;

  SampleAngles Angles() const;
  NetworkShape Shape() const { return NetworkShape(encoding, hidden, activation, channels); }

  // Throws Error, naming the field, its value and what it must be.
  void Validate() const;
};

// rho, or null for l2, which Ceres takes for rho(s) = s, and for absolute, which has none.
std::unique_ptr<ceres::LossFunction> MakeLoss(Loss loss, double scale);

// Where a fit to `samples` starts: shape.num_weights() numbers.
std::vector<double> InitialWeights(const NetworkShape& shape, std::span<const BrdfSample> samples,
                                   std::uint64_t seed,
                                   Initialization initialization = Initialization::kGlorot);

}  // namespace pbnbrdf

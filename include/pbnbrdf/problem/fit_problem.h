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
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/network/network_shape.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {

// Uniform random weights.
enum class Initialization {
  kGlorot,  // Glorot and Bengio 2010; the last layer's biases are the mean of log(1 + f)
  kNbrdf,   // NBRDF's: within +-0.05, biases 0; Adam gets furthest from this start
};

inline constexpr NameTable<Initialization, 2> kInitializations = {
    {{"glorot", Initialization::kGlorot}, {"nbrdf", Initialization::kNbrdf}}};

struct NetworkOptions {
  std::optional<Encoding> encoding;  // none: what suits the material (EncodingFor)
  std::vector<int> hidden = {21, 21};
  Activation activation = Activation::kTanh;
  Initialization initialization = Initialization::kGlorot;
  int channels = 0;  // outputs: 3, 1, or 0: as many as the material has channels

  // Of a network that is there.
  static NetworkOptions Of(const NetworkShape& shape);

  // What is left open is taken as for an isotropic material of three channels.
  NetworkShape Shape() const;
};

enum class Loss {
  kL2,
  kSoftL1,
  kAbsolute,  // for first-order solvers only
};

inline constexpr NameTable<Loss, 3> kLosses = {
    {{"l2", Loss::kL2}, {"soft_l1", Loss::kSoftL1}, {"absolute", Loss::kAbsolute}}};

// A term by its name (terms.h), and its weight > 0.
struct WeightedTerm {
  std::string name;
  double weight = 1.0;
};

struct TermOptions {
  // Each name once; a term over samples must be among them.
  std::vector<WeightedTerm> weights = {{"log", 1.0}, {"energy", 1.0}};

  Loss loss = Loss::kSoftL1;
  double loss_scale = 0.001;  // > 0, the residual at which rho turns from square to linear

  // The energy term: strata of theta_i, and of phi_i for anisotropic encodings, equal in solid
  // angle; the nodes of the quadrature for each of them (brdf/albedo.h).
  int energy_strata = 16;
  int energy_azimuths = 8;
  int energy_theta = 64;
  int energy_phi = 48;
  bool energy_skip = true;  // to leave out strata far below 1 (energy_term.h)

  // 0 if the term is absent.
  double Weight(std::string_view name) const;
  double EnergyWeight() const { return Weight("energy"); }

  // Adds the term if it is absent; a weight of 0 removes it.
  void SetWeight(std::string_view name, double weight);
};

struct SamplingOptions {
  Sampling angles = Sampling::kHighlight;
  // If not null, where a scene asks for the material: all samples but a part of `asked_floor` come
  // from there.
  std::shared_ptr<const AngleDistribution> asked;
  double asked_floor = 0.5;       // in [0, 1]
  std::uint64_t samples = 60000;  // at most, for training
  std::uint64_t seed = 1;         // of the samples and of the initial weights

  SampleAngles Angles() const;
};

struct FitProblem {
  NetworkOptions network;
  TermOptions terms;
  SamplingOptions sampling;

  NetworkShape Shape() const { return network.Shape(); }

  // The same with what is left open settled: encoding and channels.
  FitProblem For(const Brdf& material) const;

  // Throws Error, naming the field, its value and what it must be.
  void Validate() const;
};

}  // namespace pbnbrdf

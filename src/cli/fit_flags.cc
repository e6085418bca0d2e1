#include "fit_flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <optional>

#include "base/text.h"

DEFINE_int32(threads, 0, "threads to use; 0: one for each core");
DEFINE_string(encoding, "auto",
              "the network's input: cartesian | reciprocal | multiscale | merl | bilateral | "
              "anisotropic; all but the first are exactly reciprocal; auto: merl for an isotropic "
              "material, anisotropic for another one");
DEFINE_string(hidden, "21,21", "units of each hidden layer");
DEFINE_string(activation, "tanh", "of the hidden units: tanh | relu");
DEFINE_string(initialization, "glorot",
              "initial weights: glorot, by layer | nbrdf, small, better with adam");
DEFINE_string(terms, "log,energy",
              "terms of the cost: log (eq. 6), chromaticity (eq. 7), energy (eq. 5)");
DEFINE_double(log_weight, 1.0, "weight of the log term");
DEFINE_double(chromaticity_weight, 0.1, "weight of the chromaticity term");
DEFINE_double(
    energy_weight, 1.0,
    "weight of the energy term, at most to begin with: it grows until energy is conserved");
DEFINE_bool(certify_energy, true,
            "end with no directional albedo above 1, lowering the whole network if need be");
DEFINE_int32(energy_strata, 16, "theta_i of the energy term, to begin with");
DEFINE_int32(energy_azimuths, 8, "phi_i with each, of anisotropic encodings");
DEFINE_int32(energy_theta, 64, "its quadrature's elevations of the half vector");
DEFINE_int32(energy_phi, 48, "its quadrature's azimuths of the half vector");
DEFINE_bool(energy_skip, true, "look only now and then at theta_i whose albedo is far below 1");
DEFINE_string(loss, "soft_l1",
              "robust loss of the log and chromaticity terms: "
              "l2 | soft_l1 | huber | cauchy | absolute, the papers' own sum of all "
              "terms, for lbfgs and, always, adam");
DEFINE_double(loss_scale, 0.001, "residual at which the loss turns from square to linear");
DEFINE_string(sampling, "highlight",
              "training angles: uniform, as NBRDF's | highlight, half of them near the mirror");
DEFINE_uint64(samples, 60000, "most training samples");
DEFINE_uint64(first_samples, 1000, "samples to start with; --samples or more: all at once");
DEFINE_double(growth, 3.0, "factor of samples each time that the cost falls slowly");
DEFINE_uint64(seed, 1, "of the samples and the initial weights");
DEFINE_string(precision, "single", "of the network's passes: single | double");
DEFINE_string(solver, "tiny_lm",
              "tiny_lm | lm, both Levenberg-Marquardt, lm Ceres' own | lbfgs, Ceres' | adam");
DEFINE_string(init, "", "start from this fitted network, of the same shape and encoding");
DEFINE_int32(starts, 1, "start from so many random weights and go on with the best");
DEFINE_uint64(curvature_samples, 4096,
              "tiny_lm: samples that J'J is summed over, others each time");
DEFINE_string(jacobian, "condensed", "condensed | autodiff, the slow reference, always with lm");
DEFINE_int32(max_iterations, 400, "stop a stage after so many iterations (adam: epochs)");
DEFINE_double(max_seconds, 3600.0, "stop after so many seconds");
DEFINE_uint64(batch, 512, "adam: samples a step");
DEFINE_double(learning_rate, 5e-4, "adam: step size");
DEFINE_int32(energy_angles, 2, "adam: random incident angles a step of the energy term");
DEFINE_double(function_tolerance, 1e-6, "stop when an iteration lowers the cost by a smaller part");

namespace pbnbrdf::cli {
namespace {

struct Terms {
  bool log = false, chromaticity = false, energy = false;
};

Terms ParseTerms(const std::string& text) {
  Terms terms;
  const NameTable<bool*, 3> kNames = {
      {{"log", &terms.log}, {"chromaticity", &terms.chromaticity}, {"energy", &terms.energy}}};
  for (const std::string& name : Split(text, ',')) *ParseName(kNames, "terms", name) = true;
  return terms;
}

std::vector<int> ParseHidden(const std::string& text) {
  std::vector<int> sizes;
  for (const std::string& part : Split(text, ',')) {
    sizes.push_back(static_cast<int>(std::clamp(ParseInteger("hidden", part), -1L, 1L << 30)));
  }
  return sizes;
}

// Of --encoding; none for auto.
std::optional<Encoding> ParseEncoding() {
  NameTable<std::optional<Encoding>, kEncodings.size() + 1> names = {{{"auto", std::nullopt}}};
  std::copy(kEncodings.begin(), kEncodings.end(), names.begin() + 1);
  return ParseName(names, "encoding", FLAGS_encoding);
}

FitProblem ParseProblem() {
  const Terms terms = ParseTerms(FLAGS_terms);
  FitProblem problem;
  problem.encoding = ParseEncoding().value_or(problem.encoding);
  problem.hidden = ParseHidden(FLAGS_hidden);
  problem.activation = ParseName(kActivations, "activation", FLAGS_activation);
  problem.initialization = ParseName(kInitializations, "initialization", FLAGS_initialization);
  problem.log_weight = terms.log ? FLAGS_log_weight : 0.0;
  problem.chromaticity_weight = terms.chromaticity ? FLAGS_chromaticity_weight : 0.0;
  problem.energy_weight = terms.energy ? FLAGS_energy_weight : 0.0;
  problem.energy_strata = FLAGS_energy_strata;
  problem.energy_azimuths = FLAGS_energy_azimuths;
  problem.energy_theta = FLAGS_energy_theta;
  problem.energy_phi = FLAGS_energy_phi;
  problem.energy_skip = FLAGS_energy_skip;
  problem.loss = ParseName(kLosses, "loss", FLAGS_loss);
  problem.loss_scale = FLAGS_loss_scale;
  problem.sampling = ParseName(kSamplings, "sampling", FLAGS_sampling);
  problem.samples = FLAGS_samples;
  problem.first_samples = FLAGS_first_samples;
  problem.growth = FLAGS_growth;
  problem.seed = FLAGS_seed;
  problem.precision = ParseName(kPrecisions, "precision", FLAGS_precision);
  return problem;
}

FitOptions ParseOptions() {
  FitOptions options;
  options.solver = ParseName(kSolvers, "solver", FLAGS_solver);
  options.jacobian = ParseName(kJacobianMethods, "jacobian", FLAGS_jacobian);
  options.starts = FLAGS_starts;
  options.curvature_samples = FLAGS_curvature_samples;
  options.max_iterations = FLAGS_max_iterations;
  options.max_seconds = FLAGS_max_seconds;
  options.function_tolerance = FLAGS_function_tolerance;
  options.adam.batch = FLAGS_batch;
  options.adam.learning_rate = FLAGS_learning_rate;
  options.adam.energy_angles = FLAGS_energy_angles;
  options.certify_energy = FLAGS_certify_energy;
  options.threads = FLAGS_threads;
  return options;
}

}  // namespace

std::vector<FlagGroup> ProblemFlags() {
  return {{"The network", {"encoding", "hidden", "activation", "initialization", "precision"}},
          {"The terms",
           {"terms", "log_weight", "chromaticity_weight", "energy_weight", "energy_strata",
            "energy_azimuths", "energy_theta", "energy_phi", "energy_skip", "certify_energy",
            "loss", "loss_scale"}},
          {"The samples", {"sampling", "samples", "first_samples", "growth", "seed"}},
          {"The solver",
           {"solver", "jacobian", "init", "starts", "curvature_samples", "max_iterations",
            "max_seconds", "function_tolerance", "batch", "learning_rate", "energy_angles"}}};
}

std::vector<std::string> ProblemFlagNames() {
  std::vector<std::string> names;
  for (const FlagGroup& group : ProblemFlags()) {
    names.insert(names.end(), group.names.begin(), group.names.end());
  }
  return names;
}

std::string ProblemFlagfile(std::vector<std::string> subject) {
  const std::vector<std::string> problem = ProblemFlagNames();
  subject.insert(subject.end(), problem.begin(), problem.end());
  std::string text;
  for (const std::string& line : FlagLines(subject)) text += line + "\n";
  return text;
}

FitFlags ParseFitFlags() {
  try {
    const FitFlags flags = {ParseProblem(), ParseOptions()};
    ValidateFit(flags.problem, flags.options);
    return flags;
  } catch (const Error& error) {
    throw UsageError(
        StrCat("--", error.what()));  // the message begins with the field, the flag's name
  }
}

void ResolveNetwork(const Brdf& material, FitProblem* problem) {
  problem->channels = material.NumChannels();
  problem->encoding = ParseEncoding().value_or(EncodingFor(material));
}

}  // namespace pbnbrdf::cli

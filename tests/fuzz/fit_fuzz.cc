// Random problems, options and measurements through a fit: it is refused, or each number of the result is finite and
// the network can be written and read.
#include <fuzzer/FuzzedDataProvider.h>

#include "fuzz_input.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf {
namespace {

constexpr const char* kSolvers[] = {"lm", "ceres_lm", "ceres_lbfgs", "adam", "autodiff"};
constexpr const char* kTerms[] = {"log", "chromaticity", "energy", "nonsense"};
constexpr std::size_t kMaxMeasurements = 40;

template <typename Enum, std::size_t N>
Enum AnyOf(const NameTable<Enum, N>& table, FuzzedDataProvider* from) {
  return table[from->ConsumeIntegralInRange<std::size_t>(0, N - 1)].second;
}

// Mostly of a common size, sometimes any double.
double Number(double most, FuzzedDataProvider* from) {
  if (from->ConsumeIntegralInRange(0, 7) == 0) return from->ConsumeFloatingPoint<double>();
  return most * from->ConsumeProbability<double>();
}

std::unique_ptr<Brdf> Material(FuzzedDataProvider* from) {
  if (from->ConsumeIntegralInRange(0, 3) == 0) {
    const auto& names = BuiltinMaterials();
    return MakeBuiltin(
        std::string(names[from->ConsumeIntegralInRange<std::size_t>(0, names.size() - 1)].name));
  }
  ScatteredData data;
  data.kind = "random";
  data.channels = from->ConsumeBool() ? 3 : 1;
  data.isotropic = from->ConsumeBool();
  const std::size_t count = from->ConsumeIntegralInRange<std::size_t>(0, kMaxMeasurements);
  for (std::size_t n = 0; n < count; ++n) {
    BrdfSample sample;
    sample.pair.wi = FromSpherical(Number(1.7, from), Number(6.3, from));
    sample.pair.wo = FromSpherical(Number(1.7, from), Number(6.3, from));
    const double gray = Number(2.0, from);
    sample.value = {gray, gray, gray};
    if (data.channels == 3) sample.value = {gray, Number(2.0, from), Number(100.0, from)};
    data.samples.push_back(sample);
  }
  return std::make_unique<ScatteredBrdf>(data);
}

FitProblem Problem(FuzzedDataProvider* from) {
  FitProblem problem;
  if (from->ConsumeBool()) problem.network.encoding = AnyOf(kEncodings, from);
  problem.network.hidden.assign(from->ConsumeIntegralInRange<std::size_t>(0, 3), 1);
  for (int& units : problem.network.hidden) units = from->ConsumeIntegralInRange(0, 6);
  problem.network.activation = AnyOf(kActivations, from);
  problem.network.initialization = AnyOf(kInitializations, from);
  problem.network.channels = from->ConsumeIntegralInRange(-1, 4);
  if (from->ConsumeBool()) {
    problem.terms.weights.clear();
    for (int k = from->ConsumeIntegralInRange(0, 3); k > 0; --k) {
      problem.terms.weights.push_back({from->PickValueInArray(kTerms), Number(2.0, from)});
    }
  }
  problem.terms.loss = AnyOf(kLosses, from);
  problem.terms.loss_scale = Number(0.01, from);
  problem.terms.energy_strata = from->ConsumeIntegralInRange(0, 4);
  problem.terms.energy_azimuths = from->ConsumeIntegralInRange(0, 2);
  problem.terms.energy_theta = from->ConsumeIntegralInRange(0, 8);
  problem.terms.energy_phi = from->ConsumeIntegralInRange(0, 8);
  problem.terms.energy_skip = from->ConsumeBool();
  problem.sampling.angles = AnyOf(kSamplings, from);
  problem.sampling.samples = from->ConsumeIntegralInRange<std::uint64_t>(0, 100);
  problem.sampling.seed = from->ConsumeIntegral<std::uint64_t>();
  return problem;
}

FitOptions Options(const FitProblem& problem, FuzzedDataProvider* from) {
  FitOptions options;
  options.solver = from->PickValueInArray(kSolvers);
  options.schedule.first_samples = from->ConsumeIntegralInRange<std::uint64_t>(0, 50);
  options.schedule.growth = Number(4.0, from);
  options.schedule.starts = from->ConsumeIntegralInRange(0, 2);
  options.schedule.curvature_samples = from->ConsumeIntegralInRange<std::uint64_t>(0, 50);
  options.schedule.max_iterations = from->ConsumeIntegralInRange(-1, 5);
  options.schedule.max_seconds = 2.0;
  options.schedule.error_tolerance = Number(1.0, from);
  options.schedule.function_tolerance = Number(0.1, from);
  options.adam.batch = from->ConsumeIntegralInRange<std::uint64_t>(0, 20);
  options.adam.learning_rate = Number(1.0, from);
  options.adam.energy_angles = from->ConsumeIntegralInRange(0, 3);
  options.acceleration = from->ConsumeBool();
  options.precision = AnyOf(kPrecisions, from);
  options.certify_energy = from->ConsumeBool();
  options.threads = 1;
  if (from->ConsumeIntegralInRange(0, 3) == 0 && problem.network.channels >= 0) {
    const std::size_t count = from->ConsumeIntegralInRange<std::size_t>(0, 200);
    for (std::size_t n = 0; n < count; ++n) options.initial_weights.push_back(Number(2.0, from));
  }
  return options;
}

void CheckFit(const Fit& fit) {
  const FitSummary& s = fit.summary;
  for (const double weight : fit.network.weights()) {
    Expect(std::isfinite(weight), "a weight is finite");
  }
  for (const double value : {s.final_cost, s.seconds, s.energy.first_max_albedo,
                             s.energy.max_albedo, s.energy.correction}) {
    Expect(std::isfinite(value), "the summary is finite");
  }
  for (const FitMoment& moment : s.history) {
    Expect(std::isfinite(moment.error), "the history is finite");
  }
  const std::string bytes = fit.network.Serialized();
  const FuzzFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  Expect(NeuralBrdf::Read(file.path()).Serialized() == bytes,
         "the network reads as it was written");
}

}  // namespace
}  // namespace pbnbrdf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider from(data, size);
  pbnbrdf::MayRefuse([&] {
    const auto material = pbnbrdf::Material(&from);
    const pbnbrdf::FitProblem problem = pbnbrdf::Problem(&from);
    const pbnbrdf::FitOptions options = pbnbrdf::Options(problem, &from);
    pbnbrdf::CheckFit(pbnbrdf::FitBrdf(*material, problem, options));
  });
  return 0;
}

#include "stability_run.h"

#include <cmath>
#include <limits>

#include "hard_pairs.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/sampling.h"
#include "problem/initial_weights.h"
#include "solve/solver.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kDistinctDuplicates = 10;
constexpr std::size_t kHeldOutSamples = 500, kCheckedSamples = 96;
constexpr int kCheckedDirections = 3;
constexpr std::uint64_t kCheckSeed = 0x2545f4914f6cdd1d;

// What a fit leaves, from FitBrdf or from a solver alone.
struct Result {
  std::vector<double> weights;
  FitSummary summary;
};

std::vector<BrdfSample> Draw(const Brdf& material, const StabilityCase& c, std::size_t count,
                             std::uint64_t more_seed = 0) {
  const SamplingOptions& sampling = c.problem.sampling;
  return DrawSamples(material, SampleSet::kTraining, sampling.angles, count,
                     sampling.seed + more_seed);
}

// Those that no material makes FitBrdf draw.
std::vector<BrdfSample> SpecialSamples(const Brdf& material, const StabilityCase& c) {
  if (c.stress == Stress::kDuplicates) {
    std::vector<BrdfSample> samples = Draw(material, c, kDistinctDuplicates);
    for (std::size_t n = 0; samples.size() < c.problem.sampling.samples; ++n)
      samples.push_back(samples[n]);
    return samples;
  }
  std::vector<BrdfSample> samples = Draw(material, c, c.problem.sampling.samples / 2);
  for (const DirectionPair& pair : CornerPairs()) {
    Rgb value;
    material.Evaluate({&pair, 1}, {&value, 1});
    samples.push_back({pair, value});
  }
  return samples;
}

bool HasSpecialSamples(const StabilityCase& c) {
  return c.stress == Stress::kDuplicates || c.stress == Stress::kCorners;
}

std::vector<double> RandomWeights(const StabilityCase& c, std::span<const BrdfSample> samples) {
  return InitialWeights(c.problem.Shape(), samples, c.problem.sampling.seed,
                        c.problem.network.initialization);
}

// Far below 0 at the units of a hidden layer: they stay off, or saturated.
constexpr double kDeadBias = -1000.0;

std::vector<double> StressedWeights(const Brdf& material, const StabilityCase& c) {
  const NetworkShape shape = c.problem.Shape();
  std::vector<double> weights = RandomWeights(c, Draw(material, c, 100));
  const auto scale = [&](double by) {
    for (double& w : weights) w *= by;
  };
  switch (c.stress) {
    case Stress::kLargeWeights:
      scale(100.0);
      return weights;
    case Stress::kHugeWeights:
      scale(1e20);
      return weights;
    case Stress::kTinyWeights:
      scale(1e-20);
      return weights;
    case Stress::kZeroWeights:
      scale(0.0);
      return weights;
    case Stress::kInfiniteWeight:
      weights[0] = std::numeric_limits<double>::infinity();
      return weights;
    case Stress::kDeadUnits:
      for (int layer = 0; layer + 1 < shape.num_layers(); ++layer) {
        const int columns = shape.in(layer) + 1;
        for (int o = 1; o <= shape.out(layer); ++o) {
          weights[shape.offset(layer) + o * columns - 1] = kDeadBias;
        }
      }
      return weights;
    default:
      return {};
  }
}

// The solver alone, on samples of the caller's.
Result Solve(const StabilityCase& c, std::span<const BrdfSample> samples, int max_iterations) {
  const EncodedSamples encoded(*c.problem.network.encoding, samples);
  const std::vector<EnergyStratum> strata = EqualStrata(c.problem);
  const auto objective = MakeObjective(c.problem, c.options.precision, encoded, encoded.size());
  StageOptions options;
  options.max_iterations = max_iterations;
  options.curvature_samples = c.options.schedule.curvature_samples;
  options.function_tolerance = c.options.schedule.function_tolerance;
  Result result;
  result.weights = RandomWeights(c, samples);
  const StageInput input = {c.problem, c.options, encoded, strata, objective.get()};
  const StageResult stage = FindSolver(c.options.solver).minimize(input, options, &result.weights);
  if (stage.termination == Termination::kDiverged && std::isinf(stage.cost)) {
    Fail(stage.message);  // as FitBrdf does
  }
  result.summary.final_cost = stage.cost;
  result.summary.iterations = stage.iterations;
  result.summary.failed_factorizations = stage.failed_factorizations;
  result.summary.rejected_steps = stage.rejected_steps;
  result.summary.termination = stage.termination;
  result.summary.message = stage.message;
  return result;
}

Result FitFor(const Brdf& material, const StabilityCase& c, int max_iterations) {
  if (HasSpecialSamples(c)) {
    const std::vector<BrdfSample> samples = SpecialSamples(material, c);
    return Solve(c, samples, max_iterations);
  }
  FitOptions options = c.options;
  options.schedule.max_iterations = max_iterations;
  options.initial_weights = StressedWeights(material, c);
  Fit fit = FitBrdf(material, c.problem, options);
  return {fit.network.weights(), fit.summary};
}

// Notes what isn't finite.
class FiniteCheck {
 public:
  explicit FiniteCheck(StabilityRecord* record) : record_(record) {}

  void Number(const char* what, double value) {
    if (!std::isfinite(value)) Note(what);
  }

  // A Brdf promises values from 0 to kLargestValue here.
  void Values(const char* what, std::span<const Rgb> values) {
    for (const Rgb& rgb : values) {
      for (double value : rgb) {
        if (!(value >= 0.0 && value <= Brdf::kLargestValue)) return Note(what);
      }
    }
  }

  void Note(const std::string& what) {
    record_->outcome = "non-finite";
    record_->non_finite += (record_->non_finite.empty() ? "" : " ") + what;
  }

 private:
  StabilityRecord* record_;
};

void EvaluateHardPairs(const char* what, const Brdf& brdf, FiniteCheck* check) {
  const std::vector<DirectionPair> pairs = HardPairs();
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  check->Values(what, values);
  brdf.EvaluateUnclipped(pairs, values);
  check->Values(what, values);
}

// The measures, of the fast network, as they take hundreds of thousands of values.
void Measure(const Brdf& material, const StabilityCase& c, const NeuralBrdf& network,
             StabilityRecord* record, FiniteCheck* check) {
  const std::unique_ptr<Brdf> single = network.SinglePrecision();
  const Brdf& fast = *single;
  EvaluateHardPairs("values", network, check);
  EvaluateHardPairs("fast_values", fast, check);
  const HeldOutErrors errors =
      MeasureErrors(HeldOutSamples(material, kHeldOutSamples, c.problem.sampling.seed), network);
  record->error = errors.mean_abs_log_error;
  check->Number("mean_abs_log_error", errors.mean_abs_log_error);
  check->Number("chromaticity_error", errors.chromaticity_error);
  check->Number("rmse", errors.rmse);
  const Reciprocity reciprocity = MeasureReciprocity(fast);
  check->Number("hrl", reciprocity.hrl);
  check->Number("hcl", reciprocity.hcl);
  const Energy energy = MeasureEnergy(fast);
  check->Number("max_directional_albedo", energy.max_directional_albedo);
  check->Number("eal", energy.eal);
}

// In double precision, at the start, on the way and at the end.
GradientCheck CheckGradients(const Brdf& material, const StabilityCase& c,
                             const std::vector<double>& last) {
  const std::vector<BrdfSample> samples = HasSpecialSamples(c)
                                              ? SpecialSamples(material, c)
                                              : Draw(material, c, kCheckedSamples, kCheckSeed);
  const auto objective = MakeObjective(c.problem, Precision::kDouble, samples);
  GradientCheck check;
  const auto check_at = [&](const std::vector<double>& weights) {
    check.Add(CheckGradient(objective.get(), c.problem.terms.loss_scale, weights,
                            kCheckedDirections, static_cast<unsigned>(c.problem.sampling.seed)));
  };
  for (int iterations : {0, c.options.schedule.max_iterations / 3}) {
    check_at(FitFor(material, c, iterations).weights);
  }
  check_at(last);
  return check;
}

}  // namespace

StabilityRecord RunStabilityCase(const StabilityCase& to_run) {
  StabilityRecord record;
  record.levels = to_run.levels;
  record.error = std::numeric_limits<double>::quiet_NaN();
  const std::unique_ptr<Brdf> material = MakeSweepMaterial(to_run.material);
  try {
    const Result result = FitFor(*material, to_run, to_run.options.schedule.max_iterations);
    record.message = result.summary.message;
    record.termination = NameOf(kTerminations, result.summary.termination);
    record.iterations = result.summary.iterations;
    record.restarts = result.summary.restarts;
    record.failed_factorizations = result.summary.failed_factorizations;
    record.rejected_steps = result.summary.rejected_steps;
    record.cost = result.summary.final_cost;
    FiniteCheck check(&record);
    check.Number("cost", record.cost);
    if (record.message.find("nan") != std::string::npos) check.Note("message");
    const NeuralBrdf network(to_run.problem.Shape(), result.weights);
    Measure(*material, to_run, network, &record, &check);
    record.gradient = CheckGradients(*material, to_run, result.weights);
  } catch (const Error& error) {
    record.outcome = "error";
    record.message = error.what();
  }
  return record;
}

}  // namespace pbnbrdf

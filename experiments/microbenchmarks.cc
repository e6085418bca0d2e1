// microbenchmarks.cc: the parts of a fit, timed one by one.
//
//   build/bin/microbenchmarks --benchmark_filter=Linearize
//
// items_per_second counts samples (network evaluations for BM_NeuralBrdf).
#include <benchmark/benchmark.h>
#include <ceres/problem.h>
#include <hwy/targets.h>
#include <tbb/task_arena.h>

#include "pbnbrdf/brdf/builtin.h"
#include "pbnbrdf/brdf/merl.h"
#include "pbnbrdf/kernels/kernels.h"
#include "pbnbrdf/network/fast_neural_brdf.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/ceres_problem.h"
#include "pbnbrdf/problem/condensed_cost_function.h"
#include "pbnbrdf/problem/jittered_cholesky.h"

namespace pbnbrdf {
namespace {

const Brdf& Gold() {
  static const std::unique_ptr<Brdf> gold = MakeBuiltin("satin-gold");
  return *gold;
}

std::vector<BrdfSample> Samples(std::size_t count) {
  return DrawSamples(Gold(), SampleSet::kTraining, Sampling::kHighlight, count, /*seed=*/1);
}

// A problem without its energy term, and weights to evaluate it at.
struct Fixture {
  explicit Fixture(std::size_t count, Precision precision = Precision::kSingle)
      : samples(Samples(count)) {
    problem.energy_weight = 0.0;
    problem.samples = count;
    problem.precision = precision;
    weights = InitialWeights(problem.Shape(), samples, /*seed=*/1);
  }
  FitProblem problem;
  std::vector<BrdfSample> samples;
  std::vector<double> weights;
};

void CountSamples(benchmark::State& state, std::size_t samples) {
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * samples));
}

// Args: samples, threads, 1 for double precision.
void BM_Linearize(benchmark::State& state) {
  Fixture fixture(state.range(0), state.range(2) ? Precision::kDouble : Precision::kSingle);
  const auto objective = MakeObjective(fixture.problem, fixture.samples);
  Linearization at;
  tbb::task_arena arena(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    arena.execute([&] { objective->Linearize(fixture.weights.data(), &at); });
    benchmark::DoNotOptimize(at.cost);
  }
  CountSamples(state, fixture.samples.size());
}
BENCHMARK(BM_Linearize)
    ->ArgNames({"samples", "threads", "double"})
    ->Args({2000, 1, 0})
    ->Args({20000, 1, 0})
    ->Args({20000, 2, 0})
    ->Args({20000, 1, 1})
    ->Args({20000, 2, 1})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void BM_Cost(benchmark::State& state) {
  Fixture fixture(20000);
  const auto objective = MakeObjective(fixture.problem, fixture.samples);
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    arena.execute([&] { benchmark::DoNotOptimize(objective->Cost(fixture.weights.data())); });
  }
  CountSamples(state, fixture.samples.size());
}
BENCHMARK(BM_Cost)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(
    benchmark::kMillisecond);

// The factor that the condensed block adds to each evaluation.
void BM_FactorWithJitter(benchmark::State& state) {
  Fixture fixture(20000);
  const auto objective = MakeObjective(fixture.problem, fixture.samples);
  Linearization at;
  objective->Linearize(fixture.weights.data(), &at);
  const int p = static_cast<int>(at.gradient.size());
  double jitter = 0.0;
  for (auto _ : state) {
    jitter = FactorWithJitter(at.hessian.data(), p, objective->HessianRounding()).jitter;
  }
  state.counters["jitter"] = jitter;
}
BENCHMARK(BM_FactorWithJitter)->Unit(benchmark::kMillisecond);

// One evaluation with all Jacobians as Ceres asks for it. Args: samples, 1 for the autodiff
// problem.
void BM_EvaluateJacobian(benchmark::State& state) {
  Fixture fixture(state.range(0));
  ceres::Problem problem;
  std::unique_ptr<Objective> objective;
  if (state.range(1)) {
    AddAutodiff(fixture.problem, fixture.samples, fixture.weights.data(), &problem);
  } else {
    objective = MakeObjective(fixture.problem, fixture.samples);
    AddCondensed(objective.get(), fixture.weights.data(), &problem);
  }
  std::vector<double> residuals, gradient;
  double cost = 0.0;
  for (auto _ : state) {
    problem.Evaluate({}, &cost, &residuals, &gradient, nullptr);
  }
  CountSamples(state, fixture.samples.size());
}
BENCHMARK(BM_EvaluateJacobian)
    ->ArgNames({"samples", "autodiff"})
    ->Args({1000, 1})
    ->Args({1000, 0})
    ->Args({20000, 0})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void EvaluateRepeatedly(const Brdf& brdf, benchmark::State& state) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& s : Samples(16384)) pairs.push_back(s.pair);
  std::vector<Rgb> values(pairs.size());
  for (auto _ : state) {
    brdf.Evaluate(pairs, values);
    benchmark::DoNotOptimize(values.data());
  }
  CountSamples(state, pairs.size());
}

void BM_NeuralBrdf(benchmark::State& state) {
  const Fixture fixture(1000);
  EvaluateRepeatedly(NeuralBrdf(fixture.problem.Shape(), fixture.weights), state);
}
BENCHMARK(BM_NeuralBrdf)->Unit(benchmark::kMillisecond);

// The same network in single precision. Arg: 1 for AVX2 even where there is AVX-512.
void BM_FastNeuralBrdf(benchmark::State& state) {
  const Fixture fixture(1000);
  const NeuralBrdf network(fixture.problem.Shape(), fixture.weights);
  if (state.range(0)) hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & ~(HWY_AVX2 - 1));
  state.SetLabel(kernels::InstructionSet());
  EvaluateRepeatedly(FastNeuralBrdf(network), state);
  hwy::SetSupportedTargetsForTest(0);
}
BENCHMARK(BM_FastNeuralBrdf)->ArgName("avx2")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void BM_MerlLookup(benchmark::State& state) {
  EvaluateRepeatedly(MerlBrdf::Tabulate(Gold()), state);
}
BENCHMARK(BM_MerlLookup)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pbnbrdf

BENCHMARK_MAIN();

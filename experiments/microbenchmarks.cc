// microbenchmarks.cc: the parts of a fit, timed one by one.
//
//   build/bin/microbenchmarks --benchmark_filter=Linearize
//
// items_per_second counts samples (direction pairs where nothing is fitted). The parts of a
// linearization report GFLOP/s and their share of the machine's own rate of matrix products.
#include <benchmark/benchmark.h>
#include <ceres/problem.h>
#include <hwy/targets.h>
#include <tbb/task_arena.h>

#include "flops.h"
#include "kernels/evaluation.h"
#include "kernels/kernels.h"
#include "matrix_product.h"
#include "network/batched_mlp.h"
#include "network/fast_neural_brdf.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/ceres_problem.h"
#include "pbnbrdf/sources/merl.h"
#include "problem/condensed_cost_function.h"
#include "problem/jittered_cholesky.h"
#include "problem/normal_equations.h"

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

// flops: of all iterations.
void CountFlops(benchmark::State& state, double flops) {
  const double rate = MatrixProductRate();
  state.counters["GFLOP/s"] = benchmark::Counter(1e-9 * flops, benchmark::Counter::kIsRate);
  state.counters["of_product"] =
      benchmark::Counter(1e-9 * flops / rate, benchmark::Counter::kIsRate);
}

void BM_MatrixProduct(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  for (auto _ : state) MultiplyMatrices(size);
  CountFlops(state, 2.0 * size * size * size * static_cast<double>(state.iterations()));
}
BENCHMARK(BM_MatrixProduct)->ArgName("size")->Arg(512)->Unit(benchmark::kMillisecond);

// A batch in single precision on its way through the network and back, for the log term's 3 rows.
struct Batch {
  static constexpr int kRows = 3;

  Batch()
      : mlp(shape, kRows),
        input(shape.in(0) * kernels::kBatch),
        residuals(kRows * kernels::kBatch, 0.1f) {
    const std::vector<double> initial = InitialWeights(shape, Samples(10), /*seed=*/1);
    weights.assign(initial.begin(), initial.end());
    for (std::size_t i = 0; i < input.size(); ++i) input[i] = 0.01f * static_cast<float>(i % 100);
    mlp.Forward(weights.data(), input.data());
    for (int row = 0; row < kRows; ++row) {
      std::fill_n(mlp.output_gradient(row), NetworkShape::kChannels * kernels::kBatch, 0.1f);
    }
    mlp.Backward(weights.data());
    mlp.TransposeInputs();
  }

  NetworkShape shape = FitProblem().Shape();
  BatchedMlp<float> mlp;
  AlignedVector<float> weights, input, residuals;
};

void BM_Forward(benchmark::State& state) {
  Batch batch;
  for (auto _ : state) {
    batch.mlp.Forward(batch.weights.data(), batch.input.data());
    benchmark::DoNotOptimize(batch.mlp.output());
  }
  CountSamples(state, kernels::kBatch);
}
BENCHMARK(BM_Forward);

void BM_Backward(benchmark::State& state) {
  Batch batch;
  for (auto _ : state) {
    batch.mlp.Backward(batch.weights.data());
    benchmark::DoNotOptimize(batch.mlp.delta(0));
  }
  CountSamples(state, kernels::kBatch);
}
BENCHMARK(BM_Backward);

// J'J and J'r of a batch.
void BM_NormalEquations(benchmark::State& state) {
  const Batch batch;
  NormalEquations<float> sums(batch.shape);
  for (auto _ : state) {
    sums.AddBatch(batch.mlp, batch.residuals.data());
    benchmark::ClobberMemory();
  }
  CountSamples(state, kernels::kBatch);
  CountFlops(state,
             HessianFlops(batch.shape) * kernels::kBatch * static_cast<double>(state.iterations()));
}
BENCHMARK(BM_NormalEquations)->Unit(benchmark::kMicrosecond);

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
    AddAutodiff(fixture.problem, fixture.samples, EqualStrata(fixture.problem),
                fixture.weights.data(), &problem);
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

std::vector<DirectionPair> Pairs(std::size_t count) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& s : Samples(count)) pairs.push_back(s.pair);
  return pairs;
}

void BM_Encode(benchmark::State& state) {
  const std::vector<DirectionPair> pairs = Pairs(kernels::kBatch);
  for (auto _ : state) {
    for (const DirectionPair& pair : pairs) {
      benchmark::DoNotOptimize(Encode(Encoding::kMultiscale, pair));
    }
  }
  CountSamples(state, pairs.size());
}
BENCHMARK(BM_Encode);

// In single precision, several pairs to an instruction.
void BM_EncodeBatch(benchmark::State& state) {
  const std::vector<DirectionPair> pairs = Pairs(kernels::kBatch);
  AlignedVector<float> inputs(kEncodedSize * kernels::kBatch);
  for (auto _ : state) {
    kernels::EncodeMultiscale(&pairs[0].wi.x, inputs.data());
    benchmark::DoNotOptimize(inputs.data());
    benchmark::ClobberMemory();
  }
  CountSamples(state, pairs.size());
}
BENCHMARK(BM_EncodeBatch);

void EvaluateRepeatedly(const Brdf& brdf, benchmark::State& state) {
  const std::vector<DirectionPair> pairs = Pairs(16384);
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

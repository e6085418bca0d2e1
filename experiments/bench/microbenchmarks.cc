// microbenchmarks.cc: the parts of a fit, timed one by one.
//
//   build/bin/microbenchmarks --benchmark_filter=Linearize
//
// items_per_second counts samples, or pairs of directions where nothing is fitted. What is mostly matrix
// products reports GFLOP/s and of_product, that rate over the rate of Eigen's products on one core.
#include <benchmark/benchmark.h>
#include <ceres/problem.h>
#include <hwy/targets.h>
#include <tbb/task_arena.h>

#include "flops.h"
#include "jacobian_methods.h"
#include "kernels/kernels.h"
#include "matrix_product.h"
#include "network/batched_mlp.h"
#include "network/evaluation.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/ceres_problem.h"
#include "pbnbrdf/residuals/log_residual.h"
#include "pbnbrdf/sources/merl.h"
#include "problem/initial_weights.h"
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
  explicit Fixture(std::size_t count, const std::vector<int>& hidden = {21, 21})
      : samples(Samples(count)) {
    problem.network.hidden = hidden;
    problem.terms.SetWeight("energy", 0.0);
    weights = InitialWeights(problem.Shape(), samples, /*seed=*/1);
  }

  std::unique_ptr<Objective> MakeObjective(Precision precision = Precision::kSingle) const {
    return pbnbrdf::MakeObjective(problem, precision, samples);
  }

  FitProblem problem;
  std::vector<BrdfSample> samples;
  std::vector<double> weights;
};

void CountSamples(benchmark::State& state, std::size_t samples) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
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

// J'J, J'r and the cost of all samples. Args: units of each of the two hidden layers, samples, threads, and
// 1 for double precision.
void BM_Linearize(benchmark::State& state) {
  const int width = static_cast<int>(state.range(0));
  const Fixture fixture(static_cast<std::size_t>(state.range(1)), {width, width});
  const auto objective =
      fixture.MakeObjective(state.range(3) ? Precision::kDouble : Precision::kSingle);
  Linearization at;
  tbb::task_arena arena(static_cast<int>(state.range(2)));
  for (auto _ : state) {
    arena.execute([&] { objective->Linearize(fixture.weights.data(), &at); });
    benchmark::DoNotOptimize(at.cost);
  }
  CountSamples(state, fixture.samples.size());
  const NetworkShape& shape = objective->shape();
  CountFlops(state, (HessianFlops(shape) + PassFlops(shape, LogResidual::kNumResiduals)) *
                        static_cast<double>(fixture.samples.size()) *
                        static_cast<double>(state.iterations()));
}
BENCHMARK(BM_Linearize)
    ->ArgNames({"hidden", "samples", "threads", "double"})
    ->Args({21, 2000, 1, 0})
    ->Args({21, 20000, 1, 0})
    ->Args({21, 20000, 2, 0})
    ->Args({21, 20000, 1, 1})
    ->Args({21, 20000, 2, 1})
    ->Args({21, 200000, 2, 0})
    ->Args({8, 20000, 1, 0})
    ->Args({8, 20000, 2, 0})
    ->Args({32, 20000, 1, 0})
    ->Args({32, 20000, 2, 0})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void BM_Cost(benchmark::State& state) {
  const Fixture fixture(20000);
  const auto objective = fixture.MakeObjective();
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    arena.execute([&] { benchmark::DoNotOptimize(objective->Cost(fixture.weights.data())); });
  }
  CountSamples(state, fixture.samples.size());
}
BENCHMARK(BM_Cost)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(
    benchmark::kMillisecond);

// J'J, J'r and the cost on one thread, in the ways of jacobian_methods.h.
void BM_JacobianMethod(benchmark::State& state, DerivativeMethod method) {
  const Fixture fixture(static_cast<std::size_t>(state.range(0)));
  const Evaluation evaluate = MakeEvaluation(method, fixture.problem, fixture.samples);
  Linearization at;
  tbb::task_arena one_thread(1);
  for (auto _ : state) {
    one_thread.execute([&] { evaluate(fixture.weights.data(), &at); });
  }
  CountSamples(state, fixture.samples.size());
}
BENCHMARK_CAPTURE(BM_JacobianMethod, autodiff, DerivativeMethod::kAutodiff)
    ->ArgName("samples")
    ->Arg(1000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_JacobianMethod, dense, DerivativeMethod::kDense)
    ->ArgName("samples")
    ->Arg(1000)
    ->Arg(10000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_JacobianMethod, condensed, DerivativeMethod::kCondensed)
    ->ArgName("samples")
    ->Arg(1000)
    ->Arg(10000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// The factor that the condensed block adds to each evaluation.
void BM_FactorWithJitter(benchmark::State& state) {
  const Fixture fixture(20000);
  const auto objective = fixture.MakeObjective();
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

// An evaluation of the condensed block with its Jacobian, as Ceres asks for it.
void BM_EvaluateCondensed(benchmark::State& state) {
  Fixture fixture(static_cast<std::size_t>(state.range(0)));
  const auto objective = fixture.MakeObjective();
  ceres::Problem problem;
  AddCondensed(objective.get(), fixture.weights.data(), &problem);
  std::vector<double> residuals, gradient;
  double cost = 0.0;
  for (auto _ : state) {
    problem.Evaluate({}, &cost, &residuals, &gradient, nullptr);
  }
  CountSamples(state, fixture.samples.size());
}
BENCHMARK(BM_EvaluateCondensed)
    ->ArgName("samples")
    ->Arg(1000)
    ->Arg(20000)
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
    EncodeBatch(Encoding::kMultiscale, pairs.data(), inputs.data());
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
  EvaluateRepeatedly(*network.SinglePrecision(), state);
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

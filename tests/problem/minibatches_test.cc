// Minibatches: every sample once an epoch, and quadratures that integrate.
#include "problem/minibatches.h"

#include <algorithm>
#include <set>

#include "pbnbrdf/models/builtin.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

constexpr int kBatch = kernels::kBatch;

FitProblem SmallProblem(std::size_t samples) {
  FitProblem problem;
  problem.sampling.samples = samples;
  problem.terms.SetWeight("energy", 0.0);
  return problem;
}

std::vector<BrdfSample> Samples(const FitProblem& problem) {
  return DrawSamples(*MakeBuiltin("satin-gold"), SampleSet::kTraining, problem.sampling.angles,
                     problem.sampling.samples, problem.sampling.seed);
}

EncodedSamples Encoded(const FitProblem& problem, const std::vector<BrdfSample>& samples) {
  return EncodedSamples(problem.Shape().encoding(), samples);
}

// The red values of all samples of an epoch, in order.
std::vector<float> RedOfEpoch(MinibatchStream* stream) {
  std::vector<float> red;
  Minibatches run;
  do {
    stream->Draw(&run);
    for (std::size_t b = 0; b < run.count; ++b) {
      for (std::size_t n = 0; n < run.batch; ++n) {
        const float* block = run.SampleBlock(b, n / kBatch);
        red.push_back(block[Minibatches::kValue * kBatch + n % kBatch]);
      }
    }
  } while (!run.ends_epoch);
  return red;
}

TEST(MinibatchStream, AnEpochHasEachSampleOnceInAnotherOrder) {
  const FitProblem problem = SmallProblem(70000);  // more than are drawn at once
  const std::vector<BrdfSample> samples = Samples(problem);
  MinibatchStream stream(problem, Encoded(problem, samples), /*batch=*/700, /*energy_angles=*/1);
  std::vector<float> first = RedOfEpoch(&stream), second = RedOfEpoch(&stream);
  EXPECT_NE(first, second);
  std::vector<float> all;
  for (const BrdfSample& s : samples) all.push_back(static_cast<float>(s.value[0]));
  for (auto* values : {&first, &second, &all}) std::sort(values->begin(), values->end());
  EXPECT_EQ(first, all);
  EXPECT_EQ(second, all);
}

TEST(MinibatchStream, LeavesOutTheRest) {
  const FitProblem problem = SmallProblem(1000);
  MinibatchStream stream(problem, Encoded(problem, Samples(problem)), /*batch=*/300,
                         /*energy_angles=*/1);
  EXPECT_EQ(RedOfEpoch(&stream).size(), 900u);
}

TEST(MinibatchStream, RowsAreThoseOfTheSamples) {
  const FitProblem problem = SmallProblem(1);
  const std::vector<BrdfSample> samples = Samples(problem);
  MinibatchStream stream(problem, Encoded(problem, samples), /*batch=*/1, /*energy_angles=*/1);
  Minibatches run;
  stream.Draw(&run);
  EXPECT_TRUE(run.ends_epoch);
  EXPECT_TRUE(run.AlbedosOf(0).empty());
  const float* block = run.SampleBlock(0, 0);
  const auto input = Encode(problem.Shape().encoding(), samples[0].pair);
  for (int i = 0; i < kEncodedSize; ++i) EXPECT_EQ(block[i * kBatch], float(input[i]));
  EXPECT_EQ(block[Minibatches::kCos * kBatch], float(CosI(samples[0].pair)));
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(block[(Minibatches::kValue + c) * kBatch], float(samples[0].value[c]));
  }
  for (int i = 0; i < Minibatches::kRows; ++i) EXPECT_EQ(block[i * kBatch + 1], 0.0f);
}

TEST(MinibatchStream, NodesIntegrateTheCosine) {
  // The albedo of f = 1/pi is 1 at every angle; near grazing the grid of half vectors is coarse.
  FitProblem problem = SmallProblem(10);
  problem.terms.SetWeight("energy", 1.0);
  problem.terms.energy_theta = 64;
  problem.terms.energy_phi = 32;
  MinibatchStream stream(problem, Encoded(problem, Samples(problem)), /*batch=*/2,
                         /*energy_angles=*/3);
  Minibatches run;
  stream.Draw(&run);
  ASSERT_EQ(run.count, 5u);
  std::set<const void*> sets;
  for (std::size_t b = 0; b < run.count; ++b) {
    const auto albedos = run.AlbedosOf(b);
    ASSERT_EQ(albedos.size(), 3u);
    sets.insert(albedos.data());
    for (const Minibatches::Albedo& albedo : albedos) {
      double sum = 0.0;
      for (std::size_t block = 0; block < albedo.blocks; ++block) {
        const float* nodes = run.NodeBlock(albedo.first_block + block);
        for (int n = 0; n < kBatch; ++n) sum += nodes[Minibatches::kWeight * kBatch + n] / kPi;
      }
      EXPECT_NEAR(sum, 1.0, 0.02);
    }
  }
  EXPECT_GT(sets.size(), 1u);
}

}  // namespace
}  // namespace pbnbrdf

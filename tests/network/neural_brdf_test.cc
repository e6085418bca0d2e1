#include "pbnbrdf/network/neural_brdf.h"

#include "brdf/direction_pairs.h"
#include "network/random_network.h"
#include "network/safetensors.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/importance_sampler.h"
#include "pbnbrdf/network/mlp.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

NeuralBrdf RandomNetwork(Encoding encoding, Activation activation = Activation::kTanh,
                         double scale = 1.0) {
  const NetworkShape shape(encoding, {21, 21}, activation);
  return NeuralBrdf(shape, RandomWeights(shape, scale, /*seed=*/1), {{"seed", "1"}});
}

TEST(NeuralBrdf, ReciprocityIsExactToTheBit) {
  const std::vector<DirectionPair> pairs = HardAndRandomPairs(100000, /*seed=*/2);
  std::vector<DirectionPair> swapped;
  for (const DirectionPair& pair : pairs) swapped.push_back(Swapped(pair));
  // Another order, so that a pair and its exchange meet in different lanes of different batches.
  std::reverse(swapped.begin(), swapped.end());
  for (const auto& [name, encoding] : kEncodings) {
    if (!IsReciprocal(encoding)) continue;
    for (Activation activation : {Activation::kTanh, Activation::kRelu}) {
      const NeuralBrdf network = RandomNetwork(encoding, activation);
      std::vector<Rgb> there(pairs.size()), back(pairs.size());
      network.EvaluateUnclipped(pairs, there);
      network.EvaluateUnclipped(swapped, back);
      for (std::size_t n = 0; n < pairs.size(); ++n)
        ASSERT_EQ(there[n], back[pairs.size() - 1 - n]);
    }
  }
}

TEST(NeuralBrdf, IsTheClampedScalarNetwork) {
  const NeuralBrdf network = RandomNetwork(Encoding::kCartesian);
  const std::vector<DirectionPair> pairs = RandomPairs(300, /*seed=*/3);
  std::vector<Rgb> values(pairs.size());
  network.Evaluate(pairs, values);
  const auto blocks = network.shape().Blocks<const double>(network.weights().data());
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    double z[3];
    EvaluateMlp(network.shape(), Encode(Encoding::kCartesian, pairs[n]).data(), blocks.data(), z);
    for (int c = 0; c < 3; ++c) {
      const double f = std::max(0.0, Reflectance(z[c]));
      EXPECT_NEAR(values[n][c], f, 1e-12 * (1.0 + f));
    }
  }
}

TEST(NeuralBrdf, NothingNonFiniteComesOutOfHugeWeights) {
  const NeuralBrdf network = RandomNetwork(Encoding::kMultiscale, Activation::kRelu, 1e150);
  const std::vector<DirectionPair> pairs = HardAndRandomPairs(1000, /*seed=*/4);
  std::vector<Rgb> values(pairs.size());
  network.Evaluate(pairs, values);
  for (const Rgb& value : values) {
    for (double f : value) EXPECT_TRUE(f >= 0.0 && f <= Brdf::kLargestValue);
  }
}

TEST(NeuralBrdf, FilesRoundTripToTheBit) {
  TemporaryFolder folder;
  const NeuralBrdf network = RandomNetwork(Encoding::kMultiscale);
  network.Write(folder / "n.safetensors");
  const NeuralBrdf read = NeuralBrdf::Read(folder / "n.safetensors");
  EXPECT_EQ(read.weights(), network.weights());
  EXPECT_EQ(read.metadata(), network.metadata());
  EXPECT_EQ(read.metadata().at("seed"), "1");
  EXPECT_EQ(read.shape().hidden(), network.shape().hidden());
  EXPECT_EQ(OpenBrdf(folder / "n.safetensors")->Description(), network.Description());
}

TEST(NeuralBrdf, IsAsIsotropicAsItsEncodingAlsoFromAFile) {
  TemporaryFolder folder;
  for (const auto& [name, encoding] : kEncodings) {
    const NeuralBrdf network = RandomNetwork(encoding);
    network.Write(folder / "n.safetensors");
    EXPECT_EQ(network.IsIsotropic(), name != "anisotropic");
    EXPECT_EQ(OpenBrdf(folder / "n.safetensors")->IsIsotropic(), network.IsIsotropic());
    // Turned about the normal, it keeps its values or it doesn't.
    double change = 0.0;
    for (const DirectionPair& pair : RandomPairs(100, /*seed=*/6)) {
      const std::array<DirectionPair, 2> both = {pair, Turned(pair, 1.0)};
      std::array<Rgb, 2> values;
      network.EvaluateUnclipped(both, values);
      change = std::max(change, std::abs(values[0][0] - values[1][0]) / (1.0 + values[0][0]));
    }
    EXPECT_EQ(change < 1e-9, network.IsIsotropic()) << name << ", " << change;
  }
}

TEST(NeuralBrdf, FilesThatAreNoNetworkAreNamed) {
  TemporaryFolder folder;
  const std::string path = folder / "n.safetensors";
  RandomNetwork(Encoding::kMultiscale).Write(path);
  const SafetensorsFile good = ReadSafetensors(path);
  const auto read = [&](auto change) {
    SafetensorsFile file = good;
    change(file);
    WriteFile(path, SafetensorsBytes(file));
    return ErrorOf([&] { NeuralBrdf::Read(path); });
  };
  EXPECT_EQ(read([](auto&) {}), "");
  EXPECT_THAT(read([](auto& f) { f.metadata.erase("encoding"); }),
              HasSubstr("n.safetensors: not a fitted network: __metadata__ lacks encoding"));
  EXPECT_THAT(
      read([](auto& f) { f.metadata["encoding"] = "polar"; }),
      HasSubstr(
          "encoding=polar is not one of cartesian | reciprocal | multiscale | elevations | merl"));
  EXPECT_THAT(read([](auto& f) { f.metadata["output"] = "exp"; }), HasSubstr("output=exp"));
  EXPECT_THAT(read([](auto& f) { f.tensors.erase("fc2.weight"); }), HasSubstr("5 tensors"));
  EXPECT_THAT(read([](auto& f) { f.tensors["fc2.weight"] = f.tensors["fc1.weight"]; }),
              HasSubstr("tensor fc2.weight has another shape than 21 x 21"));
  EXPECT_THAT(read([](auto& f) { f.tensors["x"] = f.tensors["fc1.bias"]; }),
              HasSubstr("7 tensors"));
}

TEST(NeuralBrdf, OneOutputIsAllThreeChannels) {
  TemporaryFolder folder;
  const NetworkShape shape(Encoding::kMerl, {21, 21}, Activation::kTanh, 1);
  EXPECT_EQ(shape.num_weights(), 147 + 462 + 22);
  const NeuralBrdf network(shape, RandomWeights(shape, 0.5, /*seed=*/3));
  EXPECT_EQ(network.NumChannels(), 1);
  EXPECT_THAT(network.Description(), HasSubstr("6-21-21-1 tanh"));
  network.Write(folder / "n.safetensors");
  const SafetensorsFile file = ReadSafetensors(folder / "n.safetensors");
  EXPECT_EQ(file.tensors.at("fc3.weight").shape, (std::vector<std::int64_t>{1, 21}));
  EXPECT_EQ(file.metadata.at("units"), "one channel, 1/sr, without the cosine");
  const NeuralBrdf read = NeuralBrdf::Read(folder / "n.safetensors");
  EXPECT_EQ(read.weights(), network.weights());
  EXPECT_EQ(read.NumChannels(), 1);
  const std::vector<DirectionPair> pairs = RandomPairs(300, /*seed=*/4);
  std::vector<Rgb> values(pairs.size());
  read.EvaluateUnclipped(pairs, values);
  double largest = 0.0;
  for (const Rgb& value : values) {
    EXPECT_EQ(value[1], value[0]);
    EXPECT_EQ(value[2], value[0]);
    largest = std::max(largest, value[0]);
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_THAT(ErrorOf([] { NetworkShape(Encoding::kMerl, {3}, Activation::kTanh, 2); }),
              HasSubstr("channels: 2 outputs; must be 1 or 3"));
}

TEST(NeuralBrdf, RefusesWeightsThatDontFit) {
  const NetworkShape shape(Encoding::kMultiscale, {21, 21}, Activation::kTanh);
  EXPECT_EQ(shape.num_weights(), 675);
  EXPECT_THAT(ErrorOf([&] { NeuralBrdf(shape, std::vector<double>(3)); }), HasSubstr("3 numbers"));
  EXPECT_THAT(ErrorOf([&] { NeuralBrdf(shape, std::vector<double>(675, std::nan(""))); }),
              HasSubstr("not finite"));
}

TEST(NeuralBrdf, AnImportanceSamplerEstimatesItsAlbedo) {
  constexpr std::size_t kCount = 20000;
  for (Encoding encoding : {Encoding::kMerl, Encoding::kAnisotropic}) {
    const NeuralBrdf network = RandomNetwork(encoding);
    const ImportanceSampler sampler(network);
    const Vec3 wi = FromSpherical(0.6, 1.0);
    const std::vector<double> random = RandomNumbers(2 * kCount, 0.0, 1.0, /*seed=*/5);
    std::vector<std::array<double, 2>> u(kCount);
    for (std::size_t n = 0; n < kCount; ++n) u[n] = {random[2 * n], random[2 * n + 1]};
    std::vector<Vec3> wo(kCount);
    std::vector<double> pdf(kCount);
    sampler.Sample(std::vector<Vec3>(kCount, wi), u, wo, pdf);
    std::vector<DirectionPair> pairs;
    for (const Vec3& w : wo) pairs.push_back({wi, w});
    std::vector<Rgb> values(kCount);
    network.Evaluate(pairs, values);
    Rgb albedo = {};
    for (std::size_t n = 0; n < kCount; ++n) {
      if (pdf[n] == 0.0) continue;
      for (int c = 0; c < 3; ++c) albedo[c] += values[n][c] * wo[n].z / pdf[n] / kCount;
    }
    const Rgb exact = DirectionalAlbedo(network, wi);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(albedo[c], exact[c], 0.03 * (exact[0] + exact[1] + exact[2]));
    EXPECT_GT(exact[0] + exact[1] + exact[2], 0.1);
  }
}

}  // namespace
}  // namespace pbnbrdf

// networks.h: networks of all kinds, and pairs of directions that single precision holds exactly.
#pragma once

#include <array>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "network/random_network.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

using FloatPair = std::array<float, 6>;  // wi, wo

inline DirectionPair ToPair(const FloatPair& p) { return {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}}; }
inline FloatPair Swapped(const FloatPair& p) { return {p[3], p[4], p[5], p[0], p[1], p[2]}; }

inline FloatPair ToFloats(const Vec3& wi, const Vec3& wo) {
  return {float(wi.x), float(wi.y), float(wi.z), float(wo.x), float(wo.y), float(wo.z)};
}

// Weights of the size that fits have; values from 0 to some tens of 1/sr, not all of them positive.
inline NeuralBrdf RandomNetwork(Encoding encoding, Activation activation, std::vector<int> hidden,
                                unsigned seed, int outputs = NetworkShape::kChannels) {
  const NetworkShape shape(encoding, std::move(hidden), activation, outputs);
  std::vector<double> weights = RandomWeights(shape, 0.6, seed);
  for (int c = 0; c < outputs; ++c) {
    weights[weights.size() - 1 - c * (shape.in(shape.num_layers() - 1) + 1)] += 0.6;
  }
  return NeuralBrdf(shape, weights);
}

// Each encoding with each activation, named "merl_tanh"; of one, two and three hidden layers, whose
// sizes aren't all multiples of anything. And one of a single channel.
inline std::vector<std::pair<std::string, NeuralBrdf>> NetworksOfAllKinds() {
  const std::vector<std::vector<int>> hidden = {{21, 21}, {5}, {9, 16, 6}};
  std::vector<std::pair<std::string, NeuralBrdf>> networks;
  for (const auto& [encoding_name, encoding] : kEncodings) {
    for (const auto& [activation_name, activation] : kActivations) {
      const auto n = static_cast<unsigned>(networks.size());
      networks.emplace_back(StrCat(encoding_name, "_", activation_name),
                            RandomNetwork(encoding, activation, hidden[n % 3], n));
    }
  }
  networks.emplace_back("one_channel",
                        RandomNetwork(Encoding::kMerl, Activation::kTanh, {7}, 1, /*outputs=*/1));
  return networks;
}

// Near the mirror direction down to 1e-7, retroreflection, the pole, grazing, the horizon and below
// it; then random ones.
inline std::vector<FloatPair> HardPairs() {
  std::vector<FloatPair> pairs = {{0, 0, 1, 0, 0, 1},
                                  {0.6f, 0, 0.8f, 0.6f, 0, 0.8f},
                                  {0.6f, 0, 0.8f, -0.6f, 0, 0.8f},
                                  {0, 0.6f, 0.8f, 0, -0.6f, 0.8f},
                                  {1, 0, 0, 0, 0, 1},
                                  {0, 0, 1, 0.6f, 0, -0.8f},
                                  {0, 0.6f, 0.8f, 0, 0, 1},
                                  {1e-30f, 0, 1, 0, 1e-25f, 1}};
  for (double off : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    for (double theta : {0.1, 0.9, 1.5}) {
      pairs.push_back(ToFloats(FromSpherical(theta, 0.4), FromSpherical(theta + off, 0.4 + kPi)));
      pairs.push_back(ToFloats(FromSpherical(theta, 2.0), FromSpherical(theta, 2.0 + kPi + off)));
      pairs.push_back(ToFloats(FromSpherical(theta, 0.0), FromSpherical(theta, off)));
    }
  }
  for (double z : {1e-2, 1e-4, 1e-6}) {
    pairs.push_back(ToFloats(FromSpherical(kPi / 2 - z, 0.0), FromSpherical(1.0, 2.0)));
    pairs.push_back(ToFloats(FromSpherical(kPi / 2 - z, 0.0), FromSpherical(kPi / 2 - z, 3.0)));
  }
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int n = 0; n < 4000; ++n) {
    const double theta_i = std::acos(uniform(random)), theta_o = std::acos(uniform(random));
    pairs.push_back(ToFloats(FromSpherical(theta_i, 2 * kPi * uniform(random)),
                             FromSpherical(theta_o, 2 * kPi * uniform(random))));
  }
  return pairs;
}

// f of the library at each pair, 0 below the horizon.
inline std::vector<Rgb> LibraryValues(const Brdf& brdf, const std::vector<FloatPair>& pairs) {
  std::vector<DirectionPair> directions;
  for (const FloatPair& pair : pairs) directions.push_back(ToPair(pair));
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(directions, values);
  return values;
}

// Whether exchanging wi and wo leaves the value as it is.
inline bool IsReciprocal(const NeuralBrdf& network) {
  return IsReciprocal(network.shape().encoding());
}

}  // namespace pbnbrdf

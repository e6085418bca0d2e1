#include "problem/minibatches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/pi.h"
#include "base/uniform.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kBlock = kernels::kBatch;
constexpr std::size_t kMaxDrawn = 1 << 15;  // drawn at once: they stay in the cache
constexpr int kEnergySets = 4;              // drawn with them

}  // namespace

MinibatchStream::MinibatchStream(const FitProblem& problem, const EncodedSamples& samples,
                                 std::size_t batch, int energy_angles)
    : problem_(problem),
      encoding_(samples.encoding()),
      batch_(batch),
      energy_angles_(energy_angles),
      random_(problem.sampling.seed),
      order_(samples.size()) {
  double total_weight = 0.0;
  for (const BrdfSample& sample : samples.samples()) total_weight += sample.weight;
  const double scale = static_cast<double>(samples.size()) / total_weight;
  rows_.reserve(samples.size() * Minibatches::kRows);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const double* input = samples.inputs().batch(n / kBlock) + n % kBlock;
    for (int i = 0; i < kEncodedSize; ++i) rows_.push_back(static_cast<float>(input[i * kBlock]));
    rows_.push_back(static_cast<float>(samples.cos_i(n)));
    for (double f : samples.samples()[n].value) rows_.push_back(static_cast<float>(f));
    rows_.push_back(static_cast<float>(scale * samples.weight(n)));
  }
  std::iota(order_.begin(), order_.end(), 0u);
}

void MinibatchStream::Draw(Minibatches* to) {
  const std::size_t per_epoch = order_.size() / batch_;
  to->batch = batch_;
  to->count = std::clamp<std::size_t>(kMaxDrawn / batch_, 1, per_epoch - next_);
  to->samples.resize(to->count * to->BlocksPerStep() * Minibatches::kRows * kBlock);
  float* block = to->samples.data();
  for (std::size_t b = 0; b < to->count; ++b, ++next_) {
    const std::span<const std::uint32_t> drawn = DrawIndices(next_ * batch_);
    for (std::size_t first = 0; first < batch_; first += kBlock) {
      CopyBlock(drawn.subspan(first, std::min(kBlock, batch_ - first)), block);
      block += Minibatches::kRows * kBlock;
    }
  }
  to->ends_epoch = next_ == per_epoch;
  if (to->ends_epoch) next_ = 0;
  to->nodes.clear();
  to->albedos.clear();
  if (problem_.terms.EnergyWeight() == 0.0) return;
  to->albedos_per_step = energy_angles_;
  for (int set = 0; set < kEnergySets; ++set) {
    for (int k = 0; k < energy_angles_; ++k) {
      // Uniform in cos theta_i, that is in solid angle, and stratified.
      DrawAlbedo((k + Uniform(random_)) / energy_angles_, to);
    }
  }
}

// Steps of the shuffle of Fisher and Yates: a minibatch of the samples that the epoch hasn't had
// yet. Below 2^32 of them; std::shuffle differs between libraries.
std::span<const std::uint32_t> MinibatchStream::DrawIndices(std::size_t first) {
  for (std::size_t place = first; place < first + batch_; ++place) {
    const std::size_t left = order_.size() - place;
    std::swap(order_[place], order_[place + ((random_() >> 32) * left >> 32)]);
    // It is too far away to be waited for.
    const float* row = rows_.data() + std::size_t{order_[place]} * Minibatches::kRows;
    __builtin_prefetch(row);
    __builtin_prefetch(row + Minibatches::kRows - 1);
  }
  return std::span(order_).subspan(first, batch_);
}

void MinibatchStream::CopyBlock(std::span<const std::uint32_t> indices, float* block) const {
  for (std::size_t n = 0; n < indices.size(); ++n) {
    const float* row = rows_.data() + std::size_t{indices[n]} * Minibatches::kRows;
    for (int i = 0; i < Minibatches::kRows; ++i) block[i * kBlock + n] = row[i];
  }
  for (int i = 0; i < Minibatches::kRows && indices.size() < kBlock; ++i) {
    std::fill(block + i * kBlock + indices.size(), block + (i + 1) * kBlock, 0.0f);
  }
}

// As brdf/albedo.h, but on a grid that is shifted as a whole by random parts of its cells, lest the
// network learn where the nodes are: half vectors at theta_h = (pi/2) t^2.
void MinibatchStream::DrawAlbedo(double cos_i, Minibatches* to) {
  const int n_theta = problem_.terms.energy_theta, n_phi = problem_.terms.energy_phi;
  const double phi_i = IsIsotropic(encoding_) ? 0.0 : 2.0 * kPi * Uniform(random_);
  const Vec3 wi = FromSpherical(std::acos(cos_i), phi_i);
  const double shift_t = Uniform(random_), shift_phi = Uniform(random_);
  const std::size_t first_block = to->nodes.size() / (Minibatches::kNodeRows * kBlock);
  std::size_t nodes = 0;
  for (int i = 0; i < n_theta; ++i) {
    const double t = (i + shift_t) / n_theta, theta_h = 0.5 * kPi * t * t;
    const double sin_h = std::sin(theta_h), cos_h = std::cos(theta_h);
    for (int j = 0; j < n_phi; ++j) {
      const double phi = 2.0 * kPi * (j + shift_phi) / n_phi;
      const Vec3 h = {sin_h * std::cos(phi), sin_h * std::sin(phi), cos_h};
      const double cos_d = Dot(wi, h);
      const Vec3 wo = 2.0 * cos_d * h - wi;
      if (!(wo.z > 0.0) || !(cos_d > 0.0)) continue;
      const std::size_t place = nodes++ % kBlock;
      if (place == 0) to->nodes.resize(to->nodes.size() + Minibatches::kNodeRows * kBlock, 0.0f);
      float* block = to->nodes.data() + to->nodes.size() - Minibatches::kNodeRows * kBlock;
      const auto input = Encode(encoding_, {wi, wo});
      for (int k = 0; k < kEncodedSize; ++k)
        block[k * kBlock + place] = static_cast<float>(input[k]);
      const double solid_angle_h = sin_h * kPi * t / n_theta * (2.0 * kPi / n_phi);
      block[Minibatches::kWeight * kBlock + place] =
          static_cast<float>(wo.z * 4.0 * cos_d * solid_angle_h);
    }
  }
  to->albedos.push_back({first_block, (nodes + kBlock - 1) / kBlock});
}

}  // namespace pbnbrdf

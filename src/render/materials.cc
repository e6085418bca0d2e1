#include "materials.h"

#include <cmath>

#include "base/parallel.h"
#include "base/timer.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/scaled.h"

namespace pbnbrdf {
namespace {

PreparedMaterial Prepare(const SceneMaterial& material, const MaterialOpener& open) try {
  auto [brdf, proposal] = open(material.source);
  double factor = 1.0;
  if (material.scale_to_albedo > 0.0) {
    factor = material.scale_to_albedo / LargestAlbedo(*brdf);
    if (!std::isfinite(factor)) Fail("can't be scaled to an albedo of ", material.scale_to_albedo);
  }
  if (auto single = brdf->SinglePrecision()) brdf = std::move(single);
  if (factor != 1.0) brdf = std::make_unique<ScaledBrdf>(std::move(brdf), factor);
  auto sampler = proposal ? std::make_unique<ImportanceSampler>(*proposal)
                          : std::make_unique<ImportanceSampler>(*brdf);
  return {std::move(brdf), std::move(sampler)};
} catch (const Error& error) {
  Fail("materials.", material.name, ": ", error.what());
}

}  // namespace

Materials::Materials(const Scene& scene, const MaterialOpener& open)
    : scene_(scene), open_(open), slots_(scene.materials.size()) {}

void Materials::OpenAll() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Open(i);
    ThrowIfFailed();
  }
}

const PreparedMaterial* Materials::Reach(std::size_t material) {
  Slot& slot = slots_[material];
  if (!slot.opened.load(std::memory_order_acquire)) Open(material);
  slot.reached.store(true, std::memory_order_relaxed);
  return slot.failure ? nullptr : &slot.material;
}

void Materials::Open(std::size_t material) {
  const std::lock_guard lock(mutex_);
  Slot& slot = slots_[material];
  if (slot.opened.load(std::memory_order_relaxed)) return;
  const ScopedTimer timer(&slot.seconds);
  try {
    // Isolated: while this thread waits for the opener's own tasks, it must not start another tile,
    // which may wait for the mutex.
    Isolated([&] { slot.material = Prepare(scene_.materials[material], open_); });
  } catch (...) {
    slot.failure = std::current_exception();
  }
  slot.opened.store(true, std::memory_order_release);
}

void Materials::ThrowIfFailed() const {
  for (const Slot& slot : slots_) {
    if (slot.opened && slot.failure) std::rethrow_exception(slot.failure);
  }
}

Work Materials::Count() const {
  std::vector<bool> referenced(slots_.size());
  for (const Shape& shape : scene_.shapes) referenced[std::size_t(shape.material)] = true;
  Work work;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const Slot& slot = slots_[i];
    work.needed += slot.reached;
    work.done += slot.opened;
    work.seconds += slot.seconds;
    if (slot.opened) continue;
    ++work.Skipped(referenced[i] ? SkipReason::kNotReached : SkipReason::kUnreferenced);
  }
  return work;
}

}  // namespace pbnbrdf

// materials.h: a scene's materials, opened when the first path gets there.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <vector>

#include "pbnbrdf/brdf/importance_sampler.h"
#include "pbnbrdf/render/render.h"

namespace pbnbrdf {

struct PreparedMaterial {
  std::unique_ptr<Brdf> brdf;
  std::unique_ptr<ImportanceSampler> sampler;
};

class Materials {
 public:
  // Both must outlive this.
  Materials(const Scene& scene, const MaterialOpener& open);

  // All of them, those that no shape has, too. Throws Error, as ThrowIfFailed.
  void OpenAll();

  // The material, opened if it isn't yet, which other threads that need it wait for; null if it
  // can't be, which ThrowIfFailed tells. May be called from several threads at once; openers run
  // one at a time.
  const PreparedMaterial* Reach(std::size_t material);

  bool IsReached(std::size_t material) const { return slots_[material].reached; }

  // Throws what opening did, of the failed materials the first. Paths that reach a failed material
  // are to end, so that all others are followed as ever and the same materials fail each time.
  void ThrowIfFailed() const;

  // Of what was opened, and what of it reached.
  Work Count() const;

 private:
  struct Slot {
    std::atomic<bool> opened = false, reached = false;
    PreparedMaterial material;
    std::exception_ptr failure;
    double seconds = 0.0;
  };

  void Open(std::size_t material);

  const Scene& scene_;
  const MaterialOpener& open_;
  std::mutex mutex_;
  std::vector<Slot> slots_;
};

}  // namespace pbnbrdf

// materials.h: a scene's materials, each opened when the first path hits it.
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

  // Opens all of them, with or without a shape. Throws Error as ThrowIfFailed does.
  void OpenAll();

  // The material that a path has hit, opened at the first call; null if that failed. May be called
  // from several threads: openers run one at a time, and threads that need the material wait.
  const PreparedMaterial* Reach(std::size_t material);

  bool IsReached(std::size_t material) const { return slots_[material].reached; }

  // Throws what opening threw, for the first material of the scene that failed. Paths that hit such
  // a material end there and the others go on, so that it is always the same one.
  void ThrowIfFailed() const;

  // Materials opened, and needed because a path has hit them.
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

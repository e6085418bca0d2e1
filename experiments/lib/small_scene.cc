#include "small_scene.h"

#include <algorithm>

#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf {

Scene ReadSmallScene(const std::string& path, const std::string& environment, int width) {
  Scene scene = ReadScene(path, {.environment = environment});
  scene.film = WithWidth(scene.film, width);
  scene.film.height = std::max(scene.film.height, kSsimWindow);
  return scene;
}

}  // namespace pbnbrdf

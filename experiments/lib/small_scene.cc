#include "small_scene.h"

#include <algorithm>
#include <cmath>

#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf {

Scene ReadSmallScene(const std::string& path, const std::string& environment, int width) {
  Scene scene = ReadScene(path, {.environment = environment});
  const double height = 1.0 * scene.film.height / scene.film.width * width;
  scene.film = {width, std::max(kSsimWindow, static_cast<int>(std::lround(height)))};
  return scene;
}

}  // namespace pbnbrdf

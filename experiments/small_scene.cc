#include "small_scene.h"

#include <algorithm>
#include <cmath>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf {

Scene ReadSmallScene(const std::string& path, const std::string& environment, int width) {
  if (width < kSsimWindow) Fail("film_width = ", width, "; must be >= ", kSsimWindow);
  Scene scene = ReadScene(path, {.environment = environment});
  const double height = double(scene.film.height) / scene.film.width * width;
  scene.film = {width, std::max(kSsimWindow, static_cast<int>(std::lround(height)))};
  return scene;
}

}  // namespace pbnbrdf

// Tiles that are marked as empty show nothing, in random scenes too.
#include "camera.h"

#include <random>

#include "random.h"
#include "render/render_test_util.h"

namespace pbnbrdf {
namespace {

std::size_t CountEmpty(const std::vector<Tile>& tiles) {
  return std::size_t(
      std::count_if(tiles.begin(), tiles.end(), [](const Tile& tile) { return tile.empty; }));
}

std::vector<Tile> TilesOf(const Scene& scene) {
  return TilesOf(scene, PinholeCamera(scene.camera, scene.film));
}

// Expects that rays through the empty tiles' pixels hit nothing. Returns the number of empty tiles.
std::size_t ExpectEmptyTilesAre(const Scene& scene) {
  const PinholeCamera camera(scene.camera, scene.film);
  const Geometry geometry(scene);
  const std::vector<Tile> tiles = TilesOf(scene, camera);
  Random random(1, 2, 3);
  for (const auto& [block, empty] : tiles) {
    if (!empty) continue;
    for (int i = 0; i < 2 * block.width * block.height; ++i) {
      const auto [u, v] = random.Pair();
      Hit hit;
      const bool met = geometry.Intersect(
          camera.RayThrough(block.x + u * block.width, block.y + v * block.height), &hit);
      EXPECT_FALSE(met) << "tile at " << block.x << ", " << block.y;
      if (met) return 0;
    }
  }
  return CountEmpty(tiles);
}

class Things {
 public:
  explicit Things(unsigned seed) : random_(seed) {}

  double Uniform(double least, double most) {
    return std::uniform_real_distribution(least, most)(random_);
  }
  Vec3 Point(double size) {
    const double x = Uniform(-size, size), y = Uniform(-size, size);
    return {x, y, Uniform(-size, size)};
  }

  Scene Next(const Vec3& from) {
    Scene scene;
    scene.camera = {from, from + Point(1.0), {0.1, 1.0, 0.2}, Uniform(0.5, 140.0)};
    scene.film = {100 + int(Uniform(0, 60)), 100 + int(Uniform(0, 60))};
    const Vec3 ahead = Normalized(scene.camera.target - from);
    const auto place = [&] {  // mostly in front
      return from + Uniform(-1.0, 8.0) * ahead + Point(2.0);
    };
    AddSphere(place(), Uniform(0.05, 0.8), "white:0.5", &scene);
    Affine& map = scene.shapes.back().sphere->to_world;
    map = Compose(map, Compose(Affine::Rotation(Point(1.0), Uniform(0.0, 180.0)),
                               Affine::Scaling({Uniform(0.05, 1.0), 1.0, Uniform(1.0, 3.0)})));
    AddRectangle(place(), Point(0.5), Point(0.5), "white:0.5", &scene);
    scene.rectangle_lights.push_back({place(), Point(0.3), Point(0.3), {1.0, 1.0, 1.0}});
    return scene;
  }

 private:
  std::mt19937 random_;
};

TEST(Tiles, EmptyOnesMeetNothing) {
  Things things(3);
  std::size_t empty = 0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    empty += ExpectEmptyTilesAre(things.Next(things.Point(2.0)));
  }
  EXPECT_GT(empty, 200u * 8u);  // of some 64 in each image
}

// There, single precision is coarse beside the size of the shapes.
TEST(Tiles, EmptyOnesMeetNothingFarFromTheOrigin) {
  Things things(4);
  std::size_t empty = 0;
  for (const double distance : {1e2, 1e4, 1e5, 1e6}) {
    SCOPED_TRACE(distance);
    for (int i = 0; i < 60; ++i) {
      empty += ExpectEmptyTilesAre(things.Next(distance * Normalized(things.Point(1.0))));
    }
  }
  EXPECT_GT(empty, 60u * 8u);
}

TEST(Tiles, ASphereLeavesTheCornersEmpty) {
  Scene scene = SceneFrom(2.2, 30.0, 512);  // as problems/scenes/sphere.json
  AddSphere({0.0, 0.0, 0.0}, 0.5, "white:0.5", &scene);
  const std::vector<Tile> tiles = TilesOf(scene);
  ASSERT_EQ(tiles.size(), 1024u);
  EXPECT_TRUE(tiles.front().empty);
  EXPECT_FALSE(tiles[16 * 32 + 16].empty);
  // The sphere covers pi (0.2334 / 0.2679)^2 / 4 = 0.6 of the image.
  EXPECT_GT(CountEmpty(tiles), 300u);
  EXPECT_LT(CountEmpty(tiles), 410u);
}

TEST(Tiles, WhatIsAroundOrBesideTheCameraIsEverywhere) {
  Scene around = SceneFrom(1.0, 60.0, 64);
  AddSphere({0.0, 0.0, 0.0}, 3.0, "white:0.5", &around);
  EXPECT_EQ(CountEmpty(TilesOf(around)), 0u);
  Scene beside = SceneFrom(1.0, 60.0, 64);  // a corner beside the camera
  AddRectangle({0.0, -1.0, 0.5}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.5}, "white:0.5", &beside);
  EXPECT_EQ(CountEmpty(TilesOf(beside)), 0u);
  Scene nothing = SceneFrom(1.0, 60.0, 64);
  EXPECT_EQ(CountEmpty(TilesOf(nothing)), 16u);
}

TEST(Tiles, CoverEachPixelOnce) {
  Scene scene = SceneFrom(1.0, 60.0, 1);
  scene.film = {37, 50};
  std::vector<int> covered(37 * 50);
  for (const Tile& tile : TilesOf(scene)) {
    for (const PixelBlock& block : Cut(tile.block, 4)) {
      for (int y = block.y; y < block.y + block.height; ++y) {
        for (int x = block.x; x < block.x + block.width; ++x) ++covered[std::size_t(y * 37 + x)];
      }
    }
  }
  EXPECT_THAT(covered, testing::Each(1));
}

}  // namespace
}  // namespace pbnbrdf

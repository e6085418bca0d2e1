// scattered.h: measurements at directions of any kind, in no grid.
//
// A fit takes the measurements themselves. In between, f is interpolated, for what needs it anywhere
// (tables, albedos): by modified Shepard weights [1] of the nearest ones, where near is meant in
//
//   isotropic:   (r, q, r q cos 2 phi_d, r q sin 2 phi_d),
//   anisotropic: (r cos phi_h, r sin phi_h, q cos 2 phi_t, q sin 2 phi_t),  phi_t = phi_d + phi_h,
//
// r = sqrt(2 theta_h / pi), q = 2 theta_d / pi. Both are continuous at theta_h = 0, and the same to the
// bit for wi and wo exchanged. An isotropic measurement also stands for its mirror image (phi_d to
// -phi_d) where nothing was measured within kMirrorGap of that.
//
// [1] R. Franke, G. Nielson. Smooth Interpolation of Large Sets of Scattered Data. International
//     Journal for Numerical Methods in Engineering 15(11), 1980.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

class PointTree;

struct ScatteredData {
  std::string kind;  // for the description: "ALTA file"
  int channels = 3;  // 1: a single one, given as r = g = b
  bool isotropic = true;
  std::vector<BrdfSample> samples;
  std::size_t left_out = 0;  // rows of the file that can't be used, or lack a value
};

// The coordinates above.
std::array<double, 4> ScatteredPlace(const DirectionPair& pair, bool isotropic);

// The same, where a pair and its mirror image of an isotropic material are at one place.
std::array<double, 4> MirroredPlace(const DirectionPair& pair, bool isotropic);

class ScatteredBrdf final : public Brdf {
 public:
  static constexpr double kMirrorGap = 0.05;

  // Leaves out samples with a direction that isn't above the horizon (a cosine of at most 1e-4), and those
  // that aren't usable (IsUsable); values are cut to kLargestValue. Throws Error if none is left.
  explicit ScatteredBrdf(ScatteredData data);

  // At a measurement it is that, or the mean of those at the same place.
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;

  // Above the horizon, with a measurement no farther than kReach in the coordinates above.
  bool IsKnown(const DirectionPair& pair) const override;
  static constexpr double kReach = 0.2;

  // 1 at a measurement, 1/2 at a quarter of kReach from the nearest one.
  double Certainty(const DirectionPair& pair) const override;

  // Those that at least kLeastAtAngle measurements have in common, within kSameIncidence (radians): rounding of
  // text.
  std::vector<double> IncidentAngles() const override;
  static constexpr double kSameIncidence = 1e-3;
  static constexpr std::size_t kLeastAtAngle = 10;

  // Measurements towards that angle stay: by reciprocity they say something of it.
  std::unique_ptr<Brdf> WithoutIncidentAngle(std::size_t index) const override;

  bool IsIsotropic() const override { return data_.isotropic; }
  bool HasOwnDirections() const override { return true; }
  bool IsReciprocal() const override { return true; }
  std::vector<BrdfSample> Measurements() const override { return data_.samples; }
  int NumChannels() const override { return data_.channels; }
  std::string Description() const override;

 private:
  double SquaredDistance(const DirectionPair& pair) const;  // to the nearest measurement

  ScatteredData data_;
  std::vector<std::size_t> samples_;  // of the tree's points: which sample each stands for
  std::shared_ptr<const PointTree> tree_;
};

}  // namespace pbnbrdf

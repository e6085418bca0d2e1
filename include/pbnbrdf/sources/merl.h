// merl.h: tables in the format of the MERL BRDF database [1].
//
// A file is three little-endian int32, 90 90 180, and the planes R, G, B of 90 x 90 x 180
// little-endian float64, index (i_h * 90 + i_d) * 180 + i_p. Stored values times 1/1500, 1.15/1500
// and 1.66/1500 are f in 1/sr. A bin is known by its lower corner,
//
//   theta_h = (pi/2) (i_h/90)^2,  theta_d = (pi/2) i_d/90,  phi_d = pi i_p/180,
//
// and phi_d and phi_d + pi are the same by reciprocity. A bin is invalid where all three channels hold the same negative
// number; other negative values are noise.
//
// Other numbers of bins, when the header says so, divide the same ranges. 360 of phi_d are the whole
// circle in steps of a degree: such a table says what f is at phi_d + pi, too.
//
// [1] W. Matusik, H. Pfister, M. Brand, L. McMillan. A Data-Driven Reflectance Model. ACM TOG 22,
//     2003.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// The numbers of bins of a table, each >= 1.
struct MerlGrid {
  int theta_h = 90, theta_d = 90, phi_d = 180;

  std::size_t bins() const { return std::size_t(theta_h) * theta_d * phi_d; }
  bool WholeCircle() const { return phi_d == 360; }  // else phi_d < pi
};

// A corner of the cell of a table that a pair lies in; the trilinear weights of all eight add up to 1.
struct TableCorner {
  std::size_t bin;
  double weight;
};

std::array<TableCorner, 8> CornersOf(const MerlGrid& grid, const DirectionPair& pair);

// f (1/sr) of a bin.
struct BinValue {
  std::size_t bin;
  Rgb value;
};

class MerlBrdf final : public Brdf {
 public:
  // Of the database's own tables, and those of Tabulate.
  static constexpr int kThetaH = 90, kThetaD = 90, kPhiD = 180;
  static constexpr std::size_t kBins = std::size_t{kThetaH} * kThetaD * kPhiD;

  // Throws Error if the file is missing, hasn't the length that its header asks for, or holds values
  // that aren't finite or no valid bin.
  static MerlBrdf Read(const std::string& path);

  // `source` at each bin's corner; invalid where it isn't known or a cosine is at most 1e-4. Throws
  // Error if it is anisotropic: a table has no phi_h.
  static MerlBrdf Tabulate(const Brdf& source);

  // A table of the database's own grid, whose other bins are invalid.
  static MerlBrdf FromValues(std::span<const BinValue> values);

  // The bins of that grid at whose corner both directions are above the horizon (cosines above 1e-4),
  // ascending, and such a corner.
  static std::vector<std::size_t> BinsAboveHorizon();
  static DirectionPair CornerPair(std::size_t bin);

  // The same bins with change(f) in the place of each f, 1/sr: the channels of a valid bin one after the
  // other, bin after bin. A negative result is noise.
  MerlBrdf Changed(const std::function<double(double f)>& change) const;

  std::string FileBytes() const;

  // Throws Error if the file can't be written.
  void Write(const std::string& path) const;

  // Trilinear between the corners of the bin. Invalid corners carry no weight (that of the others
  // is normalised); 0 where no corner is valid.
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;

  // Whether the pair's bin is valid.
  bool IsKnown(const DirectionPair& pair) const override;

  bool IsReciprocal() const override { return !grid_.WholeCircle(); }
  std::string Description() const override;

  const MerlGrid& grid() const { return grid_; }
  std::size_t valid_bins() const { return valid_bins_; }

  // The stored value of a bin: f / scale, negative if invalid. channel 0, 1, 2.
  double Stored(int channel, std::size_t bin) const {
    return planes_[channel * grid_.bins() + bin];
  }

 private:
  MerlBrdf(const MerlGrid& grid, std::vector<double> planes);

  bool IsValid(std::size_t bin) const;
  Rgb Interpolate(const DirectionPair& pair) const;

  MerlGrid grid_;
  std::vector<double> planes_;  // [channel][theta_h][theta_d][phi_d], as stored in the file
  std::size_t valid_bins_ = 0;
};

}  // namespace pbnbrdf

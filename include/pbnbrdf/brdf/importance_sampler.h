// importance_sampler.h: directions in proportion to what a Brdf reflects, for renderers.
//
//   const ImportanceSampler sampler(*brdf);            // once for a material
//   sampler.Sample(wi, u, wo, pdf);                    // a batch of directions
//   brdf->Evaluate(pairs_of_wi_and_wo, f);             // weight: f wo.z / pdf, 0 where pdf is 0
//
// The density is a mixture of a cosine and of tables of the half vector h = (wi + wo) / |wi + wo|,
//
//   p(wo | wi) = w cos_o / pi + (1 - w) q(h) / (4 wi.h)
//
// in 1/sr, tabulated for some wi and interpolated linearly between them. q is constant in cells: rings of equal
// size in
//
//   u = log(1 + (1 - cos_h) / b) / log(1 + 1 / b),
//
// of which lobes of any width fill many if b is about as wide, and sectors in phi_h. p is 0 where either
// direction isn't above the horizon. Cells are drawn by the alias method [1].
//
// [1] M. D. Vose. A Linear Algorithm for Generating Random Numbers with a Given Distribution. IEEE Transactions on
//     Software Engineering 17(9), 1991.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// The tables of a density. Incident directions number `azimuth * cosines + cosine` and have
// cos_i = (cosine + 1) / cosines, phi_i = pi (azimuth + 1/2) / azimuths.
//
// One azimuth: the density is isotropic, and phi_h is the angle to the plane of incidence, from 0 to pi, the same on
// both sides. Several: phi_h is that of the material, from 0 to 2 pi, and turning both directions by pi changes nothing.
struct Proposal {
  int cosines = 1, azimuths = 1, rings = 1, sectors = 2;
  double spread = 0.25;                  // b
  std::vector<float> cosine_share = {};  // w of each incident direction, in [0, 1]
  std::vector<float> cells = {};         // probabilities of its cells, ring by ring; their sum is 1

  bool IsIsotropic() const { return azimuths == 1; }
  int NumIncident() const { return cosines * azimuths; }
  int NumCells() const { return rings * sectors; }
};

// The proposal whose cells have the shares of the cells in f cos_o, R + G + B, less what the cosine draws from them.
// Takes 25,000 values of an isotropic Brdf, 220,000 of others. Throws Error if a value isn't finite.
Proposal FitProposal(const Brdf& brdf);

class ImportanceSampler {
 public:
  // Fits a proposal to the Brdf, which needn't outlive this.
  explicit ImportanceSampler(const Brdf& brdf) : ImportanceSampler(FitProposal(brdf)) {}
  // Throws Error if a number is out of its range.
  explicit ImportanceSampler(Proposal proposal);

  // For each wi, of unit length, and two uniform numbers in [0, 1) a direction wo and its density. pdf is 0, and
  // wo of no use, where wi isn't above the horizon, or the facet drawn reflects to below it. As f is
  // reciprocal, the given direction may as well be the viewer's. Sizes must agree. The members may be called
  // from several threads at once.
  void Sample(std::span<const Vec3> wi, std::span<const std::array<double, 2>> u,
              std::span<Vec3> wo, std::span<double> pdf) const;

  // pdf[n]: the density with which Sample chooses pairs[n].wo, given pairs[n].wi.
  void Pdf(std::span<const DirectionPair> pairs, std::span<double> pdf) const;

  const Proposal& proposal() const { return proposal_; }

 private:
  // Of a cell that is drawn with all cells alike: it stays with this probability, else it is the other one.
  struct Alias {
    double share = 1.0;
    int other = 0;
  };

  static void FillAliases(std::span<const float> cells, std::span<Alias> aliases);
  Vec3 Draw(const Vec3& wi, std::array<double, 2> u) const;
  double Density(const DirectionPair& pair) const;

  Proposal proposal_;
  std::vector<Alias> aliases_;  // of the cells of each incident direction
};

}  // namespace pbnbrdf

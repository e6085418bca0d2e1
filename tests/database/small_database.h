// small_database.h: a database of a few formulas, quickly made.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/database/database_material.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "test_util.h"

namespace pbnbrdf {

// Paints over a diffuse ground, from rough to glossy, in several colours.
inline std::shared_ptr<const Brdf> Paint(double roughness, double red, double blue) {
  return std::make_shared<AnalyticBrdf>(AnalyticBrdf::FromText(
      StrCat("ward_bounded:rho_d=", red, "/0.2/", blue, ",rho_s=0.08,alpha=", roughness)));
}

inline std::vector<DatabaseMaterial> Paints() {
  std::vector<DatabaseMaterial> paints;
  for (const double roughness : {0.15, 0.25, 0.35, 0.5}) {
    for (const double red : {0.1, 0.3, 0.5}) {
      for (const double blue : {0.1, 0.4}) {
        paints.push_back({StrCat("paint-", paints.size()), Paint(roughness, red, blue)});
      }
    }
  }
  return paints;
}

inline FitProblem SmallProblem(FitProblem problem) {
  problem.network.hidden = {8};
  problem.network.encoding = Encoding::kReciprocal;
  problem.sampling.samples = 400;
  return problem;
}

}  // namespace pbnbrdf

// fit_material.h: what `fit` does with one material, within --max_seconds.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "base/timer.h"
#include "fit_record.h"
#include "material_options.h"
#include "pbnbrdf/solve/problem_file.h"

namespace pbnbrdf::cli {

struct FitRequest {
  MaterialOptions material;
  std::string init;   // a network to start from, or ""
  std::string prior;  // what a database has in common (sources/collection_file.h), or ""
  FitSetup setup;
};

// What is fitted; with the fields of the setup that is all that it takes to repeat the fit.
Fields SubjectFields(FitRequest* request);

struct FittedMaterial {
  Fit fit;
  Json measures;
  FitSubject subject;
};

// Opens, fits and measures; --max_seconds is for all of it. on_iteration as FitOptions has it; FitProgress has
// the held-out error if reports_heldout_error. Throws Error, which names the material.
class MaterialFitter {
 public:
  // The time begins now.
  explicit MaterialFitter(const FitRequest& request);

  const Brdf& material() const { return *material_; }

  FittedMaterial Run(bool reports_heldout_error,
                     const std::function<bool(const FitProgress&)>& on_iteration) const;

 private:
  const FitRequest& request_;
  const Timer timer_;
  const std::unique_ptr<Brdf> material_;
  FitProblem problem_;
  FitOptions options_;  // with where the fit starts
};

}  // namespace pbnbrdf::cli

// analytic.h: analytic reflectance models by name and parameters: a diffuse part, and lobes.
//
// All are reciprocal and non-negative. A text names a model with its parameters, colours as R/G/B or one
// number for all three:
//
//   ggx:f0=1/0.78/0.34,alpha=0.2,rho_d=0.05
//   ward:rho_d=0.3,rho_s=0.1,alpha_x=0.05,alpha_y=0.15
//   phong:rho_s=0.2,n=50,rho_s_2=0.1,n_2=1000        a second lobe's parameters end with _2
//
// Parameters that aren't given have their initial value (model_parameter.h).
//
// [1] M. Ashikhmin, P. Shirley. An Anisotropic Phong BRDF Model. J. Graphics Tools 5(2), 2000.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/brdf/lobe_widths.h"
#include "pbnbrdf/models/model_parameter.h"

namespace pbnbrdf {

inline constexpr int kMaxLobes = 2;

struct AnalyticModel {
  std::string_view name, paper;
  std::span<const ModelParameter> base, lobe;  // lobe is empty: the model has none
  // f of `lobes` lobes at a pair above the horizon; parameters: as AnalyticBrdf has them.
  Rgb (*evaluate)(const ReflectionGeometry& geometry, const double* parameters, int lobes);

  int BaseSize() const;  // scalars of the base, and of a lobe
  int LobeSize() const;
};

std::span<const AnalyticModel> AnalyticModels();

// Throws Error, naming the known ones and the nearest of them, if there is none of that name.
const AnalyticModel& FindAnalyticModel(std::string_view name);

// Whether the text is that of an analytic model, "NAME:..." or one that only misspells the name.
bool NamesAnalyticModel(const std::string& text);

class AnalyticBrdf : public PointwiseBrdf {
 public:
  // Parameters by name, of size 1 or 3.
  using Values = std::map<std::string, std::vector<double>>;
  // What a file says about a fit beyond its parameters: "material", "errors", ..., as JSON texts.
  using Metadata = std::map<std::string, std::string>;

  // parameters: the scalars of the base and of each lobe, one after the other. lobes: 1 to
  // kMaxLobes, 0 if the model has none. Throws Error if their number is another or one isn't
  // within its bounds.
  AnalyticBrdf(const AnalyticModel& model, int lobes, std::vector<double> parameters);

  // Throws Error: what is unknown and the nearest that is known, or out of bounds.
  static AnalyticBrdf FromValues(const std::string& model, const Values& values);
  static AnalyticBrdf FromText(const std::string& text);

  // A JSON file with "model", "parameters" and whatever else. Throws Error, naming the file.
  static AnalyticBrdf Read(const std::string& path);

  // The text of a JSON object with "model" and "parameters".
  std::string Json() const;

  bool IsIsotropic() const override;
  bool IsReciprocal() const override { return true; }
  std::string Description() const override;

  // Every parameter with its value; FromValues and FromText make the same Brdf of them.
  std::vector<std::pair<std::string, std::vector<double>>> NamedValues() const;
  std::string Text() const;

  const AnalyticModel& model() const { return *model_; }
  int lobes() const { return lobes_; }
  const std::vector<double>& parameters() const { return parameters_; }
  const Metadata& metadata() const { return metadata_; }
  void set_metadata(Metadata metadata) { metadata_ = std::move(metadata); }

 protected:
  Rgb Value(const DirectionPair& pair) const override;

 private:
  const AnalyticModel* model_;
  int lobes_;
  std::vector<double> parameters_;
  Metadata metadata_;
};

// Models with one lobe or none, as types.

struct LambertBrdf final : AnalyticBrdf {
  explicit LambertBrdf(const Rgb& rho);
};

struct OrenNayarBrdf final : AnalyticBrdf {
  OrenNayarBrdf(const Rgb& rho, double sigma);
};

// ward_bounded. alpha: root mean square slopes along x and y.
struct WardBrdf final : AnalyticBrdf {
  WardBrdf(const Rgb& rho_d, const Rgb& rho_s, LobeWidths alpha);
};

// GGX over the diffuse base of [1], which receives what the facets don't reflect.
class GgxBrdf final : public PointwiseBrdf {
 public:
  // alpha: widths of the distribution of facet normals. rho_d = 0 for metals.
  GgxBrdf(const Rgb& f0, LobeWidths alpha, const Rgb& rho_d = {})
      : f0_(f0), alpha_(alpha), rho_d_(rho_d) {}
  bool IsIsotropic() const override { return alpha_.AreEqual(); }
  std::string Description() const override;

 protected:
  Rgb Value(const DirectionPair& pair) const override;

 private:
  Rgb f0_;
  LobeWidths alpha_;
  Rgb rho_d_;
};

// A parameter of a model of so many lobes, where it stands among the scalars.
struct PlacedParameter {
  const ModelParameter* parameter;
  int lobe;           // 0: the base or the first lobe, 1: the second one
  std::size_t first;  // of parameter->size scalars

  std::string Name() const;  // "alpha_x", "alpha_x_2"
};

// In the order of the scalars.
std::vector<PlacedParameter> PlacedParameters(const AnalyticModel& model, int lobes);

}  // namespace pbnbrdf

#include "measure/measures.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "base/text.h"
#include "base/timer.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/metrics/coverage.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// For the albedos of a material. Nearer to the horizon than 85 degrees measurements have no data, and models are
// wrong. What is interpolated has kinks, of which many digits take minutes; three are enough.
constexpr AlbedoGrid kMaterialGrid = {
    .angles = 30, .last_angle = 85.0 * kDegree, .tolerance = 1e-3, .refinements = 2};
constexpr std::size_t kTrialSamples = 500;  // to see how long one takes
constexpr double kAlbedoValues = 1e5;       // about what the albedos of a material take
constexpr double kMinSamples = 5000.0;
// How often the material and the fit are evaluated for each held-out sample, and the part of the time for that.
constexpr double kEvaluations = 3.0, kErrorsPart = 0.4;
constexpr double kAlbedoPart = 0.25;  // of the time, for the albedos of the material
// Of the angles that the check of a network's energy has, a few tell the time that it takes.
constexpr int kTrialAngles = 10, kTrials = 4;
constexpr double kChecksPerAngle = 1.7;  // with refinements and reciprocity

constexpr double kExplainsNothing = 0.8;  // HeldOutErrors::relative_error
// Largest values (1/sr) beyond which the unit is in doubt: dark materials, too, reflect more than the one at some
// pair of directions, and only mirrors more than the other.
constexpr double kMinLargest = 1e-3, kMaxLargest = 1e4;

constexpr MeasureMeaning kMeanings[] = {
    {"mean_abs_log_error", "mean |log1p(f cos) - log1p(f^ cos)| (eq. 6)"},
    {"relative_error", "mean |f cos - f^ cos| / mean |f cos|"},
    {"error_at_measured",
     "mean_abs_log_error at measured directions, where others are interpolated between them"},
    {"reciprocal_floor",
     "least mean_abs_log_error of any reciprocal fit: half the material's own difference"},
    {"measured_part", "of all pairs of directions: where the material is known, or nearly"},
    {"measured_in_plane", "whether only one plane through the normal was measured"},
    {"measured_negative", "part of the measured values with a channel below 0"},
    {"measured_noise", "1/sr, at most: by how much neighbouring values differ, in the median"},
    {"rmse", "root mean square error of f cos, 1/sr"},
    {"hrl", "Helmholtz reciprocity loss (eq. 8)"},
    {"hcl", "Helmholtz continuity loss (eq. 9)"},
    {"max_directional_albedo", "over all incident directions; above 1 the fit creates energy"},
    {"energy", "certified if max_directional_albedo is at most 1 + 1e-6"},
    {"eal", "energy amplification loss (eq. 5), sr"},
    {"material_max_directional_albedo", "of the material itself, up to 85 degrees"},
    {"material_energy", "above 1, no fit that conserves energy can equal the material"},
    {"chromaticity_error", "mean |log1p(|f cos|^2) - log1p(|f^ cos|^2)| (eq. 7)"},
    {"delta_e_mean", "mean CIE Delta E 2000 of the lit colour, pi f cos cut to [0, 1]"},
    {"delta_e_p95", "its 95th percentile; about 1 is just visible"},
    {"dark_hue_chroma_mean", "sqrt(da^2 + db^2) in CIELAB where the lit luminance is at most 0.1"},
    {"dark_hue_chroma_p95", "its 95th percentile"},
    {"parameters", "numbers that the fit stores"},
    {"samples", "number of held-out samples"},
    {"dark_samples", "number of those with a lit luminance of at most 0.1"},
    {"cut_short", "whether there was time for fewer samples, or not for the material's energy"}};

// "certified", or by how much and where a directional albedo exceeds 1.
std::string EnergyVerdict(const Energy& energy) {
  if (energy.Conserved()) return "certified";
  constexpr const char* kChannels[] = {"red", "green", "blue"};
  std::ostringstream text;
  text << std::setprecision(4) << "albedo 1 + " << energy.max_directional_albedo - 1.0 << " at "
       << energy.theta_i / kDegree << " degrees, " << kChannels[energy.channel];
  return text.str();
}

// What there is time for.
struct Allowance {
  std::size_t samples;
  bool material_albedo;
};

// What a value takes: seconds.
double SecondsOfValue(const Brdf& brdf) {
  std::vector<DirectionPair> pairs;
  for (std::size_t n = 0; n < kTrialSamples; ++n) {
    const double part = (static_cast<double>(n) + 0.5) / kTrialSamples;
    pairs.push_back(
        {FromSpherical(1.5 * part, 0.0), FromSpherical(1.5 * (1.0 - part), 40.0 * part)});
  }
  std::vector<Rgb> values(pairs.size());
  const Timer timer;
  brdf.EvaluateUnclipped(pairs, values);
  return timer.Seconds() / kTrialSamples;
}

Allowance AllowanceFor(const Brdf& material, const Brdf& fit, const MeasureOptions& options) {
  if (std::isinf(options.seconds)) return {options.samples, true};
  const double of_material = SecondsOfValue(material);
  const double of_sample = kEvaluations * (of_material + SecondsOfValue(fit));
  const double affordable = std::max(kErrorsPart * options.seconds / of_sample, kMinSamples);
  return {static_cast<std::size_t>(std::min(affordable, static_cast<double>(options.samples))),
          kAlbedoValues * of_material < kAlbedoPart * options.seconds};
}

}  // namespace

std::vector<std::string> Cautions(const Coverage& coverage) {
  std::vector<std::string> cautions;
  if (coverage.in_plane) {
    cautions.emplace_back(
        "only a plane was measured: what lies beside it is a guess, by a model fitted to the "
        "plane");
  }
  const double largest = coverage.largest;
  if (largest > 0.0 && (largest < kMinLargest || largest > kMaxLargest)) {
    cautions.push_back(
        StrCat("the largest value within 60 degrees of the normal is ", largest,
               " 1/sr, where a white diffuse surface has 0.32: if the unit is another one, "
               "--scale_to_albedo=A makes A the largest directional albedo"));
  }
  return cautions;
}

double SecondsOfChecks(const NetworkShape& shape) {
  const NeuralBrdf network(shape, std::vector<double>(shape.num_weights()));
  AlbedoGrid grid;
  const double trials = static_cast<double>(grid.angles) / kTrialAngles;
  grid.angles = kTrialAngles;
  grid.refinements = 0;
  // Other work on the machine counts for nothing.
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kTrials; ++k) {
    const Timer timer;
    AlbedoProfile(network, grid);
    least = std::min(least, timer.Seconds());
  }
  return kChecksPerAngle * trials * least;
}

Json MeasureFit(const Brdf& material, const Brdf& fit, std::size_t parameters,
                const MeasureOptions& options) {
  const Allowance allowance = AllowanceFor(material, fit, options);
  const std::vector<BrdfSample> heldout = HeldOutSamples(material, allowance.samples, options.seed);
  const HeldOutErrors errors = MeasureErrors(heldout, fit);
  const ColorErrors colors = MeasureColorErrors(heldout, fit);
  const Reciprocity reciprocity = MeasureReciprocity(fit);
  const Energy energy = options.profile.empty() ? MeasureEnergy(fit) : EnergyOf(options.profile);
  Energy of_material;
  if (allowance.material_albedo) {
    of_material = MeasureEnergy(material, kMaterialGrid);
  }
  const auto at_measured = MovedToMeasured(material, heldout);
  const Coverage coverage = MeasureCoverage(material);
  std::vector<std::string> cautions = Cautions(coverage);
  if (!fit.IsReciprocal()) {
    cautions.push_back(
        "the fit is not reciprocal: pictures depend on which end of a light path is called wi");
  }
  const std::size_t measurements = material.Measurements().size();
  if (measurements > 0 && !HoldsOut(measurements)) {
    cautions.push_back(StrCat("of ", measurements,
                              " measurements none is held out: a fit to them has seen what its "
                              "errors are measured at"));
  }
  if (errors.relative_error > kExplainsNothing) {
    cautions.push_back(StrCat("the fit explains nothing: values are wrong by ",
                              std::lround(100.0 * errors.relative_error), " % in the mean"));
  }
  return {{"mean_abs_log_error", errors.mean_abs_log_error},
          {"relative_error", errors.relative_error},
          {"error_at_measured", MeasureErrors(at_measured, fit).mean_abs_log_error},
          {"reciprocal_floor", ReciprocalFloor(heldout, material)},
          {"measured_part", coverage.known},
          {"measured_in_plane", coverage.in_plane},
          {"measured_negative", coverage.negative},
          {"measured_noise", coverage.noise},
          {"rmse", errors.rmse},
          {"hrl", reciprocity.hrl},
          {"hcl", reciprocity.hcl},
          {"max_directional_albedo", energy.max_directional_albedo},
          {"energy", EnergyVerdict(energy)},
          {"eal", energy.eal},
          {"material_max_directional_albedo",
           allowance.material_albedo ? Json(of_material.max_directional_albedo) : Json()},
          {"material_energy",
           allowance.material_albedo ? EnergyVerdict(of_material) : "not measured: no time left"},
          {"chromaticity_error", errors.chromaticity_error},
          {"delta_e_mean", colors.delta_e_mean},
          {"delta_e_p95", colors.delta_e_p95},
          {"dark_hue_chroma_mean", colors.dark_hue_chroma_mean},
          {"dark_hue_chroma_p95", colors.dark_hue_chroma_p95},
          {"parameters", parameters},
          {"samples", errors.samples},
          {"dark_samples", colors.dark_samples},
          {"cut_short", allowance.samples < options.samples || !allowance.material_albedo},
          {"cautions", cautions}};
}

std::span<const MeasureMeaning> MeasureMeanings() { return kMeanings; }

std::string MeasuresText(const Json& measures) {
  std::ostringstream text;
  for (const auto& [key, meaning] : kMeanings) {
    const auto& value = measures.at(key);
    text << std::left << std::setw(33) << key << std::setw(13);
    if (value.is_number_float()) {
      text << std::setprecision(5) << value.get<double>();
    } else if (value.is_string()) {
      text << value.get<std::string>() + "  ";
    } else {
      text << JsonLine(value);
    }
    text << meaning << "\n";
  }
  for (const auto& caution : measures.at("cautions")) text << caution.get<std::string>() << "\n";
  return text.str();
}

}  // namespace pbnbrdf

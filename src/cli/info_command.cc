// pbnbrdf info
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>

#include "command_line.h"
#include "material_options.h"
#include "measure/measures.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/metrics/coverage.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kSamples = 50000;  // for the material's own differences

void ListBuiltins() {
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    std::cout << "builtin:" << material.name << "\n    " << material.make()->Description()
              << "\n    " << material.source << "\n";
  }
}

std::string ShownBounds(const ModelParameter& parameter) {
  return StrCat(parameter.lower, " to ", parameter.upper, ", default ", parameter.initial);
}

void ListParameters(std::span<const ModelParameter> table) {
  for (const ModelParameter& parameter : table) {
    std::cout << "    " << std::left << std::setw(16) << parameter.name << parameter.meaning
              << (parameter.size == 3 ? "; R/G/B" : "") << "; " << ShownBounds(parameter) << "\n";
    if (!parameter.pair_name.empty()) {
      std::cout << "    " << std::left << std::setw(16) << parameter.pair_name
                << "sets both of the above\n";
    }
  }
}

void ListModels() {
  std::cout
      << "An analytic model is written as its name, a colon and its parameters, such as\n"
         "ggx:f0=1/0.78/0.34,alpha=0.2,rho_d=0.05. A colour is R/G/B or one number. For a second "
         "lobe,\nadd _2 to the names of its parameters.\n";
  for (const AnalyticModel& model : AnalyticModels()) {
    std::cout << model.name << ": (" << model.paper << ")\n";
    ListParameters(model.base);
    ListParameters(model.lobe);
  }
}

// Indents the further lines of a text.
std::string Indented(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; ++at) {
    text.replace(at, 1, "\n    ");
  }
  return text;
}

void PrintMetadata(const std::map<std::string, std::string>& metadata) {
  for (const auto& [key, value] : metadata) {
    std::cout << "  " << key << ": " << Indented(value) << "\n";
  }
}

// Of a material that needn't be reciprocal.
void PrintReciprocity(const Brdf& material) {
  const auto [hrl, hcl] = MeasureReciprocity(material);
  const std::vector<BrdfSample> samples = HeldOutSamples(material, kSamples, 1);
  std::cout << (hcl > 0.0 ? "  not reciprocal" : "  reciprocal") << ": Helmholtz reciprocity loss "
            << hrl << " (eq. 8), continuity loss " << hcl
            << " (eq. 9)\n  least mean absolute log error of a reciprocal fit: "
            << ReciprocalFloor(samples, material)
            << ", half the mean |log1p(f(wi, wo) cos_i) - log1p(f(wo, wi) cos_i)|\n";
}

// What to beware of. Of measurements, which are lists of them, and tables that aren't known everywhere or have noise
// that shows, also how much they cover.
void PrintCoverage(const Brdf& material) {
  const Coverage coverage = MeasureCoverage(material);
  const bool is_list = !material.Measurements().empty();
  for (const std::string& caution : Cautions(coverage)) std::cout << "  " << caution << "\n";
  if (!is_list && coverage.known == 1.0 && coverage.negative == 0.0) return;
  std::cout << "  " << (is_list ? "measured near " : "known at ")
            << std::lround(100.0 * coverage.known)
            << " % of all pairs of directions\n  below 0: " << 100.0 * coverage.negative
            << " % of the values; noise: at most " << coverage.noise
            << " 1/sr, as far as neighbouring values differ\n";
}

int RunInfo(const Arguments& arguments) {
  const std::string& source = arguments[0];
  if (source == "builtin:") {
    ListBuiltins();
    return 0;
  }
  if (source == "models:") {
    ListModels();
    return 0;
  }
  const std::unique_ptr<Brdf> brdf = OpenBrdf(source);
  std::cout << source << ": " << brdf->Description() << "\n";
  PrintCoverage(*brdf);
  if (!brdf->IsReciprocal()) PrintReciprocity(*brdf);
  if (const auto* network = dynamic_cast<const NeuralBrdf*>(brdf.get())) {
    PrintMetadata(network->metadata());
  }
  if (const auto* model = dynamic_cast<const AnalyticBrdf*>(brdf.get())) {
    PrintMetadata(model->metadata());
  }
  return 0;
}

}  // namespace

Command InfoCommand() {
  return Command{.name = "info",
                 .summary = "describes a source of reflectance",
                 .usage = R"(  pbnbrdf info gold.safetensors
  pbnbrdf info builtin:          lists the materials that come with the program
  pbnbrdf info models:           lists the analytic models and their parameters
)",
                 .notes = kSourceNotes,
                 .arguments = {"a file or another source"},
                 .run = RunInfo};
}

}  // namespace pbnbrdf::cli

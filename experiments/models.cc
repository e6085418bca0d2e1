// models.cc: analytic models beside networks: error and size, the comparison of Ngan et al. 2005.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>

#include "base/text.h"
#include "comparison.h"
#include "default_materials.h"
#include "experiment.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/models/fit_analytic.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"

DEFINE_string(materials, "",
              "in place of the default ones, separated by commas: sources, CLASS= in front of them "
              "if wanted; sgd:NAME is a material of --sgd");
DEFINE_string(sgd, "", "CSV of SGD parameters; '': the default materials are the built-in ones");
DEFINE_string(models,
              "lambert,oren_nayar,phong,blinn_phong,lafortune,ward,ward_duer,ward_bounded,"
              "cook_torrance,ggx,abc,disney",
              "analytic models");
DEFINE_string(lobes, "1,2", "lobes of those that have any");
DEFINE_string(hidden, "3,3 21,21", "hidden layers of the networks, '' for none");
DEFINE_string(sampling, "uniform",
              "training angles of the models: uniform, as those that errors are measured on | "
              "highlight, as the networks have them");
DEFINE_uint64(samples, 6000, "training samples of the models");
DEFINE_int32(starts, pbnbrdf::AnalyticFitOptions{}.starts, "of the models");
DEFINE_uint64(network_samples, pbnbrdf::FitProblem{}.samples, "most samples of the networks");
DEFINE_int32(network_iterations, pbnbrdf::FitOptions{}.max_iterations, "of the networks, at most");
DEFINE_double(max_seconds, 60.0, "of each network");
DEFINE_uint64(seed, 1, "of the fits");
DEFINE_int32(threads, 0, "of each fit; 0: one for each core");
DEFINE_uint64(heldout_samples, 200000, "held-out samples of a fit's errors");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(models: analytic models fitted to materials, beside networks.

  models --out_dir=results --sgd=parameters.csv
  models --out_dir=results --materials=builtin:satin-gold,metal=gold.binary --models=ggx,ward

The arguments are further materials. Each fit is a row of models.csv as soon as it is done; the
tables, in models.md, are the best of each material and each method over each kind of source.
The built-in materials are analytic themselves (Lambert, Oren-Nayar, ward_bounded, ggx).
)";

// One fit of a method to a material.
struct ModelRecord {
  std::string material, kind, method;
  bool is_network = false;
  std::size_t parameters = 0;
  int iterations = 0;
  double seconds = 0.0;
  HeldOutErrors errors;
  double delta_e = 0.0;
};

// What a fit gave: the numbers that it stores, and what they say.
struct MethodResult {
  std::unique_ptr<Brdf> brdf;
  std::size_t parameters;
  int iterations;
  double seconds;
};

struct Method {
  std::string name;
  bool is_network;
  std::function<MethodResult(const Brdf&)> fit;
};

MethodResult FitModel(const Brdf& material, const AnalyticModel& model,
                      const AnalyticFitOptions& options) {
  const std::vector<BrdfSample> samples =
      DrawSamples(material, SampleSet::kTraining, ParseName(kSamplings, "sampling", FLAGS_sampling),
                  FLAGS_samples, FLAGS_seed);
  const AnalyticFit fit = FitAnalytic(samples, material.IsIsotropic(), model, options);
  return {std::make_unique<AnalyticBrdf>(fit.brdf), fit.brdf.parameters().size(),
          fit.summary.iterations, fit.summary.seconds};
}

MethodResult FitNetwork(const Brdf& material, FitProblem problem, const FitOptions& options) {
  problem.encoding = EncodingFor(material);
  const Fit fit = FitBrdf(material, problem, options);
  return {std::make_unique<NeuralBrdf>(fit.network), fit.network.weights().size(),
          fit.summary.iterations, fit.summary.seconds};
}

void AddModels(std::vector<Method>* methods) {
  const std::vector<std::size_t> lobes = ParseCounts("lobes", FLAGS_lobes);
  for (const std::string& name : Split(FLAGS_models, ',')) {
    const AnalyticModel& model = FindAnalyticModel(name);
    for (std::size_t n : lobes) {
      AnalyticFitOptions options;
      options.lobes = static_cast<int>(n);
      options.starts = FLAGS_starts;
      options.threads = FLAGS_threads;
      options.Validate();
      const bool has_lobes = !model.lobe.empty();
      methods->push_back(
          {has_lobes ? StrCat(name, ", ", n, n == 1 ? " lobe" : " lobes") : name, false,
           [&model, options](const Brdf& material) { return FitModel(material, model, options); }});
      if (!has_lobes) break;
    }
  }
}

void AddNetworks(std::vector<Method>* methods) {
  if (FLAGS_hidden.empty()) return;
  for (const std::vector<int>& hidden : ParseNetworks("hidden", FLAGS_hidden)) {
    FitProblem problem;
    problem.hidden = hidden;
    problem.samples = FLAGS_network_samples;
    problem.seed = FLAGS_seed;
    FitOptions options;
    options.max_iterations = FLAGS_network_iterations;
    options.max_seconds = FLAGS_max_seconds;
    options.threads = FLAGS_threads;
    ValidateFit(problem, options);
    methods->push_back(
        {StrCat("network ", HiddenName(hidden)), true, [problem, options](const Brdf& material) {
           return FitNetwork(material, problem, options);
         }});
  }
}

std::vector<MaterialSource> Materials(const std::vector<std::string>& arguments) {
  std::vector<std::string> texts;
  if (!FLAGS_materials.empty()) {
    texts = Split(FLAGS_materials, ',');
  } else {
    for (const BuiltinMaterial& material : BuiltinMaterials()) {
      texts.push_back(StrCat("builtin:", material.name));
    }
    const std::vector<std::string> sgd =
        FLAGS_sgd.empty() ? std::vector<std::string>{} : SgdTexts();
    texts.insert(texts.end(), sgd.begin(), sgd.end());
  }
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  for (std::string& text : texts) text = WithSgdPath(text, FLAGS_sgd);
  return ParseMaterials(texts);
}

// "builtin", "sgd", "file"
std::string KindOf(const MaterialSource& material) {
  const std::size_t colon = material.source.find(':');
  return colon == std::string::npos ? "file" : material.source.substr(0, colon);
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// The record of least error among the analytic models, or the networks; null if there is none.
const ModelRecord* Best(const std::vector<const ModelRecord*>& records, bool networks) {
  const ModelRecord* best = nullptr;
  for (const ModelRecord* record : records) {
    if (record->is_network != networks) continue;
    const double error = record->errors.mean_abs_log_error;
    if (!best || error < best->errors.mean_abs_log_error) best = record;
  }
  return best;
}

// Rounding isn't an error.
std::string Shown(double value, int digits) {
  return value < 1e-9 ? "0" : Significant(value, digits);
}

std::string ErrorOf(const ModelRecord* record) {
  return record ? Shown(record->errors.mean_abs_log_error, 3) : "-";
}

// A row for each material: the best model and the best network.
std::string MaterialTable(const std::vector<ModelRecord>& records) {
  std::vector<std::string> materials;
  std::map<std::string, std::vector<const ModelRecord*>> of_material;
  for (const ModelRecord& record : records) {
    if (of_material[record.material].empty()) materials.push_back(record.material);
    of_material[record.material].push_back(&record);
  }
  Table table({"material", "best model", "numbers", "error", "best network", "weights", "its error",
               "model's over it"});
  for (const std::string& material : materials) {
    const ModelRecord* model = Best(of_material[material], false);
    const ModelRecord* network = Best(of_material[material], true);
    const double ratio = model && network
                             ? model->errors.mean_abs_log_error / network->errors.mean_abs_log_error
                             : std::numeric_limits<double>::quiet_NaN();
    table.Add({material, model ? model->method : "-", model ? StrCat(model->parameters) : "-",
               ErrorOf(model), network ? network->method : "-",
               network ? StrCat(network->parameters) : "-", ErrorOf(network), Shown(ratio, 2)});
  }
  return table.Markdown();
}

// A row for each method, over the materials of one kind of source.
std::string MethodTable(const std::vector<ModelRecord>& records, const std::string& kind,
                        const std::vector<Method>& methods) {
  Table table({"method", "materials", "numbers", "median error", "worst error", "median Delta E",
               "median s"});
  for (const Method& method : methods) {
    std::vector<double> errors, delta_e, seconds, parameters;
    for (const ModelRecord& record : records) {
      if (record.kind != kind || record.method != method.name) continue;
      errors.push_back(record.errors.mean_abs_log_error);
      delta_e.push_back(record.delta_e);
      seconds.push_back(record.seconds);
      parameters.push_back(static_cast<double>(record.parameters));
    }
    if (errors.empty()) continue;
    table.Add({method.name, StrCat(errors.size()), StrCat(Median(parameters)),
               Shown(Median(errors), 3), Shown(*std::max_element(errors.begin(), errors.end()), 3),
               Shown(Median(delta_e), 3), Significant(Median(seconds), 2)});
  }
  return table.Markdown();
}

class Comparison {
 public:
  explicit Comparison(const std::vector<Method>& methods)
      : methods_(methods), csv_path_(OutputPath("models.csv")), csv_(csv_path_) {
    csv_ << CsvLine({"material", "kind", "method", "parameters", "iterations", "seconds",
                     "mean_abs_log_error", "rmse", "delta_e_mean"})
         << std::flush;
  }

  void RunMaterial(const MaterialSource& source) {
    const std::unique_ptr<Brdf> material = OpenBrdf(source.source);
    for (const Method& method : methods_) {
      ModelRecord record;
      record.material = source.name;
      record.kind = KindOf(source);
      record.method = method.name;
      record.is_network = method.is_network;
      try {
        Measure(*material, method, &record);
        Keep(record);
      } catch (const Error& error) {
        failures_.push_back(StrCat(source.name, ", ", method.name, ": ", error.what()));
        std::fprintf(stderr, "%s\n", failures_.back().c_str());
      }
    }
  }

  void Report(std::size_t materials) const {
    std::string text = StrCat(materials, " materials. Error: mean absolute log error (eq. 6) on ",
                              FLAGS_heldout_samples,
                              " held-out samples. Failed fits: ", failures_.size(), ".\n\n");
    for (const std::string& failure : failures_) text += "- " + failure + "\n";
    text += "\n## By material\n\n" + MaterialTable(records_);
    for (const char* kind : {"builtin", "sgd", "file"}) {
      const bool any = std::any_of(records_.begin(), records_.end(),
                                   [&](const ModelRecord& r) { return r.kind == kind; });
      if (any) {
        text += StrCat("\n## By method, ", kind, "\n\n") + MethodTable(records_, kind, methods_);
      }
    }
    WriteReport("models", text);
  }

 private:
  static void Measure(const Brdf& material, const Method& method, ModelRecord* record) {
    const MethodResult result = method.fit(material);
    record->parameters = result.parameters;
    record->iterations = result.iterations;
    record->seconds = result.seconds;
    record->errors =
        MeasureErrors(HeldOutSamples(material, FLAGS_heldout_samples, /*seed=*/1), *result.brdf);
    record->delta_e = MeasureColorErrors(
                          HeldOutSamples(material, FLAGS_heldout_samples, /*seed=*/1), *result.brdf)
                          .delta_e_mean;
    if (!std::isfinite(record->errors.mean_abs_log_error) || !std::isfinite(record->delta_e)) {
      Fail("a measure isn't finite");
    }
  }

  // At once, so that a long run that is stopped has left its rows.
  void Keep(const ModelRecord& record) {
    csv_ << CsvLine({record.material, record.kind, record.method, StrCat(record.parameters),
                     StrCat(record.iterations), FormatNumber(record.seconds),
                     FormatNumber(record.errors.mean_abs_log_error),
                     FormatNumber(record.errors.rmse), FormatNumber(record.delta_e)});
    if (!csv_.flush()) Fail(csv_path_, ": can't be written");
    std::fprintf(stderr, "%s, %s: %.3g in %.3g s\n", record.material.c_str(), record.method.c_str(),
                 record.errors.mean_abs_log_error, record.seconds);
    records_.push_back(record);
  }

  const std::vector<Method>& methods_;
  std::string csv_path_;
  std::ofstream csv_;
  std::vector<ModelRecord> records_;
  std::vector<std::string> failures_;
};

void Run(const std::vector<std::string>& arguments) {
  if (FLAGS_heldout_samples < 1) Fail("heldout_samples = 0; must be >= 1");
  std::vector<Method> methods;
  AddModels(&methods);
  AddNetworks(&methods);
  const std::vector<MaterialSource> materials = Materials(arguments);
  Comparison comparison(methods);
  for (const MaterialSource& material : materials) comparison.RunMaterial(material);
  comparison.Report(materials.size());
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}

// models.cc: analytic models beside networks: error and size, the comparison of Ngan et al. 2005.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <memory>

#include "base/median.h"
#include "base/text.h"
#include "experiment.h"
#include "fit_log.h"
#include "materials.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/models/fit_analytic.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(models: analytic models fitted to materials, beside networks.

  models --out_dir=results --sgd=parameters.csv
  models --out_dir=results --models=ggx,ward builtin:satin-gold metal=gold.binary

The arguments are materials; without any, the built-in ones and, with --sgd, 30 of the SGD model. Each
fit is a row of models.csv as soon as it is done. models.md has two tables: the best model and the best
network of each material, and each method over each kind of source. The built-in materials are analytic
themselves (Lambert, Oren-Nayar, ward_bounded, ggx).
)" + std::string(kMaterialsHelp);

struct Options {
  std::vector<std::string> models = {"lambert",       "oren_nayar", "phong",     "blinn_phong",
                                     "lafortune",     "ward",       "ward_duer", "ward_bounded",
                                     "cook_torrance", "ggx",        "abc",       "disney"};
  std::vector<int> lobes = {1, 2};
  std::vector<std::vector<int>> hidden = {{3, 3}, {21, 21}};
  Sampling sampling = Sampling::kUniform;
  std::uint64_t samples = 6000;
  int starts = AnalyticFitOptions{}.starts;
  std::uint64_t network_samples = SamplingOptions{}.samples;
  int network_iterations = ScheduleOptions{}.max_iterations;
  double max_seconds = 60.0;
  std::uint64_t seed = 1;
  int threads = 0;
  std::uint64_t heldout_samples = 200000;
  std::string sgd;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Texts("models", &o->models, "analytic models"));
  fields.Add(Integers("lobes", &o->lobes, AtLeast(1), "numbers of lobes of models that have any"));
  fields.Add(
      Networks("hidden", &o->hidden, "sizes of the hidden layers of each network; '': no network"));
  fields.Add(Choice("sampling", &o->sampling, kSamplings,
                    "training angles of the models: uniform, like the angles that errors are "
                    "measured at, or highlight, like the training angles of the networks"));
  fields.Add(Integer("samples", &o->samples, AtLeast(1), "training samples of the models"));
  fields.Add(Integer("starts", &o->starts, AtLeast(1), "starts of each model's fit"));
  fields.Add(Integer("network_samples", &o->network_samples, AtLeast(1),
                     "training samples of the networks, at most"));
  fields.Add(Integer("network_iterations", &o->network_iterations, AtLeast(0),
                     "iterations of the networks, at most"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each network"));
  fields.Add(Integer("seed", &o->seed, AtLeast(0), "of the fits"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "of each fit; 0: one for each core"));
  fields.Add(Integer("heldout_samples", &o->heldout_samples, AtLeast(1),
                     "held-out samples that errors are measured on"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

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

// What a fit gave; `parameters` is how many numbers it stores.
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

MethodResult FitModel(const Brdf& material, const AnalyticModel& model, const Options& options,
                      const AnalyticFitOptions& fit_options) {
  const std::vector<BrdfSample> samples =
      DrawSamples(material, SampleSet::kTraining, options.sampling, options.samples, options.seed);
  const AnalyticFit fit = FitAnalytic(samples, material.IsIsotropic(), model, fit_options);
  return {std::make_unique<AnalyticBrdf>(fit.brdf), fit.brdf.parameters().size(),
          fit.summary.iterations, fit.summary.seconds};
}

MethodResult FitNetwork(const Brdf& material, const FitProblem& problem,
                        const FitOptions& options) {
  const Fit fit = FitBrdf(material, problem, options);
  return {std::make_unique<NeuralBrdf>(fit.network), fit.network.weights().size(),
          fit.summary.iterations, fit.summary.seconds};
}

void AddModels(const Options& options, std::vector<Method>* methods) {
  for (const std::string& name : options.models) {
    const AnalyticModel& model = FindAnalyticModel(name);
    for (int n : options.lobes) {
      AnalyticFitOptions fit_options;
      fit_options.lobes = n;
      fit_options.starts = options.starts;
      fit_options.threads = options.threads;
      fit_options.Validate();
      const bool has_lobes = !model.lobe.empty();
      methods->push_back({has_lobes ? StrCat(name, ", ", n, n == 1 ? " lobe" : " lobes") : name,
                          false, [&options, &model, fit_options](const Brdf& material) {
                            return FitModel(material, model, options, fit_options);
                          }});
      if (!has_lobes) break;
    }
  }
}

void AddNetworks(const Options& options, std::vector<Method>* methods) {
  for (const std::vector<int>& hidden : options.hidden) {
    FitProblem problem;
    problem.network.hidden = hidden;
    problem.sampling.samples = options.network_samples;
    problem.sampling.seed = options.seed;
    FitOptions fit_options;
    fit_options.schedule.max_iterations = options.network_iterations;
    fit_options.schedule.max_seconds = options.max_seconds;
    fit_options.threads = options.threads;
    ValidateFit(problem, fit_options);
    methods->push_back({StrCat("network ", HiddenName(hidden)), true,
                        [problem, fit_options](const Brdf& material) {
                          return FitNetwork(material, problem, fit_options);
                        }});
  }
}

Arguments DefaultMaterials(const std::string& sgd) {
  Arguments texts;
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    texts.push_back(StrCat("builtin:", material.name));
  }
  const Arguments more = SgdMaterials(sgd);
  texts.insert(texts.end(), more.begin(), more.end());
  return texts;
}

// "builtin", "sgd", "file"
std::string KindOf(const MaterialSource& material) {
  const std::size_t colon = material.source.find(':');
  return colon == std::string::npos ? "file" : material.source.substr(0, colon);
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
  // methods must outlive this.
  Comparison(const Options& options, const std::vector<Method>& methods, const Output& output)
      : options_(options),
        methods_(methods),
        log_(output.Path("models.csv"), {"material", "kind", "method", "parameters", "iterations",
                                         "seconds", "mean_abs_log_error", "rmse", "delta_e_mean"}) {
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
        log_.AddFailure(StrCat(source.name, ", ", method.name, ": ", error.what()));
      }
    }
  }

  std::string Report(std::size_t materials) const {
    std::string text =
        StrCat(materials, " materials. Error: mean absolute log error (eq. 6) on ",
               options_.heldout_samples, " held-out samples. ", log_.FailuresMarkdown(),
               "## By material\n\n", MaterialTable(records_));
    for (const char* kind : {"builtin", "sgd", "file"}) {
      const bool any = std::any_of(records_.begin(), records_.end(),
                                   [&](const ModelRecord& r) { return r.kind == kind; });
      if (any) {
        text += StrCat("\n## By method, ", kind, "\n\n") + MethodTable(records_, kind, methods_);
      }
    }
    return text;
  }

 private:
  void Measure(const Brdf& material, const Method& method, ModelRecord* record) const {
    const auto heldout = [&] {
      return HeldOutSamples(material, options_.heldout_samples, /*seed=*/1);
    };
    const MethodResult result = method.fit(material);
    record->parameters = result.parameters;
    record->iterations = result.iterations;
    record->seconds = result.seconds;
    record->errors = MeasureErrors(heldout(), *result.brdf);
    record->delta_e = MeasureColorErrors(heldout(), *result.brdf).delta_e_mean;
    if (!std::isfinite(record->errors.mean_abs_log_error) || !std::isfinite(record->delta_e)) {
      Fail("a measure isn't finite");
    }
  }

  void Keep(const ModelRecord& record) {
    log_.AddRow({record.material, record.kind, record.method, StrCat(record.parameters),
                 StrCat(record.iterations), FormatNumber(record.seconds),
                 FormatNumber(record.errors.mean_abs_log_error), FormatNumber(record.errors.rmse),
                 FormatNumber(record.delta_e)});
    std::fprintf(stderr, "%s, %s: %.3g in %.3g s\n", record.material.c_str(), record.method.c_str(),
                 record.errors.mean_abs_log_error, record.seconds);
    records_.push_back(record);
  }

  const Options& options_;
  const std::vector<Method>& methods_;
  FitLog log_;
  std::vector<ModelRecord> records_;
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  std::vector<Method> methods;
  AddModels(options, &methods);
  AddNetworks(options, &methods);
  const std::vector<MaterialSource> materials =
      ParseMaterials(arguments, DefaultMaterials(options.sgd), options.sgd);
  Comparison comparison(options, methods, output);
  for (const MaterialSource& material : materials) comparison.RunMaterial(material);
  output.WriteReport("models", comparison.Report(materials.size()));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}

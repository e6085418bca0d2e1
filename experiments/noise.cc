// noise.cc: what noise of measurements does to fits: formulas with noise, and how near fits come to the
// formulas themselves.
#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "cpu_timer.h"
#include "experiment.h"
#include "materials.h"
#include "noisy.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(noise: fits of formulas measured with noise, against the formulas themselves.

  noise --out_dir=results --sgd=parameters.csv sgd:gold-metallic-paint sgd:black-obsidian
  noise --out_dir=results --additive=0.002,0.01 --multiplicative= --forms=list builtin:satin-gold

The arguments are isotropic materials; without any, a built-in one. Each is measured as a MERL table and
as a list of measurements, without noise, with additive noise of each standard deviation (1/sr), and
with multiplicative noise of each (a part of f). The noisy data themselves, interpolated, stand beside
the fit.
)" + std::string(kMaterialsHelp);

struct Options {
  std::vector<std::string> additive = {"0.002", "0.01"}, multiplicative = {"0.01", "0.05", "0.1"},
                           forms = {"table", "list"};
  std::uint64_t measurements = 20000, samples = 50000, seed = 1;
  double max_seconds = ScheduleOptions{}.max_seconds;
  int threads = 0;
  std::string sgd;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Texts("additive", &o->additive, "standard deviations of additive noise, 1/sr"));
  fields.Add(Texts("multiplicative", &o->multiplicative,
                   "standard deviations of multiplicative noise, parts of f"));
  fields.Add(Texts("forms", &o->forms, "what the measurements are: table, list"));
  fields.Add(Integer("measurements", &o->measurements, AtLeast(1), "of each list"));
  fields.Add(Integer("samples", &o->samples, AtLeast(2), "held-out samples of each formula"));
  fields.Add(Integer("seed", &o->seed, AtLeast(0), "of the noise and of the fits"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each fit"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "0: one for each core"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

double Deviation(const char* field, const std::string& text) {
  const double value = ParseNumber(field, text);
  if (!(value >= 0.0 && std::isfinite(value))) Fail(field, " = ", text, "; must be >= 0");
  return value;
}

std::vector<Noise> NoisesOf(const Options& options) {
  std::vector<Noise> noises = {{}};
  for (const std::string& text : options.additive) {
    if (!text.empty()) noises.push_back({.additive = Deviation("additive", text)});
  }
  for (const std::string& text : options.multiplicative) {
    if (!text.empty()) noises.push_back({.multiplicative = Deviation("multiplicative", text)});
  }
  return noises;
}

std::string NameOf(const Noise& noise) {
  if (noise.additive > 0.0) return StrCat("additive ", noise.additive);
  if (noise.multiplicative > 0.0) return StrCat("multiplicative ", noise.multiplicative);
  return "none";
}

class Study {
 public:
  explicit Study(const Options& options)
      : options_(options),
        table_({"material", "measured as", "noise", "error of the fit", "of the noisy data",
                "fit over data", "bias of the dark half, %", "CPU s"}) {}

  void Add(const MaterialSource& source) {
    const std::unique_ptr<Brdf> clean = OpenBrdf(source.source);
    const std::vector<BrdfSample> truth = HeldOutSamples(*clean, options_.samples, /*seed=*/1);
    for (const std::string& form : options_.forms) {
      for (const Noise& noise : NoisesOf(options_)) {
        AddRow(source.name, form, noise, truth, *Measured(*clean, form, noise));
      }
    }
  }

  std::string Markdown() const {
    return StrCat("Error: mean absolute log error (eq. 6) to the formula on ", options_.samples,
                  " samples.\n\n", table_.Markdown(),
                  "\nThe fit's error is above the noisy data's in ", worse_, " of ", noisy_,
                  " rows with noise.\n");
  }

 private:
  std::unique_ptr<Brdf> Measured(const Brdf& clean, const std::string& form,
                                 const Noise& noise) const {
    if (form == "table") {
      return std::make_unique<MerlBrdf>(NoisyTable(clean, noise, options_.seed));
    }
    if (form != "list") Fail("forms = ", form, "; must be table or list");
    return std::make_unique<ScatteredBrdf>(
        NoisyMeasurements(clean, options_.measurements, noise, options_.seed));
  }

  void AddRow(const std::string& name, const std::string& form, const Noise& noise,
              const std::vector<BrdfSample>& truth, const Brdf& measured) {
    FitProblem problem;
    problem.sampling.seed = options_.seed;
    FitOptions fit_options;
    fit_options.schedule.max_seconds = options_.max_seconds;
    fit_options.threads = options_.threads;
    const CpuTimer timer;
    const NeuralBrdf fit = FitBrdf(measured, problem, fit_options).network;
    const double seconds = timer.Seconds();
    const double ours = MeasureErrors(truth, fit).mean_abs_log_error;
    const double data = MeasureErrors(truth, measured).mean_abs_log_error;
    const double bias = 100.0 * DarkHalfBias(truth, fit);
    const bool has_noise = noise.additive + noise.multiplicative > 0.0;
    noisy_ += has_noise;
    worse_ += has_noise && ours > data;
    table_.Add({name, form, NameOf(noise), Significant(ours, 3), Significant(data, 3),
                Significant(ours / data, 2), Significant(bias, 2), Significant(seconds, 2)});
    std::fprintf(stderr, "%s, %s, noise %s: error %.3g (data %.3g), bias %.2g %%, %.3g CPU s\n",
                 name.c_str(), form.c_str(), NameOf(noise).c_str(), ours, data, bias, seconds);
  }

  const Options& options_;
  Table table_;
  int noisy_ = 0, worse_ = 0;  // rows
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  NoisesOf(options);  // a mistake shows before the first fit
  Study study(options);
  for (const MaterialSource& source :
       ParseMaterials(arguments, {"builtin:satin-gold"}, options.sgd)) {
    study.Add(source);
  }
  output.WriteReport("noise", study.Markdown());
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}

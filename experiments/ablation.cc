// ablation.cc: what each of the paper's terms does.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "ablation_tables.h"
#include "base/text.h"
#include "experiment.h"
#include "fit_log.h"
#include "for_each.h"
#include "materials.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "problems.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(ablation: the paper's tables, with and without each of its terms, on our materials.

  ablation --out_dir=results --sgd=parameters.csv
  ablation --out_dir=results --tables=1,3 builtin:satin-gold metal=gold.binary

Table 1 compares encodings. Table 2 compares fits with and without the energy term, of materials that
reflect nearly all light. Table 3 compares weights of the chromaticity term. Table 4 is
problems/pbnbrdf.flags with and without the energy term, on materials as they are and scaled.

The arguments are materials; without any, 16 built-in ones and, with --sgd, 30 of the SGD model. Each
fit is a row of ablation.csv as soon as it is done; ablation.md has the tables.
)" + std::string(kMaterialsHelp);

// Table 2 has built-in materials as they are, if their largest albedo is at least this.
constexpr double kMinAlbedo = 0.9;

enum class Base { kDefault, kReciprocal };

constexpr NameTable<Base, 2> kBases = {
    {{"default", Base::kDefault}, {"reciprocal", Base::kReciprocal}}};

struct Options {
  std::vector<int> tables = {1, 2, 3, 4};
  Base base = Base::kDefault;
  std::vector<std::string> chromaticity_weights = {"0.1", "1"};
  double scale_to_albedo = 0.99;
  std::vector<int> seeds = {1};
  std::optional<int> max_iterations;
  std::optional<std::uint64_t> samples;
  double max_seconds = 60.0;
  int threads = 0, jobs = 1;
  std::uint64_t heldout_samples = 200000;
  std::string sgd;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Integers("tables", &o->tables, Between(1, 4), "the tables to make"));
  fields.Add(Choice("base", &o->base, kBases,
                    "what tables 2 and 3 add their terms to: default is the default problem, "
                    "reciprocal is problems/reciprocal.flags"));
  fields.Add(Texts("chromaticity_weights", &o->chromaticity_weights,
                   "weights of table 3, which also has fits without the term"));
  fields.Add(Number("scale_to_albedo", &o->scale_to_albedo, Above(0.0),
                    "the largest directional albedo that tables 2 and 4 scale materials to; "
                    "built-in ones are not scaled"));
  fields.Add(Integers("seeds", &o->seeds, AtLeast(1), "seeds of the fits"));
  fields.Add(OverridingInteger("max_iterations", &o->max_iterations, AtLeast(0),
                               "iterations of each fit, at most"));
  fields.Add(OverridingInteger("samples", &o->samples, AtLeast(1), "training samples, at most"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each fit"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "of each fit; 0: one for each core"));
  fields.Add(Integer("jobs", &o->jobs, AtLeast(1), "how many materials are fitted at a time"));
  fields.Add(Integer("heldout_samples", &o->heldout_samples, AtLeast(1),
                     "held-out samples that errors are measured on"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

// A row of a table.
struct Row {
  std::string name;
  FitSetup setup;
};

Row WithWeight(std::string name, FitSetup setup, std::string_view term, double weight) {
  setup.problem.terms.SetWeight(term, weight);
  return {std::move(name), std::move(setup)};
}

// With the log term alone.
FitSetup BaseSetup(Base base) {
  if (base == Base::kReciprocal) return ShippedProblem("reciprocal");
  return WithWeight("", {}, "energy", 0.0).setup;
}

std::vector<Row> EncodingRows() {
  Row merl = {"merl encoding", ShippedProblem("nbrdf")};
  merl.setup.problem.network.encoding = Encoding::kMerl;
  return {{"nbrdf", ShippedProblem("nbrdf")},
          {"reciprocal encoding", ShippedProblem("reciprocal")},
          merl};
}

// Rows with the energy term come last.
std::vector<Row> Rows(int table, const Options& options) {
  const FitSetup base = BaseSetup(options.base), all_terms = ShippedProblem("pbnbrdf");
  switch (table) {
    case 1:
      return EncodingRows();
    case 2:
      return {{"log", base},
              WithWeight("log + energy", base, "energy", TermOptions{}.EnergyWeight())};
    case 4:
      return {WithWeight("log + chromaticity", all_terms, "energy", 0.0),
              {"log + chromaticity + energy", all_terms}};
    default:
      break;
  }
  std::vector<Row> rows = {{"log", base}};
  for (const std::string& weight : options.chromaticity_weights) {
    rows.push_back(WithWeight(StrCat("log + ", weight, " chromaticity"), base, "chromaticity",
                              ParseNumber("chromaticity_weights", weight)));
  }
  return rows;
}

// What is asked for, all of it checked before the first fit.
struct Plan {
  Options options;
  std::vector<MaterialSource> materials;
  std::vector<std::vector<Row>> rows;  // of each of the tables
};

Plan MakePlan(const Options& options, const Arguments& arguments) {
  Plan plan = {options, {}, {}};
  for (int table : options.tables) {
    std::vector<Row> rows = Rows(table, options);
    for (auto& [name, setup] : rows) {
      ScheduleOptions* schedule = &setup.options.schedule;
      schedule->max_iterations = options.max_iterations.value_or(schedule->max_iterations);
      schedule->max_seconds = options.max_seconds;
      setup.options.threads = options.threads;
      SamplingOptions* sampling = &setup.problem.sampling;
      sampling->samples = options.samples.value_or(sampling->samples);
      ValidateFit(setup.problem, setup.options);
    }
    plan.rows.push_back(std::move(rows));
  }
  plan.materials = ParseMaterials(arguments, ManyMaterials(options.sgd), options.sgd);
  return plan;
}

// What a table fits of a material: under its name, and maybe scaled.
struct Variant {
  std::string name;
  std::unique_ptr<Brdf> brdf;
};

std::vector<Variant> Variants(int table, const MaterialSource& material, double scale_to_albedo) {
  std::vector<Variant> variants;
  const auto add = [&](const std::string& name, std::unique_ptr<Brdf> brdf) {
    variants.push_back({name, std::move(brdf)});
  };
  const bool is_builtin = material.source.starts_with("builtin:");
  std::unique_ptr<Brdf> brdf = OpenBrdf(material.source);
  if (table == 1 && !brdf->IsIsotropic()) return {};  // its encodings are
  const bool as_it_is = table != 2 || (is_builtin && LargestAlbedo(*brdf) >= kMinAlbedo);
  if (as_it_is) add(material.name, std::move(brdf));
  if (is_builtin || (table != 2 && table != 4)) return variants;
  add(table == 4 ? StrCat(material.name, " scaled") : material.name,
      ScaleToAlbedo(OpenBrdf(material.source), scale_to_albedo));
  return variants;
}

class Ablation {
 public:
  Ablation(const Plan& plan, const Output& output)
      : plan_(plan),
        output_(output),
        log_(output.Path("ablation.csv"), AblationCsvHeader()),
        records_(plan.materials.size()) {}

  // Of the plan's materials.
  void RunMaterial(std::size_t index) {
    const MaterialSource& material = plan_.materials[index];
    for (std::size_t t = 0; t < plan_.rows.size(); ++t) {
      const int table = plan_.options.tables[t];
      try {
        for (const Variant& variant : Variants(table, material, plan_.options.scale_to_albedo)) {
          RunTable(table, plan_.rows[t], variant, index);
        }
      } catch (const Error& error) {
        log_.AddFailure(StrCat("table ", table, ", ", material.name, ": ", error.what()));
      }
    }
  }

  void Report() const {
    std::vector<AblationRecord> all;
    for (const auto& of_material : records_) {
      all.insert(all.end(), of_material.begin(), of_material.end());
    }
    output_.WriteReport("ablation", Preface() + AblationMarkdown(all));
  }

 private:
  void RunTable(int table, const std::vector<Row>& rows, const Variant& variant,
                std::size_t index) {
    AblationRecord record;
    record.table = table;
    record.material = variant.name;
    record.material_class = plan_.materials[index].material_class;
    if (table == 2 || table == 4) {
      record.set_up = kMaterialItself;
      record.energy = MeasureEnergy(*variant.brdf);
      Keep(record, index);
    }
    for (int seed : plan_.options.seeds) {
      record.seed = static_cast<std::uint64_t>(seed);
      RunRows(rows, *variant.brdf, record, index);
    }
  }

  // record: names the fits. The last row is done first if it has an energy term: where that had nothing
  // to do, its fit is also that of the row before it, the same without the term.
  void RunRows(std::vector<Row> rows, const Brdf& material, AblationRecord record,
               std::size_t index) {
    const bool is_reversed = rows.back().setup.problem.terms.EnergyWeight() > 0.0;
    if (is_reversed) std::reverse(rows.begin(), rows.end());
    std::vector<AblationRecord> fits;
    bool is_known = false;
    for (const Row& row : rows) {
      record.set_up = row.name;
      if (!is_known) {
        const std::optional<EnergySummary> energy = RunFit(material, row.setup, &record);
        if (!energy) continue;
        const bool has_acted = energy->rounds > 0 || energy->correction > 0.0;
        is_known = row.setup.problem.terms.EnergyWeight() > 0.0 && !has_acted;
      }
      fits.push_back(record);
    }
    if (is_reversed) std::reverse(fits.begin(), fits.end());
    for (const AblationRecord& fit : fits) Keep(fit, index);
  }

  // record: names the fit and takes its measures. None if it failed.
  std::optional<EnergySummary> RunFit(const Brdf& material, FitSetup setup,
                                      AblationRecord* record) {
    const std::string what = StrCat("table ", record->table, ", ", record->material, ", ",
                                    record->set_up, ", seed ", record->seed, ": ");
    setup.problem.sampling.seed = record->seed;
    if (!material.IsIsotropic()) setup.problem.network.encoding = EncodingFor(material);
    std::optional<EnergySummary> energy;
    try {
      const Fit fit = FitBrdf(material, setup.problem, setup.options);
      Measure(material, fit, record);
      energy = fit.summary.energy;
    } catch (const Error& error) {
      log_.AddFailure(what + error.what());
      return std::nullopt;
    }
    if (!IsFinite(*record)) {
      log_.AddFailure(what + "a measure isn't finite");
      return std::nullopt;
    }
    std::fprintf(stderr, "%s%.3g in %.3g s\n", what.c_str(), record->errors.mean_abs_log_error,
                 record->seconds);
    return energy;
  }

  void Measure(const Brdf& material, const Fit& fit, AblationRecord* record) const {
    const auto heldout = [&] {
      return HeldOutSamples(material, plan_.options.heldout_samples, /*seed=*/1);
    };
    record->iterations = fit.summary.iterations;
    record->seconds = fit.summary.seconds;
    record->errors = MeasureErrors(heldout(), fit.network);
    record->colors = MeasureColorErrors(heldout(), fit.network);
    record->reciprocity = MeasureReciprocity(fit.network);
    record->energy = MeasureEnergy(fit.network);
  }

  void Keep(const AblationRecord& record, std::size_t index) {
    log_.AddRow(AblationCsvRow(record));
    records_[index].push_back(record);
  }

  // How the numbers came about, and what failed.
  std::string Preface() const {
    const Options& o = plan_.options;
    return StrCat(plan_.materials.size(), " materials, seeds ", Joined(o.seeds, ","), ", at most ",
                  o.max_seconds, " s a fit; tables 2 and 3 add terms to: ", NameOf(kBases, o.base),
                  ". Medians are over materials, of each the median of its seeds; worst: of all "
                  "fits. Table 2 "
                  "scales materials to a largest directional albedo of ",
                  o.scale_to_albedo, ", and has built-in ones as they are if theirs is at least ",
                  kMinAlbedo, "; table 4 has materials both as they are and scaled. ",
                  log_.FailuresMarkdown());
  }

  const Plan& plan_;
  const Output& output_;
  FitLog log_;
  std::vector<std::vector<AblationRecord>> records_;  // of each material
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const Plan plan = MakePlan(options, arguments);
  Ablation ablation(plan, output);
  ForEach(plan.materials.size(), options.jobs, [&](std::size_t k) { ablation.RunMaterial(k); });
  ablation.Report();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}

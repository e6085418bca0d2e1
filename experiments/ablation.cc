// ablation.cc: what each of the paper's terms does, on many materials.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "ablation_tables.h"
#include "base/text.h"
#include "comparison.h"
#include "default_materials.h"
#include "experiment.h"
#include "fit_log.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"

DEFINE_string(materials, "",
              "in place of the default ones, separated by commas: sources, CLASS= in front of them "
              "if wanted; sgd:NAME is a material of --sgd");
DEFINE_string(sgd, "", "CSV of SGD parameters; '': the default materials are the built-in ones");
DEFINE_string(tables, "1,2,3,4", "those to make: 1 to 3 are the paper's, 4 has all terms together");
DEFINE_string(base, "default",
              "what tables 2 and 3 add their terms to: default: the fit's default set-up, merl "
              "encoding and tanh units | reciprocal: problems/reciprocal.flags");
DEFINE_string(chromaticity_weights, "0.1,1", "of table 3, beside none");
DEFINE_double(
    scale_to_albedo, 0.99,
    "of tables 2 and 4: the largest directional albedo that materials are scaled to, but for the "
    "built-in ones");
DEFINE_string(seeds, "1", "seeds of the fits");
DEFINE_int32(max_iterations, pbnbrdf::FitOptions{}.max_iterations, "of each fit");
DEFINE_uint64(samples, pbnbrdf::FitProblem{}.samples, "most training samples");
DEFINE_double(max_seconds, 60.0, "of each fit");
DEFINE_int32(threads, 0, "of each fit; 0: one for each core");
DEFINE_int32(jobs, 1, "materials at a time");
DEFINE_uint64(heldout_samples, 200000, "held-out samples of a fit's errors");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(ablation: the paper's tables, with and without each of its terms, on our materials.

  ablation --out_dir=results --sgd=parameters.csv
  ablation --out_dir=results --materials=builtin:satin-gold,metal=gold.binary --tables=1,3
  ablation --out_dir=results --sgd=parameters.csv --jobs=2 --threads=1 merl/*.binary

The arguments are further materials. Table 1 compares encodings, table 2 fits of materials that
reflect next to all light with and without the energy term, table 3 weights of the chromaticity
term, table 4 problems/pbnbrdf.flags with and without the energy term on materials as they are and
scaled. Each fit is a row of ablation.csv as soon as it is done; ablation.md has the tables.
)";

// A built-in material below this isn't one of low dissipation; others are scaled.
constexpr double kLowDissipation = 0.9;

enum class Base { kDefault, kReciprocal };

constexpr NameTable<Base, 2> kBases = {
    {{"default", Base::kDefault}, {"reciprocal", Base::kReciprocal}}};

// A row of a table.
struct SetUp {
  std::string name;
  FitProblem problem;
};

// problems/nbrdf.flags, on another encoding.
FitProblem NbrdfProblem(Encoding encoding) {
  FitProblem problem;
  problem.encoding = encoding;
  problem.activation = Activation::kRelu;
  problem.sampling = Sampling::kUniform;
  problem.energy_weight = 0.0;
  return problem;
}

// With the log term alone.
FitProblem BaseProblem(Base base) {
  if (base == Base::kReciprocal) return NbrdfProblem(Encoding::kReciprocal);
  FitProblem problem;
  problem.energy_weight = 0.0;
  return problem;
}

// problems/pbnbrdf.flags; the energy term last.
std::vector<SetUp> AllTermsSetUps() {
  std::vector<SetUp> set_ups(2);
  for (SetUp& set_up : set_ups) set_up.problem.chromaticity_weight = 0.1;
  set_ups[0].name = "log + chromaticity";
  set_ups[0].problem.energy_weight = 0.0;
  set_ups[1].name = "log + chromaticity + energy";
  return set_ups;
}

std::vector<SetUp> SetUps(std::size_t table, Base base) {
  if (table == 1) {
    return {{"nbrdf", NbrdfProblem(Encoding::kCartesian)},
            {"reciprocal encoding", NbrdfProblem(Encoding::kReciprocal)},
            {"merl encoding", NbrdfProblem(Encoding::kMerl)}};
  }
  if (table == 4) return AllTermsSetUps();
  std::vector<SetUp> set_ups = {{"log", BaseProblem(base)}};
  if (table == 2) {
    set_ups.push_back({"log + energy", BaseProblem(base)});
    set_ups.back().problem.energy_weight = FitProblem{}.energy_weight;
    return set_ups;
  }
  for (const std::string& text : Split(FLAGS_chromaticity_weights, ',')) {
    set_ups.push_back({StrCat("log + ", text, " chromaticity"), BaseProblem(base)});
    set_ups.back().problem.chromaticity_weight = ParseNumber("chromaticity_weights", text);
  }
  return set_ups;
}

std::vector<std::string> MaterialTexts(const std::vector<std::string>& arguments) {
  std::vector<std::string> texts =
      FLAGS_materials.empty() ? BuiltinTexts() : Split(FLAGS_materials, ',');
  if (FLAGS_materials.empty() && !FLAGS_sgd.empty()) {
    const std::vector<std::string> sgd = SgdTexts();
    texts.insert(texts.end(), sgd.begin(), sgd.end());
  }
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  for (std::string& text : texts) text = WithSgdPath(text, FLAGS_sgd);
  return texts;
}

// What is asked for, all of it checked before the first fit.
struct Plan {
  std::vector<std::size_t> tables;
  std::vector<MaterialSource> materials;
  std::vector<std::size_t> seeds;
  Base base;
  FitOptions options;
};

Plan MakePlan(const std::vector<std::string>& arguments) {
  Plan plan;
  plan.tables = ParseCounts("tables", FLAGS_tables);
  plan.seeds = ParseCounts("seeds", FLAGS_seeds);
  plan.base = ParseName(kBases, "base", FLAGS_base);
  plan.options.max_iterations = FLAGS_max_iterations;
  plan.options.max_seconds = FLAGS_max_seconds;
  plan.options.threads = FLAGS_threads;
  for (std::size_t table : plan.tables) {
    if (table > 4) Fail("tables: ", table, "; must be 1 to 4");
    for (SetUp& set_up : SetUps(table, plan.base)) {
      set_up.problem.samples = FLAGS_samples;
      ValidateFit(set_up.problem, plan.options);
    }
  }
  if (FLAGS_heldout_samples < 1) Fail("heldout_samples = 0; must be >= 1");
  if (FLAGS_jobs < 1) Fail("jobs = ", FLAGS_jobs, "; must be >= 1");
  if (!(FLAGS_scale_to_albedo > 0.0)) {
    Fail("scale_to_albedo = ", FLAGS_scale_to_albedo, "; must be > 0");
  }
  plan.materials = ParseMaterials(MaterialTexts(arguments));
  return plan;
}

// What a table fits of a material: under its name, and maybe scaled.
struct Variant {
  std::string name;
  std::unique_ptr<Brdf> brdf;
};

std::vector<Variant> Variants(std::size_t table, const MaterialSource& material) {
  std::vector<Variant> variants;
  const auto add = [&](const std::string& name, std::unique_ptr<Brdf> brdf) {
    variants.push_back({name, std::move(brdf)});
  };
  const bool is_builtin = material.source.starts_with("builtin:");
  std::unique_ptr<Brdf> brdf = OpenBrdf(material.source);
  if (table == 1 && !brdf->IsIsotropic()) return {};  // its encodings are
  const bool as_it_is = table != 2 || (is_builtin && LargestAlbedo(*brdf) >= kLowDissipation);
  if (as_it_is) add(material.name, std::move(brdf));
  if (is_builtin || (table != 2 && table != 4)) return variants;
  add(table == 4 ? StrCat(material.name, " scaled") : material.name,
      ScaleToAlbedo(OpenBrdf(material.source), FLAGS_scale_to_albedo));
  return variants;
}

class Ablation {
 public:
  explicit Ablation(const Plan& plan)
      : plan_(plan),
        log_(OutputPath("ablation.csv"), AblationCsvHeader()),
        records_(plan.materials.size()) {}

  // Of the plan's materials.
  void RunMaterial(std::size_t index) {
    const MaterialSource& material = plan_.materials[index];
    for (std::size_t table : plan_.tables) {
      try {
        for (const Variant& variant : Variants(table, material)) RunTable(table, variant, index);
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
    WriteReport("ablation", Preface() + AblationMarkdown(all));
  }

 private:
  void RunTable(std::size_t table, const Variant& variant, std::size_t index) {
    AblationRecord record;
    record.table = static_cast<int>(table);
    record.material = variant.name;
    record.material_class = plan_.materials[index].material_class;
    if (table == 2 || table == 4) {
      record.set_up = kMaterialItself;
      record.energy = MeasureEnergy(*variant.brdf);
      Keep(record, index);
    }
    for (std::size_t seed : plan_.seeds) {
      record.seed = seed;
      RunSetUps(SetUps(table, plan_.base), *variant.brdf, record, index);
    }
  }

  // record: names the fits. The last one is done first if it has an energy term: where that had
  // nothing to do, its fit is also that of the set-up before it, the same without the term.
  void RunSetUps(std::vector<SetUp> set_ups, const Brdf& material, AblationRecord record,
                 std::size_t index) {
    const bool is_reversed = set_ups.back().problem.energy_weight > 0.0;
    if (is_reversed) std::reverse(set_ups.begin(), set_ups.end());
    std::vector<AblationRecord> fits;
    bool is_known = false;
    for (const SetUp& set_up : set_ups) {
      record.set_up = set_up.name;
      if (!is_known) {
        const std::optional<EnergySummary> energy = RunFit(material, set_up.problem, &record);
        if (!energy) continue;
        const bool has_acted = energy->rounds > 0 || energy->correction > 0.0;
        is_known = set_up.problem.energy_weight > 0.0 && !has_acted;
      }
      fits.push_back(record);
    }
    if (is_reversed) std::reverse(fits.begin(), fits.end());
    for (const AblationRecord& fit : fits) Keep(fit, index);
  }

  // record: names the fit and takes its measures. None if it failed.
  std::optional<EnergySummary> RunFit(const Brdf& material, FitProblem problem,
                                      AblationRecord* record) {
    const std::string what = StrCat("table ", record->table, ", ", record->material, ", ",
                                    record->set_up, ", seed ", record->seed, ": ");
    problem.samples = FLAGS_samples;
    problem.seed = record->seed;
    if (!material.IsIsotropic()) problem.encoding = EncodingFor(material);
    std::optional<EnergySummary> energy;
    try {
      const Fit fit = FitBrdf(material, problem, plan_.options);
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

  static void Measure(const Brdf& material, const Fit& fit, AblationRecord* record) {
    record->iterations = fit.summary.iterations;
    record->seconds = fit.summary.seconds;
    record->errors =
        MeasureErrors(HeldOutSamples(material, FLAGS_heldout_samples, /*seed=*/1), fit.network);
    record->colors = MeasureColorErrors(HeldOutSamples(material, FLAGS_heldout_samples, /*seed=*/1),
                                        fit.network);
    record->reciprocity = MeasureReciprocity(fit.network);
    record->energy = MeasureEnergy(fit.network);
  }

  void Keep(const AblationRecord& record, std::size_t index) {
    log_.AddRow(AblationCsvRow(record));
    records_[index].push_back(record);
  }

  // How the numbers came about, and what failed.
  std::string Preface() const {
    return StrCat(
        plan_.materials.size(), " materials, seeds ", FLAGS_seeds, ", at most ",
        FLAGS_max_iterations, " iterations and ", FLAGS_max_seconds,
        " s a fit; base of the energy and chromaticity tables: ", FLAGS_base,
        ". Medians are over materials, of each the median of its seeds; worst: of all fits. For "
        "energy, materials that aren't built in are scaled to a largest directional albedo of ",
        FLAGS_scale_to_albedo, ", and built-in ones as they are if theirs is at least ",
        kLowDissipation, "; for all terms, they come both as they are and scaled. ",
        log_.FailuresMarkdown());
  }

  const Plan& plan_;
  FitLog log_;
  std::vector<std::vector<AblationRecord>> records_;  // of each material
};

void Run(const std::vector<std::string>& arguments) {
  const Plan plan = MakePlan(arguments);
  Ablation ablation(plan);
  ForEach(plan.materials.size(), FLAGS_jobs, [&](std::size_t k) { ablation.RunMaterial(k); });
  ablation.Report();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}

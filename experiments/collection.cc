// collection.cc: every material of a collection, fitted with one set-up.
#include <algorithm>
#include <cstdio>

#include "base/text.h"
#include "comparison.h"
#include "experiment.h"
#include "fit_log.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"

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
    R"(collection: every material of a collection, fitted with the default set-up.

  collection --out_dir=results --jobs=2 --threads=1 merl/*.binary
  collection --out_dir=results merl_nbrdf/*.h5 nielsen_nbrdf/*.h5

The arguments are sources, CLASS= in front of them if wanted. Each fit is a row of collection.csv as
soon as it is done; collection.md has them from the least error to the largest, and their medians.
)";

struct Record {
  std::string material, material_class;
  std::size_t seed;
  int iterations;
  double seconds, mean_abs_log_error, hrl, hcl, max_directional_albedo;
};

struct Column {
  const char* name;
  const char* title;
  double Record::*value;
  int digits;
};

constexpr Column kColumns[] = {
    {"seconds", "seconds", &Record::seconds, 3},
    {"mean_abs_log_error", "mean abs log error", &Record::mean_abs_log_error, 3},
    {"hrl", "HRL", &Record::hrl, 3},
    {"hcl", "HCL", &Record::hcl, 3},
    {"max_directional_albedo", "largest directional albedo", &Record::max_directional_albedo, 7}};

std::vector<std::string> CsvHeader() {
  std::vector<std::string> header = {"material", "material_class", "seed", "iterations"};
  for (const Column& column : kColumns) header.push_back(column.name);
  return header;
}

std::vector<std::string> CsvRow(const Record& record) {
  std::vector<std::string> row = {record.material, record.material_class, StrCat(record.seed),
                                  StrCat(record.iterations)};
  for (const Column& column : kColumns) row.push_back(FormatNumber(record.*column.value));
  return row;
}

std::vector<double> Values(const std::vector<Record>& records, const Column& column) {
  std::vector<double> values;
  for (const Record& record : records) values.push_back(record.*column.value);
  return values;
}

std::string Markdown(std::vector<Record> records) {
  std::stable_sort(records.begin(), records.end(), [](const Record& a, const Record& b) {
    return a.mean_abs_log_error < b.mean_abs_log_error;
  });
  std::vector<std::string> titles = {"material", "seed", "iterations"};
  for (const Column& column : kColumns) titles.push_back(column.title);
  Table table(titles);
  for (const Record& record : records) {
    std::vector<std::string> row = {record.material, StrCat(record.seed),
                                    StrCat(record.iterations)};
    for (const auto& column : kColumns)
      row.push_back(Significant(record.*column.value, column.digits));
    table.Add(row);
  }
  std::vector<std::string> median = {"**median**", "", ""}, worst = {"**worst**", "", ""};
  for (const Column& column : kColumns) {
    const std::vector<double> values = Values(records, column);
    median.push_back(Significant(Median(values), column.digits));
    worst.push_back(Significant(*std::max_element(values.begin(), values.end()), column.digits));
  }
  if (records.empty()) return table.Markdown();
  table.Add(median);
  table.Add(worst);
  return table.Markdown();
}

struct Plan {
  std::vector<MaterialSource> materials;
  std::vector<std::size_t> seeds;
  FitProblem problem;
  FitOptions options;
};

Plan MakePlan(const std::vector<std::string>& arguments) {
  Plan plan;
  plan.seeds = ParseCounts("seeds", FLAGS_seeds);
  plan.problem.samples = FLAGS_samples;
  plan.options.max_iterations = FLAGS_max_iterations;
  plan.options.max_seconds = FLAGS_max_seconds;
  plan.options.threads = FLAGS_threads;
  ValidateFit(plan.problem, plan.options);
  if (FLAGS_heldout_samples < 1) Fail("heldout_samples = 0; must be >= 1");
  if (FLAGS_jobs < 1) Fail("jobs = ", FLAGS_jobs, "; must be >= 1");
  if (arguments.empty()) Fail("no material is given; see --help");
  plan.materials = ParseMaterials(arguments);
  return plan;
}

Record FitOne(const Plan& plan, const MaterialSource& material, std::size_t seed) {
  const std::unique_ptr<Brdf> brdf = OpenBrdf(material.source);
  FitProblem problem = plan.problem;
  problem.seed = seed;
  problem.encoding = EncodingFor(*brdf);
  const Fit fit = FitBrdf(*brdf, problem, plan.options);
  const auto [hrl, hcl] = MeasureReciprocity(fit.network);
  return {material.name,
          material.material_class,
          seed,
          fit.summary.iterations,
          fit.summary.seconds,
          MeasureErrors(HeldOutSamples(*brdf, FLAGS_heldout_samples, /*seed=*/1), fit.network)
              .mean_abs_log_error,
          hrl,
          hcl,
          MeasureEnergy(fit.network).max_directional_albedo};
}

class Collection {
 public:
  explicit Collection(const Plan& plan)
      : plan_(plan),
        log_(OutputPath("collection.csv"), CsvHeader()),
        records_(plan.materials.size()) {}

  // Of the plan's materials.
  void RunMaterial(std::size_t index) {
    const MaterialSource& material = plan_.materials[index];
    for (std::size_t seed : plan_.seeds) {
      try {
        Keep(FitOne(plan_, material, seed), index);
      } catch (const Error& error) {
        log_.AddFailure(StrCat(material.name, ", seed ", seed, ": ", error.what()));
      }
    }
  }

  void Report() const {
    std::vector<Record> all;
    for (const auto& of_material : records_) {
      all.insert(all.end(), of_material.begin(), of_material.end());
    }
    WriteReport("collection",
                StrCat(plan_.materials.size(), " materials, seeds ", FLAGS_seeds, ", at most ",
                       FLAGS_max_iterations, " iterations and ", FLAGS_max_seconds, " s a fit. ",
                       log_.FailuresMarkdown(), Markdown(std::move(all))));
  }

 private:
  void Keep(const Record& record, std::size_t index) {
    log_.AddRow(CsvRow(record));
    records_[index].push_back(record);
    std::fprintf(stderr, "%s, seed %zu: %.3g in %.3g s\n", record.material.c_str(), record.seed,
                 record.mean_abs_log_error, record.seconds);
  }

  const Plan& plan_;
  FitLog log_;
  std::vector<std::vector<Record>> records_;  // of each material
};

void Run(const std::vector<std::string>& arguments) {
  const Plan plan = MakePlan(arguments);
  Collection collection(plan);
  ForEach(plan.materials.size(), FLAGS_jobs, [&](std::size_t k) { collection.RunMaterial(k); });
  collection.Report();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}

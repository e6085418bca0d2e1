// prior.cc: how near one comes to a material from few measurements, if one knows a database of others.
#include <cstdio>
#include <map>
#include <numbers>
#include <optional>

#include "base/about.h"
#include "base/median.h"
#include "base/parallel.h"
#include "base/text.h"
#include "experiment.h"
#include "nielsen.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/database/plan.h"
#include "pbnbrdf/database/start_from_prior.h"
#include "pbnbrdf/database/table_components.h"
#include "pbnbrdf/database/train_family.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "sources/source_list.h"
#include "table.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(prior: fits from few measurements, with and without a database of other materials.

  prior --out_dir=results --database='merl/*.h5' --hold_out=5
  prior --out_dir=results --database='merl/*.h5' --measured='cornell/*.brdf;rgl/*.bsdf'

Of the database each --hold_out-th material is left out. It is then measured at few directions, --counts
of them, as planned (pbnbrdf plan), and in a single scan: light from 45 degrees, seen in the plane of
incidence every 5 degrees. Compared are Nielsen's method (2015) with its own directions, the code of a
shared network, the code of principal components, the fit that goes on from that (pbnbrdf fit --prior),
and the fit that knows no other material. The files of --measured are measured at as many of their own
directions, the nearest ones.
)";

struct Options {
  Options() { training.code_size = 32; }

  std::string database, measured;
  int hold_out = 5;
  std::vector<std::string> counts = {"8", "16", "32", "64"};
  int components = 64;
  FamilyOptions training;
  FitProblem problem = FamilyProblem();
  double max_seconds = 20.0;
  std::uint64_t samples = 20000;
  int threads = 0;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.AddRequired(Text("database", &o->database, "its materials, isotropic: a pattern"));
  fields.Add(Text("measured", &o->measured, "files that are measured at few of their directions"));
  fields.Add(Integer("hold_out", &o->hold_out, AtLeast(2),
                     "every so many materials one is held out of the database"));
  fields.Add(Texts("counts", &o->counts, "numbers of measurements"));
  fields.Add(Integer("components", &o->components, Between(1, TablePca::kMaxComponents),
                     "principal components"));
  fields.Add(Integer("code_size", &o->training.code_size, Between(1, WeightFamily::kMaxCodeSize),
                     "numbers of each material in the shared network"));
  fields.Add(Integer("training_iterations", &o->training.max_iterations, AtLeast(0),
                     "maximum number of iterations of the shared network"));
  fields.Add(Integers("hidden", &o->problem.network.hidden, AtLeast(1), "hidden layers"));
  fields.Add(ChoiceOrAuto("encoding", &o->problem.network.encoding, kEncodings, "its inputs"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each fit"));
  fields.Add(Integer("samples", &o->samples, AtLeast(2), "held-out samples of each material"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "0: one for each core"));
  return fields;
}

// What is measured, and where its fits are judged.
struct Subject {
  std::string name;
  std::shared_ptr<const Brdf> material;
  std::vector<BrdfSample> truth;
};

Subject MakeSubject(const std::string& name, std::shared_ptr<const Brdf> material,
                    std::size_t samples) {
  std::vector<BrdfSample> truth = HeldOutSamples(*material, samples, /*seed=*/1);
  return {name, std::move(material), std::move(truth)};
}

// The database without what is held out, and that.
struct Split {
  std::vector<DatabaseMaterial> known;
  std::vector<Subject> held_out;
};

Split SplitOf(const Options& options) {
  const std::vector<std::string> sources = ExpandSources(options.database),
                                 names = NamesOfSources(sources);
  Split split;
  for (std::size_t m = 0; m < sources.size(); ++m) {
    std::shared_ptr<const Brdf> brdf = OpenBrdf(sources[m]);
    if ((m + 1) % static_cast<std::size_t>(options.hold_out) == 0) {
      split.held_out.push_back(MakeSubject(names[m], std::move(brdf), options.samples));
    } else {
      split.known.push_back({names[m], std::move(brdf)});
    }
  }
  return split;
}

// In the plane of incidence, light from 45 degrees.
std::vector<DirectionPair> Scan() {
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::vector<DirectionPair> pairs;
  for (int theta = -80; theta <= 80; theta += 5) {
    pairs.push_back({FromSpherical(45.0 * kDegree, 0.0), FromSpherical(theta * kDegree, 0.0)});
  }
  return pairs;
}

double SquaredDistance(const DirectionPair& a, const DirectionPair& b) {
  const auto x = MirroredPlace(a, true), y = MirroredPlace(b, true);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return sum;
}

// What is measured at the directions; of a list, its measurements nearest to them, each once.
std::vector<BrdfSample> MeasuredAt(const Brdf& material, const std::vector<DirectionPair>& pairs) {
  std::vector<BrdfSample> list = TrainingMeasurements(material);
  if (list.empty()) return SamplesAt(material, pairs);
  std::vector<BrdfSample> chosen;
  for (const DirectionPair& pair : pairs) {
    if (list.empty()) break;
    const auto nearest =
        std::min_element(list.begin(), list.end(), [&](const auto& a, const auto& b) {
          return SquaredDistance(a.pair, pair) < SquaredDistance(b.pair, pair);
        });
    chosen.push_back(*nearest);
    list.erase(nearest);
  }
  return chosen;
}

enum Method { kNielsen, kNetworkCode, kPcaCode, kPcaFit, kPlainFit };
constexpr std::array<const char*, 5> kMethods = {
    "Nielsen's method", "network's code", "components' code", "fit with components", "fit alone"};
using Errors = std::array<double, kMethods.size()>;  // mean absolute log errors, of each method

class Study {
 public:
  explicit Study(const Options& options) : options_(options) {
    Split split = SplitOf(options);
    held_out_ = std::move(split.held_out);
    FamilyOptions training = options.training;
    training.threads = options.threads;
    training.on_iteration = [](const FamilyProgress& progress) {
      if (progress.iteration % 10 == 0) {
        std::fprintf(stderr, "iteration %d, cost %.3g, %.3g s\n", progress.iteration, progress.cost,
                     progress.seconds);
      }
      return true;
    };
    family_ = TrainFamily(split.known, options.problem, training).family;
    pca_ = PrincipalComponents(split.known, options.components);
  }

  void Run() {
    for (const std::string& text : options_.counts) {
      const Plans plans = PlansFor(ParseInteger<int>("counts", text));
      for (const Subject& subject : held_out_) Measure(text + " planned", subject, plans);
    }
    for (const Subject& subject : held_out_) Measure("scan", subject, {Scan(), Scan(), Scan()});
    if (options_.measured.empty()) return;
    std::vector<Subject> files;
    for (const std::string& source : ExpandSources(options_.measured)) {
      files.push_back(MakeSubject(NameOfSource(source), OpenBrdf(source), options_.samples));
    }
    for (const int count : {16, 64}) {
      const Plans plans = PlansFor(count);
      for (const Subject& file : files) Measure(StrCat(count, " of a file"), file, plans);
    }
  }

  std::string Markdown() const {
    Table medians(Columns({"measurements", "materials"},
                          {"fit over Nielsen", "fit over fit alone", "largest of these"}));
    for (const auto& [name, rows] : errors_) medians.Add(MediansRow(name, rows));
    return StrCat(
        "Mean absolute log errors (eq. 6), medians over materials; ratios: their "
        "medians.\n\n",
        medians.Markdown(), "\n", all_.Markdown());
  }

 private:
  // The directions that each way of planning chooses.
  struct Plans {
    std::vector<DirectionPair> nielsen, network, pca;
  };

  static std::vector<std::string> Columns(std::vector<std::string> first,
                                          const std::vector<std::string>& last) {
    first.insert(first.end(), kMethods.begin(), kMethods.end());
    first.insert(first.end(), last.begin(), last.end());
    return first;
  }

  Plans PlansFor(int count) const {
    PlanOptions plan;
    plan.count = count;
    return {NielsenDirections(*pca_, CandidatePairs(plan), count),
            PlanDirections(*family_, {}, plan), PlanDirections(*pca_, {}, plan)};
  }

  static std::vector<std::string> MediansRow(const std::string& name,
                                             const std::vector<Errors>& rows) {
    std::vector<std::string> row = {name, StrCat(rows.size())};
    const auto all = [&](auto value) {
      std::vector<double> values;
      for (const Errors& errors : rows) values.push_back(value(errors));
      return values;
    };
    for (std::size_t k = 0; k < kMethods.size(); ++k) {
      row.push_back(Significant(Median(all([&](const Errors& e) { return e[k]; })), 3));
    }
    const auto over = [&](Method method) {
      return all([=](const Errors& e) { return e[kPcaFit] / e[method]; });
    };
    row.push_back(Significant(Median(over(kNielsen)), 2));
    row.push_back(Significant(Median(over(kPlainFit)), 2));
    const std::vector<double> gains = over(kPlainFit);
    row.push_back(Significant(*std::max_element(gains.begin(), gains.end()), 2));
    return row;
  }

  void Measure(const std::string& kind, const Subject& subject, const Plans& plans) {
    const auto error = [&](const Brdf& fit) {
      return MeasureErrors(subject.truth, fit).mean_abs_log_error;
    };
    const auto measured = [&](const std::vector<DirectionPair>& pairs) {
      ScatteredData data;
      data.kind = "few measurements";
      data.samples = MeasuredAt(*subject.material, pairs);
      return ScatteredBrdf(std::move(data));
    };
    const ScatteredBrdf by_network = measured(plans.network), by_pca = measured(plans.pca);
    Errors errors;
    errors[kNielsen] =
        error(pca_->At(NielsenCode(*pca_, MeasuredAt(*subject.material, plans.nielsen))));
    errors[kNetworkCode] = error(Expected(*family_, by_network));
    errors[kPcaCode] = error(Expected(*pca_, by_pca));
    errors[kPcaFit] = error(FitOf(by_pca, /*with_prior=*/true));
    errors[kPlainFit] = error(FitOf(by_pca, /*with_prior=*/false));
    std::vector<std::string> row = {subject.name, kind};
    for (const double e : errors) row.push_back(Significant(e, 3));
    std::fprintf(stderr, "%s\n", Join(row, "  ").c_str());
    all_.Add(row);
    if (errors_.empty() || errors_.back().first != kind) errors_.push_back({kind, {}});
    errors_.back().second.push_back(errors);
  }

  NeuralBrdf FitOf(const Brdf& few, bool with_prior) const {
    FitProblem problem;
    FitOptions options;
    options.schedule.max_seconds = options_.max_seconds;
    options.threads = options_.threads;
    if (with_prior) StartFromPrior(*pca_, few, &problem, &options);
    return FitBrdf(few, problem, options).network;
  }

  const Options& options_;
  std::vector<Subject> held_out_;
  std::optional<WeightFamily> family_;
  std::optional<TablePca> pca_;
  std::vector<std::pair<std::string, std::vector<Errors>>> errors_;  // of each kind of measurements
  Table all_{Columns({"material", "measurements"}, {})};
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  if (!arguments.empty()) Fail("no arguments are expected: ", arguments.front());
  Study study(options);
  study.Run();
  output.WriteReport("prior", study.Markdown());
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}

// jacobian_cost.cc: what one evaluation with derivatives costs in three ways (jacobian_methods.h).
#include <tbb/task_arena.h>

#include <cstdio>

#include "base/text.h"
#include "experiment.h"
#include "jacobian_methods.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "process.h"

DEFINE_string(material, "builtin:satin-gold", "source of reflectance");
DEFINE_string(samples, "100,300,1000,3000,10000", "numbers of samples");
DEFINE_string(hidden, "8,8 21,21 32,32 64,64", "hidden layers' sizes of each network");
DEFINE_string(shown_hidden, "21,21", "the network of the figure's left half");
DEFINE_uint64(shown_samples, 1000, "the number of samples of its right half");
DEFINE_double(
    most_entries, 7e6,
    "of samples times weights with autodiff; what has more is left out, as it takes long");
DEFINE_double(least_seconds, 0.5, "repeat an evaluation for so long, and take the median");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(jacobian_cost: time and memory of one evaluation of J'J and J'r on one thread, by autodiff jets (a
block a sample), with a dense Jacobian in chunks, and as the condensed block does it.

  jacobian_cost --out_dir=results

Writes jacobian_cost.csv, jacobian_cost.md and jacobian_cost.svg.
)";

struct Cost {
  DerivativeMethod method;
  std::vector<int> hidden;
  int weights;
  std::size_t samples;
  double seconds, megabytes;  // of an evaluation; of the problem and an evaluation

  std::string MethodName() const { return std::string(NameOf(kDerivativeMethods, method)); }
};

FitProblem LogProblem(const std::vector<int>& hidden, std::size_t samples) {
  FitProblem problem;
  problem.hidden = hidden;
  problem.samples = samples;
  problem.energy_weight = 0.0;
  return problem;
}

// Seconds, megabytes: of this process, which does nothing else.
std::vector<double> MeasureHere(DerivativeMethod method, const FitProblem& problem) {
  const std::vector<BrdfSample> samples =
      DrawSamples(*OpenBrdf(FLAGS_material), SampleSet::kTraining, problem.sampling,
                  problem.samples, problem.seed);
  const std::vector<double> weights = InitialWeights(problem.Shape(), samples, problem.seed);
  const std::size_t before = ResidentMemory();
  const Evaluation evaluate = MakeEvaluation(method, problem, samples);
  Linearization at;
  tbb::task_arena one_thread(1);
  const double seconds = MedianSeconds(
      FLAGS_least_seconds, [&] { one_thread.execute([&] { evaluate(weights.data(), &at); }); });
  const std::size_t peak = PeakMemory();
  return {seconds, 1e-6 * static_cast<double>(peak > before ? peak - before : 0)};
}

std::vector<Cost> MeasureAll() {
  const auto networks = ParseNetworks("hidden", FLAGS_hidden);
  const auto counts = ParseCounts("samples", FLAGS_samples);
  std::vector<Cost> costs;
  for (const std::vector<int>& hidden : networks) {
    for (std::size_t samples : counts) {
      const FitProblem problem = LogProblem(hidden, samples);
      problem.Validate();
      const int weights = problem.Shape().num_weights();
      for (const auto& [name, method] : kDerivativeMethods) {
        const double entries = static_cast<double>(samples) * weights;
        if (method == DerivativeMethod::kAutodiff && entries > FLAGS_most_entries) continue;
        const std::vector<double> measured =
            RunInChild([&] { return MeasureHere(method, problem); });
        costs.push_back({method, hidden, weights, samples, measured[0], measured[1]});
        std::fprintf(stderr, "%s, %zu samples, %s: %.3g ms\n", HiddenName(hidden).c_str(), samples,
                     std::string(name).c_str(), 1e3 * measured[0]);
      }
    }
  }
  return costs;
}

Table CsvTable(const std::vector<Cost>& costs) {
  Table table({"hidden", "weights", "samples", "method", "seconds", "megabytes"});
  for (const Cost& cost : costs) {
    table.Add({HiddenName(cost.hidden), StrCat(cost.weights), StrCat(cost.samples),
               cost.MethodName(), FormatNumber(cost.seconds), FormatNumber(cost.megabytes)});
  }
  return table;
}

// A row for each network and number of samples.
Table MarkdownTable(const std::vector<Cost>& costs) {
  Table table({"hidden", "weights", "samples", "autodiff, ms", "dense, ms", "condensed, ms",
               "autodiff, MB", "dense, MB", "condensed, MB"});
  for (const Cost& last : costs) {
    if (last.method != DerivativeMethod::kCondensed) continue;
    std::vector<std::string> row = {HiddenName(last.hidden),
                                    StrCat(last.weights),
                                    StrCat(last.samples),
                                    "-",
                                    "-",
                                    "-",
                                    "-",
                                    "-",
                                    "-"};
    for (const Cost& cost : costs) {
      if (cost.hidden != last.hidden || cost.samples != last.samples) continue;
      const std::size_t column = 3 + static_cast<std::size_t>(cost.method);
      row[column] = Significant(1e3 * cost.seconds, 3);
      row[column + 3] = Significant(cost.megabytes, 3);
    }
    table.Add(row);
  }
  return table;
}

// A line for each method; `x` and `y` of the costs that `shows` accepts.
template <typename Shows, typename X, typename Y>
std::vector<Series> Lines(const std::vector<Cost>& costs, Shows shows, X x, Y y) {
  std::vector<Series> lines;
  for (const auto& [name, method] : kDerivativeMethods) {
    Series line;
    line.label = name;
    for (const Cost& cost : costs) {
      if (cost.method == method && shows(cost)) line.points.emplace_back(x(cost), y(cost));
    }
    lines.push_back(line);
  }
  return lines;
}

Figure MakeFigure(const std::vector<Cost>& costs) {
  const std::vector<int> hidden = ParseNetworks("shown_hidden", FLAGS_shown_hidden)[0];
  const auto of_network = [&](const Cost& cost) { return cost.hidden == hidden; };
  const auto of_samples = [](const Cost& cost) { return cost.samples == FLAGS_shown_samples; };
  const auto samples = [](const Cost& cost) { return static_cast<double>(cost.samples); };
  const auto weights = [](const Cost& cost) { return static_cast<double>(cost.weights); };
  const auto milliseconds = [](const Cost& cost) { return 1e3 * cost.seconds; };
  const auto megabytes = [](const Cost& cost) { return std::max(cost.megabytes, 0.1); };
  const std::string network = StrCat(HiddenName(hidden), " hidden units, one thread");
  const std::string number = StrCat(FLAGS_shown_samples, " samples, one thread");
  const std::string time = "One evaluation, ms", memory = "Peak memory, MB";
  return {{{network, "Samples", time, Lines(costs, of_network, samples, milliseconds)},
           {number, "Weights", time, Lines(costs, of_samples, weights, milliseconds)},
           {network, "Samples", memory, Lines(costs, of_network, samples, megabytes)},
           {number, "Weights", memory, Lines(costs, of_samples, weights, megabytes)}}};
}

void Run(const std::vector<std::string>&) {
  const std::vector<Cost> costs = MeasureAll();
  WriteFile(OutputPath("jacobian_cost.csv"), CsvTable(costs).Csv());
  WriteReport("jacobian_cost", MarkdownTable(costs).Markdown());
  WriteFigure("jacobian_cost", MakeFigure(costs));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}

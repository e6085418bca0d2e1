// scaling.cc: how the time of a fit's evaluations, and a fit's memory, grow.
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdio>

#include "base/text.h"
#include "experiment.h"
#include "flops.h"
#include "matrix_product.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/problem/objective.h"
#include "pbnbrdf/residuals/log_residual.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "process.h"

DEFINE_string(material, "builtin:satin-gold", "source of reflectance");
DEFINE_string(samples, "1e3,1e4,1e5,1e6", "numbers of samples, also of the fits");
DEFINE_string(threads, "1,2", "numbers of threads; those that the machine lacks are left out");
DEFINE_string(hidden, "8,8 21,21 32,32", "hidden layers' sizes of each network");
DEFINE_string(fit_hidden, "21,21", "of the fits whose memory is measured");
DEFINE_int32(fit_iterations, 3, "of these fits, each with all samples");
DEFINE_double(least_seconds, 0.5, "repeat an evaluation for so long, and take the median");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(scaling: time of one evaluation, with J'J and J'r (Linearize) and without derivatives (Cost), over
numbers of samples, threads and weights, as a part of the machine's own rate of matrix products;
and the peak memory of whole fits, each in a process of its own.

  scaling --out_dir=results

Writes scaling.csv, scaling_memory.csv, scaling.md and scaling.svg.
)";

struct Timing {
  std::vector<int> hidden;
  int weights;
  std::size_t samples, threads;
  double linearize_seconds, cost_seconds;
  double gflops, of_product;                 // of Linearize; of the product's rate on all threads
  double linearize_speed_up, cost_speed_up;  // over the first number of threads
};

struct FitMemory {
  std::size_t samples;
  double megabytes;
};

// All samples from the first iteration on.
FitProblem MakeProblem(const std::vector<int>& hidden, std::size_t samples) {
  FitProblem problem;
  problem.hidden = hidden;
  problem.samples = samples;
  problem.first_samples = samples;
  problem.Validate();
  return problem;
}

std::vector<int> FitNetwork() { return ParseNetworks("fit_hidden", FLAGS_fit_hidden)[0]; }

std::vector<FitMemory> MeasureMemory(const std::vector<std::size_t>& counts) {
  std::vector<FitMemory> memory;
  for (std::size_t samples : counts) {
    const auto fit = [&] {
      FitOptions options;
      options.max_iterations = FLAGS_fit_iterations;
      FitBrdf(*OpenBrdf(FLAGS_material), MakeProblem(FitNetwork(), samples), options);
      return std::vector<double>{static_cast<double>(PeakMemory())};
    };
    memory.push_back({samples, 1e-6 * RunInChild(fit)[0]});
    std::fprintf(stderr, "fit with %zu samples: %.0f MB\n", samples, memory.back().megabytes);
  }
  return memory;
}

// The numbers of --threads that the machine has.
std::vector<std::size_t> Threads() {
  std::vector<std::size_t> threads;
  const auto most = static_cast<std::size_t>(tbb::info::default_concurrency());
  for (std::size_t count : ParseCounts("threads", FLAGS_threads)) {
    if (count <= most) threads.push_back(count);
  }
  if (threads.empty()) Fail("threads: the machine has ", most);
  return threads;
}

Timing Measure(Objective* objective, const std::vector<double>& weights, std::size_t threads) {
  const NetworkShape& shape = objective->shape();
  tbb::task_arena arena(static_cast<int>(threads));
  Linearization at;
  Timing timing;
  timing.hidden = shape.hidden();
  timing.weights = shape.num_weights();
  timing.samples = objective->num_samples();
  timing.threads = threads;
  arena.execute([&] { objective->Linearize(weights.data(), &at); });  // fills caches and buffers
  timing.linearize_seconds = MedianSeconds(FLAGS_least_seconds, [&] {
    arena.execute([&] { objective->Linearize(weights.data(), &at); });
  });
  timing.cost_seconds = MedianSeconds(
      FLAGS_least_seconds, [&] { arena.execute([&] { objective->Cost(weights.data()); }); });
  const double flops = HessianFlops(shape) + PassFlops(shape, LogResidual::kNumResiduals);
  timing.gflops = 1e-9 * flops * static_cast<double>(timing.samples) / timing.linearize_seconds;
  timing.of_product = timing.gflops / (static_cast<double>(threads) * MatrixProductRate());
  return timing;
}

std::vector<Timing> MeasureTimes(const std::vector<std::size_t>& counts) {
  const std::vector<BrdfSample> samples =
      DrawSamples(*OpenBrdf(FLAGS_material), SampleSet::kTraining, FitProblem().sampling,
                  *std::max_element(counts.begin(), counts.end()), /*seed=*/1);
  std::vector<Timing> timings;
  for (const std::vector<int>& hidden : ParseNetworks("hidden", FLAGS_hidden)) {
    for (std::size_t count : counts) {
      FitProblem problem = MakeProblem(hidden, count);
      problem.energy_weight = 0.0;  // it isn't over the samples
      const auto objective = MakeObjective(problem, std::span(samples).first(count));
      const std::vector<double> weights = InitialWeights(problem.Shape(), samples, problem.seed);
      const std::size_t first = timings.size();
      for (std::size_t threads : Threads()) {
        Timing timing = Measure(objective.get(), weights, threads);
        const Timing& base = timings.size() > first ? timings[first] : timing;
        timing.linearize_speed_up = base.linearize_seconds / timing.linearize_seconds;
        timing.cost_speed_up = base.cost_seconds / timing.cost_seconds;
        timings.push_back(timing);
        std::fprintf(stderr, "%s, %zu samples, %zu threads: %.3g ms\n", HiddenName(hidden).c_str(),
                     count, threads, 1e3 * timing.linearize_seconds);
      }
    }
  }
  return timings;
}

Table CsvTable(const std::vector<Timing>& timings) {
  Table table({"hidden", "weights", "samples", "threads", "linearize_seconds", "cost_seconds",
               "gflops", "product_gflops_per_core", "of_product", "linearize_speed_up",
               "cost_speed_up"});
  for (const Timing& t : timings) {
    table.Add({HiddenName(t.hidden), StrCat(t.weights), StrCat(t.samples), StrCat(t.threads),
               FormatNumber(t.linearize_seconds), FormatNumber(t.cost_seconds),
               FormatNumber(t.gflops), FormatNumber(MatrixProductRate()),
               FormatNumber(t.of_product), FormatNumber(t.linearize_speed_up),
               FormatNumber(t.cost_speed_up)});
  }
  return table;
}

Table MarkdownTable(const std::vector<Timing>& timings) {
  Table table({"hidden", "weights", "samples", "threads", "Linearize, ms", "speed-up", "GFLOP/s",
               "of matrix product", "Cost, ms", "speed-up"});
  for (const Timing& t : timings) {
    table.Add({HiddenName(t.hidden), StrCat(t.weights), StrCat(t.samples), StrCat(t.threads),
               Significant(1e3 * t.linearize_seconds, 3), Significant(t.linearize_speed_up, 3),
               Significant(t.gflops, 3), Significant(t.of_product, 2),
               Significant(1e3 * t.cost_seconds, 3), Significant(t.cost_speed_up, 3)});
  }
  return table;
}

Table MemoryTable(const std::vector<FitMemory>& memory, const std::string& column) {
  Table table({"samples", column});
  for (const FitMemory& m : memory) table.Add({StrCat(m.samples), Significant(m.megabytes, 3)});
  return table;
}

// A line for each network and number of threads, these in the order of the networks; value of a
// timing against its samples.
template <typename Value>
std::vector<Series> Lines(const std::vector<Timing>& timings, Value value) {
  std::vector<Series> lines;
  for (const Timing& t : timings) {
    const std::string label =
        StrCat(HiddenName(t.hidden), ", ", t.threads, t.threads == 1 ? " thread" : " threads");
    auto line = std::find_if(lines.begin(), lines.end(),
                             [&](const Series& series) { return series.label == label; });
    if (line == lines.end()) {
      line = lines.insert(lines.end(), Series{label, {}, t.threads > 1, HiddenName(t.hidden)});
    }
    line->points.emplace_back(t.samples, value(t));
  }
  return lines;
}

Figure MakeFigure(const std::vector<Timing>& timings, const std::vector<FitMemory>& memory) {
  Series fits;
  fits.label = HiddenName(FitNetwork());
  for (const FitMemory& m : memory) fits.points.emplace_back(m.samples, m.megabytes);
  return {{{"With J'J and J'r (Linearize)", "Samples", "Time, ms",
            Lines(timings, [](const Timing& t) { return 1e3 * t.linearize_seconds; })},
           {"Without derivatives (Cost)", "Samples", "Time, ms",
            Lines(timings, [](const Timing& t) { return 1e3 * t.cost_seconds; })},
           {"Linearize", "Samples", "Part of the matrix product's rate",
            Lines(timings, [](const Timing& t) { return t.of_product; }), /*log_y=*/false},
           {"A whole fit", "Samples", "Peak memory, MB", {fits}, /*log_y=*/false}}};
}

void Run(const std::vector<std::string>&) {
  const std::vector<std::size_t> counts = ParseCounts("samples", FLAGS_samples);
  const std::vector<FitMemory> memory = MeasureMemory(counts);  // first: it starts processes
  const std::vector<Timing> timings = MeasureTimes(counts);
  WriteFile(OutputPath("scaling.csv"), CsvTable(timings).Csv());
  WriteFile(OutputPath("scaling_memory.csv"), MemoryTable(memory, "peak_megabytes").Csv());
  WriteReport("scaling", StrCat("One core's matrix products: ", Significant(MatrixProductRate(), 3),
                                " GFLOP/s.\n\n", MarkdownTable(timings).Markdown(),
                                "\nPeak memory of a fit, its whole process:\n\n",
                                MemoryTable(memory, "peak memory, MB").Markdown()));
  WriteFigure("scaling", MakeFigure(timings, memory));
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}

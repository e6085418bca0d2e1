#include <pbnbrdf/models/builtin.h>
#include <pbnbrdf/solve/fit.h>
#include <iostream>

int main(int argc, char** argv) {
  const auto material = pbnbrdf::MakeBuiltin("satin-gold");
  pbnbrdf::FitProblem problem;
  problem.sampling.samples = 2000;
  pbnbrdf::FitOptions options;
  options.schedule.max_iterations = 20;
  const pbnbrdf::Fit fit = pbnbrdf::FitBrdf(*material, problem, options);
  fit.network.Write(argc > 1 ? argv[1] : "gold.safetensors");
  std::cout << fit.network.Description() << ", " << fit.summary.seconds << " s\n";
}

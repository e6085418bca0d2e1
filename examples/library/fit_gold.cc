#include <pbnbrdf/solve/fit.h>
#include <pbnbrdf/sources/open_brdf.h>
#include <iostream>

int main(int argc, char** argv) {
  const auto material = pbnbrdf::OpenBrdf("builtin:satin-gold");
  pbnbrdf::FitProblem problem;
  problem.samples = 2000;
  const pbnbrdf::Fit fit = pbnbrdf::FitBrdf(*material, problem, {.max_iterations = 20});
  fit.network.Write(argc > 1 ? argv[1] : "gold.safetensors");
  std::cout << fit.network.Description() << ", " << fit.summary.seconds << " s\n";
}

#include <iostream>
#include <pbnbrdf/network/open_brdf.h>
#include <pbnbrdf/solve/fit.h>

int main(int argc, char** argv) {
  const auto material = pbnbrdf::OpenBrdf("builtin:satin-gold");
  pbnbrdf::FitProblem problem;
  problem.samples = 2000;
  const pbnbrdf::Fit fit = pbnbrdf::FitBrdf(*material, problem, {.max_iterations = 20});
  fit.network.Write(argc > 1 ? argv[1] : "gold.safetensors");
  std::cout << fit.network.Description() << ", " << fit.summary.seconds << " s\n";
}

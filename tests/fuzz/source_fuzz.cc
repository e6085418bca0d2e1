// Any file as a material: it is refused, or its values are finite and not negative.
#include "fuzz_input.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "sources/collection_file.h"

// HDF5 asks for as much memory as a damaged file says, copes with getting none, and doesn't give all of it back.
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace pbnbrdf {
namespace {

void CheckValues(const Brdf& brdf) {
  std::vector<DirectionPair> pairs;
  for (const double theta_i : {0.0, 0.3, 0.9, 1.5, 1.7}) {
    for (const double theta_o : {0.0, 0.31, 1.2, 1.57}) {
      for (const double phi_o : {0.0, 2.0, 3.14159}) {
        pairs.push_back({FromSpherical(theta_i, 0.4), FromSpherical(theta_o, phi_o)});
      }
    }
  }
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    for (const double value : values[n]) {
      Expect(std::isfinite(value) && value >= 0.0, "a value is finite and not negative");
    }
    Expect(brdf.Certainty(pairs[n]) > 0.0, "certainty is positive");
    brdf.IsKnown(pairs[n]);
  }
}

void CheckMeasurements(const Brdf& brdf) {
  for (const BrdfSample& sample : brdf.Measurements()) {
    Expect(sample.pair.AboveHorizon(), "a measurement is above the horizon");
    Expect(sample.weight > 0.0 && sample.weight <= 1.0, "a weight is in (0, 1]");
    for (const double value : sample.value) Expect(std::isfinite(value), "a measurement is finite");
  }
}

// The file, or its first material if it holds several.
std::string SourceOf(const std::string& path) {
  if (!LooksLikeCollection(ReadStart(path, 1 << 12))) return path;
  return StrCat(path, "#", MaterialNames(path).front());
}

}  // namespace
}  // namespace pbnbrdf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const pbnbrdf::FuzzFile file(data, size);
  pbnbrdf::MayRefuse([&] {
    const auto brdf = pbnbrdf::OpenBrdf(pbnbrdf::SourceOf(file.path()));
    pbnbrdf::CheckValues(*brdf);
    pbnbrdf::CheckMeasurements(*brdf);
    if (const auto estimate = brdf->BestEstimate(pbnbrdf::Brdf::Estimate::kLikeliest)) {
      pbnbrdf::CheckValues(*estimate);
    }
  });
  return 0;
}

// Sources as RGL files: at the measured incident angles they are what they were, and spectra are the colours.
#include "brdf/direction_pairs.h"
#include "export/formats.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/sources/rgl.h"

namespace pbnbrdf {
namespace {

// Pairs whose wi is at a node of the file, wo above 80 degrees.
std::vector<DirectionPair> PairsAtNodes(const RglBrdf& file, bool isotropic, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<DirectionPair> pairs;
  for (const DirectionPair& any : RandomPairs(4000, seed)) {
    const std::vector<double> angles = file.IncidentAngles();
    const double theta = angles[random() % angles.size()];
    const double phi = isotropic ? std::atan2(any.wi.y, any.wi.x) : double(random() % 16) / 8 * kPi;
    if (any.wo.z > 0.17) pairs.push_back({FromSpherical(theta, phi), any.wo});
  }
  return pairs;
}

// The mean difference of log(1 + f cos).
double Error(const Brdf& a, const Brdf& b, const std::vector<DirectionPair>& pairs) {
  std::vector<Rgb> values[2];
  const Brdf* of[2] = {&a, &b};
  for (int k = 0; k < 2; ++k) {
    values[k].resize(pairs.size());
    of[k]->Evaluate(pairs, values[k]);
  }
  double sum = 0.0;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum += std::abs(std::log1p(values[0][n][c] * pairs[n].wi.z) -
                      std::log1p(values[1][n][c] * pairs[n].wi.z));
    }
  }
  return sum / (3.0 * double(pairs.size()));
}

RglBrdf Written(const std::string& bytes) {
  TemporaryFolder folder;
  WriteBytes(folder / "a.bsdf", bytes);
  return RglBrdf::Read(folder / "a.bsdf");
}

TEST(RglFile, HoldsTheSourceAtItsNodes) {
  for (const char* name :
       {"wall-plaster", "satin-gold", "glossy-grey-paper", "brushed-copper", "rolled-brass"}) {
    const auto source = MakeBuiltin(name);
    const RglBrdf file = Written(RglFile(*source));
    EXPECT_EQ(file.IsIsotropic(), source->IsIsotropic());
    EXPECT_EQ(file.IncidentAngles().size(), 7u);
    const double error = Error(*source, file, PairsAtNodes(file, source->IsIsotropic(), 1));
    EXPECT_LT(error, 1e-3) << name;
    RecordProperty(name, std::to_string(error));
  }
}

TEST(RglFile, SpectraAreSeenAsTheColors) {
  const auto gold = MakeBuiltin("satin-gold");
  const RglBrdf rgb = Written(RglFile(*gold)), spectral = Written(SpectralRglFile(*gold));
  EXPECT_EQ(rgb.wavelengths().size(), 0u);
  EXPECT_EQ(spectral.wavelengths().size(), 16u);
  EXPECT_LT(Error(rgb, spectral, RandomPairs(2000, 3)), 1e-6);
}

TEST(RglFile, BlackIsBlack) {
  const NetworkShape shape(Encoding::kMerl, {5}, Activation::kTanh);
  const NeuralBrdf black(shape, std::vector<double>(shape.num_weights(), 0.0));
  const RglBrdf file = Written(RglFile(black));
  EXPECT_EQ(Error(black, file, RandomPairs(100, 2)), 0.0);
}

}  // namespace
}  // namespace pbnbrdf

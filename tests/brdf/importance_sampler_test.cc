#include "pbnbrdf/brdf/importance_sampler.h"

#include <numeric>

#include "brdf/direction_pairs.h"
#include "brdf/half_vector_cells.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/merl.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

constexpr double kThetas[] = {0.0, 0.4, 0.9, 1.3, 1.5};

struct Draws {
  std::vector<Vec3> wo;
  std::vector<double> pdf;
};

Draws DrawFor(const ImportanceSampler& sampler, const Vec3& wi, std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<std::array<double, 2>> u(count);
  for (auto& pair : u) {
    pair[0] = uniform(random);
    pair[1] = uniform(random);
  }
  Draws draws{std::vector<Vec3>(count), std::vector<double>(count)};
  sampler.Sample(std::vector<Vec3>(count, wi), u, draws.wo, draws.pdf);
  return draws;
}

double PdfAt(const ImportanceSampler& sampler, const DirectionPair& pair) {
  double pdf;
  sampler.Pdf({&pair, 1}, {&pdf, 1});
  return pdf;
}

struct NamedProposal {
  std::string name;
  Proposal proposal;
};

const std::vector<NamedProposal>& Proposals() {
  static const std::vector<NamedProposal> proposals = [] {
    std::vector<NamedProposal> all = {{"white", FitProposal(LambertBrdf({0.5, 0.5, 0.5}))},
                                      {"blue-plastic", FitProposal(*MakeBuiltin("blue-plastic"))}};
    for (LobeWidths alpha : {LobeWidths(0.001), LobeWidths(0.02), LobeWidths(0.1), LobeWidths(0.5),
                             LobeWidths(1.0), LobeWidths(0.05, 0.4), LobeWidths(0.9, 0.2)}) {
      all.push_back({alpha.Description(), FitProposal(GgxBrdf({1, 1, 1}, alpha))});
    }
    return all;
  }();
  return proposals;
}

// A cell of a division of the hemisphere, with midpoint rules inside of each.
struct Histogram {
  static constexpr int kRows = 16, kColumns = 48, kInside = 12;

  // Of the point (s, t) of the unit square, s, t in [0, 1).
  static int Cell(double s, double t) {
    return std::min(static_cast<int>(s * kRows), kRows - 1) * kColumns +
           std::min(static_cast<int>(t * kColumns), kColumns - 1);
  }

  // The integrals of a function of (s, t) over each cell.
  template <typename Function>
  static std::vector<double> Integrate(Function function) {
    std::vector<double> cells(kRows * kColumns);
    const int rows = kRows * kInside, columns = kColumns * kInside;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const double s = (i + 0.5) / rows, t = (j + 0.5) / columns;
        cells[Cell(s, t)] += function(s, t) / (rows * columns);
      }
    }
    return cells;
  }
};

// How many standard deviations chi-square is above its mean, as a normal variable (Wilson and
// Hilferty); cells that expect little are counted together.
double ChiSquareDeviation(const std::vector<double>& probabilities, const std::vector<int>& counts,
                          double total) {
  double chi2 = 0.0, rare_expected = 0.0, rare_count = 0.0;
  int cells = 0;
  const auto add = [&](double expected, double count) {
    chi2 += (count - expected) * (count - expected) / expected;
    ++cells;
  };
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double expected = probabilities[k] * total;
    if (expected >= 10.0) {
      add(expected, counts[k]);
    } else {
      rare_expected += expected;
      rare_count += counts[k];
    }
  }
  if (rare_expected >= 10.0) add(rare_expected, rare_count);
  const double freedom = cells - 1.0, scale = 2.0 / (9.0 * freedom);
  return (std::cbrt(chi2 / freedom) - (1.0 - scale)) / std::sqrt(scale);
}

constexpr std::size_t kDraws = 200000;

// Over theta_o and phi_o; lobes must not be narrower than a cell. claimed: whose density is tested.
double DeviationOverDirections(const ImportanceSampler& sampler, const ImportanceSampler& claimed,
                               const Vec3& wi) {
  const auto probabilities = Histogram::Integrate([&](double s, double t) {
    const double theta = 0.5 * kPi * s;
    return PdfAt(claimed, {wi, FromSpherical(theta, 2 * kPi * t)}) * std::sin(theta) * kPi * kPi;
  });
  std::vector<int> counts(probabilities.size());
  const Draws draws = DrawFor(sampler, wi, kDraws, /*seed=*/21);
  for (std::size_t n = 0; n < kDraws; ++n) {
    if (draws.pdf[n] == 0.0) continue;
    const Vec3& wo = draws.wo[n];
    const double phi = std::atan2(wo.y, wo.x);
    ++counts[Histogram::Cell(std::acos(wo.z) / (0.5 * kPi),
                             (phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi))];
  }
  return ChiSquareDeviation(probabilities, counts, kDraws);
}

// Over the proposal's own cells of half vectors, s over the rings and t all around, so that any width fills them. A
// cell of the histogram has whole cells of the proposal.
class OverHalfVectors {
 public:
  OverHalfVectors(const ImportanceSampler& sampler, const Vec3& wi)
      : sampler_(sampler),
        wi_(wi),
        cells_(sampler.proposal()),
        axis_(HalfVectorCells::Axis(sampler.proposal(), wi)) {}

  std::vector<double> Probabilities() const {
    return Histogram::Integrate([&](double s, double t) {
      const double phi = kPi * (2.0 * t - 1.0);
      Vec3 h = cells_.At(s, cells_.V(std::cos(phi), std::sin(phi)));
      const double sine = std::hypot(h.x, h.y);
      h = FromFrame(axis_, {sine * std::cos(phi), sine * std::sin(phi), h.z});
      const double cos_d = Dot(wi_, h);
      const Vec3 wo = Reflected(wi_, h);
      if (cos_d <= 0.0 || wo.z <= 0.0) return 0.0;
      return PdfAt(sampler_, {wi_, wo}) * 4.0 * cos_d / cells_.Density(OneMinusCosine(h));
    });
  }

  std::vector<int> Counts(const Draws& draws) const {
    std::vector<int> counts(Histogram::kRows * Histogram::kColumns);
    for (std::size_t n = 0; n < draws.wo.size(); ++n) {
      if (draws.pdf[n] == 0.0) continue;
      const Vec3 sum = wi_ + draws.wo[n];
      const Vec3 h = FromFrame({axis_.x, -axis_.y, 0.0}, (1.0 / Length(sum)) * sum);
      ++counts[Histogram::Cell(cells_.U(OneMinusCosine(h)),
                               0.5 + std::atan2(h.y, h.x) / (2.0 * kPi))];
    }
    return counts;
  }

 private:
  const ImportanceSampler& sampler_;
  Vec3 wi_;
  HalfVectorCells cells_;
  Vec3 axis_;
};

// All but the draws that are lost below the horizon.
TEST(ImportanceSampler, DensityIntegratesToOne) {
  double worst = 0.0, most_lost = 0.0;
  for (const auto& [name, proposal] : Proposals()) {
    const ImportanceSampler sampler(proposal);
    for (double theta : kThetas) {
      const Vec3 wi = FromSpherical(theta, 0.7);
      const std::vector<double> cells = OverHalfVectors(sampler, wi).Probabilities();
      const double sum = std::accumulate(cells.begin(), cells.end(), 0.0);
      const std::vector<double> pdf = DrawFor(sampler, wi, kDraws, /*seed=*/20).pdf;
      const double lost = double(std::count(pdf.begin(), pdf.end(), 0.0)) / kDraws;
      EXPECT_NEAR(sum, 1.0 - lost, 3e-3) << name << ", " << theta;
      worst = std::max(worst, std::abs(sum + lost - 1.0));
      most_lost = std::max(most_lost, lost);
    }
  }
  EXPECT_LT(most_lost, 0.1);
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("most_lost", std::to_string(most_lost));
}

TEST(ImportanceSampler, SamplesHaveTheDensity) {
  for (const auto& [name, proposal] : Proposals()) {
    const ImportanceSampler sampler(proposal);
    for (double theta : {0.0, 0.4, 0.9, 1.3}) {
      for (double phi : {0.7, 3.3, 5.9}) {
        const Vec3 wi = FromSpherical(theta, phi);
        const OverHalfVectors over(sampler, wi);
        const Draws draws = DrawFor(sampler, wi, kDraws, /*seed=*/22);
        const double deviation =
            ChiSquareDeviation(over.Probabilities(), over.Counts(draws), kDraws);
        EXPECT_LT(deviation, 4.0) << name << ", " << theta << ", " << phi;
      }
    }
  }
}

TEST(ImportanceSampler, TheChiSquareTestSeesADensityThatIsOff) {
  const ImportanceSampler sampler(GgxBrdf({1, 1, 1}, 0.5));
  const Vec3 wi = FromSpherical(0.9, 0.7);
  EXPECT_LT(DeviationOverDirections(sampler, sampler, wi), 4.0);
  EXPECT_GT(DeviationOverDirections(sampler, ImportanceSampler(GgxBrdf({1, 1, 1}, 0.56)), wi), 4.0);
}

TEST(ImportanceSampler, SamplesAreUnitAboveTheHorizonWithTheirPdf) {
  for (const auto& [name, proposal] : Proposals()) {
    const ImportanceSampler sampler(proposal);
    for (double theta : {0.0, 1.0, 1.57}) {
      const Vec3 wi = FromSpherical(theta, 2.0);
      const Draws draws = DrawFor(sampler, wi, 2000, /*seed=*/23);
      for (std::size_t n = 0; n < draws.wo.size(); ++n) {
        ASSERT_NEAR(Length(draws.wo[n]), 1.0, 1e-9) << name;
        ASSERT_EQ(draws.pdf[n] > 0.0, draws.wo[n].z > 0.0) << name;
        ASSERT_TRUE(std::isfinite(draws.pdf[n])) << name;
        ASSERT_EQ(draws.pdf[n], PdfAt(sampler, {wi, draws.wo[n]})) << name;
      }
    }
  }
}

TEST(ImportanceSampler, ZeroBelowTheHorizon) {
  const ImportanceSampler sampler(LambertBrdf({0.5, 0.5, 0.5}));
  const Vec3 up = {0, 0, 1}, down = {0.6, 0, -0.8}, along = {1, 0, 0};
  for (const Vec3& w : {down, along}) {
    EXPECT_EQ(PdfAt(sampler, {up, w}), 0.0);
    EXPECT_EQ(PdfAt(sampler, {w, up}), 0.0);
    EXPECT_THAT(DrawFor(sampler, w, 3, /*seed=*/1).pdf, testing::Each(0.0));
  }
}

TEST(ImportanceSampler, ChecksItsProposal) {
  const auto error = [](auto change) {
    Proposal proposal = {.cosine_share = {0.5f}, .cells = {0.25f, 0.75f}};
    change(&proposal);
    return ErrorOf([&] { ImportanceSampler sampler(proposal); });
  };
  EXPECT_EQ(error([](Proposal*) {}), "");
  EXPECT_THAT(error([](Proposal* p) { p->sectors = 3; }), HasSubstr("an even number of sectors"));
  EXPECT_THAT(error([](Proposal* p) { p->spread = 0.0; }), HasSubstr("spread = 0"));
  EXPECT_THAT(error([](Proposal* p) { p->cosine_share = {1.5f}; }), HasSubstr("cosine_share: 1.5"));
  EXPECT_THAT(error([](Proposal* p) { p->cosine_share = {}; }), HasSubstr("0 numbers, not 1"));
  EXPECT_THAT(error([](Proposal* p) { p->cells = {1.0f}; }), HasSubstr("cells: 1 numbers, not 2"));
  EXPECT_THAT(error([](Proposal* p) { p->cells = {0.5f, 0.75f}; }), HasSubstr("sum is 1.25"));
  EXPECT_THAT(error([](Proposal* p) { p->cells[0] = std::nanf(""); }), HasSubstr("cells: nan"));
}

// Mean and variance of f cos_o / p of the green channel.
struct Estimate {
  double mean = 0.0, variance = 0.0;
};

Estimate EstimateAlbedo(const Brdf& brdf, const ImportanceSampler& sampler, const Vec3& wi) {
  constexpr std::size_t kCount = 40000;
  const Draws draws = DrawFor(sampler, wi, kCount, /*seed=*/24);
  std::vector<DirectionPair> pairs;
  for (const Vec3& wo : draws.wo) pairs.push_back({wi, wo});
  std::vector<Rgb> values(kCount);
  brdf.Evaluate(pairs, values);
  Estimate estimate;
  double squares = 0.0;
  for (std::size_t n = 0; n < kCount; ++n) {
    const double weight = draws.pdf[n] > 0.0 ? values[n][1] * draws.wo[n].z / draws.pdf[n] : 0.0;
    estimate.mean += weight / kCount;
    squares += weight * weight / kCount;
  }
  estimate.variance = squares - estimate.mean * estimate.mean;
  return estimate;
}

// The variance by quadrature of cosine sampling: samples of it may miss a narrow lobe altogether.
double CosineVariance(const Brdf& brdf, const Vec3& wi, double albedo) {
  double squares = 0.0;
  for (const AlbedoNode& node : AlbedoQuadrature(200, 100).Nodes(wi)) {
    Rgb f;
    brdf.Evaluate({&node.pair, 1}, {&f, 1});
    squares += node.weight * f[1] * f[1] * kPi;
  }
  return squares - albedo * albedo;
}

// Returns the least ratio of the variances of cosine sampling and of ours.
double LeastGain(const Brdf& brdf, const std::string& name) {
  const ImportanceSampler sampler(brdf);
  double least = std::numeric_limits<double>::infinity();
  for (double theta : {0.1, 0.7, 1.2}) {
    const Vec3 wi = FromSpherical(theta, 0.4);
    const double albedo = DirectionalAlbedo(brdf, wi, 200, 100)[1];
    const Estimate ours = EstimateAlbedo(brdf, sampler, wi);
    EXPECT_NEAR(ours.mean, albedo, 5 * std::sqrt(ours.variance / 40000) + 1e-3 * albedo)
        << name << ", " << theta;
    least = std::min(least, CosineVariance(brdf, wi, albedo) / ours.variance);
  }
  testing::Test::RecordProperty(name, StrCat("gain ", least));
  return least;
}

TEST(ImportanceSampler, VarianceIsAFractionOfThatOfCosineSampling) {
  // About a quarter of what they are.
  const std::pair<const char*, double> kLeastGains[] = {
      {"silver-mirror", 2500000}, {"polished-chromium", 35000}, {"brushed-copper", 300},
      {"satin-gold", 40},         {"blue-plastic", 10},         {"white-ceramic-tile", 20},
      {"rolled-brass", 100},      {"brushed-aluminium", 25},    {"rolled-aluminium", 300}};
  for (const auto& [name, gain] : kLeastGains) {
    EXPECT_GT(LeastGain(*MakeBuiltin(name), name), gain) << name;
  }
}

TEST(ImportanceSampler, TablesHaveProposalsToo) {
  const MerlBrdf table = MerlBrdf::Tabulate(GgxBrdf({0.9, 0.8, 0.5}, 0.02));
  EXPECT_GT(LeastGain(table, "table"), 10000);
}

TEST(FitProposal, FindsTheWidthOfTheLobe) {
  for (double alpha : {0.001, 0.01, 0.2}) {
    const Proposal proposal = FitProposal(GgxBrdf({1, 1, 1}, alpha));
    EXPECT_GT(proposal.spread, 0.01 * alpha * alpha) << alpha;
    EXPECT_LT(proposal.spread, 0.1 * alpha * alpha) << alpha;
    EXPECT_LT(*std::max_element(proposal.cosine_share.begin(), proposal.cosine_share.end()), 0.3);
  }
}

TEST(FitProposal, DiffuseMaterialsNeedTheCosineOnly) {
  EXPECT_THAT(FitProposal(LambertBrdf({0.5, 0.5, 0.5})).cosine_share, testing::Each(1.0f));
  EXPECT_THAT(FitProposal(LambertBrdf({0.0, 0.0, 0.0})).cosine_share, testing::Each(1.0f));
}

TEST(FitProposal, ValuesThatArentFiniteAreRefused) {
  class Bad final : public Brdf {
   public:
    void EvaluateUnclipped(std::span<const DirectionPair>, std::span<Rgb> values) const override {
      std::fill(values.begin(), values.end(), Rgb{std::nan(""), 1, 1});
    }
    std::string Description() const override { return "bad"; }
  };
  EXPECT_THAT(ErrorOf([] { FitProposal(Bad()); }), HasSubstr("isn't finite"));
}

}  // namespace
}  // namespace pbnbrdf

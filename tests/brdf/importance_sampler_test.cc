#include "pbnbrdf/brdf/importance_sampler.h"

#include "brdf/direction_pairs.h"
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

std::vector<LobeProposal> Proposals() {
  std::vector<LobeProposal> proposals;
  for (double weight : {0.0, 0.5, 1.0}) {
    for (LobeWidths alpha : {LobeWidths(0.01), LobeWidths(0.1), LobeWidths(0.5), LobeWidths(1.0),
                             LobeWidths(0.05, 0.4), LobeWidths(0.9, 0.2)}) {
      proposals.push_back({alpha, weight});
    }
  }
  return proposals;
}

std::string Show(const LobeProposal& p) {
  return StrCat(p.alpha.Description(), ", weight ", p.lobe_weight);
}

// A cell of a division of the hemisphere, with midpoint rules inside of each.
struct Histogram {
  static constexpr int kRows = 20, kColumns = 40, kInside = 12;

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
  for (const Vec3& wo : DrawFor(sampler, wi, kDraws, /*seed=*/21).wo) {
    const double phi = std::atan2(wo.y, wo.x);
    ++counts[Histogram::Cell(std::acos(wo.z) / (0.5 * kPi),
                             (phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi))];
  }
  return ChiSquareDeviation(probabilities, counts, kDraws);
}

// Over the half vector: s = r / (1 + r), r = tan^2 theta_h / alpha^2 in the lobe's own frame, so
// that any width fills the cells.
double DeviationOverHalfVectors(const ImportanceSampler& sampler, const Vec3& wi) {
  const LobeWidths alpha = sampler.proposal().alpha;
  const auto probabilities = Histogram::Integrate([&](double s, double t) {
    const double r = s / (1.0 - s), phi = 2 * kPi * t;
    const double x = alpha.x * std::sqrt(r) * std::cos(phi);
    const double y = alpha.y * std::sqrt(r) * std::sin(phi);
    const double cos_h = 1.0 / std::sqrt(1.0 + x * x + y * y);
    const Vec3 h = {x * cos_h, y * cos_h, cos_h};
    const double cos_d = Dot(wi, h);
    const Vec3 wo = 2.0 * cos_d * h - wi;
    if (cos_d <= 0.0 || wo.z <= 0.0) return 0.0;
    // dwo = 4 cos_d dwh, dwh = cos^3 dx dy, dx dy = alpha_x alpha_y / 2 dr dphi, dr = ds / (1 -
    // s)^2
    const double jacobian = 4.0 * cos_d * cos_h * cos_h * cos_h * alpha.x * alpha.y * kPi;
    return PdfAt(sampler, {wi, wo}) * jacobian / ((1.0 - s) * (1.0 - s));
  });
  std::vector<int> counts(probabilities.size());
  for (const Vec3& wo : DrawFor(sampler, wi, kDraws, /*seed=*/22).wo) {
    const Vec3 h = wi + wo;
    const double x = h.x / (h.z * alpha.x), y = h.y / (h.z * alpha.y), r = x * x + y * y;
    const double phi = std::atan2(y, x);
    ++counts[Histogram::Cell(r / (1.0 + r), (phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi))];
  }
  return ChiSquareDeviation(probabilities, counts, kDraws);
}

TEST(ImportanceSampler, DensityIntegratesToOne) {
  const AlbedoQuadrature quadrature(200, 200);
  double worst = 0.0;
  for (const LobeProposal& proposal : Proposals()) {
    const ImportanceSampler sampler(proposal);
    for (double theta : kThetas) {
      double sum = 0.0;
      for (const AlbedoNode& node : quadrature.Nodes(FromSpherical(theta, 0.7))) {
        sum += node.weight / node.pair.wo.z * PdfAt(sampler, node.pair);
      }
      EXPECT_NEAR(sum, 1.0, 2e-3) << Show(proposal) << ", " << theta;
      worst = std::max(worst, std::abs(sum - 1.0));
    }
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(ImportanceSampler, SamplesHaveTheDensity) {
  for (const LobeProposal& proposal : Proposals()) {
    if (std::min(proposal.alpha.x, proposal.alpha.y) < 0.2 && proposal.lobe_weight > 0) continue;
    const ImportanceSampler sampler(proposal);
    for (double theta : kThetas) {
      const Vec3 wi = FromSpherical(theta, 0.7);
      EXPECT_LT(DeviationOverDirections(sampler, sampler, wi), 4.0)
          << Show(proposal) << ", " << theta;
    }
  }
}

TEST(ImportanceSampler, SamplesOfNarrowLobesHaveTheDensity) {
  for (LobeWidths alpha : {LobeWidths(0.001), LobeWidths(0.02), LobeWidths(0.005, 0.05)}) {
    const ImportanceSampler sampler(LobeProposal{alpha, 1.0});
    for (double theta : {0.0, 0.4, 0.9, 1.3}) {
      EXPECT_LT(DeviationOverHalfVectors(sampler, FromSpherical(theta, 0.7)), 4.0)
          << alpha.Description() << ", " << theta;
    }
  }
}

TEST(ImportanceSampler, TheChiSquareTestSeesADensityThatIsOff) {
  const ImportanceSampler sampler(LobeProposal{0.5, 0.5});
  const Vec3 wi = FromSpherical(0.9, 0.7);
  EXPECT_GT(DeviationOverDirections(sampler, ImportanceSampler(LobeProposal{0.56, 0.5}), wi), 4.0);
  EXPECT_GT(DeviationOverDirections(sampler, ImportanceSampler(LobeProposal{0.5, 0.56}), wi), 4.0);
}

TEST(ImportanceSampler, SamplesAreUnitAboveTheHorizonWithTheirPdf) {
  for (const LobeProposal& proposal : Proposals()) {
    const ImportanceSampler sampler(proposal);
    for (double theta : {0.0, 1.0, 1.57}) {
      const Vec3 wi = FromSpherical(theta, 2.0);
      const Draws draws = DrawFor(sampler, wi, 2000, /*seed=*/23);
      for (std::size_t n = 0; n < draws.wo.size(); ++n) {
        ASSERT_NEAR(Length(draws.wo[n]), 1.0, 1e-9) << Show(proposal);
        ASSERT_GT(draws.wo[n].z, 0.0) << Show(proposal);
        ASSERT_GT(draws.pdf[n], 0.0) << Show(proposal);
        ASSERT_EQ(draws.pdf[n], PdfAt(sampler, {wi, draws.wo[n]})) << Show(proposal);
      }
    }
  }
}

TEST(ImportanceSampler, ZeroBelowTheHorizon) {
  const ImportanceSampler sampler(LobeProposal{});
  const Vec3 up = {0, 0, 1}, down = {0.6, 0, -0.8}, along = {1, 0, 0};
  for (const Vec3& w : {down, along}) {
    EXPECT_EQ(PdfAt(sampler, {up, w}), 0.0);
    EXPECT_EQ(PdfAt(sampler, {w, up}), 0.0);
    EXPECT_THAT(DrawFor(sampler, w, 3, /*seed=*/1).pdf, testing::Each(0.0));
  }
}

TEST(ImportanceSampler, ChecksItsProposal) {
  const auto error = [](const LobeProposal& proposal) {
    return ErrorOf([&] { ImportanceSampler sampler(proposal); });
  };
  EXPECT_EQ(error({}), "");
  EXPECT_THAT(error({0.0, 0.5}), HasSubstr("alpha_x = 0; must be 0.0001 to 1"));
  EXPECT_THAT(error({{0.1, 2.0}, 0.5}), HasSubstr("alpha_y = 2; must be"));
  EXPECT_THAT(error({0.1, 1.5}), HasSubstr("lobe_weight = 1.5; must be 0 to 1"));
  EXPECT_THAT(error({0.1, std::nan("")}), HasSubstr("lobe_weight = nan"));
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
    const double weight = values[n][1] * draws.wo[n].z / draws.pdf[n];
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
  testing::Test::RecordProperty(name, StrCat(Show(sampler.proposal()), ", gain ", least));
  return least;
}

TEST(ImportanceSampler, VarianceIsAFractionOfThatOfCosineSampling) {
  // About a quarter of what they are.
  const std::pair<const char*, double> kLeastGains[] = {
      {"silver-mirror", 100000}, {"polished-chromium", 5000}, {"brushed-copper", 100},
      {"satin-gold", 30},        {"blue-plastic", 80},        {"white-ceramic-tile", 20},
      {"rolled-brass", 25},      {"brushed-aluminium", 15},   {"rolled-aluminium", 50}};
  for (const auto& [name, gain] : kLeastGains) {
    EXPECT_GT(LeastGain(*MakeBuiltin(name), name), gain) << name;
  }
}

TEST(ImportanceSampler, TablesHaveProposalsToo) {
  const MerlBrdf table = MerlBrdf::Tabulate(GgxBrdf({0.9, 0.8, 0.5}, 0.02));
  EXPECT_GT(LeastGain(table, "table"), 1500);
}

TEST(FitLobeProposal, FindsTheWidthOfTheLobe) {
  for (LobeWidths alpha : {LobeWidths(0.01), LobeWidths(0.2)}) {
    const LobeProposal fit = FitLobeProposal(GgxBrdf({1, 1, 1}, alpha));
    EXPECT_NEAR(fit.alpha.x / alpha.x, 1.0, 0.1);
    EXPECT_EQ(fit.alpha.x, fit.alpha.y);
    EXPECT_GT(fit.lobe_weight, 0.9);
  }
  const LobeProposal fit = FitLobeProposal(GgxBrdf({1, 1, 1}, {0.05, 0.3}));
  EXPECT_NEAR(fit.alpha.x / 0.05, 1.0, 0.1);
  EXPECT_NEAR(fit.alpha.y / 0.3, 1.0, 0.1);
}

TEST(FitLobeProposal, DiffuseMaterialsNeedNoLobe) {
  EXPECT_LT(FitLobeProposal(LambertBrdf({0.5, 0.5, 0.5})).lobe_weight, 0.01);
  EXPECT_EQ(FitLobeProposal(LambertBrdf({0.0, 0.0, 0.0})).lobe_weight, 0.0);
}

TEST(FitLobeProposal, ValuesThatArentFiniteAreRefused) {
  class Bad final : public Brdf {
   public:
    void EvaluateUnclipped(std::span<const DirectionPair>, std::span<Rgb> values) const override {
      std::fill(values.begin(), values.end(), Rgb{std::nan(""), 1, 1});
    }
    std::string Description() const override { return "bad"; }
  };
  EXPECT_THAT(ErrorOf([] { FitLobeProposal(Bad()); }), HasSubstr("isn't finite"));
}

}  // namespace
}  // namespace pbnbrdf

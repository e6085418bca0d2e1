// Every analytic model: reciprocity, signs, and the limits that its formula has.
#include "brdf/direction_pairs.h"
#include "brdf/value_at.h"
#include "models/facets.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {
namespace {

constexpr Vec3 kNormal = {0.0, 0.0, 1.0};

double RedAt(const std::string& text, const DirectionPair& pair) {
  return ValueAt(AnalyticBrdf::FromText(text), pair)[0];
}

double Albedo(const std::string& text, double theta_i) {
  return DirectionalAlbedo(AnalyticBrdf::FromText(text), FromSpherical(theta_i, 0.3), 256, 128)[0];
}

// Parameters that keep no part of the formula silent.
const char* const kTexts[] = {
    "lambert:rho_d=0.5/0.3/0.1",
    "oren_nayar:rho_d=0.5/0.3/0.1,sigma=0.6",
    "phong:rho_d=0.2,rho_s=0.5,n=40,rho_s_2=0.1,n_2=1000",
    "blinn_phong:rho_d=0.2,rho_s=0.5,n=40,rho_s_2=0.1,n_2=1000",
    "lafortune:rho_s=0.5,c_x=-0.9,c_y=-0.8,c_z=0.7,n=9,c_xy_2=0.5,c_z_2=0.5,n_2=4",
    "ward:rho_d=0.2,rho_s=0.3,alpha_x=0.05,alpha_y=0.2,alpha_2=0.4",
    "ward_duer:rho_d=0.2,rho_s=0.3,alpha_x=0.05,alpha_y=0.2,alpha_2=0.4",
    "ward_bounded:rho_d=0.2,rho_s=0.3,alpha_x=0.05,alpha_y=0.2,alpha_2=0.4",
    "cook_torrance:rho_d=0.2,f0=0.9/0.5/0.04,alpha_x=0.05,alpha_y=0.3,alpha_2=0.4,f0_2=0.1",
    "ggx:rho_d=0.2,f0=0.9/0.5/0.04,alpha_x=0.05,alpha_y=0.3,alpha_2=0.4,f0_2=0.1",
    "abc:rho_d=0.2,rho_s=3,f0=0.5,b=1e4,c=1.5,rho_s_2=1,b_2=10,c_2=0.5",
    "disney:base_color=0.8/0.4/0.1,metallic=0.3,subsurface=0.4,specular=0.7,specular_tint=0.3,"
    "roughness=0.4,anisotropic=0.6,sheen=0.5,sheen_tint=0.4,clearcoat=0.7,clearcoat_gloss=0.8",
    "principled:base_color=0.8/0.4/0.1,metallic=0.3,roughness=0.4,anisotropy=0.6,specular=0.7,"
    "specular_color=1.5/1/0.5,coat=0.6,coat_roughness=0.2,sheen_color=0.5/0.3/"
    "0.1,sheen_roughness=0.4"};

TEST(AnalyticModels, EachIsTestedHere) {
  std::vector<std::string> tested, known;
  for (const char* text : kTexts) tested.push_back(Split(text, ':')[0]);
  for (const AnalyticModel& model : AnalyticModels()) known.emplace_back(model.name);
  EXPECT_THAT(tested, testing::UnorderedElementsAreArray(known));
}

TEST(AnalyticModels, AreReciprocalNonNegativeAndFinite) {
  const std::vector<DirectionPair> pairs = HardAndRandomPairs(2000, /*seed=*/11);
  for (const char* text : kTexts) {
    const AnalyticBrdf brdf = AnalyticBrdf::FromText(text);
    int positive = 0;
    for (const DirectionPair& pair : pairs) {
      const Rgb there = ValueAt(brdf, pair), back = ValueAt(brdf, Swapped(pair));
      for (int c = 0; c < 3; ++c) {
        ASSERT_GE(there[c], 0.0) << text;
        ASSERT_LE(there[c], Brdf::kLargestValue) << text;
        ASSERT_NEAR(there[c], back[c], 1e-11 * there[c]) << text;
        positive += there[c] > 0.0;
      }
    }
    EXPECT_GT(positive, 3000) << text;
  }
}

TEST(AnalyticModels, AreIsotropicOrNotAsTheySay) {
  int anisotropic = 0;
  for (const char* text : kTexts) {
    const AnalyticBrdf brdf = AnalyticBrdf::FromText(text);
    double largest_change = 0.0;
    for (const DirectionPair& pair : RandomPairs(1000, /*seed=*/12)) {
      const double f = ValueAt(brdf, pair)[0], turned = ValueAt(brdf, Turned(pair, 1.0))[0];
      if (f > 1e-9) largest_change = std::max(largest_change, std::abs(turned - f) / f);
    }
    if (brdf.IsIsotropic()) {
      EXPECT_LT(largest_change, 1e-7) << text;
    } else {
      EXPECT_GT(largest_change, 0.05) << text;
      ++anisotropic;
    }
  }
  EXPECT_EQ(anisotropic, 8);
}

TEST(AnalyticModels, LobesAddUp) {
  const std::string first = "rho_s=0.5,n=40", second = "rho_s=0.1,n=1000";
  for (const DirectionPair& pair : RandomPairs(200, /*seed=*/13)) {
    const double sum = RedAt("phong:" + first, pair) + RedAt("phong:" + second, pair);
    EXPECT_NEAR(RedAt("phong:" + first + ",rho_s_2=0.1,n_2=1000", pair), sum, 1e-12 * sum);
  }
}

TEST(AnalyticModels, TheClassesHaveTheFormulasValues) {
  const WardBrdf ward({0.1, 0.2, 0.3}, {0.3, 0.2, 0.1}, {0.05, 0.2});
  const GgxBrdf ggx({0.9, 0.5, 0.1}, {0.05, 0.2});
  const auto expect_same = [](const Brdf& brdf, const std::string& text) {
    const AnalyticBrdf model = AnalyticBrdf::FromText(text);
    for (const DirectionPair& pair : HardAndRandomPairs(200, /*seed=*/14)) {
      const Rgb a = ValueAt(brdf, pair), b = ValueAt(model, pair);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-12 * a[c]) << text;
    }
  };
  expect_same(ward, "ward_bounded:rho_d=0.1/0.2/0.3,rho_s=0.3/0.2/0.1,alpha_x=0.05,alpha_y=0.2");
  expect_same(ggx, "ggx:f0=0.9/0.5/0.1,alpha_x=0.05,alpha_y=0.2");
}

// The diffuse parts.
TEST(AnalyticModels, DiffuseLimits) {
  for (const DirectionPair& pair : RandomPairs(100, /*seed=*/15)) {
    EXPECT_NEAR(RedAt("lambert:rho_d=0.4", pair), 0.4 / kPi, 1e-15);
    EXPECT_NEAR(RedAt("oren_nayar:rho_d=0.4,sigma=0", pair), 0.4 / kPi, 1e-15);
    for (const char* model : {"phong", "blinn_phong", "lafortune", "ward", "ward_duer",
                              "ward_bounded", "cook_torrance", "ggx", "abc"}) {
      EXPECT_NEAR(RedAt(StrCat(model, ":rho_d=0.4,rho_s=0"), pair), 0.4 / kPi, 1e-15) << model;
    }
  }
  // sigma = 0.5: a = 1 - 0.5 * 0.25 / 0.58, b = 0.45 * 0.25 / 0.34; retroreflection at 60 degrees.
  const Vec3 w = FromSpherical(kPi / 3, 1.0);
  const double a = 1.0 - 0.125 / 0.58, b = 0.1125 / 0.34, c = 0.75 / 0.5;
  EXPECT_NEAR(RedAt("oren_nayar:rho_d=1,sigma=0.5", {w, w}), (a + b * c) / kPi, 1e-14);
}

TEST(Phong, NormalisedAndBounded) {
  for (const char* n : {"0.5", "10", "300"}) {
    const std::string text = StrCat("phong:rho_s=0.7,n=", n);
    EXPECT_NEAR(Albedo(text, 0.0), 0.7, 1e-4) << n;
    for (double theta : {0.5, 1.0, 1.5}) EXPECT_LT(Albedo(text, theta), 0.7) << n;
    EXPECT_NEAR(Albedo(StrCat("blinn_phong:rho_s=0.7,n=", n), 0.0), 0.7, 1e-4) << n;
  }
  // In the mirror direction the cosine is 1, at any incidence.
  const DirectionPair mirror = {FromSpherical(1.2, 0.4), FromSpherical(1.2, 0.4 + kPi)};
  EXPECT_NEAR(RedAt("phong:n=1000", mirror), 1002 / (2 * kPi), 1e-9);
}

TEST(Phong, BlinnsExponentOfFourIsPhongsOfOneNearTheMirror) {
  // The angle to the mirror direction is about twice theta_h.
  const DirectionPair pair = {kNormal, FromSpherical(0.02, 0.0)};
  const double phong = RedAt("phong:n=100", pair) / RedAt("phong:n=100", {kNormal, kNormal});
  const double blinn =
      RedAt("blinn_phong:n=400", pair) / RedAt("blinn_phong:n=400", {kNormal, kNormal});
  EXPECT_NEAR(phong, blinn, 1e-4);
  EXPECT_LT(phong, 0.99);
}

TEST(Lafortune, IsPhongWhereItsFactorsAreTheMirrors) {
  for (const DirectionPair& pair : HardAndRandomPairs(300, /*seed=*/16)) {
    const double f = RedAt("phong:rho_s=0.4,n=25", pair);
    EXPECT_NEAR(RedAt("lafortune:rho_s=0.4,c_xy=-1,c_z=1,n=25", pair), f, 1e-11 * f + 1e-30);
  }
}

TEST(Lafortune, PositiveFactorsAreRetroreflective) {
  const std::string retro = "lafortune:c_xy=1,c_z=1,n=20";
  const Vec3 w = FromSpherical(0.8, 0.2);
  EXPECT_NEAR(RedAt(retro, {w, w}), 22 / (2 * kPi), 1e-12);
  EXPECT_LT(RedAt(retro, {w, {-w.x, -w.y, w.z}}), 1e-6);
}

TEST(Ward, VariantsDifferByTheirCosines) {
  const std::string parameters = "rho_s=0.3,alpha_x=0.1,alpha_y=0.4";
  for (const DirectionPair& pair : RandomPairs(300, /*seed=*/17)) {
    const double ward = RedAt("ward:" + parameters, pair);
    const double f = ward / std::sqrt(pair.wi.z * pair.wo.z);
    EXPECT_NEAR(RedAt("ward_duer:" + parameters, pair), f, 1e-12 * f + 1e-30);
  }
  for (double theta : {0.0, 0.5, 1.4}) {  // the mirror direction: h = n, |wi + wo| = 2 cos
    const DirectionPair mirror = {FromSpherical(theta, 0.1), FromSpherical(theta, 0.1 + kPi)};
    const double peak = 0.3 / (4 * kPi * 0.04 * std::pow(std::cos(theta), 2));
    EXPECT_NEAR(RedAt("ward_bounded:" + parameters, mirror), peak, 1e-9 * peak);
    EXPECT_NEAR(RedAt("ward_duer:" + parameters, mirror), peak, 1e-9 * peak);
  }
}

TEST(Ward, OriginalLosesWhatTheBoundedOneKeeps) {
  EXPECT_NEAR(Albedo("ward:rho_s=1,alpha=0.05", 0.0), 1.0, 0.01);
  EXPECT_LT(Albedo("ward:rho_s=1,alpha=0.05", 1.35), 0.5);
  EXPECT_GT(Albedo("ward_duer:rho_s=1,alpha=0.2", 1.55), 1.1);
  for (double theta : {0.0, 0.8, 1.45}) {
    EXPECT_LE(Albedo("ward_bounded:rho_s=1,alpha=0.2", theta), 1.0 + 1e-6);
  }
}

// The integral of D cos theta_h over the half vectors, by the midpoint rule in s = tan^2 theta_h =
// alpha^2 t / (1 - t): cos dwh = ds dphi cos^4 / 2.
template <typename Distribution>
double ProjectedArea(Distribution distribution, double alpha) {
  double sum = 0.0;
  constexpr int kSteps = 4000;
  for (int k = 0; k < kSteps; ++k) {
    const double t = (k + 0.5) / kSteps, tan2 = alpha * alpha * t / (1.0 - t);
    const double cos2 = 1.0 / (1.0 + tan2);
    const Vec3 h = FromSpherical(std::atan(std::sqrt(tan2)), 0.0);
    const double jacobian = alpha * alpha / ((1.0 - t) * (1.0 - t)) / kSteps;
    sum += distribution(ReflectionGeometry({h, h})) * kPi * cos2 * cos2 * jacobian;
  }
  return sum;
}

TEST(Microfacets, DistributionsAreNormalised) {
  for (double alpha : {0.01, 0.3, 1.0}) {
    EXPECT_NEAR(
        ProjectedArea([&](const ReflectionGeometry& g) { return GgxDistribution(g, alpha, alpha); },
                      alpha),
        1.0, 1e-6);
    EXPECT_NEAR(
        ProjectedArea(
            [&](const ReflectionGeometry& g) { return BeckmannDistribution(g, alpha, alpha); },
            alpha),
        1.0, 1e-4);
  }
}

TEST(Microfacets, ValuesAtNormalIncidence) {
  // D(0) / 4 = 1 / (4 pi alpha_x alpha_y), nothing masked, F = f0.
  const DirectionPair pair = {kNormal, kNormal};
  const double peak = 0.6 / (4 * kPi * 0.02 * 0.3);
  EXPECT_NEAR(RedAt("ggx:f0=0.6,alpha_x=0.02,alpha_y=0.3", pair), peak, 1e-12 * peak);
  EXPECT_NEAR(RedAt("cook_torrance:f0=0.6,alpha_x=0.02,alpha_y=0.3", pair), peak, 1e-12 * peak);
}

TEST(Microfacets, FresnelIsAllAtGrazingIncidence) {
  const double theta = kPi / 2 - 1e-6;
  const DirectionPair grazing = {FromSpherical(theta, 0.0), FromSpherical(theta, kPi)};
  for (const char* model : {"ggx", "cook_torrance", "abc"}) {
    const double dark = RedAt(StrCat(model, ":f0=0.04"), grazing);
    const double white = RedAt(StrCat(model, ":f0=1"), grazing);
    EXPECT_GT(white, 0.0) << model;
    EXPECT_NEAR(dark / white, 1.0, 1e-4) << model;
  }
}

TEST(Microfacets, NarrowLobesReflectAll) {
  for (const char* model : {"ggx", "cook_torrance"}) {
    for (double theta : {0.0, 1.0}) {
      EXPECT_NEAR(Albedo(StrCat(model, ":alpha=0.01"), theta), 1.0, 5e-3) << model << theta;
    }
    for (double theta : {0.0, 0.7, 1.3, 1.5}) {
      EXPECT_LT(Albedo(StrCat(model, ":alpha=0.5"), theta), 1.0 + 1e-6) << model << theta;
    }
  }
}

TEST(Microfacets, VCavitiesMaskAtGrazingAngles) {
  // Eq. of the first angle that is masked: 2 cos theta_h cos theta_o < cos theta_d.
  EXPECT_EQ(VCavities(ReflectionGeometry({kNormal, kNormal})), 1.0);
  const DirectionPair pair = {kNormal, FromSpherical(1.4, 0.0)};
  EXPECT_NEAR(VCavities(ReflectionGeometry(pair)),
              2 * std::cos(0.7) * std::cos(1.4) / std::cos(0.7), 1e-14);
}

TEST(Abc, CurveHasItsHeightAndTail) {
  const std::string text = "abc:rho_s=5,f0=1,b=1000,c=1.5";
  const double theta_h = 0.1;
  const auto retro = [](double theta) {
    return DirectionPair{FromSpherical(theta, 0.0), FromSpherical(theta, 0.0)};
  };
  EXPECT_NEAR(RedAt(text, retro(0.0)), 5.0, 1e-12);
  const double cos_h = std::cos(theta_h);
  EXPECT_NEAR(RedAt(text, retro(theta_h)),
              5.0 / std::pow(1.0 + 1000 * (1.0 - cos_h), 1.5) / (cos_h * cos_h), 1e-9);
}

TEST(Disney, DiffuseIsLambertsAtNormalIncidenceAndRetroreflectsIfRough) {
  const std::string dull = "disney:base_color=0.6,specular=0,roughness=";
  const DirectionPair normal = {kNormal, kNormal};
  EXPECT_NEAR(RedAt(dull + "1", normal), 0.6 / kPi, 1e-9);
  const Vec3 w = FromSpherical(1.45, 0.0);
  // Fd90 = 0.5 + 2 roughness cos^2 theta_d: 2.5 when rough, 0.5 when smooth.
  const double grazing = std::pow(1.0 - std::cos(1.45), 5);
  EXPECT_NEAR(RedAt(dull + "1", {w, w}), 0.6 / kPi * std::pow(1 + 1.5 * grazing, 2), 1e-9);
  EXPECT_NEAR(RedAt(dull + "0", {w, w}), 0.6 / kPi * std::pow(1 - 0.5 * grazing, 2), 1e-3);
}

TEST(Disney, MetalIsGgxButForItsMasking) {
  // roughness 1: the masking's width ((1 + 1) / 2)^2 is the lobe's, too.
  for (const DirectionPair& pair : RandomPairs(300, /*seed=*/18)) {
    const double f = RedAt("ggx:f0=0.7,alpha=1", pair);
    EXPECT_NEAR(RedAt("disney:base_color=0.7,metallic=1,roughness=1", pair), f, 1e-11 * f);
  }
  const DirectionPair normal = {kNormal, kNormal};
  const double peak = 0.7 / (4 * kPi * 0.0625);  // alpha = roughness^2 = 0.25
  EXPECT_NEAR(RedAt("disney:base_color=0.7,metallic=1,roughness=0.5", normal), peak, 1e-12 * peak);
}

TEST(Disney, SpecularOfADielectricIsEightHundredthsOfIt) {
  const DirectionPair normal = {kNormal, kNormal};
  const double without = RedAt("disney:specular=0,roughness=0.5", normal);
  const double with = RedAt("disney:specular=0.5,roughness=0.5", normal);
  EXPECT_NEAR(with - without, 0.04 / (4 * kPi * 0.0625), 1e-12);
}

TEST(Disney, ClearcoatDistributionIsNormalised) {
  // Normal incidence: f = 0.25 clearcoat 0.04 D G1(wo) / (4 cos_o); D from it, integrated.
  const std::string coat =
      "disney:base_color=0,specular=0,roughness=1,clearcoat_gloss=0,clearcoat=";
  const auto distribution = [&](const ReflectionGeometry& g) {
    const double theta_h = std::acos(std::min(1.0, g.cos_h));
    const DirectionPair pair = {FromSpherical(theta_h, 0.0), FromSpherical(theta_h, 0.0)};
    const double f = RedAt(coat + "1", pair) - RedAt(coat + "0", pair);
    const double masking = GgxMasking(pair.wi, 0.25, 0.25) * GgxMasking(pair.wo, 0.25, 0.25);
    return f * 4.0 * pair.wi.z * pair.wo.z / (0.25 * 0.04 * masking);
  };
  // D falls as 1 / tan^2 and so has much of its area at wide angles.
  EXPECT_NEAR(ProjectedArea(distribution, 0.1), 1.0, 2e-3);
}

TEST(Disney, SheenIsThereAtGrazingAnglesOnly) {
  const std::string cloth = "disney:base_color=0.2,specular=0,roughness=1,sheen=";
  const DirectionPair normal = {kNormal, kNormal};
  EXPECT_EQ(RedAt(cloth + "1", normal), RedAt(cloth + "0", normal));
  const DirectionPair grazing = {FromSpherical(1.5, 0.0), FromSpherical(1.5, kPi)};
  const double schlick = std::pow(1.0 - std::cos(1.5), 5);
  EXPECT_NEAR(RedAt(cloth + "1", grazing) - RedAt(cloth + "0", grazing), schlick, 1e-9);
}

TEST(Principled, MetalIsGgx) {
  for (const DirectionPair& pair : RandomPairs(300, /*seed=*/19)) {
    // alpha_y = roughness^2, alpha_x = alpha_y + (1 - alpha_y) anisotropy^2.
    const double f = RedAt("ggx:f0=0.7,alpha_x=0.4375,alpha_y=0.25", pair);
    EXPECT_NEAR(RedAt("principled:base_color=0.7,metallic=1,roughness=0.5,anisotropy=0.5", pair), f,
                1e-11 * f);
  }
}

TEST(Principled, DielectricIsDiffuseUnderItsFacets) {
  for (const DirectionPair& pair : RandomPairs(300, /*seed=*/20)) {
    EXPECT_NEAR(RedAt("principled:base_color=0.6,specular=0", pair), 0.6 / kPi, 1e-12);
    const double facets = RedAt("ggx:f0=0.06,alpha=0.25", pair);
    const double fresnel = SchlickFresnel(0.06, ReflectionGeometry(pair).cos_d);
    EXPECT_NEAR(
        RedAt("principled:base_color=0.6,roughness=0.5,specular=0.5,specular_color=1.5", pair),
        0.6 / kPi * (1.0 - 0.5 * fresnel) + 0.5 * facets, 1e-11);
  }
}

TEST(Principled, CoatTakesWhatItReflectsFromWhatIsUnder) {
  for (const DirectionPair& pair : RandomPairs(300, /*seed=*/21)) {
    const double fresnel = SchlickFresnel(0.04, ReflectionGeometry(pair).cos_d);
    const double coat = RedAt("ggx:f0=0.04,alpha=0.04", pair);
    EXPECT_NEAR(RedAt("principled:base_color=0.6,specular=0,coat=0.5,coat_roughness=0.2", pair),
                0.6 / kPi * (1.0 - 0.5 * fresnel) + 0.5 * coat, 1e-11);
  }
}

TEST(Principled, SheenKeepsTheEnergyOfAWhiteBase) {
  for (const char* roughness : {"0", "0.3", "0.6", "1"}) {
    for (double theta : {0.0, 0.8, 1.4}) {
      const std::string text = "principled:base_color=1,specular=0,sheen_roughness=";
      const double albedo = Albedo(StrCat(text, roughness, ",sheen_color=1"), theta);
      EXPECT_LT(albedo, 1.005) << roughness << " " << theta;
      EXPECT_GT(albedo, 0.5) << roughness << " " << theta;
    }
  }
  const DirectionPair grazing = {FromSpherical(1.4, 0.0), FromSpherical(1.4, kPi / 2)};
  const std::string cloth = "principled:base_color=0,specular=0,sheen_color=";
  EXPECT_EQ(RedAt(cloth + "0", grazing), 0.0);
  EXPECT_GT(RedAt(cloth + "1", grazing), 0.1);
}

}  // namespace
}  // namespace pbnbrdf

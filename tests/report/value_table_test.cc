#include "report/value_table.h"

#include <half.h>

#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "report/base64.h"
#include "report/light_set.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

TEST(ValueTable, HoldsTheMaterialAtTheCentresOfItsTexels) {
  const auto material = OpenBrdf("builtin:satin-gold");
  const ValueTableSize size = {16, 8, 4};
  const std::vector<std::uint16_t> table = ValueTable(*material, size);
  ASSERT_EQ(table.size(), 3u * 16 * 8 * 4);
  int above = 0;
  for (int p = 0; p < size.phi_d; ++p) {
    for (int d = 0; d < size.theta_d; ++d) {
      for (int h = 0; h < size.theta_h; ++h) {
        const double u = (h + 0.5) / size.theta_h;
        const DirectionPair pair = FromAngles({.theta_h = 0.5 * kPi * u * u,
                                               .theta_d = 0.5 * kPi * (d + 0.5) / size.theta_d,
                                               .phi_d = kPi * (p + 0.5) / size.phi_d});
        Imath::half stored;
        stored.setBits(table[3 * std::size_t((p * size.theta_d + d) * size.theta_h + h)]);
        EXPECT_TRUE(std::isfinite(float(stored)));
        if (!pair.AboveHorizon()) continue;
        Rgb value;
        material->Evaluate({&pair, 1}, {&value, 1});
        EXPECT_NEAR(kValueTableUnit * std::expm1(stored), value[0], 0.01 * value[0] + 1e-4);
        ++above;
      }
    }
  }
  EXPECT_GT(above, 100);
}

TEST(LightSet, HasAllOfTheLight) {
  const auto sky = [](const Vec3& d) {
    const double sun = Dot(d, {0.0, 0.6, 0.8}) > 0.999 ? 500.0 : 0.0;
    return Rgb{0.2 + sun, 0.5 + sun, d.y > 0.0 ? 1.0 : 0.0};
  };
  const std::vector<DistantLight> lights = LightSet(sky, 48);
  Rgb sum = {};
  const DistantLight* brightest = &lights[0];
  for (const DistantLight& light : lights) {
    EXPECT_NEAR(Length(light.direction), 1.0, 1e-12);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += light.irradiance[c];
    if (light.irradiance[1] > brightest->irradiance[1]) brightest = &light;
  }
  const double sun = 500.0 * 2.0 * kPi * 0.001;  // the cap's solid angle
  EXPECT_NEAR(sum[0], 0.2 * 4.0 * kPi + sun, 0.05 * sum[0]);
  EXPECT_NEAR(sum[1], 0.5 * 4.0 * kPi + sun, 0.05 * sum[1]);
  EXPECT_NEAR(sum[2], 2.0 * kPi, 0.02 * sum[2]);
  EXPECT_GT(Dot(brightest->direction, {0.0, 0.6, 0.8}), 0.99);  // where the sun is
}

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648, section 10
  const std::pair<const char*, const char*> kVectors[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : kVectors) EXPECT_EQ(Base64(bytes), text);
  EXPECT_EQ(Base64(std::string("\xff\xfe\x00", 3)), "//4A");
}

}  // namespace
}  // namespace pbnbrdf

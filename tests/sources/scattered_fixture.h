// scattered_fixture.h: tests that open texts as materials.
#pragma once

#include "pbnbrdf/sources/open_brdf.h"
#include "test_util.h"

namespace pbnbrdf {

class ScatteredFiles : public testing::Test {
 protected:
  std::unique_ptr<Brdf> Open(const std::string& name, const std::string& text) const {
    WriteBytes(folder_ / name, text);
    return OpenBrdf(folder_ / name);
  }
  std::vector<BrdfSample> Samples(const std::string& name, const std::string& text) const {
    return Open(name, text)->Measurements();
  }
  std::string ErrorOfOpening(const std::string& name, const std::string& text) const {
    return ErrorOf([&] { Open(name, text); });
  }

  TemporaryFolder folder_;
};

inline void ExpectNear(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

// The cosine of the angle from one azimuth to the other.
inline double CosDeltaPhi(const DirectionPair& pair) {
  const auto& [wi, wo] = pair;
  return (wi.x * wo.x + wi.y * wo.y) / (std::hypot(wi.x, wi.y) * std::hypot(wo.x, wo.y));
}

}  // namespace pbnbrdf

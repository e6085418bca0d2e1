#include "paper_tables.h"

#include <limits>

#include "discontinuity.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using testing::Not;

PaperRecord Record(const std::string& material, const std::string& method, double psnr,
                   bool low_dissipation = false) {
  PaperRecord record;
  record.material = material;
  record.method = method;
  record.low_dissipation = low_dissipation;
  record.picture.psnr = psnr;
  record.picture.mae = 1.0 / psnr;
  record.reciprocity.hrl = method == kOurs ? 0.0 : psnr;
  return record;
}

TEST(PaperMarkdown, SetsOursAgainstOthersOnTheMaterialsThatBothHave) {
  const std::string text = PaperMarkdown({Record("a", kRecipe, 30.0), Record("a", kOurs, 50.0),
                                          Record("b", kRecipe, 40.0), Record("b", kOurs, 39.0),
                                          Record("c", kOurs, 90.0)});
  EXPECT_THAT(text, HasSubstr("| ours           |         3 |"));
  EXPECT_THAT(text, HasSubstr("50.0 (39.0)"));            // median and worst of three
  EXPECT_THAT(text, HasSubstr("44.5 and 35.0; 1 of 2"));  // of the two that both have
  EXPECT_THAT(text, HasSubstr("0 and 35000; 2 of 2"));    // HRL x 1000
  EXPECT_THAT(text, HasSubstr("NBRDF's recipe is ahead on b ("));
  EXPECT_THAT(text, Not(HasSubstr("ahead on a")));
  EXPECT_THAT(text, Not(HasSubstr("Table 2")));  // no material reflects nearly all light
}

TEST(PaperMarkdown, HasTheMaterialsThatReflectNearlyAllLightInTable2) {
  const std::string text =
      PaperMarkdown({Record("a", kOurs, 30.0), Record("b", kOurs, 50.0, true)});
  const std::string table2 =
      text.substr(text.find("Table 2"), text.find("Table 3") - text.find("Table 2"));
  EXPECT_THAT(table2, HasSubstr("| ours   |         1 |"));
}

TEST(PaperMarkdown, LeavesOutAColumnThatNobodyMeasured) {
  PaperRecord record = Record("a", kOurs, 30.0);
  EXPECT_THAT(PaperMarkdown({record}), Not(HasSubstr("| LPIPS x 1000 ")));
  record.lpips = 0.25;
  EXPECT_THAT(PaperMarkdown({record, Record("b", kOurs, 30.0)}), HasSubstr("| LPIPS x 1000 "));
}

TEST(PaperCsv, HasARowForEachRecord) {
  const std::string csv = PaperCsv({Record("a", kOurs, 30.0)});
  EXPECT_THAT(csv, HasSubstr("\na,ours,0,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
}

// Depends on the order of the two directions.
class OneSided final : public PointwiseBrdf {
 public:
  std::string Description() const override { return "one-sided"; }

 protected:
  Rgb Value(const DirectionPair& pair) const override {
    const double v = 0.1 + 0.1 * ToHalfDiff(pair).d.x;
    return {v, v, v};
  }
};

TEST(Discontinuity, IsThereForWhatIsNotReciprocalAlone) {
  const Discontinuity found = WorstDiscontinuity(OneSided());
  EXPECT_GT(found.jump, 0.02);
  EXPECT_NEAR(found.theta_d, 45.0 * kPi / 180.0, 0.2);  // d.x is largest there
  EXPECT_LT(WorstDiscontinuity(*OpenBrdf("builtin:satin-gold")).jump, 1e-9);
}

TEST(FoldedBrdf, IsReciprocalAndJumps) {
  const FoldedBrdf folded(std::make_unique<OneSided>());
  const auto value = [&](double phi_d) {
    const DirectionPair pair = FromAngles({.theta_h = 0.2, .theta_d = 0.6, .phi_d = phi_d});
    Rgb rgb;
    folded.Evaluate({&pair, 1}, {&rgb, 1});
    return rgb[0];
  };
  EXPECT_NEAR(value(1.0), value(1.0 + kPi), 1e-12);
  EXPECT_GT(std::abs(value(0.01) - value(-0.01)), 0.1);
}

}  // namespace
}  // namespace pbnbrdf

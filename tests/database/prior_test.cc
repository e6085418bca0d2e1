// What a database says of a material that isn't in it: codes, plans, fits.
#include <numeric>
#include <set>

#include "database/even_pairs.h"
#include "database/lobe_codes.h"
#include "database/pca_rows.h"
#include "database/small_database.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/database/plan.h"
#include "pbnbrdf/database/start_from_prior.h"
#include "pbnbrdf/database/table_components.h"
#include "pbnbrdf/database/train_family.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// Made once for all tests.
const WeightFamily& Family() {
  static const WeightFamily family = [] {
    FamilyOptions options;
    options.code_size = 4;
    options.max_iterations = 40;
    return TrainFamily(Paints(), SmallProblem(FamilyProblem()), options).family;
  }();
  return family;
}

const TablePca& Pca() {
  static const TablePca pca = PrincipalComponents(Paints(), 8);
  return pca;
}

ScatteredBrdf Measured(const Brdf& material, const std::vector<DirectionPair>& pairs) {
  ScatteredData data;
  data.kind = "a few";
  data.samples = SamplesAt(material, pairs);
  return ScatteredBrdf(std::move(data));
}

double ErrorOfFit(const Brdf& material, const Brdf& fit) {
  return MeasureErrors(HeldOutSamples(material, 2000, /*seed=*/1), fit).mean_abs_log_error;
}

TEST(PrincipalComponents, MembersComeBack) {
  // Twelve colours and roughnesses make up the channels of all: as many components tell nearly all of them.
  const MerlBrdf table = Pca().Material("paint-5");
  const double error = ErrorOfFit(*Paints()[5].brdf, table);
  EXPECT_LT(error, 0.004);
  const TablePca fewer = PrincipalComponents(Paints(), 2);
  EXPECT_LT(error, ErrorOfFit(*Paints()[5].brdf, fewer.Material("paint-5")));
}

TEST(PrincipalComponents, CodesHaveVarianceOneAndAreUncorrelated) {
  const TablePca& pca = Pca();
  const auto size = static_cast<std::size_t>(pca.num_components());
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0.0, count = 0.0;
      for (const DatabaseMember& member : pca.members()) {
        for (std::size_t c = 0; c < 3; ++c, ++count) {
          sum += member.code[c * size + i] * member.code[c * size + j];
        }
      }
      EXPECT_NEAR(sum / count, i == j ? 1.0 : 0.0, 1e-3) << i << " " << j;
    }
  }
}

TEST(PrincipalComponents, RefusesWhatATableCannotHold) {
  EXPECT_THAT(
      ErrorOf([] {
        PrincipalComponents(std::vector<DatabaseMaterial>{{"b", MakeBuiltin("rolled-brass")}}, 1);
      }),
      HasSubstr("b: anisotropic"));
  EXPECT_THAT(ErrorOf([] { PrincipalComponents(Paints(), 72); }),
              HasSubstr("components = 72; must be 1 to 71 for 24 materials"));
}

TEST(FitCode, FindsTheCodeThatSamplesWereMadeWith) {
  const std::vector<double> wanted = {0.5, -0.3, 0.2, 0.6};
  const NeuralBrdf material(Family().shape(), Family().WeightsAt(wanted));
  const auto samples = HeldOutSamples(material, 200, /*seed=*/2);
  const std::vector<double> found = FitCode(Family(), samples, /*noise=*/1e-3);
  for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_NEAR(found[k], wanted[k], 0.02);
}

TEST(FitCode, WithoutInformationItIsLikeTheDatabase) {
  // One sample at the horizon's edge says next to nothing; a code far from 0 would be a guess.
  const BrdfSample sample = {{FromSpherical(1.5, 0.0), FromSpherical(1.5, 1.0)}, {0.1, 0.1, 0.1}};
  double square = 0.0;
  for (const double number : FitCode(Family(), std::vector{sample}, 10.0))
    square += number * number;
  EXPECT_LT(square, 8.0);  // the mean of four normal numbers' is 4
}

TEST(FitCode, ComponentsFindAMemberAgain) {
  // Measured at bins, where nothing is interpolated.
  const MerlBrdf table = Pca().Material("paint-9");
  std::vector<DirectionPair> pairs;
  const std::vector<std::size_t> bins = MerlBrdf::BinsAboveHorizon();
  for (std::size_t n = 500; n < bins.size(); n += 40007)
    pairs.push_back(MerlBrdf::CornerPair(bins[n]));
  const MerlBrdf found = Pca().At(FitCode(Pca(), SamplesAt(table, pairs), /*noise=*/0.01));
  EXPECT_LT(ErrorOfFit(table, found), 0.003);
}

TEST(LobeCodes, AreNearerToTheirLobesThanTheMeanIs) {
  const Eigen::MatrixXd codes = LobeCodes(Pca());
  ASSERT_EQ(codes.cols(), 400);
  const std::vector<DirectionPair> pairs = EvenPairs(500);
  for (const int k : {0, 17, 399}) {
    const auto [rows, rests] = LinearSamplesOf(Pca(), SamplesAt(Lobe(k), pairs));
    const double distance = (rows * codes.col(k) - rests.col(0)).norm();
    EXPECT_LT(distance, 0.9 * rests.col(0).norm()) << k;
  }
}

TEST(FitCode, AMaterialLikeAFormulaIsFoundThoughNoMemberIsLikeIt) {
  const LambertBrdf soot({0.02, 0.02, 0.02});  // members alone: an error of 0.013
  const MerlBrdf found = Pca().At(FitCode(Pca(), SamplesAt(soot, EvenPairs(8))));
  EXPECT_LT(ErrorOfFit(soot, found), 0.009);
}

TEST(FitCode, NoMeasurementsAreAnError) {
  EXPECT_THAT(ErrorOf([] { FitCode(Family(), {}); }), HasSubstr("no measurements"));
  EXPECT_THAT(ErrorOf([] { FitCode(Pca(), {}); }), HasSubstr("no measurements"));
}

template <typename Prior>
void ExpectAPlan(const Prior& prior) {
  PlanOptions options;
  options.count = 12;
  options.max_theta = 60.0;
  const std::vector<DirectionPair> pairs = PlanDirections(prior, {}, options);
  ASSERT_EQ(pairs.size(), 12u);
  std::set<std::array<double, 3>> places;
  for (const auto& [wi, wo] : pairs) {
    EXPECT_GE(std::min(wi.z, wo.z), std::cos(60.001 * kPi / 180.0));
    EXPECT_EQ(wi.y, 0.0);
    places.insert({wi.z, wo.z, wo.y});
  }
  EXPECT_EQ(places.size(), 12u);
  options.count = 100000;
  EXPECT_THAT(ErrorOf([&] { PlanDirections(prior, {}, options); }), HasSubstr("count = 100000"));
}

TEST(Plan, DirectionsAreOnTheGridAndDiffer) {
  ExpectAPlan(Family());
  ExpectAPlan(Pca());
}

TEST(Plan, GoesOnFromWhatWasMeasured) {
  PlanOptions options;
  options.count = 4;
  const std::vector<DirectionPair> all = PlanDirections(Pca(), {}, options);
  const std::vector<BrdfSample> first = {{all[0], {0.1, 0.1, 0.1}}, {all[1], {0.2, 0.2, 0.2}}};
  options.count = 2;
  const std::vector<DirectionPair> next = PlanDirections(Pca(), first, options);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(next[k].wi.x, all[k + 2].wi.x);
    EXPECT_EQ(next[k].wo.y, all[k + 2].wo.y);
  }
}

template <typename Prior>
double ErrorWith(const Prior* prior, const Brdf& material, const Brdf& few) {
  FitProblem problem;
  problem.network.hidden = {8};
  problem.network.encoding = Encoding::kReciprocal;
  problem.sampling.samples = 4000;
  FitOptions options;
  options.schedule.max_iterations = 40;
  if (prior != nullptr) StartFromPrior(*prior, few, &problem, &options);
  return ErrorOfFit(material, FitBrdf(few, problem, options).network);
}

TEST(StartFromPrior, AFewMeasurementsAreEnoughForWhoKnowsOthers) {
  const auto paint = Paint(0.3, 0.2, 0.25);
  PlanOptions options;
  options.count = 6;
  const ScatteredBrdf few = Measured(*paint, PlanDirections(Pca(), {}, options));
  const double alone = ErrorWith(static_cast<const TablePca*>(nullptr), *paint, few);
  EXPECT_LT(ErrorWith(&Pca(), *paint, few), 0.7 * alone);
  EXPECT_LT(ErrorWith(&Family(), *paint, few), 0.7 * alone);
}

TEST(StartFromPrior, TheFitStartsAtTheFamilysNetwork) {
  const auto paint = Paint(0.3, 0.2, 0.25);
  PlanOptions plan;
  plan.count = 6;
  const ScatteredBrdf few = Measured(*paint, PlanDirections(Family(), {}, plan));
  FitProblem problem;
  problem.network.hidden = {8};
  FitOptions options;
  StartFromPrior(Family(), few, &problem, &options);
  EXPECT_EQ(problem.network.encoding, Encoding::kReciprocal);
  EXPECT_EQ(options.initial_weights, Expected(Family(), few).weights());
  problem.network.hidden = {9};  // another shape: what to expect is the same, the start isn't
  options = {};
  StartFromPrior(Family(), few, &problem, &options);
  EXPECT_TRUE(options.initial_weights.empty());
  EXPECT_NE(options.expected, nullptr);
}

TEST(StartFromPrior, RefusesAnisotropicMaterials) {
  EXPECT_THAT(ErrorOf([] { Expected(Family(), *MakeBuiltin("rolled-brass")); }),
              HasSubstr("the material is anisotropic"));
  EXPECT_THAT(ErrorOf([] { Expected(Pca(), *MakeBuiltin("rolled-brass")); }),
              HasSubstr("the material is anisotropic"));
}

}  // namespace
}  // namespace pbnbrdf

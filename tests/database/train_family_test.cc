#include "pbnbrdf/database/train_family.h"

#include "database/small_database.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

FamilyOptions Quick(int code_size) {
  FamilyOptions options;
  options.code_size = code_size;
  options.max_iterations = 40;
  return options;
}

double MeanError(const std::vector<DatabaseMaterial>& materials, const WeightFamily& family) {
  double sum = 0.0;
  for (const auto& [name, brdf] : materials) {
    const auto samples = HeldOutSamples(*brdf, 1000, /*seed=*/1);
    sum += MeasureErrors(samples, family.Material(name)).mean_abs_log_error;
  }
  return sum / static_cast<double>(materials.size());
}

TEST(TrainFamily, AFewNumbersTellTheMaterialsApart) {
  const std::vector<DatabaseMaterial> paints = Paints();
  const FitProblem problem = SmallProblem(FamilyProblem());
  const TrainedFamily one = TrainFamily(paints, problem, Quick(1)),
                      four = TrainFamily(paints, problem, Quick(4));
  const double with_one = MeanError(paints, one.family), with_four = MeanError(paints, four.family);
  EXPECT_LT(with_four, 0.01);
  EXPECT_LT(with_four, 0.5 * with_one);
  EXPECT_EQ(four.family.code_size(), 4);
  EXPECT_TRUE(four.family.Material("paint-3").IsReciprocal());
}

TEST(TrainFamily, TheSameToTheBitWhateverTheThreads) {
  const std::vector<DatabaseMaterial> paints = Paints();
  FamilyOptions options = Quick(2);
  options.max_iterations = 5;
  options.threads = 1;
  const WeightFamily one = TrainFamily(paints, SmallProblem(FamilyProblem()), options).family;
  options.threads = 3;
  const WeightFamily three = TrainFamily(paints, SmallProblem(FamilyProblem()), options).family;
  EXPECT_EQ(one.mean(), three.mean());
  EXPECT_EQ(one.basis(), three.basis());
  EXPECT_EQ(one.members()[7].code, three.members()[7].code);
}

TEST(TrainFamily, NoMemberMakesEnergy) {
  // Whose lobes reflect all, and more in a fit without the energy term.
  std::vector<DatabaseMaterial> mirrors;
  for (const char* roughness : {"0.2", "0.3", "0.4", "0.5"}) {
    mirrors.push_back({roughness, std::make_shared<AnalyticBrdf>(AnalyticBrdf::FromText(
                                      StrCat("ggx:f0=1,rho_d=0.5,alpha=", roughness)))});
    ASSERT_GT(MeasureEnergy(*mirrors.back().brdf).max_directional_albedo, 1.0);
  }
  const TrainedFamily trained = TrainFamily(mirrors, SmallProblem(FamilyProblem()), Quick(2));
  for (std::size_t m = 0; m < mirrors.size(); ++m) {
    const NeuralBrdf network = trained.family.Material(mirrors[m].name);
    EXPECT_TRUE(MeasureEnergy(network).Conserved())
        << mirrors[m].name << " " << trained.max_albedos[m] - 1.0;
    EXPECT_NEAR(MeasureEnergy(network).max_directional_albedo, trained.max_albedos[m], 1e-3);
    EXPECT_GT(trained.max_albedos[m], 0.8);  // it has not gone dark
  }
}

TEST(TrainFamily, TheUserMayEndIt) {
  FamilyOptions options = Quick(2);
  int calls = 0;
  options.on_iteration = [&](const FamilyProgress& progress) {
    EXPECT_GT(progress.cost, 0.0);
    return ++calls < 3;
  };
  TrainFamily(Paints(), SmallProblem(FamilyProblem()), options);
  EXPECT_LE(calls, 4);  // once more for the mean, and for what has codes
}

TEST(TrainFamily, RefusesWhatMakesNoDatabase) {
  const FitProblem problem = SmallProblem(FamilyProblem());
  const auto error = [&](std::vector<DatabaseMaterial> materials, int code_size) {
    return ErrorOf([&] { TrainFamily(materials, problem, Quick(code_size)); });
  };
  const DatabaseMaterial paint = Paints().front();
  EXPECT_THAT(error({paint}, 1), HasSubstr("at least two materials"));
  EXPECT_THAT(error({paint, Paints().back()}, 2), HasSubstr("code_size = 2; must be 1 to 1"));
  EXPECT_THAT(error({paint, {"brass", MakeBuiltin("rolled-brass")}}, 1),
              HasSubstr("brass: anisotropic"));
}

}  // namespace
}  // namespace pbnbrdf

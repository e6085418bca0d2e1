#include "problems.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

TEST(ShippedProblem, IsWhatItsFileSays) {
  const FitSetup adam = ShippedProblem("pbnbrdf_adam");
  EXPECT_EQ(adam.options.solver, "adam");
  EXPECT_EQ(adam.options.schedule.max_iterations, 100);
  EXPECT_FALSE(adam.options.certify_energy);
  EXPECT_EQ(adam.problem.network.encoding, Encoding::kReciprocal);
  EXPECT_EQ(adam.problem.terms.Weight("chromaticity"), 1.0);
  for (const char* name : {"nbrdf", "reciprocal", "pbnbrdf", "nbrdf_adam"}) {
    EXPECT_EQ(ErrorOf([&] { ShippedProblem(name); }), "") << name;
  }
  EXPECT_THAT(ErrorOf([] { ShippedProblem("absent"); }), testing::HasSubstr("absent.flags"));
}

}  // namespace
}  // namespace pbnbrdf

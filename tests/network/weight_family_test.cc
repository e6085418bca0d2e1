#include "pbnbrdf/network/weight_family.h"

#include "network/random_network.h"
#include "network/safetensors.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

constexpr int kCodeSize = 2;

NetworkShape Shape() { return NetworkShape(Encoding::kReciprocal, {5, 4}, Activation::kTanh); }

WeightFamily Family() {
  const NetworkShape shape = Shape();
  std::vector<double> basis = RandomWeights(shape, 0.1, 2);
  const std::vector<double> second = RandomWeights(shape, 0.1, 3);
  basis.insert(basis.end(), second.begin(), second.end());
  return WeightFamily(shape, RandomWeights(shape, 0.5, 1), std::move(basis),
                      {{"gold", {1.0, -2.0}}, {"pink-felt", {0.5, 0.25}}});
}

TEST(WeightFamily, WeightsAreAffineInTheCode) {
  const WeightFamily family = Family();
  ASSERT_EQ(family.code_size(), kCodeSize);
  const std::vector<double> weights = family.WeightsAt(std::vector<double>{1.0, -2.0});
  const std::size_t size = family.mean().size();
  for (std::size_t i = 0; i < size; ++i) {
    EXPECT_DOUBLE_EQ(weights[i],
                     family.mean()[i] + family.basis()[i] - 2.0 * family.basis()[size + i]);
  }
  EXPECT_EQ(family.Material("gold").weights(), weights);
  EXPECT_TRUE(family.Material("gold").IsReciprocal());
}

TEST(WeightFamily, FilesRoundTripToTheBit) {
  const TemporaryFolder folder;
  const WeightFamily family = Family();
  family.Write(folder / "a.prior");
  const WeightFamily read = WeightFamily::Read(folder / "a.prior");
  EXPECT_EQ(read.shape().Description(), family.shape().Description());
  EXPECT_EQ(read.shape().encoding(), family.shape().encoding());
  EXPECT_EQ(read.mean(), family.mean());
  EXPECT_EQ(read.basis(), family.basis());
  ASSERT_EQ(read.members().size(), 2u);
  EXPECT_EQ(read.members()[1].name, "pink-felt");
  EXPECT_EQ(read.members()[1].code, family.members()[1].code);
  read.Write(folder / "b.prior");
  EXPECT_EQ(ReadFile(folder / "a.prior", 1 << 20), ReadFile(folder / "b.prior", 1 << 20));
}

TEST(WeightFamily, AMemberThatItHasNotIsAnErrorWithTheNearestName) {
  EXPECT_THAT(ErrorOf([] { Family().Material("pink-velt"); }),
              HasSubstr("none of its 2 materials is named 'pink-velt'; the nearest name is "
                        "'pink-felt'"));
}

TEST(WeightFamily, RefusesPartsThatDoNotFit) {
  const NetworkShape shape = Shape();
  const std::vector<double> mean = RandomWeights(shape, 0.5, 1);
  const auto error = [&](std::vector<double> m, std::vector<double> basis,
                         std::vector<DatabaseMember> members) {
    return ErrorOf([&] { WeightFamily(shape, std::move(m), std::move(basis), members); });
  };
  EXPECT_EQ(error(mean, mean, {{"a", {1.0}}}), "");
  EXPECT_THAT(error({1.0}, mean, {{"a", {1.0}}}), HasSubstr("mean: 1 numbers"));
  EXPECT_THAT(error(mean, {}, {{"a", {}}}), HasSubstr("basis: 0 rows"));
  EXPECT_THAT(error(mean, mean, {}), HasSubstr("no materials"));
  EXPECT_THAT(error(mean, mean, {{"a", {1.0, 2.0}}}), HasSubstr("codes: 2 numbers for a"));
  EXPECT_THAT(error(mean, mean, {{"a", {1.0}}, {"a", {2.0}}}), HasSubstr("two materials"));
  EXPECT_THAT(error(mean, mean, {{"a;b", {1.0}}}), HasSubstr("'a;b' is no name"));
  EXPECT_THAT(error(mean, mean, {{"a", {std::nan("")}}}), HasSubstr("isn't finite"));
}

TEST(WeightFamily, DamagedFilesAreErrorsThatNameThem) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.prior";
  Family().Write(path);
  const SafetensorsFile good = ReadSafetensors(path);
  const auto error = [&](auto change) {
    SafetensorsFile file = good;
    change(&file);
    WriteFile(path, SafetensorsBytes(file));
    return ErrorOf([&] { WeightFamily::Read(path); });
  };
  EXPECT_EQ(error([](SafetensorsFile*) {}), "");
  for (const char* key : {"format", "encoding", "hidden", "activation", "outputs", "materials"}) {
    EXPECT_THAT(error([&](SafetensorsFile* file) { file->metadata.erase(key); }),
                testing::AllOf(HasSubstr(path), HasSubstr(StrCat("__metadata__ lacks ", key))));
  }
  for (const char* name : {"mean", "basis", "codes"}) {
    EXPECT_THAT(error([&](SafetensorsFile* file) { file->tensors.erase(name); }),
                HasSubstr(StrCat("tensor ", name, " is missing")));
  }
  EXPECT_THAT(error([](SafetensorsFile* file) { file->metadata["hidden"] = "5,99999999"; }),
              HasSubstr("hidden: a layer of"));
  EXPECT_THAT(error([](SafetensorsFile* file) { file->metadata["materials"] = "a;b;c"; }),
              HasSubstr("codes: 4 numbers for 3 materials"));
}

}  // namespace
}  // namespace pbnbrdf

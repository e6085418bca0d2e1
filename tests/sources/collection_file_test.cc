#include "sources/collection_file.h"

#include "network/random_network.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "sources/source_list.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class CollectionFile : public testing::Test {
 protected:
  CollectionFile() {
    const NetworkShape shape(Encoding::kReciprocal, {3}, Activation::kTanh);
    const WeightFamily family(shape, RandomWeights(shape, 0.5, 1), RandomWeights(shape, 0.5, 2),
                              {{"gold", {1.0}}, {"green-felt", {2.0}}, {"grey-felt", {-1.0}}});
    family.Write(path_);
    gold_ = family.Material("gold").weights();
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "some.prior";
  std::vector<double> gold_;
};

TEST_F(CollectionFile, ItsMaterialsAreSourcesAndNetworks) {
  const auto gold = OpenBrdf(path_ + "#gold");
  ASSERT_NE(dynamic_cast<const NeuralBrdf*>(gold.get()), nullptr);
  EXPECT_EQ(dynamic_cast<const NeuralBrdf&>(*gold).weights(), gold_);
  EXPECT_EQ(OpenNetwork(path_ + "#gold").weights(), gold_);
}

TEST_F(CollectionFile, PatternsStandForItsMaterials) {
  EXPECT_THAT(ExpandSources(path_ + "#*-felt"),
              ElementsAre(path_ + "#green-felt", path_ + "#grey-felt"));
  EXPECT_THAT(NamesOfSources({path_ + "#gold", path_ + "#grey-felt"}),
              ElementsAre("gold", "grey-felt"));
  EXPECT_THAT(NamesOfSources({path_ + "#gold", "builtin:gold"}),
              ElementsAre("some-gold", "builtin-gold"));
  EXPECT_NE(SourceFingerprint(path_ + "#gold"), SourceFingerprint(path_ + "#grey-felt"));
}

TEST_F(CollectionFile, ErrorsSayWhatToDo) {
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(path_); }),
              HasSubstr(StrCat("holds 3 materials; name one: ", path_, "#gold")));
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(path_ + "#bold"); }),
              testing::AllOf(HasSubstr(path_), HasSubstr("the nearest name is 'gold'")));
  WriteBytes(folder_ / "text", "text");
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(folder_ / "text#gold"); }),
              HasSubstr("holds no materials by name"));
}

TEST_F(CollectionFile, AFileMayHaveTheSignInItsName) {
  const NeuralBrdf network = OpenNetwork(path_ + "#gold");
  network.Write(folder_ / "fit#1.safetensors");
  EXPECT_EQ(OpenNetwork(folder_ / "fit#1.safetensors").weights(), gold_);
}

}  // namespace
}  // namespace pbnbrdf

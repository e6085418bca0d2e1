#include "option_fields.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Networks, ReadsBackWhatItPrints) {
  std::vector<std::vector<int>> networks = {{21, 21}};
  const Field field = Networks("hidden", &networks, "");
  EXPECT_EQ(field.default_text, "21,21");
  field.set("8,8,8  3");
  EXPECT_THAT(networks, ElementsAre(ElementsAre(8, 8, 8), ElementsAre(3)));
  EXPECT_EQ(field.text(), "8,8,8 3");
  field.set("");
  EXPECT_TRUE(networks.empty());
  EXPECT_THAT(ErrorOf([&] { field.set("a"); }), HasSubstr("hidden"));
  EXPECT_NE(ErrorOf([&] { field.set("0"); }), "");
}

TEST(OverridingInteger, IsAutoUntilItIsSet) {
  std::optional<int> epochs;
  const Field field = OverridingInteger("epochs", &epochs, AtLeast(0), "");
  EXPECT_EQ(field.text(), "auto");
  field.set("0");
  EXPECT_EQ(epochs, 0);
  EXPECT_EQ(field.text(), "0");
  field.set("-1");
  EXPECT_EQ(ErrorOf([&] { field.check(); }), "epochs = -1; must be >= 0");
  field.set("auto");
  EXPECT_EQ(epochs, std::nullopt);
  EXPECT_THAT(ErrorOf([&] { field.set("many"); }), HasSubstr("epochs"));
}

TEST(Texts, AreSeparatedByCommas) {
  std::vector<std::string> texts = {"a"};
  const Field field = Texts("names", &texts, "");
  field.set("b, c");
  EXPECT_THAT(texts, ElementsAre("b", "c"));
  EXPECT_EQ(field.text(), "b,c");
}

}  // namespace
}  // namespace pbnbrdf

#include "materials.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(ParseMaterial, NamesTheMaterialAndItsClass) {
  const MaterialSource sgd = ParseMaterial("metal=sgd:folder/parameters.csv#chrome-steel");
  EXPECT_EQ(sgd.name, "chrome-steel");
  EXPECT_EQ(sgd.material_class, "metal");
  EXPECT_EQ(sgd.source, "sgd:folder/parameters.csv#chrome-steel");
  EXPECT_EQ(ParseMaterial("builtin:satin-gold").name, "satin-gold");
  EXPECT_EQ(ParseMaterial("folder/gold.paint.binary").name, "gold.paint");
  const MaterialSource equals = ParseMaterial("folder/a=b.binary");
  EXPECT_EQ(equals.material_class, "");
  EXPECT_EQ(equals.source, "folder/a=b.binary");
  EXPECT_THAT(ErrorOf([] { ParseMaterial("metal="); }), HasSubstr("names no source"));
}

std::vector<std::string> Names(const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const MaterialSource& material :
       ParseMaterials(arguments, {"builtin:satin-gold", "metal=builtin:rolled-brass"}, "")) {
    names.push_back(material.name);
  }
  return names;
}

TEST(ParseMaterials, TakesTheDefaultsWhereThereAreNoneAndAmongOthers) {
  EXPECT_THAT(Names({}), ElementsAre("satin-gold", "rolled-brass"));
  EXPECT_THAT(Names({"builtin:wall-plaster"}), ElementsAre("wall-plaster"));
  EXPECT_THAT(Names({"default", "builtin:wall-plaster"}),
              ElementsAre("satin-gold", "rolled-brass", "wall-plaster"));
}

TEST(ParseMaterials, RejectsWhatItCantOpenAndWhatIsThereTwice) {
  EXPECT_THAT(ErrorOf([] { Names({"absent.binary"}); }), HasSubstr("absent.binary"));
  EXPECT_THAT(ErrorOf([] { Names({"sgd:brass"}); }), HasSubstr("--sgd must say"));
  EXPECT_THAT(ErrorOf([] {
                Names({"default", "builtin:satin-gold"});
              }),
              HasSubstr("another one is named satin-gold"));
}

}  // namespace
}  // namespace pbnbrdf

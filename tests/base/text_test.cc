#include "base/text.h"

#include <limits>

#include "pbnbrdf/base/names.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Text, LowerCaseIsThatOfAscii) { EXPECT_EQ(LowerCase("Az_9\xc3\x84"), "az_9\xc3\x84"); }

TEST(Error, IsOneLine) {
  EXPECT_STREQ(Error("a: field 'b\n\x1b[1m\x7f\xc3\x84'").what(), "a: field 'b??[1m?\xc3\x84'");
}

TEST(Text, SplitsAndTrims) {
  EXPECT_THAT(Split(" a, b ,,c\r", ','), ElementsAre("a", "b", "", "c"));
  EXPECT_THAT(Split("", ','), ElementsAre(""));
}

TEST(Text, NumbersRoundTrip) {
  for (double x : {0.1, -1e-300, 5e-324, 1.7976931348623157e308, 0.0}) {
    EXPECT_EQ(ParseNumber("x", FormatNumber(x)), x);
    EXPECT_EQ(ParseNumber("x", FormatFullPrecision(x)), x);
  }
  EXPECT_EQ(FormatFullPrecision(0.1), "0.10000000000000001");
}

TEST(Text, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "x", "1x", "1 2", "nan", "inf", "1e999", "--1"}) {
    EXPECT_THAT(ErrorOf([&] { ParseNumber("field", text); }),
                HasSubstr(StrCat("field: '", text, "' is not a finite number")));
  }
  EXPECT_THAT(ErrorOf([] { ParseInteger("field", "1.5"); }), HasSubstr("not a whole number"));
}

TEST(Names, ErrorsListTheChoices) {
  constexpr NameTable<int, 2> kTable = {{{"one", 1}, {"two", 2}}};
  EXPECT_EQ(ParseName(kTable, "count", "two"), 2);
  EXPECT_EQ(NameOf(kTable, 1), "one");
  EXPECT_EQ(ErrorOf([&] { ParseName(kTable, "count", "three"); }),
            "count=three is not one of one | two");
}

TEST(Nearest, CountsLetters) {
  const std::vector<std::string> names = {"rho_d", "alpha", "alpha_x"};
  EXPECT_EQ(Nearest(names, "alpa"), "alpha");
  EXPECT_EQ(Nearest(names, "alphax"), "alpha");  // the first of those that are equally near
  EXPECT_EQ(Nearest(names, "aplha_x"), "alpha_x");
  EXPECT_EQ(Nearest(names, "rho"), "rho_d");
  EXPECT_EQ(Nearest(names, "alpha_x"), "alpha_x");
}

}  // namespace
}  // namespace pbnbrdf

#include "export/code.h"

#include "export/networks.h"

namespace pbnbrdf {
namespace {

constexpr Language kLanguage = {
    .statement = "$ = $\n",
    .component = {".x", ".y", ".z"},
    .single_precision = false,
    .functions = {"max($, $)", "min($, $)", "angle($, $)", "sqrt($)", "log($)", "floor($)",
                  "tanh($)", "expm1($)", "$ > $ ? $ : $"}};

const Term a = Term::Variable("a"), b = Term::Variable("b"), c = Term::Variable("c");

std::string Printed(const Term& term) { return PrintExpression(kLanguage, term); }

TEST(Code, ParenthesesKeepTheOrderOfOperations) {
  EXPECT_EQ(Printed(a - b - c), "a - b - c");
  EXPECT_EQ(Printed(a - (b - c)), "a - (b - c)");
  EXPECT_EQ(Printed(a + (b + c)), "a + (b + c)");
  EXPECT_EQ(Printed(a * b / c), "a * b / c");
  EXPECT_EQ(Printed(a * (b / c)), "a * (b / c)");
  EXPECT_EQ(Printed((a + b) * c - a / (b + 1.0)), "(a + b) * c - a / (b + 1.0)");
  EXPECT_EQ(Printed(2.0 * sqrt(a + b)), "2.0 * sqrt(a + b)");
  EXPECT_EQ(Printed(1.0 + IfGreater(a, b + c, c, 0.5)), "1.0 + (a > b + c ? c : 0.5)");
  EXPECT_EQ(Printed(Max(IfGreater(a, b, c, 0.5), a)), "max(a > b ? c : 0.5, a)");
  EXPECT_EQ(Printed(IfGreater(a, b, IfGreater(a, c, 1.0, 2.0), 3.0)),
            "a > b ? (a > c ? 1.0 : 2.0) : 3.0");
}

TEST(Code, WhatIsUsedTwiceIsComputedOnce) {
  const Term sum = a + b;
  Term root = sqrt(sum * sum);
  root.SetName("root");
  const Code code = PrintTerms(kLanguage, {sum / c, root, 3.0});
  EXPECT_EQ(code.statements, "t1 = a + b\nroot = sqrt(t1 * t1)\n");
  EXPECT_EQ(code.values, (std::vector<std::string>{"t1 / c", "root", "3.0"}));
  EXPECT_NE(ErrorOf([&] { Printed(sum * sum); }), "");
}

TEST(Code, FillInReplacesWhatHasAValueOnce) {
  EXPECT_EQ(FillIn("@x@ and @y@, @ @x@@", {{"x", "@y@"}}), "@y@ and @y@, @ @y@@");
  EXPECT_EQ(FillIn("", {{"x", "1"}}), "");
}

}  // namespace
}  // namespace pbnbrdf

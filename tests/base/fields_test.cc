#include "base/fields.h"

#include <cmath>

#include "pbnbrdf/base/error.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

enum class Metal { kGold, kIron };
constexpr NameTable<Metal, 2> kMetals = {{{"gold", Metal::kGold}, {"iron", Metal::kIron}}};

struct Ball {
  double radius = 0.5;
  int count = 3;
  std::uint64_t seed = 1;
  bool smooth = true;
  std::string label = "a ball";
  std::vector<int> sizes = {21, 21};
  Metal metal = Metal::kGold;
  std::optional<Metal> coat;

  bool operator==(const Ball&) const = default;
};

Fields FieldsOf(Ball* ball) {
  Fields fields;
  fields.Group("The shape");
  fields.AddRequired(Text("label", &ball->label, "its name"));
  fields.AddCommon(Number("radius", &ball->radius, Above(0.0), "in metres"));
  fields.Add(Integer("count", &ball->count, Between(1, 10), "how many"));
  fields.Add(Integer("seed", &ball->seed, AtLeast(0), "seed"));
  fields.Add(Integers("sizes", &ball->sizes, Between(1, 256), "sizes"));
  fields.Group("The surface");
  fields.Add(Switch("smooth", &ball->smooth, "without bumps"));
  fields.Add(Choice("metal", &ball->metal, kMetals, "what it is made of"));
  fields.Add(ChoiceOrAuto("coat", &ball->coat, kMetals, "what covers it"));
  return fields;
}

template <typename Function>
std::string ErrorOf(Function function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// Of reading the lines.
std::string ReadError(const std::string& lines) {
  Ball ball;
  return ErrorOf([&] { FieldsOf(&ball).ReadLines(lines); });
}

// Of checking a ball that is changed.
template <typename Change>
std::string CheckError(Change change) {
  Ball ball;
  change(&ball);
  return ErrorOf([&] { FieldsOf(&ball).Check(); });
}

TEST(Fields, LinesAreReadBackExactly) {
  Ball ball = {.radius = 1.0 / 3.0,
               .count = 7,
               .seed = 18446744073709551615u,
               .smooth = false,
               .label = "a = b, c",
               .sizes = {5},
               .metal = Metal::kIron,
               .coat = Metal::kGold};
  Ball read;
  FieldsOf(&read).ReadLines(FieldsOf(&ball).Lines());
  EXPECT_EQ(read, ball);
  EXPECT_EQ(FieldsOf(&read).Lines(), FieldsOf(&ball).Lines());
}

TEST(Fields, LinesNameEveryField) {
  Ball ball;
  EXPECT_EQ(FieldsOf(&ball).Lines(),
            "--label=a ball\n--radius=0.5\n--count=3\n--seed=1\n--sizes=21,21\n--smooth=true\n"
            "--metal=gold\n--coat=auto\n");
}

TEST(Fields, ReadsCommentsSwitchesAndTheLastOfSeveralLines) {
  Ball ball;
  FieldsOf(&ball).ReadLines(
      "# a comment\n\n  --nosmooth  \n--radius=2\n--radius=4\n--sizes=1, 2\n");
  EXPECT_FALSE(ball.smooth);
  EXPECT_EQ(ball.radius, 4.0);
  EXPECT_EQ(ball.sizes, (std::vector<int>{1, 2}));
  FieldsOf(&ball).ReadLines("--smooth");
  EXPECT_TRUE(ball.smooth);
  FieldsOf(&ball).ReadLines("--smooth=false");
  EXPECT_FALSE(ball.smooth);
}

TEST(Fields, AutoStandsForNoValue) {
  Ball ball;
  FieldsOf(&ball).Set("coat", "iron");
  EXPECT_EQ(ball.coat, Metal::kIron);
  FieldsOf(&ball).Set("coat", "auto");
  EXPECT_EQ(ball.coat, std::nullopt);
}

TEST(Fields, TextsThatAreNoValuesAreNamed) {
  EXPECT_EQ(ReadError("--radius=x"), "--radius: 'x' is not a finite number");
  EXPECT_EQ(ReadError("--radius=nan"), "--radius: 'nan' is not a finite number");
  EXPECT_EQ(ReadError("--count=1.5"), "--count: '1.5' is not a whole number");
  EXPECT_EQ(ReadError("--seed=-1"), "--seed: '-1' is not a whole number");
  EXPECT_EQ(ReadError("--sizes=1,,2"), "--sizes: '' is not a whole number");
  EXPECT_EQ(ReadError("--smooth=yes"), "--smooth=yes is not true | false");
  EXPECT_EQ(ReadError("--metal=tin"), "--metal=tin is not one of gold | iron");
  EXPECT_EQ(ReadError("--coat=tin"), "--coat=tin is not one of auto | gold | iron");
}

TEST(Fields, LinesThatAreNoFlagsAreNamed) {
  EXPECT_EQ(ReadError("radius=1"), "'radius=1' is not a flag; flags begin with --");
  EXPECT_EQ(ReadError("--radius"), "--radius needs a value");
  EXPECT_EQ(ReadError("--radios=1"), "--radios is not a flag; did you mean --radius?");
  EXPECT_EQ(ReadError("--smoth"), "--smoth is not a flag; did you mean --smooth?");
  EXPECT_EQ(ReadError("--nometal"), "--nometal is not a flag; did you mean --metal?");
}

TEST(Fields, ValuesOutOfRangeAreNamed) {
  EXPECT_EQ(CheckError([](Ball*) {}), "");
  EXPECT_EQ(CheckError([](Ball* b) { b->radius = 0; }), "radius = 0; must be finite and > 0");
  EXPECT_EQ(CheckError([](Ball* b) { b->radius = NAN; }), "radius = nan; must be finite and > 0");
  EXPECT_EQ(CheckError([](Ball* b) { b->radius = INFINITY; }),
            "radius = inf; must be finite and > 0");
  EXPECT_EQ(CheckError([](Ball* b) { b->count = 0; }), "count = 0; must be 1 to 10");
  EXPECT_EQ(CheckError([](Ball* b) { b->count = 11; }), "count = 11; must be 1 to 10");
  EXPECT_EQ(CheckError([](Ball* b) { b->sizes = {1, 257}; }), "sizes = 257; must be 1 to 256");
}

TEST(Fields, RangesHoldTheirEndsUnlessTheyAreOpen) {
  EXPECT_TRUE(Between(1, 10).Holds(1) && Between(1, 10).Holds(10) && AtLeast(0).Holds(0));
  EXPECT_FALSE(Above(0).Holds(0));
  EXPECT_TRUE(Above(0).Holds(1e-300) && Any().Holds(-1e300));
  for (const Range& range : {Any(), AtLeast(0), Above(0), Between(0, 1)}) {
    EXPECT_FALSE(range.Holds(NAN) || range.Holds(INFINITY) || range.Holds(-INFINITY));
  }
  EXPECT_EQ(Above(0).Text(), "> 0");
  EXPECT_EQ(AtLeast(1).Text(), ">= 1");
  EXPECT_EQ(Between(1, 1024).Text(), "1 to 1024");
  EXPECT_EQ(Any().Text(), "finite");
}

TEST(Fields, RequiredFieldsNeedAText) {
  Ball ball;
  EXPECT_EQ(ErrorOf([&] { FieldsOf(&ball).CheckRequired(); }), "");
  ball.label = "";
  EXPECT_EQ(ErrorOf([&] { FieldsOf(&ball).CheckRequired(); }), "label is required");
}

TEST(Fields, KnowTheirHelpDefaultAndGroup) {
  Ball ball;
  const Fields fields = FieldsOf(&ball);
  ball.radius = 8.0;  // after the default was noted
  const Field& radius = *fields.Find("radius");
  EXPECT_EQ(radius.default_text, "0.5");
  EXPECT_EQ(radius.text(), "8");
  EXPECT_EQ(radius.group, "The shape");
  EXPECT_TRUE(radius.is_common && !radius.is_switch && !radius.is_required);
  EXPECT_TRUE(fields.Find("label")->is_required && fields.Find("label")->is_common);
  EXPECT_FALSE(fields.Find("count")->is_common);
  EXPECT_TRUE(fields.Find("smooth")->is_switch);
  EXPECT_EQ(fields.Find("metal")->help, "what it is made of (gold | iron)");
  EXPECT_EQ(fields.Find("coat")->help, "what covers it (auto | gold | iron)");
  EXPECT_EQ(fields.Find("coat")->group, "The surface");
  EXPECT_EQ(fields.Find("colour"), nullptr);
}

TEST(Fields, ATableTakesAnother) {
  Ball ball;
  Fields fields;
  fields.Group("Mine");
  int extra = 4;
  fields.Add(FieldsOf(&ball)).Add(Integer("extra", &extra, Any(), "one more"));
  EXPECT_EQ(fields.all().size(), 9u);
  EXPECT_EQ(fields.Find("radius")->group, "The shape");
  EXPECT_EQ(fields.Find("extra")->group, "Mine");
}

TEST(FlagText, IsANameAndPerhapsAValue) {
  EXPECT_EQ(FlagText("--a=b=c").name, "a");
  EXPECT_EQ(FlagText("--a=b=c").value, "b=c");
  EXPECT_EQ(FlagText("-a").name, "a");
  EXPECT_EQ(FlagText("-a").value, std::nullopt);
  EXPECT_EQ(FlagText("--a=").value, "");
}

}  // namespace
}  // namespace pbnbrdf

// The exported C code, compiled and run.
#include "export/formats.h"

#include <cstring>

#include "export/networks.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using Values = std::vector<std::array<float, 3>>;

constexpr const char* kStrict = " -Wall -Wextra -Werror -pedantic ";

// A program that evaluates all networks, one after the other, at the pairs of floats that it reads.
std::string Program(const std::vector<std::pair<std::string, NeuralBrdf>>& networks) {
  std::string text = "#include <stdio.h>\n", calls;
  for (const auto& [name, network] : networks) {
    text += "#include \"" + name + ".h\"\n";
    calls += "    " + name + "_eval(p, p + 3, rgb);\n    fwrite(rgb, sizeof rgb, 1, stdout);\n";
  }
  return text +
         "int main(void) {\n  float p[6], rgb[3];\n  while (fread(p, sizeof p, 1, stdin)) {\n" +
         calls + "  }\n  return 0;\n}\n";
}

class CSourceTest : public testing::Test {
 protected:
  CSourceTest() : networks_(NetworksOfAllKinds()) {
    for (const auto& [name, network] : networks_) {
      WriteBytes(folder_ / (name + ".h"), CSource(network, name));
    }
    WriteBytes(folder_ / "main.c", Program(networks_));
  }

  // What the program, compiled with the flags, prints for the pairs: network n's value at pair p is
  // at p * networks + n.
  Values Run(const std::string& flags, const std::vector<FloatPair>& pairs) const {
    WriteBytes(folder_ / "pairs", std::string(reinterpret_cast<const char*>(pairs.data()),
                                              pairs.size() * sizeof(FloatPair)));
    const std::string compile = StrCat(PBNBRDF_COMPILER, " ", flags, kStrict, folder_ / "main.c",
                                       " -o ", folder_ / "main", " -lm 2> ", folder_ / "errors");
    EXPECT_EQ(std::system(compile.c_str()), 0) << compile << "\n"
                                               << ReadFile(folder_ / "errors", 1 << 24);
    const std::string run =
        StrCat(folder_ / "main", " < ", folder_ / "pairs", " > ", folder_ / "values");
    EXPECT_EQ(std::system(run.c_str()), 0);
    const std::string bytes = ReadFile(folder_ / "values", 1 << 28);
    Values values(bytes.size() / sizeof(Values::value_type));
    EXPECT_EQ(values.size(), pairs.size() * networks_.size());
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  void ExpectReciprocal(const std::string& flags) const {
    const std::vector<FloatPair> pairs = HardPairs();
    std::vector<FloatPair> swapped;
    for (const FloatPair& pair : pairs) swapped.push_back(Swapped(pair));
    const Values there = Run(flags, pairs), back = Run(flags, swapped);
    std::size_t different = 0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      const auto& [name, network] = networks_[i % networks_.size()];
      const bool same = std::memcmp(&there[i], &back[i], sizeof(there[i])) == 0;
      if (IsReciprocal(network)) {
        ASSERT_TRUE(same) << flags << " " << name << " pair " << i / networks_.size();
      } else {
        different += !same;
      }
    }
    EXPECT_GT(different, pairs.size());  // the comparison can fail
  }

  TemporaryFolder folder_;
  const std::vector<std::pair<std::string, NeuralBrdf>> networks_;
};

TEST_F(CSourceTest, AgreesWithTheLibraryAsC99) {
  const std::vector<FloatPair> pairs = HardPairs();
  const Values values = Run("-x c -std=c99 -O2", pairs);
  double worst = 0.0;
  std::size_t positive = 0;
  for (std::size_t n = 0; n < networks_.size(); ++n) {
    const std::vector<Rgb> expected = LibraryValues(networks_[n].second, pairs);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      for (int c = 0; c < 3; ++c) {
        const double value = values[p * networks_.size() + n][c], f = expected[p][c];
        // The smallest are those where expm1 is about 0, and z no more than rounded.
        const double error = std::abs(value - f) / (f + 1e-9);
        ASSERT_LE(error, 1e-5) << networks_[n].first << " pair " << p << ": " << value << " " << f;
        worst = std::max(worst, error);
        positive += f > 0.0;
      }
    }
  }
  EXPECT_GT(positive, pairs.size() * networks_.size());
  RecordProperty("worst_error", FormatNumber(worst));
}

TEST_F(CSourceTest, IsReciprocalToTheBit) {
  ExpectReciprocal("-x c -std=c99 -O2 -ffp-contract=off");
  ExpectReciprocal("-x c -std=gnu99 -O3 -ffp-contract=fast");
#if defined(__x86_64__)
  if (__builtin_cpu_supports("fma")) ExpectReciprocal("-x c -std=c99 -O3 -mfma -ffp-contract=fast");
#endif
}

TEST_F(CSourceTest, IsCppToo) {
  const std::vector<FloatPair> pairs = {HardPairs()[1]};
  EXPECT_EQ(Run("-x c++ -std=c++11 -O1", pairs), Run("-x c -std=c99 -O1", pairs));
}

TEST(CSource, TextsThatAreNotCodeStayComments) {
  const NetworkShape shape(Encoding::kMerl, {2}, Activation::kTanh);
  const NeuralBrdf network(shape, RandomWeights(shape, 1.0, 1), {{"material", "a*/b\\\n?c\xff@"}});
  const std::string text = CSource(network, "gold");
  EXPECT_THAT(text, HasSubstr("fitted to a_/b___c_@.\n"));
  EXPECT_THAT(ErrorOf([&] { CSource(network, "2gold"); }), HasSubstr("name=2gold is not a letter"));
  EXPECT_THAT(ErrorOf([&] { CSource(network, "gold-paint"); }), HasSubstr("is not a letter"));
  EXPECT_THAT(ErrorOf([&] { CSource(network, ""); }), HasSubstr("is not a letter"));
}

}  // namespace
}  // namespace pbnbrdf

#include "pbnbrdf/sources/table_pca.h"

#include "brdf/value_at.h"
#include "network/safetensors.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// Two components; the median is what a white surface has.
TablePca Pca() {
  const auto bins = MerlBrdf::BinsAboveHorizon().size();
  std::vector<float> mean(bins), components(2 * bins, 0.1f);
  for (std::size_t n = 0; n < bins; ++n) {
    mean[n] = static_cast<float>(n % 7) * 0.1f;
    components[bins + n] = static_cast<float>(n % 5) * 0.2f - 0.4f;
  }
  return TablePca(std::vector<float>(bins, 0.3f), std::move(mean), std::move(components),
                  {{"gold", {1, 0, 0, 1, -1, 0.5}}, {"felt", {0, 0, 0, 0, 0, 0}}});
}

TEST(TablePca, TheTableOfACodeHasTheMappedValuesThatRowsSay) {
  const TablePca pca = Pca();
  const MerlBrdf gold = pca.Material("gold");
  for (const std::size_t bin : {50u * 16200u + 20u * 180u + 7u, 3u * 16200u + 40u * 180u + 90u}) {
    const DirectionPair pair = MerlBrdf::CornerPair(bin);
    const TablePca::Row row = pca.RowAt(pair);
    const Rgb value = ValueAt(gold, pair);
    const double codes[3][2] = {{1, 0}, {0, 1}, {-1, 0.5}};
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(row.Mapped(value[c]),
                  row.mean + codes[c][0] * row.components[0] + codes[c][1] * row.components[1],
                  1e-6);
    }
  }
}

TEST(TablePca, MappedIsTheFormula) {
  const TablePca::Row row = Pca().RowAt({FromSpherical(0.3, 0.0), FromSpherical(0.7, 2.0)});
  const double w = std::cos(0.3) * std::cos(0.7);
  EXPECT_NEAR(row.Mapped(0.5), std::log((0.5 * w + 1e-3) / (0.3 * w + 1e-3)), 1e-6);
  EXPECT_NEAR(row.Mapped(-0.5), std::log(1e-3 / (0.3 * w + 1e-3)), 1e-6);
}

TEST(TablePca, FilesRoundTrip) {
  const TemporaryFolder folder;
  const TablePca pca = Pca();
  pca.Write(folder / "a.pca");
  const TablePca read = TablePca::Read(folder / "a.pca");
  EXPECT_EQ(read.num_components(), 2);
  EXPECT_EQ(read.members()[0].code, pca.members()[0].code);
  EXPECT_TRUE(read.Material("gold").FileBytes() == pca.Material("gold").FileBytes());
}

TEST(TablePca, RefusesPartsThatDoNotFit) {
  const auto bins = MerlBrdf::BinsAboveHorizon().size();
  const std::vector<float> plane(bins);
  EXPECT_THAT(ErrorOf([&] {
                TablePca({1.0f}, plane, plane, {{"a", {0, 0, 0}}});
              }),
              HasSubstr("median and mean: 1 and"));
  EXPECT_THAT(ErrorOf([&] {
                TablePca(plane, plane, {1.0f}, {{"a", {0, 0, 0}}});
              }),
              HasSubstr("components: 1 numbers"));
  EXPECT_THAT(ErrorOf([&] {
                TablePca(plane, plane, plane, {{"a", {0, 0}}});
              }),
              HasSubstr("codes: 2 numbers for a, not 3"));
  const TemporaryFolder folder;
  WriteFile(folder / "x", SafetensorsBytes({{{"a", {{1}, {1.0}}}}, {{"format", "other"}}}));
  EXPECT_THAT(ErrorOf([&] { TablePca::Read(folder / "x"); }),
              HasSubstr("not principal components"));
}

}  // namespace
}  // namespace pbnbrdf

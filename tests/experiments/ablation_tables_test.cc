#include "ablation_tables.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

AblationRecord Record(int table, const std::string& set_up, const std::string& material,
                      std::size_t seed = 1) {
  AblationRecord record;
  record.table = table;
  record.set_up = set_up;
  record.material = material;
  record.seed = seed;
  record.colors.dark_samples = 100;
  return record;
}

AblationRecord ReciprocityRecord(const std::string& material, std::size_t seed, double hrl) {
  AblationRecord record = Record(1, "nbrdf", material, seed);
  record.reciprocity.hrl = hrl;
  return record;
}

TEST(AblationMarkdown, HasMediansOfSeedsAndTheWorstFit) {
  // HRL: gold 0.001, 0.002, 0.009, of median 0.002, and tin 0.004. As 10^3: median 3, worst 9.
  const std::string text =
      AblationMarkdown({ReciprocityRecord("gold", 1, 0.009), ReciprocityRecord("gold", 2, 0.001),
                        ReciprocityRecord("gold", 3, 0.002), ReciprocityRecord("tin", 1, 0.004)});
  EXPECT_THAT(text, ContainsRegex("\\| nbrdf +\\| +3.00 \\| +9.00 \\|"));
  EXPECT_THAT(text, HasSubstr("| NBRDF       |      14729 |         52 |"));
  EXPECT_THAT(text, Not(HasSubstr("## Energy")));
  EXPECT_THAT(text, Not(HasSubstr("## Chromaticity")));
}

TEST(AblationMarkdown, CountsMaterialsThatMakeEnergy) {
  std::vector<AblationRecord> records;
  for (const auto& [material, albedo] : std::vector<std::pair<std::string, double>>{
           {"gold", 1.1}, {"gold", 1.2}, {"tin", 1.0 + 5e-7}, {"zinc", 1.0 + 2e-6}}) {
    records.push_back(Record(2, "log", material, records.size()));
    records.back().energy.max_directional_albedo = albedo;
  }
  EXPECT_THAT(AblationMarkdown(records),
              ContainsRegex("\\| log +\\| +1.0000020 \\| +1.2000000 \\|.*\\| 2 of 3 "));
}

TEST(AblationMarkdown, SaysWhatTheEnergyTermCostsWhichMaterials) {
  std::vector<AblationRecord> records;
  for (const auto& [material, albedo, error, energy_error] :
       {std::tuple("dark", 0.5, 0.1, 0.1), std::tuple("white", 1.0, 0.1, 0.2),
        std::tuple("diverges", 7.0, 0.1, 0.8)}) {
    records.push_back(Record(4, kMaterialItself, material));
    records.back().energy.max_directional_albedo = albedo;
    records.push_back(Record(4, "log", material));
    records.back().errors.mean_abs_log_error = error;
    records.push_back(Record(4, "log + energy", material));
    records.back().errors.mean_abs_log_error = energy_error;
  }
  const std::string text = AblationMarkdown(records);
  EXPECT_THAT(text,
              HasSubstr("| all                                  |         3 |  2.000 | 8.000 |"));
  EXPECT_THAT(text,
              HasSubstr("| conserve energy themselves           |         2 |  1.500 | 2.000 |"));
  EXPECT_THAT(text,
              HasSubstr("| don't                                |         1 |  8.000 | 8.000 |"));
}

AblationRecord DarkRecord(const std::string& set_up, const std::string& material,
                          const std::string& material_class, double p95) {
  AblationRecord record = Record(3, set_up, material);
  record.material_class = material_class;
  record.colors.dark_hue_chroma_p95 = p95;
  return record;
}

const std::vector<AblationRecord> kDarkRecords = {
    DarkRecord("log", "gold", "metal", 1.0),  DarkRecord("more", "gold", "metal", 0.8),
    DarkRecord("log", "tin", "metal", 1.0),   DarkRecord("more", "tin", "metal", 1.05),
    DarkRecord("log", "felt", "fabric", 2.0), DarkRecord("more", "felt", "fabric", 2.3),
    DarkRecord("log", "silk", "fabric", 2.0)};

TEST(DarkColorChanges, AreThoseOfMoreThanATenth) {
  const std::vector<Change> changes = DarkColorChanges(kDarkRecords, "log", "more");
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].material_class, "metal");
  EXPECT_EQ(changes[0].materials, 2);
  EXPECT_THAT(changes[0].falls, ElementsAre("gold"));
  EXPECT_THAT(changes[0].rises, ElementsAre());
  EXPECT_EQ(changes[1].materials, 1);  // silk has but one set-up
  EXPECT_THAT(changes[1].rises, ElementsAre("felt"));
}

TEST(DarkColorChanges, LeaveOutMaterialsWithoutDarkColours) {
  std::vector<AblationRecord> records = kDarkRecords;
  for (AblationRecord& record : records) {
    if (record.material == "gold") record.colors.dark_samples = 0;
  }
  EXPECT_EQ(DarkColorChanges(records, "log", "more")[0].materials, 1);
}

TEST(AblationMarkdown, SaysWhereChromaticityHelps) {
  const std::string text = AblationMarkdown(kDarkRecords);
  EXPECT_THAT(text,
              HasSubstr("more against log: dark hue/chroma p95 falls by more than 10 % on 1 of "
                        "3 materials and rises by more than 10 % on 1."));
  EXPECT_THAT(text, ContainsRegex("\\| metal +\\| +2 \\| +1 \\| +0 \\|"));
  EXPECT_THAT(text, ContainsRegex("\\| fabric +\\| +1 \\| +0 \\| +1 \\|"));
  EXPECT_THAT(text, HasSubstr("It falls on: gold.\nIt rises on: felt.\n"));
}

TEST(AblationCsv, HasACellForEachColumn) {
  AblationRecord record = Record(3, "log + energy", "gold", 7);
  record.colors.delta_e_p95 = 0.25;
  const std::vector<std::string> header = AblationCsvHeader(), row = AblationCsvRow(record);
  ASSERT_EQ(header.size(), row.size());
  const auto cell = [&](const std::string& column) {
    return row.at(std::find(header.begin(), header.end(), column) - header.begin());
  };
  EXPECT_EQ(cell("seed"), "7");
  EXPECT_EQ(cell("delta_e_p95"), "0.25");
  EXPECT_EQ(cell("dark_samples"), "100");
}

TEST(IsFinite, FindsWhatIsNotANumber) {
  AblationRecord record = Record(3, "log", "gold");
  EXPECT_TRUE(IsFinite(record));
  record.colors.delta_e_mean = NAN;
  EXPECT_FALSE(IsFinite(record));
}

}  // namespace
}  // namespace pbnbrdf

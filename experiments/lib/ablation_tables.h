// ablation_tables.h: fits with and without each of the paper's terms, as tables. Tables 1 to 3 are numbered
// as the paper's: reciprocity, energy, chromaticity. Table 4 has all terms together.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/metrics/brdf_metrics.h"

namespace pbnbrdf {

// One fit; or, in tables 2 and 4, what the fits are to reproduce, if set_up is kMaterialItself.
struct AblationRecord {
  int table = 1;       // 1 to 4
  std::string set_up;  // a row of the table
  std::string material, material_class;
  std::uint64_t seed = 0;
  int iterations = 0;
  double seconds = 0.0;
  HeldOutErrors errors;
  ColorErrors colors;
  Reciprocity reciprocity;
  Energy energy;
};

inline constexpr char kMaterialItself[] = "the material itself";

// The columns of a CSV and a record's row, every measure in full.
std::vector<std::string> AblationCsvHeader();
std::vector<std::string> AblationCsvRow(const AblationRecord& record);

// Whether each measure is a number; the tables are of such records.
bool IsFinite(const AblationRecord& record);

// A section for each table that has records. A row for each set-up has, for each measure, the median
// over materials (of each the median of its seeds) and the worst of all fits; the paper's figures stand
// below. Table 3 also says, against its first set-up, on which kinds of material the 95th percentile of
// the dark colours' hue and chroma error falls or rises by more than 10 %.
std::string AblationMarkdown(const std::vector<AblationRecord>& records);

// How many materials a measure falls or rises on by more than 10 % from one set-up to another.
struct Change {
  std::string material_class;
  std::vector<std::string> falls, rises;  // the materials' names
  int materials = 0;                      // that both set-ups have fitted
};

// Of dark_hue_chroma_p95, class by class; materials without dark colours are left out. records: of
// one table.
std::vector<Change> DarkColorChanges(const std::vector<AblationRecord>& records,
                                     const std::string& from, const std::string& to);

}  // namespace pbnbrdf

// ReadScatteredCsv of scattered_files.h.
#include <algorithm>
#include <array>
#include <optional>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/sources/scattered_files.h"
#include "sources/direction_columns.h"
#include "sources/make_scattered.h"
#include "sources/sample_weights.h"

namespace pbnbrdf {
namespace {

using Names = std::array<const char*, 3>;

const std::string kWanted = std::string(kDirectionColumns) + ", and value or r,g,b";

struct Columns {
  DirectionColumns directions;
  std::vector<std::size_t> values;  // of R, G, B, or of the only channel
  std::vector<std::size_t> sigmas;  // the same, or none
};

// Of all the names, else of the single one, else none. Throws Error if both are there.
std::vector<std::size_t> FindAll(const TextTable& table, const Names& all, const char* single) {
  const std::vector<std::size_t> columns = table.FindColumns(all);
  const auto at = table.FindColumn(single);
  if (columns.size() != all.size()) return at ? std::vector{*at} : std::vector<std::size_t>();
  if (at) Fail(table.path(), ": columns ", single, " and ", all[0], ", ...; leave out one");
  return columns;
}

// None if the table's line doesn't name them.
std::optional<Columns> FindColumns(TextTable* table) {
  const auto directions = DirectionColumns::Find(table);
  if (!directions) return std::nullopt;
  Columns columns = {*directions, FindAll(*table, {"r", "g", "b"}, "value"),
                     FindAll(*table, {"sigma_r", "sigma_g", "sigma_b"}, "sigma")};
  if (!columns.values.empty()) return columns;
  table->ForgetNames();
  return std::nullopt;
}

bool IsComplete(const TextTable& table, const Columns& columns) {
  const auto is_missing = [&](std::size_t column) { return table.IsMissing(column); };
  return !columns.directions.AreMissing(table) &&
         std::none_of(columns.values.begin(), columns.values.end(), is_missing) &&
         std::none_of(columns.sigmas.begin(), columns.sigmas.end(), is_missing);
}

BrdfSample ParseSample(const TextTable& table, const Columns& columns) {
  BrdfSample sample;
  sample.pair = columns.directions.Parse(table);
  for (std::size_t c = 0; c < 3; ++c) {
    sample.value[c] = table.Number(columns.values[std::min(c, columns.values.size() - 1)]);
  }
  return sample;
}

// The mean of the channels'.
double ParseSigma(const TextTable& table, const Columns& columns) {
  double sum = 0.0;
  for (std::size_t column : columns.sigmas) {
    const double sigma = table.Number(column);
    if (sigma < 0.0) {
      Fail(table.Place(), ", ", table.names()[column], ": ", sigma, "; must be >= 0");
    }
    sum += sigma;
  }
  return sum / static_cast<double>(columns.sigmas.size());
}

// What has been read of a file so far.
class Reading {
 public:
  void Take(TextTable* table) {
    if (table->IsComment()) {
      TakeComment(table);
    } else if (columns_) {
      TakeRow(*table);
    } else if (columns_ = FindColumns(table); !columns_) {
      Fail(table->Place(), ": the first line must name the columns ", kWanted);
    }
  }

  ScatteredData Finish(const std::string& path) {
    if (!columns_) Fail(path, ": no line that names the columns ", kWanted);
    if (!sigmas_.empty()) SetWeights(sigmas_, data_.samples);
    data_.kind = "CSV measurements";
    data_.channels = static_cast<int>(columns_->values.size());
    data_.isotropic = said_isotropic_.value_or(HaveOneIncidentAzimuth(data_.samples));
    return std::move(data_);
  }

 private:
  // It may also name the columns, as numpy.savetxt has it.
  void TakeComment(TextTable* table) {
    const std::string_view comment = Trim(table->line().substr(1));
    if (comment == "isotropic" || comment == "anisotropic") {
      said_isotropic_ = comment == "isotropic";
    } else if (!columns_) {
      columns_ = FindColumns(table);
    }
  }

  void TakeRow(const TextTable& table) {
    table.RequireCells(table.names().size());
    if (!IsComplete(table, *columns_)) {
      ++data_.left_out;
      return;
    }
    data_.samples.push_back(ParseSample(table, *columns_));
    if (!columns_->sigmas.empty()) sigmas_.push_back(ParseSigma(table, *columns_));
  }

  std::optional<Columns> columns_;
  std::optional<bool> said_isotropic_;
  ScatteredData data_;
  std::vector<double> sigmas_;
};

}  // namespace

bool LooksLikeScatteredCsv(std::string_view start) {
  if (LooksLikeUtf16(start)) return true;
  TextTable table("", std::string(start), TextTable::Cells::kFound);
  while (table.Next()) {
    const std::string line = LowerCase(table.line());
    const bool named = line.find("theta_i") != line.npos || line.find("wi_x") != line.npos;
    if (!table.IsComment()) return named && table.cells().size() > 1;
    if (named && FindColumns(&table)) return true;
  }
  return false;
}

ScatteredBrdf ReadScatteredCsv(const std::string& path) {
  TextTable table = TextTable::Read(path, TextTable::Cells::kFound);
  Reading reading;
  while (table.Next()) reading.Take(&table);
  return MakeScattered(path, reading.Finish(path));
}

}  // namespace pbnbrdf

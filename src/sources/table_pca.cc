#include "pbnbrdf/sources/table_pca.h"

#include <algorithm>
#include <cmath>

#include "base/about.h"
#include "network/members.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxTableBytes = std::uintmax_t{2}
                                          << 30;  // bytes; kMaxComponents have 1.2 GB

std::vector<float> FloatsOf(const SafetensorsFile& file, const std::string& name) {
  const std::vector<double>& values = TensorOf(file, name).values;
  return {values.begin(), values.end()};
}

Tensor TensorOfFloats(std::vector<std::int64_t> shape, const std::vector<float>& values) {
  return {std::move(shape), {values.begin(), values.end()}};
}

double Cosines(const DirectionPair& pair) { return pair.wi.z * pair.wo.z; }

}  // namespace

TablePca::TablePca(std::vector<float> median, std::vector<float> mean,
                   std::vector<float> components, std::vector<DatabaseMember> members)
    : bins_(MerlBrdf::BinsAboveHorizon()),
      place_(MerlBrdf::kBins, -1),
      median_(std::move(median)),
      mean_(std::move(mean)),
      components_(std::move(components)),
      members_(std::move(members)) {
  if (median_.size() != bins_.size() || mean_.size() != bins_.size()) {
    Fail("median and mean: ", median_.size(), " and ", mean_.size(), " numbers, not ",
         bins_.size());
  }
  const std::size_t rows = components_.size() / bins_.size();
  if (rows < 1 || rows > kMaxComponents || rows * bins_.size() != components_.size()) {
    Fail("components: ", components_.size(), " numbers, not 1 to ", kMaxComponents, " times ",
         bins_.size());
  }
  num_components_ = static_cast<int>(rows);
  CheckMembers(members_, 3 * rows);
  for (std::size_t n = 0; n < bins_.size(); ++n) place_[bins_[n]] = static_cast<int>(n);
}

TablePca TablePca::Read(const std::string& path) {
  const SafetensorsFile file = ReadSafetensors(path, kMaxTableBytes);
  return About(path, [&] {
    if (MetadataOf(file, "format") != kFormat) {
      Fail("not principal components: its format is another");
    }
    return TablePca(FloatsOf(file, "median"), FloatsOf(file, "mean"), FloatsOf(file, "components"),
                    ReadMembers(file));
  });
}

void TablePca::Write(const std::string& path) const {
  const auto bins = static_cast<std::int64_t>(bins_.size());
  SafetensorsFile file;
  file.metadata["format"] = kFormat;
  file.tensors["median"] = TensorOfFloats({bins}, median_);
  file.tensors["mean"] = TensorOfFloats({bins}, mean_);
  file.tensors["components"] = TensorOfFloats({num_components_, bins}, components_);
  AddMembers(members_, &file);
  WriteFile(path, SafetensorsBytes(file, /*single=*/true));
}

MerlBrdf TablePca::At(std::span<const double> code) const {
  const auto components = static_cast<std::size_t>(num_components_);
  std::vector<BinValue> values(bins_.size());
  std::vector<double> logs(bins_.size());
  for (std::size_t n = 0; n < bins_.size(); ++n) values[n].bin = bins_[n];
  for (std::size_t c = 0; c < 3; ++c) {
    logs.assign(mean_.begin(), mean_.end());
    for (std::size_t k = 0; k < components; ++k) {
      const double number = code[c * components + k];
      const float* component = components_.data() + k * bins_.size();
      for (std::size_t n = 0; n < bins_.size(); ++n) logs[n] += number * component[n];
    }
    for (std::size_t n = 0; n < bins_.size(); ++n) {
      const double w = std::max(Cosines(MerlBrdf::CornerPair(bins_[n])), kOffset);
      const double f = (std::exp(logs[n]) * (median_[n] * w + kOffset) - kOffset) / w;
      values[n].value[c] = std::clamp(f, 0.0, Brdf::kLargestValue);
    }
  }
  return MerlBrdf::FromValues(values);
}

MerlBrdf TablePca::Material(const std::string& name) const {
  return At(FindMember(members_, name).code);
}

// Between those of the eight bins around the pair that are above the horizon; 0 if there are none.
TablePca::Row TablePca::RowAt(const DirectionPair& pair) const {
  Row row = {Cosines(pair), 0.0, 0.0,
             std::vector<double>(static_cast<std::size_t>(num_components_))};
  const auto corners = CornersOf({}, pair);
  const auto is_used = [&](std::size_t bin, double weight) {
    return weight > 0.0 && place_[bin] >= 0;
  };
  double total = 0.0;
  for (const auto& [bin, weight] : corners) total += is_used(bin, weight) ? weight : 0.0;
  for (const auto& [bin, weight] : corners) {
    if (!is_used(bin, weight)) continue;
    const double part = weight / total;
    const auto n = static_cast<std::size_t>(place_[bin]);
    row.median += part * median_[n];
    row.mean += part * mean_[n];
    for (std::size_t k = 0; k < row.components.size(); ++k) {
      row.components[k] += part * components_[k * bins_.size() + n];
    }
  }
  return row;
}

}  // namespace pbnbrdf

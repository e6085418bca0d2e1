#include "pbnbrdf/network/weight_family.h"

#include <algorithm>
#include <cmath>

#include "base/about.h"
#include "base/text.h"
#include "network/members.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

void CheckNumbers(std::string_view name, const std::vector<double>& values, std::size_t wanted) {
  if (values.size() != wanted) Fail(name, ": ", values.size(), " numbers, not ", wanted);
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    Fail(name, ": one isn't finite");
  }
}

std::string HiddenText(const NetworkShape& shape) {
  std::vector<std::string> sizes;
  for (const int size : shape.hidden()) sizes.push_back(StrCat(size));
  return Join(sizes, ",");
}

NetworkShape ShapeOf(const SafetensorsFile& file) {
  std::vector<int> hidden;
  for (const std::string& size : Split(MetadataOf(file, "hidden"), ',')) {
    hidden.push_back(static_cast<int>(std::clamp(ParseInteger("hidden", size), 0L, 1L << 20)));
  }
  const long outputs = ParseInteger("outputs", MetadataOf(file, "outputs"));
  return NetworkShape(ParseName(kEncodings, "encoding", MetadataOf(file, "encoding")),
                      std::move(hidden),
                      ParseName(kActivations, "activation", MetadataOf(file, "activation")),
                      static_cast<int>(std::clamp(outputs, 0L, 1L << 20)));
}

}  // namespace

WeightFamily::WeightFamily(const NetworkShape& shape, std::vector<double> mean,
                           std::vector<double> basis, std::vector<DatabaseMember> members,
                           NeuralBrdf::Metadata metadata)
    : shape_(shape),
      code_size_(static_cast<int>(basis.size() / static_cast<std::size_t>(shape.num_weights()))),
      mean_(std::move(mean)),
      basis_(std::move(basis)),
      members_(std::move(members)),
      metadata_(std::move(metadata)) {
  const auto weights = static_cast<std::size_t>(shape.num_weights());
  const auto code_size = static_cast<std::size_t>(code_size_);
  if (code_size_ < 1 || code_size_ > kMaxCodeSize) {
    Fail("basis: ", code_size_, " rows; must be 1 to ", kMaxCodeSize);
  }
  CheckNumbers("mean", mean_, weights);
  CheckNumbers("basis", basis_, code_size * weights);
  CheckMembers(members_, code_size);
}

WeightFamily WeightFamily::Read(const std::string& path) {
  const SafetensorsFile file = ReadSafetensors(path);
  return About(path, [&] {
    if (MetadataOf(file, "format") != kFormat) Fail("not a prior: its format is another");
    std::vector<DatabaseMember> members = ReadMembers(file);
    return WeightFamily(ShapeOf(file), TensorOf(file, "mean").values,
                        TensorOf(file, "basis").values, std::move(members), file.metadata);
  });
}

void WeightFamily::Write(const std::string& path) const {
  SafetensorsFile file;
  file.metadata = metadata_;
  file.metadata["format"] = kFormat;
  file.metadata["encoding"] = NameOf(kEncodings, shape_.encoding());
  file.metadata["activation"] = NameOf(kActivations, shape_.activation());
  file.metadata["hidden"] = HiddenText(shape_);
  file.metadata["outputs"] = StrCat(shape_.num_outputs());
  file.tensors["mean"] = {{shape_.num_weights()}, mean_};
  file.tensors["basis"] = {{code_size_, shape_.num_weights()}, basis_};
  AddMembers(members_, &file);
  WriteFile(path, SafetensorsBytes(file));
}

std::vector<double> WeightFamily::WeightsAt(std::span<const double> code) const {
  std::vector<double> weights = mean_;
  const double* row = basis_.data();
  for (const double number : code) {
    for (double& weight : weights) weight += number * *row++;
  }
  return weights;
}

NeuralBrdf WeightFamily::Material(const std::string& name) const {
  return NeuralBrdf(shape_, WeightsAt(FindMember(members_, name).code), {{"material", name}});
}

}  // namespace pbnbrdf

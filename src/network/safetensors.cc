#include "network/safetensors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kLengthBytes = 8;
constexpr std::size_t kAlignment = 8;

// `data`: where the tensors' bytes begin in `bytes`.
Tensor ParseTensor(const std::string& place, const Json& entry, const std::string& bytes,
                   std::size_t data) {
  Tensor tensor;
  std::string dtype;
  std::vector<std::uint64_t> offsets;
  try {
    entry.at("dtype").get_to(dtype);
    entry.at("shape").get_to(tensor.shape);
    entry.at("data_offsets").get_to(offsets);
  } catch (const Json::exception&) {
    Fail(place, ": expected dtype, shape and data_offsets");
  }
  if (dtype != "F64" && dtype != "F32") Fail(place, ": dtype ", dtype, " is not one of F64 | F32");
  const std::size_t size = dtype == "F64" ? sizeof(double) : sizeof(float);
  const std::size_t available = bytes.size() - data;
  const std::size_t count = ElementCount(tensor.shape, available);
  if (count == 0) Fail(place, ": shape ", JsonLine(tensor.shape), " doesn't fit the file");
  if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > available ||
      offsets[1] - offsets[0] != count * size) {
    Fail(place, ": data_offsets ", JsonLine(offsets), " don't fit shape ", JsonLine(tensor.shape),
         " of ", dtype, " in ", available, " bytes of data");
  }
  const auto data_bytes = std::string_view(bytes).substr(data + offsets[0], count * size);
  tensor.values = dtype == "F64" ? ToDoubles<double>(data_bytes) : ToDoubles<float>(data_bytes);
  for (double value : tensor.values) {
    if (!std::isfinite(value)) Fail(place, ": holds a value that is not finite");
  }
  return tensor;
}

std::map<std::string, std::string> ParseMetadata(const std::string& path, const Json& entry) {
  try {
    return entry.get<std::map<std::string, std::string>>();
  } catch (const Json::exception&) {
    Fail(path, ": __metadata__ must map names to texts");
  }
}

template <typename T>
void AppendBytes(const std::vector<T>& values, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

}  // namespace

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  if (shape.empty()) return "a scalar";
  std::string text;
  for (std::int64_t extent : shape) text += StrCat(text.empty() ? "" : " x ", extent);
  return text;
}

std::uint64_t ElementCount(const std::vector<std::int64_t>& shape, std::uint64_t limit) {
  std::uint64_t count = 1;
  for (std::int64_t extent : shape) {
    if (extent < 1 || static_cast<std::uint64_t>(extent) > limit / count) return 0;
    count *= static_cast<std::uint64_t>(extent);
  }
  return count;
}

SafetensorsFile ReadSafetensors(const std::string& path, std::uintmax_t max_size) {
  const std::string bytes = ReadFile(path, max_size);
  std::uint64_t header_size = 0;
  if (bytes.size() >= kLengthBytes) std::memcpy(&header_size, bytes.data(), kLengthBytes);
  if (header_size < 2 || header_size > bytes.size() - kLengthBytes) {
    Fail(path, ": not a safetensors file: its first 8 bytes say that the header has ", header_size,
         " bytes, the file has ", bytes.size());
  }
  const char* header_begin = bytes.data() + kLengthBytes;
  const Json header = ParseJson({header_begin, header_size});
  if (!header.is_object()) Fail(path, ": not a safetensors file: its header is not a JSON object");
  SafetensorsFile file;
  std::size_t used = 0;
  for (const auto& [name, entry] : header.items()) {
    if (name == "__metadata__") {
      file.metadata = ParseMetadata(path, entry);
    } else {
      const Tensor& tensor = file.tensors[name] =
          ParseTensor(StrCat(path, ": tensor ", name), entry, bytes, kLengthBytes + header_size);
      used += tensor.values.size() * (entry["dtype"] == "F64" ? sizeof(double) : sizeof(float));
    }
  }
  const std::size_t available = bytes.size() - kLengthBytes - header_size;
  if (used != available) {
    Fail(path, ": its tensors take ", used, " bytes, but ", available, " follow the header");
  }
  return file;
}

std::string SafetensorsBytes(const SafetensorsFile& file, bool single) {
  Json header = Json::object();
  if (!file.metadata.empty()) header["__metadata__"] = file.metadata;
  std::string data;
  for (const auto& [name, tensor] : file.tensors) {
    const std::size_t begin = data.size();
    if (single) {
      AppendBytes(std::vector<float>(tensor.values.begin(), tensor.values.end()), &data);
    } else {
      AppendBytes(tensor.values, &data);
    }
    header[name] = {{"data_offsets", {begin, data.size()}},
                    {"dtype", single ? "F32" : "F64"},
                    {"shape", tensor.shape}};
  }
  // File names may be in it that aren't UTF-8.
  std::string text = JsonLine(header);
  text.resize((text.size() + kAlignment - 1) / kAlignment * kAlignment, ' ');
  const std::uint64_t header_size = text.size();
  std::string bytes(kLengthBytes, '\0');
  std::memcpy(bytes.data(), &header_size, kLengthBytes);
  return bytes + text + data;
}

}  // namespace pbnbrdf

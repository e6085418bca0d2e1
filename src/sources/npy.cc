#include "sources/npy.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMaxDimensions = 32;  // NumPy's own limit

// The header's text, printable ASCII, and where the elements begin.
struct Layout {
  std::string_view header;
  std::size_t data;
};

Layout FindHeader(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kVersionBytes = 2;
  const std::size_t length_at = kMagic.size() + kVersionBytes;
  if (!bytes.starts_with(kMagic) || bytes.size() < length_at + sizeof(std::uint32_t)) {
    Fail(path, ": not a .npy file; write one with numpy.save");
  }
  const int version = bytes[kMagic.size()];
  if (version < 1 || version > 3) {
    Fail(path, ": .npy version ", version, ", expected 1 to 3; write it with numpy.save");
  }
  std::uint32_t length = 0;  // two bytes in version 1, four later
  const std::size_t length_bytes = version == 1 ? sizeof(std::uint16_t) : sizeof(std::uint32_t);
  std::memcpy(&length, bytes.data() + length_at, length_bytes);
  const std::size_t begin = length_at + length_bytes;
  if (length > bytes.size() - begin) {
    Fail(path, ": truncated .npy file: a header of ", length, " bytes in a file of ", bytes.size());
  }
  const std::string_view header = Trim(bytes.substr(begin, length));
  // Later messages quote from it.
  const bool printable =
      std::all_of(header.begin(), header.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (!printable) Fail(path, ": damaged .npy header: it isn't text; copy the file again");
  return {header, begin + length};
}

// The header's text between `open` and `close` after 'key':.
std::string_view HeaderValue(const std::string& path, std::string_view header, const char* key,
                             std::string_view open, std::string_view close) {
  const std::string quoted = StrCat("'", key, "':");
  const std::size_t at = header.find(quoted);
  if (at != std::string_view::npos) {
    const std::string_view rest = Trim(header.substr(at + quoted.size()));
    const std::size_t end = rest.find(close, open.size());
    if (rest.starts_with(open) && end != std::string_view::npos) {
      return Trim(rest.substr(open.size(), end - open.size()));
    }
  }
  Fail(path, ": damaged .npy header: '", key, "' is missing or not what numpy.save writes");
}

// "6, 21" or "21,": NumPy ends a tuple of one with a comma.
std::vector<std::int64_t> ParseShape(const std::string& path, std::string_view text) {
  std::vector<std::int64_t> shape;
  if (text.ends_with(',')) text.remove_suffix(1);
  if (text.empty()) return shape;
  for (const std::string& extent : Split(text, ',')) {
    shape.push_back(ParseInteger(StrCat(path, ": 'shape'"), extent));
  }
  if (shape.size() > kMaxDimensions) Fail(path, ": ", shape.size(), " dimensions");
  return shape;
}

// From first index fastest to last index fastest, for the rows x columns of a matrix.
std::vector<double> Transposed(const std::vector<double>& values, std::size_t rows,
                               std::size_t columns) {
  std::vector<double> result(values.size());
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) result[r * columns + c] = values[c * rows + r];
  }
  return result;
}

}  // namespace

Tensor ReadNpy(const std::string& path) {
  const std::string bytes = ReadFile(path, kMaxWeightFileSize);
  const auto [header, data] = FindHeader(path, bytes);
  const std::string_view elements = std::string_view(bytes).substr(data);
  const std::string_view type = HeaderValue(path, header, "descr", "'", "'");
  const std::string_view order = HeaderValue(path, header, "fortran_order", "", ",");
  Tensor tensor;
  tensor.shape = ParseShape(path, HeaderValue(path, header, "shape", "(", ")"));
  if (type != "<f4" && type != "<f8") {
    Fail(path, ": elements of type '", type, "', expected '<f4' or '<f8'; save x.astype('<f4')");
  }
  const std::size_t size = type == "<f4" ? sizeof(float) : sizeof(double);
  const std::uint64_t count = ElementCount(tensor.shape, elements.size() / size);
  if (count == 0 || count * size != elements.size()) {
    Fail(path, ": its header says ", ShapeText(tensor.shape), " of '", type, "', but ",
         elements.size(), " bytes follow: truncated or damaged; copy it again");
  }
  tensor.values = type == "<f4" ? ToDoubles<float>(elements) : ToDoubles<double>(elements);
  if (order == "True" && tensor.shape.size() == 2) {
    tensor.values = Transposed(tensor.values, tensor.shape[0], tensor.shape[1]);
  } else if (order != "False" && !(order == "True" && tensor.shape.size() < 2)) {
    Fail(path, ": 'fortran_order' is '", order, "'; save numpy.ascontiguousarray(x)");
  }
  return tensor;
}

std::string NpyBytes(const Tensor& tensor) {
  constexpr std::size_t kAlignment = 64;
  std::string extents;
  for (std::int64_t extent : tensor.shape) extents += StrCat(extent, ", ");
  if (tensor.shape.size() > 1) extents.resize(extents.size() - 2);
  std::string header =
      StrCat("{'descr': '<f4', 'fortran_order': False, 'shape': (", Trim(extents), "), }");
  const std::size_t begin = kMagic.size() + 2 + sizeof(std::uint16_t);
  while ((begin + header.size() + 1) % kAlignment != 0) header += ' ';
  header += '\n';
  const std::vector<float> elements(tensor.values.begin(), tensor.values.end());
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string bytes(kMagic);
  bytes.append({'\x01', '\x00'});
  bytes.append(reinterpret_cast<const char*>(&length), sizeof(length));
  bytes += header;
  return bytes.append(reinterpret_cast<const char*>(elements.data()),
                      elements.size() * sizeof(float));
}

}  // namespace pbnbrdf

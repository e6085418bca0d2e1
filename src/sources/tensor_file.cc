#include "sources/tensor_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little, "tensor files are little-endian");
static_assert(std::is_same_v<std::size_t, std::uint64_t>, "sizes in files are sizes in memory");

constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;
constexpr std::size_t kMostRank = 16;
// Bytes of an element by the number of its type: none, u8, i8, u16, i16, u32, i32, u64, i64, f16,
// f32, f64.
constexpr std::array<std::size_t, 12> kElementBytes = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

// Takes numbers from the bytes, one after the other.
class Cursor {
 public:
  Cursor(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  std::string_view Take(std::size_t count) {
    if (count > bytes_.size() - at_) {
      Fail(path_, ": truncated tensor file: its ", bytes_.size(), " bytes end within ", what_);
    }
    const std::string_view taken = std::string_view(bytes_).substr(at_, count);
    at_ += count;
    return taken;
  }

  template <typename T>
  T Number() {
    T number;
    std::memcpy(&number, Take(sizeof(T)).data(), sizeof(T));
    return number;
  }

  // What is being read, for messages.
  void Enter(const std::string& what) { what_ = what; }

 private:
  const std::string& path_;
  const std::string& bytes_;
  std::size_t at_ = 0;
  std::string what_ = "the header";
};

// The product of the sizes, no more than `most`; false if it is more.
bool Count(std::span<const std::uint64_t> shape, std::uint64_t most, std::size_t* count) {
  *count = 1;
  for (std::uint64_t size : shape) {
    if (size != 0 && *count > most / size) return false;
    *count *= size;
  }
  return true;
}

TensorFile::Field TakeField(const std::string& path, const std::string& name,
                            std::size_t file_bytes, Cursor* cursor) {
  TensorFile::Field field;
  const std::size_t rank = cursor->Number<std::uint16_t>();
  if (rank > kMostRank) {
    Fail(path, ": field '", name, "' has ", rank, " dimensions; at most ", kMostRank);
  }
  const std::size_t type = cursor->Number<std::uint8_t>();
  if (type == 0 || type >= kElementBytes.size()) {
    Fail(path, ": field '", name, "' is of type ", type, "; must be 1 to 11");
  }
  field.type = static_cast<TensorFile::Type>(type);
  field.offset = cursor->Number<std::uint64_t>();
  for (std::size_t k = 0; k < rank; ++k) field.shape.push_back(cursor->Number<std::uint64_t>());
  const std::size_t left = file_bytes - std::min<std::size_t>(field.offset, file_bytes);
  if (field.offset > file_bytes || !Count(field.shape, left / kElementBytes[type], &field.count)) {
    Fail(path, ": truncated or damaged: field '", name, "', ", ShapeText(field.shape), " of ",
         kElementBytes[type], " bytes each from byte ", field.offset,
         " on, goes beyond the file's ", file_bytes, " bytes");
  }
  return field;
}

}  // namespace

std::string ShapeText(std::span<const std::uint64_t> shape) {
  std::string text;
  for (std::uint64_t size : shape) text += StrCat(text.empty() ? "" : " x ", size);
  return text.empty() ? "a single number" : text;
}

TensorFile TensorFile::Read(const std::string& path) {
  return TensorFile(path, ReadFile(path, kLargestFile));
}

TensorFile::TensorFile(const std::string& path, std::string bytes)
    : path_(path), bytes_(std::move(bytes)) {
  Cursor cursor(path_, bytes_);
  if (!bytes_.starts_with(kMagic)) {
    Fail(path, ": not a tensor file (RGL .bsdf): it must begin with 'tensor_file' and a zero byte");
  }
  cursor.Take(kMagic.size());
  const int major = cursor.Number<std::uint8_t>(), minor = cursor.Number<std::uint8_t>();
  if (major != 1 || minor != 0) {
    Fail(path, ": a tensor file of version ", major, ".", minor, ", expected 1.0");
  }
  const auto fields = cursor.Number<std::uint32_t>();
  for (std::uint32_t k = 0; k < fields; ++k) {
    cursor.Enter(StrCat("the entry of field ", k + 1, " of ", fields));
    const std::string name(cursor.Take(cursor.Number<std::uint16_t>()));
    const Field field = TakeField(path, name, bytes_.size(), &cursor);
    if (!fields_.emplace(name, field).second) Fail(path, ": two fields are named '", name, "'");
  }
}

const TensorFile::Field& TensorFile::Find(const std::string& name) const {
  const auto found = fields_.find(name);
  if (found == fields_.end()) Fail(path_, ": no field '", name, "' in it");
  return found->second;
}

std::vector<std::size_t> TensorFile::FloatShape(const std::string& name, std::size_t rank) const {
  const Field& field = Find(name);
  if (field.type != Type::kFloat32) {
    Fail(path_, ": field '", name, "' is of type ", static_cast<int>(field.type),
         ", expected 10, float32");
  }
  if (field.shape.size() != rank || field.count == 0) {
    Fail(path_, ": field '", name, "' is ", ShapeText(field.shape), ", expected ", rank,
         " sizes, none of them 0");
  }
  return field.shape;
}

std::vector<float> TensorFile::Floats(const std::string& name,
                                      std::span<const std::size_t> shape) const {
  const std::vector<std::size_t> found = FloatShape(name, shape.size());
  if (!std::equal(found.begin(), found.end(), shape.begin())) {
    Fail(path_, ": field '", name, "' is ", ShapeText(found), ", expected ", ShapeText(shape));
  }
  const Field& field = Find(name);
  std::vector<float> elements(field.count);
  std::memcpy(elements.data(), bytes_.data() + field.offset, field.count * sizeof(float));
  const auto bad = std::find_if(elements.begin(), elements.end(),
                                [](float element) { return !std::isfinite(element); });
  if (bad != elements.end()) {
    Fail(path_, ": damaged: element ", bad - elements.begin(), " of field '", name,
         "' is not a finite number");
  }
  return elements;
}

std::string TensorFile::Text(const std::string& name) const {
  const auto found = fields_.find(name);
  if (found == fields_.end()) return "";
  const Field& field = found->second;
  if (field.type != Type::kUInt8 || field.shape.size() != 1) return "";
  return bytes_.substr(field.offset, field.count);
}

}  // namespace pbnbrdf

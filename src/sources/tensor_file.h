// tensor_file.h: the container of named arrays in which the RGL material database [1] is published.
//
// Little-endian, nothing between the items:
//   "tensor_file" and a NUL; u8 major = 1; u8 minor = 0; u32 number of fields;
//   for each field: u16 length of its name, the name, u16 rank, u8 type, u64 offset of its data from
//   the file's beginning, and rank x u64 sizes;
//   the data, dense, the last size varying fastest, wherever the offsets say.
//
// [1] J. Dupuy, W. Jakob. An Adaptive Parameterization for Efficient Material Acquisition and
//     Rendering. ACM TOG 37(6), 2018.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pbnbrdf {

class TensorFile {
 public:
  // The types' numbers in files; 0 and what is beyond kFloat64 are none.
  enum class Type : std::uint8_t { kUInt8 = 1, kFloat32 = 10, kFloat64 = 11 };

  struct Field {
    Type type;
    std::vector<std::uint64_t> shape;
    std::size_t offset, count;  // bytes, elements
  };

  // What a file of this kind begins with.
  static constexpr std::string_view kMagic{"tensor_file\0", 12};

  // Throws Error if the file is missing, larger than 4 GiB or no tensor file, or if a field's entry or
  // data aren't all within it.
  static TensorFile Read(const std::string& path);

  const std::string& path() const { return path_; }
  bool Has(const std::string& name) const { return fields_.count(name) > 0; }

  // The sizes of a field of floats. Throws Error, naming file and field, if it is missing, of
  // another type or rank, or has a size of 0.
  std::vector<std::size_t> FloatShape(const std::string& name, std::size_t rank) const;

  // The elements of a field of that very shape. Throws Error as FloatShape, or if it has another
  // shape or an element isn't finite.
  std::vector<float> Floats(const std::string& name, std::span<const std::size_t> shape) const;

  // The bytes of a field of rank 1 of type u8; "" if it is another one or missing.
  std::string Text(const std::string& name) const;

 private:
  TensorFile(const std::string& path, std::string bytes);

  const Field& Find(const std::string& name) const;

  std::string path_, bytes_;
  std::map<std::string, Field> fields_;
};

// "2 x 3 x 4"
std::string ShapeText(std::span<const std::uint64_t> shape);

}  // namespace pbnbrdf

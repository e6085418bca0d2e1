// tensor_writer.h: the bytes of tensor files (tensor_file.h).
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pbnbrdf {

// What is written isn't checked: tests of bad input want fields that contradict each other.
class TensorWriter {
 public:
  TensorWriter& Add(const std::string& name, std::uint8_t type, std::vector<std::uint64_t> shape,
                    const std::string& data) {
    fields_.push_back({name, type, std::move(shape), data});
    return *this;
  }

  TensorWriter& AddBytes(const std::string& name, const std::string& bytes) {
    return Add(name, 1, {bytes.size()}, bytes);
  }

  TensorWriter& AddFloats(const std::string& name, const std::vector<std::uint64_t>& shape,
                          const std::vector<float>& values) {
    return Add(name, 10, shape,
               {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
  }

  // In place of the field of that name.
  TensorWriter& Replace(const std::string& name, const std::vector<std::uint64_t>& shape,
                        const std::vector<float>& values) {
    return Remove(name).AddFloats(name, shape, values);
  }

  TensorWriter& Remove(const std::string& name) {
    std::erase_if(fields_, [&](const Field& field) { return field.name == name; });
    return *this;
  }

  std::string Bytes() const {
    std::size_t header = 18;
    for (const Field& f : fields_) header += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
    std::string bytes("tensor_file\0\1\0", 14), data;
    Append(static_cast<std::uint32_t>(fields_.size()), &bytes);
    for (const Field& f : fields_) {
      Append(static_cast<std::uint16_t>(f.name.size()), &bytes);
      bytes += f.name;
      Append(static_cast<std::uint16_t>(f.shape.size()), &bytes);
      Append(f.type, &bytes);
      Append(static_cast<std::uint64_t>(header + data.size()), &bytes);
      for (std::uint64_t size : f.shape) Append(size, &bytes);
      data += f.data;
    }
    return bytes + data;
  }

 private:
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::uint64_t> shape;
    std::string data;
  };

  template <typename T>
  static void Append(T number, std::string* bytes) {
    bytes->append(reinterpret_cast<const char*>(&number), sizeof(T));
  }

  std::vector<Field> fields_;
};

}  // namespace pbnbrdf

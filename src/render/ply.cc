// Reads PLY files (Turk 1994): a text header with elements and their properties, then the values.
#include <bit>
#include <cstring>

#include "base/text.h"
#include "mesh_files.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/names.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

constexpr NameTable<Type, 16> kTypes = {{{"char", Type::kInt8},
                                         {"int8", Type::kInt8},
                                         {"uchar", Type::kUint8},
                                         {"uint8", Type::kUint8},
                                         {"short", Type::kInt16},
                                         {"int16", Type::kInt16},
                                         {"ushort", Type::kUint16},
                                         {"uint16", Type::kUint16},
                                         {"int", Type::kInt32},
                                         {"int32", Type::kInt32},
                                         {"uint", Type::kUint32},
                                         {"uint32", Type::kUint32},
                                         {"float", Type::kFloat},
                                         {"float32", Type::kFloat},
                                         {"double", Type::kDouble},
                                         {"float64", Type::kDouble}}};

struct Property {
  std::string name;
  Type type;
  bool is_list = false;
  Type count_type = Type::kUint8;
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

// The values of the body, one after the other, from text or bytes.
class Values {
 public:
  Values(std::string_view data, bool is_text) : data_(data), is_text_(is_text) {}

  double Next(Type type) {
    if (is_text_) return ParseNumber("value", Word());
    switch (type) {
      case Type::kInt8:
        return Take<std::int8_t>();
      case Type::kUint8:
        return Take<std::uint8_t>();
      case Type::kInt16:
        return Take<std::int16_t>();
      case Type::kUint16:
        return Take<std::uint16_t>();
      case Type::kInt32:
        return Take<std::int32_t>();
      case Type::kUint32:
        return Take<std::uint32_t>();
      case Type::kFloat:
        return Take<float>();
      case Type::kDouble:
        return Take<double>();
    }
    return 0.0;
  }

  std::size_t left() const { return data_.size() - at_; }

 private:
  template <typename T>
  double Take() {
    if (left() < sizeof(T)) Fail("truncated");
    T value;
    std::memcpy(&value, data_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(value);
  }

  std::string_view Word() {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t begin = data_.find_first_not_of(kBlank, at_);
    if (begin == std::string_view::npos) Fail("truncated");
    at_ = data_.find_first_of(kBlank, begin);
    if (at_ == std::string_view::npos) Fail("truncated: the last line has no end");
    return data_.substr(begin, at_ - begin);
  }

  std::string_view data_;
  bool is_text_;
  std::size_t at_ = 0;
};

class PlyParser {
 public:
  explicit PlyParser(std::string_view bytes) : rest_(bytes) {}

  TriangleMesh Parse() {
    Header();
    Values values(rest_, is_text_);
    for (const Element& element : elements_) {
      if (element.count > 0 && element.properties.empty()) {
        Fail("element ", element.name, " has no properties");
      }
      if (element.count > values.left()) {
        Fail("truncated: ", element.count, " of element ", element.name, " in ", values.left(),
             " bytes");
      }
      for (std::size_t i = 0; i < element.count; ++i) Row(element, i, &values);
    }
    CheckIndices();
    if (!has_normals_) mesh_.normals.clear();
    return std::move(mesh_);
  }

 private:
  std::string HeaderLine() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) Fail("truncated: the header has no end_header");
    const std::string line(Trim(rest_.substr(0, end)));
    rest_.remove_prefix(end + 1);
    return line;
  }

  void Header() {
    if (HeaderLine() != "ply") Fail("not a PLY file");
    bool has_format = false;
    for (std::string line = HeaderLine(); line != "end_header"; line = HeaderLine()) {
      const std::vector<std::string> words = Split(line, ' ');
      if (words[0] == "format" && words.size() == 3) {
        is_text_ = words[1] == "ascii";
        has_format = true;
        if (!is_text_ && words[1] != "binary_little_endian") {
          Fail("format ", words[1], " isn't ascii or binary_little_endian");
        }
      } else if (words[0] == "element" && words.size() == 3) {
        const long count = ParseInteger("element " + words[1], words[2]);
        if (count < 0) Fail("element ", words[1], ": ", count, " of them");
        elements_.push_back({words[1], static_cast<std::size_t>(count), {}});
      } else if (words[0] == "property") {
        AddProperty(words);
      } else if (words[0] != "comment" && words[0] != "obj_info" && !line.empty()) {
        Fail("header: '", line, "' isn't known");
      }
    }
    if (!has_format) Fail("header: no format");
    CheckHeader();
  }

  void AddProperty(const std::vector<std::string>& words) {
    if (elements_.empty()) Fail("header: a property before the first element");
    std::vector<Property>& properties = elements_.back().properties;
    if (words.size() == 3) {
      properties.push_back({words[2], ParseName(kTypes, "property type", words[1])});
    } else if (words.size() == 5 && words[1] == "list") {
      properties.push_back({words[4], ParseName(kTypes, "property type", words[3]), true,
                            ParseName(kTypes, "property type", words[2])});
    } else {
      Fail("header: a property of ", words.size(), " words");
    }
  }

  void CheckHeader() {
    int vertex_names = 0, normal_names = 0, faces = 0;
    for (const Element& element : elements_) {
      for (const Property& property : element.properties) {
        const std::string& name = property.name;
        if (element.name == "vertex" && !property.is_list) {
          vertex_names += name == "x" || name == "y" || name == "z";
          normal_names += name == "nx" || name == "ny" || name == "nz";
        }
        faces += element.name == "face" && IsIndices(property);
      }
    }
    if (vertex_names != 3) Fail("element vertex must have x, y and z once each");
    if (faces != 1) Fail("element face must have the list vertex_indices once");
    has_normals_ = normal_names == 3;
  }

  static bool IsIndices(const Property& property) {
    return property.is_list &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  void Row(const Element& element, std::size_t number, Values* values) try {
    Vec3 position, normal;
    for (const Property& property : element.properties) {
      if (property.is_list) {
        ReadList(element.name == "face" && IsIndices(property), property, values);
        continue;
      }
      const double value = values->Next(property.type);
      const std::string& name = property.name;
      if (name == "x") position.x = value;
      if (name == "y") position.y = value;
      if (name == "z") position.z = value;
      if (name == "nx") normal.x = value;
      if (name == "ny") normal.y = value;
      if (name == "nz") normal.z = value;
    }
    if (element.name != "vertex") return;
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
  } catch (const Error& error) {
    Fail(element.name, " ", number + 1, ": ", error.what());
  }

  // A face becomes a fan of triangles.
  void ReadList(bool is_face, const Property& property, Values* values) {
    const double count = values->Next(property.count_type);
    if (!(count >= 0.0) || count > static_cast<double>(values->left()) + 1.0) {
      Fail("truncated: a list of ", count, " values");
    }
    if (is_face && count < 3.0) Fail("a face of ", count, " corners, at least 3 were expected");
    std::array<std::uint32_t, 3> triangle = {};
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const double value = values->Next(property.type);
      if (!is_face) continue;
      if (!(value >= 0.0 && value < 4294967295.0)) Fail("vertex index ", value);
      const auto index = static_cast<std::uint32_t>(value);
      if (k == 0) triangle[0] = index;
      if (k >= 2) {
        triangle[2] = index;
        mesh_.triangles.push_back(triangle);
      }
      triangle[1] = index;
    }
  }

  void CheckIndices() const {
    for (const auto& triangle : mesh_.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= mesh_.positions.size()) {
          Fail("vertex index ", index, " of ", mesh_.positions.size());
        }
      }
    }
  }

  std::string_view rest_;
  bool is_text_ = false, has_normals_ = false;
  std::vector<Element> elements_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh ParsePly(std::string_view bytes) { return PlyParser(bytes).Parse(); }

}  // namespace pbnbrdf

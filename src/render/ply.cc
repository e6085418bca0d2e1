// Reads PLY files (Turk 1994): a text header with elements and their properties, then the values.
#include <bit>
#include <cstring>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/names.h"
#include "polygons.h"

namespace pbnbrdf {
namespace {

static_assert(std::endian::native == std::endian::little);

// Reads a number of type T from its bytes, of this machine's order.
template <typename T>
double Read(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

struct Type {
  std::string_view name;
  std::size_t size;
  double (*read)(const char* bytes);
};

template <typename T>
constexpr Type TypeOf(std::string_view name) {
  return {name, sizeof(T), Read<T>};
}

constexpr Type kTypes[] = {TypeOf<std::int8_t>("char"),     TypeOf<std::int8_t>("int8"),
                           TypeOf<std::uint8_t>("uchar"),   TypeOf<std::uint8_t>("uint8"),
                           TypeOf<std::int16_t>("short"),   TypeOf<std::int16_t>("int16"),
                           TypeOf<std::uint16_t>("ushort"), TypeOf<std::uint16_t>("uint16"),
                           TypeOf<std::int32_t>("int"),     TypeOf<std::int32_t>("int32"),
                           TypeOf<std::uint32_t>("uint"),   TypeOf<std::uint32_t>("uint32"),
                           TypeOf<float>("float"),          TypeOf<float>("float32"),
                           TypeOf<double>("double"),        TypeOf<double>("float64")};

struct Property {
  std::string name;
  const Type* type;
  const Type* count_type = nullptr;  // of a list

  bool IsList() const { return count_type != nullptr; }
  bool IsIndices() const {
    return IsList() && (name == "vertex_indices" || name == "vertex_index");
  }
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

enum class Format { kText, kLittleEndian, kBigEndian };

constexpr NameTable<Format, 3> kFormats = {{{"ascii", Format::kText},
                                            {"binary_little_endian", Format::kLittleEndian},
                                            {"binary_big_endian", Format::kBigEndian}}};

// The values of the body, one after the other, from text or bytes.
class Values {
 public:
  Values(std::string_view data, Format format) : data_(data), format_(format) {}

  double Next(const Type& type) {
    if (format_ == Format::kText) return ParseNumber("value", Word());
    if (left() < type.size) Fail("truncated");
    std::string bytes(data_.substr(at_, type.size));
    at_ += type.size;
    if (format_ == Format::kBigEndian) std::reverse(bytes.begin(), bytes.end());
    return type.read(bytes.data());
  }

  std::size_t left() const { return data_.size() - at_; }

 private:
  std::string_view Word() {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t begin = data_.find_first_not_of(kBlank, at_);
    if (begin == std::string_view::npos) Fail("truncated");
    at_ = std::min(data_.find_first_of(kBlank, begin), data_.size());
    return data_.substr(begin, at_ - begin);
  }

  std::string_view data_;
  Format format_;
  std::size_t at_ = 0;
};

class PlyParser {
 public:
  explicit PlyParser(std::string_view bytes) : rest_(bytes) {}

  PolygonMesh Parse() {
    Header();
    Values values(rest_, format_);
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
    FinishCorners();
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
        format_ = ParseName(kFormats, "format", words[1]);
        has_format = true;
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
      properties.push_back({words[2], &FindNamed(kTypes, "property type=", words[1])});
    } else if (words.size() == 5 && words[1] == "list") {
      properties.push_back({words[4], &FindNamed(kTypes, "property type=", words[3]),
                            &FindNamed(kTypes, "property type=", words[2])});
    } else {
      Fail("header: a property of ", words.size(), " words");
    }
  }

  void CheckHeader() {
    int vertex_names = 0, normal_names = 0, faces = 0;
    for (const Element& element : elements_) {
      for (const Property& property : element.properties) {
        const std::string& name = property.name;
        if (element.name == "vertex" && !property.IsList()) {
          vertex_names += name == "x" || name == "y" || name == "z";
          normal_names += name == "nx" || name == "ny" || name == "nz";
        }
        faces += element.name == "face" && property.IsIndices();
      }
    }
    if (vertex_names != 3) Fail("element vertex must have x, y and z once each");
    if (faces != 1) Fail("element face must have the list vertex_indices once");
    has_normals_ = normal_names == 3;
  }

  void Row(const Element& element, std::size_t number, Values* values) try {
    Vec3 position, normal;
    const std::pair<std::string_view, double*> numbers[] = {{"x", &position.x}, {"y", &position.y},
                                                            {"z", &position.z}, {"nx", &normal.x},
                                                            {"ny", &normal.y},  {"nz", &normal.z}};
    for (const Property& property : element.properties) {
      if (property.IsList()) {
        ReadList(element.name == "face" && property.IsIndices(), property, values);
        continue;
      }
      const double value = values->Next(*property.type);
      for (const auto& [name, to] : numbers) {
        if (property.name == name) *to = value;
      }
    }
    if (element.name != "vertex") return;
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
  } catch (const Error& error) {
    Fail(element.name, " ", number + 1, ": ", error.what());
  }

  void ReadList(bool is_face, const Property& property, Values* values) {
    const double count = values->Next(*property.count_type);
    if (!(count >= 0.0) || count > static_cast<double>(values->left()) + 1.0) {
      Fail("truncated: a list of ", count, " values");
    }
    if (is_face && count < 3.0) Fail("a face of ", count, " corners, at least 3 were expected");
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const double value = values->Next(*property.type);
      if (!is_face) continue;
      if (!(value >= 0.0 && value < 4294967295.0)) Fail("vertex index ", value);
      mesh_.corners.push_back({static_cast<std::uint32_t>(value), PolygonMesh::kNone});
    }
    if (is_face) mesh_.face_ends.push_back(mesh_.corners.size());
  }

  void FinishCorners() {
    for (PolygonMesh::Corner& corner : mesh_.corners) {
      if (corner.position >= mesh_.positions.size()) {
        Fail("vertex index ", corner.position, " of ", mesh_.positions.size());
      }
      if (has_normals_) corner.normal = corner.position;
    }
  }

  std::string_view rest_;
  Format format_ = Format::kText;
  bool has_normals_ = false;
  std::vector<Element> elements_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh ParsePly(std::string_view bytes) { return PlyParser(bytes).Parse(); }

}  // namespace pbnbrdf

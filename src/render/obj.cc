// Reads the geometry of Wavefront OBJ files.
#include <map>

#include "base/about.h"
#include "base/text.h"
#include "mesh_checks.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no index

struct Corner {
  std::uint32_t position, normal;  // indices; the normal may be kNone
  auto operator<=>(const Corner&) const = default;
};

std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlank = " \t\r";
  for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlank, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

class ObjParser {
 public:
  TriangleMesh Parse(std::string_view text) {
    int number = 0;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      ++number;
      About(StrCat("line ", number), [&] {
        if (end == std::string_view::npos && !Trim(text).empty()) Fail("cut off: has no end");
        Line(Words(text.substr(0, end)));
      });
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return Mesh();
  }

 private:
  void Line(const std::vector<std::string_view>& words) {
    if (words.empty()) return;
    if (words[0] == "v") {
      positions_.push_back(Vector(words));
    } else if (words[0] == "vn") {
      normals_.push_back(Vector(words));
    } else if (words[0] == "f") {
      Face(words);
    }
  }

  // "v x y z". More numbers, a weight or a colour, are ignored.
  static Vec3 Vector(const std::vector<std::string_view>& words) {
    if (words.size() < 4)
      Fail("'", words[0], "' has ", words.size() - 1, " numbers, 3 were expected");
    return {ParseNumber("x", words[1]), ParseNumber("y", words[2]), ParseNumber("z", words[3])};
  }

  void Face(const std::vector<std::string_view>& words) {
    if (words.size() < 4)
      Fail("a face of ", words.size() - 1, " corners, at least 3 were expected");
    const Corner first = ParseCorner(words[1]);
    for (std::size_t i = 2; i + 1 < words.size(); ++i) {
      triangles_.push_back({first, ParseCorner(words[i]), ParseCorner(words[i + 1])});
    }
  }

  // "position", "position/texture", "position//normal" or "position/texture/normal".
  Corner ParseCorner(std::string_view word) const {
    const std::vector<std::string> parts = Split(word, '/');
    const bool has_normal = parts.size() > 2 && !parts[2].empty();
    return {Index(parts[0], positions_.size(), "vertex"),
            has_normal ? Index(parts[2], normals_.size(), "normal") : kNone};
  }

  // Indices count from 1, or backwards from -1, the last one so far.
  static std::uint32_t Index(const std::string& text, std::size_t count, const char* what) {
    const long number = ParseInteger(what, text), n = static_cast<long>(count);
    const long index = number < 0 ? n + number : number - 1;
    if (index < 0 || index >= n) Fail(what, " ", number, " of ", n);
    return static_cast<std::uint32_t>(index);
  }

  TriangleMesh Mesh() {
    bool all_normals = true;
    for (const auto& corners : triangles_) {
      for (const Corner& corner : corners) all_normals &= corner.normal != kNone;
    }
    TriangleMesh mesh;
    std::map<Corner, std::uint32_t> vertices;
    for (const auto& corners : triangles_) {
      std::array<std::uint32_t, 3> triangle;
      for (int k = 0; k < 3; ++k) {
        const Corner corner = {corners[k].position, all_normals ? corners[k].normal : kNone};
        const auto size = static_cast<std::uint32_t>(mesh.positions.size());
        const auto [at, is_new] = vertices.try_emplace(corner, size);
        triangle[k] = at->second;
        if (!is_new) continue;
        mesh.positions.push_back(positions_[corner.position]);
        if (all_normals) mesh.normals.push_back(normals_[corner.normal]);
      }
      mesh.triangles.push_back(triangle);
    }
    return mesh;
  }

  std::vector<Vec3> positions_, normals_;
  std::vector<std::array<Corner, 3>> triangles_;
};

}  // namespace

TriangleMesh ParseObj(std::string_view text) { return ObjParser().Parse(text); }

}  // namespace pbnbrdf

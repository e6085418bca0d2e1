// Reads the geometry of Wavefront OBJ files.
#include "base/about.h"
#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "polygons.h"

namespace pbnbrdf {
namespace {

using Corner = PolygonMesh::Corner;

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
  PolygonMesh Parse(std::string_view text) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    while (!text.empty()) {
      const int first = line_ + 1;
      const std::string whole = WholeLine(&text);
      About(StrCat("line ", first),
            [&] { Line(Words(std::string_view(whole).substr(0, whole.find('#'))), first); });
    }
    CheckIndices();
    return std::move(mesh_);
  }

 private:
  // Takes a line from the text, with those that it is continued on; a comment isn't.
  std::string WholeLine(std::string_view* text) {
    std::string whole;
    bool goes_on = true;
    while (goes_on && !text->empty()) {
      ++line_;
      const std::size_t end = std::min(text->find('\n'), text->size());
      std::string_view line = text->substr(0, end);
      text->remove_prefix(std::min(end + 1, text->size()));
      if (line.ends_with('\r')) line.remove_suffix(1);
      goes_on = line.ends_with('\\') && line.find('#') == line.npos;
      if (goes_on) line.remove_suffix(1);
      whole += line;
      whole += ' ';
    }
    return whole;
  }

  void Line(const std::vector<std::string_view>& words, int line) {
    if (words.empty()) return;
    if (words[0] == "v") {
      mesh_.positions.push_back(Vector(words));
    } else if (words[0] == "vn") {
      mesh_.normals.push_back(Vector(words));
    } else if (words[0] == "f") {
      if (words.size() < 4) {
        Fail("a face of ", words.size() - 1, " corners, at least 3 were expected");
      }
      for (std::size_t i = 1; i < words.size(); ++i) mesh_.corners.push_back(ParseCorner(words[i]));
      mesh_.face_ends.push_back(mesh_.corners.size());
      lines_.push_back(line);
    }
  }

  // "v x y z". More numbers, a weight or a colour, are ignored.
  static Vec3 Vector(const std::vector<std::string_view>& words) {
    if (words.size() < 4)
      Fail("'", words[0], "' has ", words.size() - 1, " numbers, 3 were expected");
    return {ParseNumber("x", words[1]), ParseNumber("y", words[2]), ParseNumber("z", words[3])};
  }

  // "position", "position/texture", "position//normal" or "position/texture/normal".
  Corner ParseCorner(std::string_view word) const {
    const std::vector<std::string> parts = Split(word, '/');
    const bool has_normal = parts.size() > 2 && !parts[2].empty();
    return {Index(parts[0], mesh_.positions.size(), kVertex),
            has_normal ? Index(parts[2], mesh_.normals.size(), kNormal) : PolygonMesh::kNone};
  }

  // Indices count from 1, or backwards from -1, the last one so far.
  static std::uint32_t Index(const std::string& text, std::size_t count, const char* what) {
    const long number = ParseInteger(what, text), n = static_cast<long>(count);
    const long index = number < 0 ? n + number : number - 1;
    if (index < 0 || index >= PolygonMesh::kNone) Fail(what, " ", number, " of ", n);
    return static_cast<std::uint32_t>(index);
  }

  // A vertex may come after the face.
  void CheckIndices() const {
    std::size_t at = 0;
    for (std::size_t face = 0; face < lines_.size(); ++face) {
      for (; at < mesh_.face_ends[face]; ++at) {
        const auto check = [&](std::uint32_t index, std::size_t count, const char* what) {
          if (index >= count)
            Fail("line ", lines_[face], ": ", what, " ", index + 1, " of ", count);
        };
        const Corner& corner = mesh_.corners[at];
        check(corner.position, mesh_.positions.size(), kVertex);
        if (corner.normal != PolygonMesh::kNone) {
          check(corner.normal, mesh_.normals.size(), kNormal);
        }
      }
    }
  }

  static constexpr char kVertex[] = "vertex", kNormal[] = "normal";

  PolygonMesh mesh_;
  int line_ = 0;
  std::vector<int> lines_;  // of each face
};

}  // namespace

PolygonMesh ParseObj(std::string_view text) { return ObjParser().Parse(text); }

}  // namespace pbnbrdf

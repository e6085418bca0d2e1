#include "polygons.h"

#include <span>
#include <unordered_map>

#include "base/about.h"
#include "mesh_checks.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

using Corner = PolygonMesh::Corner;
using Triangle = std::array<std::uint32_t, 3>;  // numbers of corners within a face

// A corner that turns by less, relative to the square of the face's area, counts as straight: coordinates are
// often written in single precision.
constexpr double kStraight = 1e-9;

// Cutting ears takes up to the cube of the number of corners: 0.1 s for a star of a thousand random rays.
constexpr std::size_t kMaxConcaveCorners = 1000;

// Cuts one face, whose neighbouring corners aren't in the same place, into triangles.
class FaceCutter {
 public:
  explicit FaceCutter(std::vector<Vec3> points) : points_(std::move(points)) {
    for (std::size_t k = 1; k + 1 < points_.size(); ++k) {
      area_ = area_ + Cross(points_[k] - points_[0], points_[k + 1] - points_[0]);
    }
    ring_.resize(points_.size());
    for (std::size_t k = 0; k < ring_.size(); ++k) ring_[k] = static_cast<std::uint32_t>(k);
  }

  // The normal times twice the area.
  const Vec3& area() const { return area_; }

  std::vector<Triangle> Cut() {
    if (!IsConvex()) {
      if (ring_.size() > kMaxConcaveCorners) {
        Fail("is concave and has ", ring_.size(), " corners, more than ", kMaxConcaveCorners);
      }
      CutEars();
    }
    for (std::size_t k = 1; k + 1 < ring_.size(); ++k) {
      triangles_.push_back({ring_[0], ring_[k], ring_[k + 1]});
    }
    return std::move(triangles_);
  }

 private:
  std::uint32_t Before(std::size_t k) const { return ring_[(k + ring_.size() - 1) % ring_.size()]; }
  std::uint32_t After(std::size_t k) const { return ring_[(k + 1) % ring_.size()]; }

  // Positive if the triangle, seen along the face's normal, is counterclockwise.
  double Turn(std::uint32_t a, std::uint32_t b, const Vec3& c) const {
    return Dot(Cross(points_[b] - points_[a], c - points_[a]), area_);
  }

  // 1 at a corner that sticks out, as all do of a convex face, -1 at one that points inwards, 0 at a straight one.
  int TurnAt(std::size_t k) const {
    const double turn = Turn(Before(k), ring_[k], points_[After(k)]);
    if (std::abs(turn) <= kStraight * Dot(area_, area_)) return 0;
    return turn > 0.0 ? 1 : -1;
  }

  bool IsConvex() const {
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      if (TurnAt(k) < 0) return false;
    }
    return true;
  }

  // No other corner lies in the triangle that would be cut off.
  bool IsFree(std::size_t k) const {
    const std::uint32_t a = Before(k), b = ring_[k], c = After(k);
    const auto is_apart = [&](std::uint32_t corner) {
      const Vec3& p = points_[corner];
      if (p == points_[a] || p == points_[b] || p == points_[c]) return true;
      return Turn(a, b, p) < 0.0 || Turn(b, c, p) < 0.0 || Turn(c, a, p) < 0.0;
    };
    return std::all_of(ring_.begin(), ring_.end(), is_apart);
  }

  // Goes round until a triangle is left, or a face without ears, whose sides cross.
  void CutEars() {
    std::size_t k = 1, tried = 0;
    while (ring_.size() > 3 && tried < ring_.size()) {
      k %= ring_.size();
      const int turn = TurnAt(k);
      const bool is_ear = turn > 0 && IsFree(k);
      if (is_ear) triangles_.push_back({Before(k), ring_[k], After(k)});
      if (is_ear || turn == 0) {
        ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(k));
        tried = 0;
      } else {
        ++k;
        ++tried;
      }
    }
  }

  std::vector<Vec3> points_;
  Vec3 area_;
  std::vector<std::uint32_t> ring_;  // corners that are still to be cut off
  std::vector<Triangle> triangles_;
};

class Triangulation {
 public:
  explicit Triangulation(const PolygonMesh& polygons) : polygons_(polygons) {
    for (const Corner& corner : polygons.corners) has_normals_ |= HasNormal(corner);
  }

  TriangleMesh Run() {
    std::size_t begin = 0;
    for (std::size_t face = 0; face < polygons_.face_ends.size(); ++face) {
      const std::size_t end = polygons_.face_ends[face];
      About(StrCat("face ", face + 1),
            [&] { AddFace(std::span(polygons_.corners).subspan(begin, end - begin)); });
      begin = end;
    }
    return std::move(mesh_);
  }

 private:
  bool HasNormal(const Corner& corner) const {
    return corner.normal != PolygonMesh::kNone && polygons_.normals[corner.normal] != Vec3{};
  }

  const Vec3& Position(const Corner& corner) const { return polygons_.positions[corner.position]; }

  void AddFace(std::span<const Corner> all) {
    std::vector<Corner> corners;
    for (const Corner& corner : all) {
      if (!(LargestCoordinate(Position(corner)) <= kMaxCoordinate)) {
        Fail("vertex ", corner.position + 1, ": a coordinate isn't finite or is beyond ",
             kMaxCoordinate);
      }
      if (corners.empty() || Position(corner) != Position(corners.back()))
        corners.push_back(corner);
    }
    while (corners.size() > 1 && Position(corners.front()) == Position(corners.back())) {
      corners.pop_back();
    }
    const std::size_t before = mesh_.triangles.size();
    if (corners.size() >= 3) AddTriangles(corners);
    mesh_.left_out += all.size() - 2 - (mesh_.triangles.size() - before);
  }

  void AddTriangles(const std::vector<Corner>& corners) {
    std::vector<Vec3> points;
    for (const Corner& corner : corners) points.push_back(Position(corner));
    FaceCutter cutter(std::move(points));
    const std::vector<Triangle> triangles = cutter.Cut();
    const Vec3 normal = cutter.area();
    if (normal == Vec3{}) return;
    std::vector<std::uint32_t> vertices;
    for (const Corner& corner : corners) vertices.push_back(Vertex(corner, normal));
    for (const auto& [a, b, c] : triangles) {
      mesh_.triangles.push_back({vertices[a], vertices[b], vertices[c]});
    }
  }

  // A position with several normals is repeated.
  std::uint32_t Vertex(const Corner& corner, const Vec3& face_normal) {
    const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
    const bool has_own = HasNormal(corner);
    if (has_own || !has_normals_) {
      const std::uint64_t normal = has_own ? corner.normal : PolygonMesh::kNone;
      const auto [at, is_new] = vertices_.try_emplace(normal << 32 | corner.position, next);
      if (!is_new) return at->second;
    }
    mesh_.positions.push_back(Position(corner));
    if (has_normals_) {
      mesh_.normals.push_back(has_own ? polygons_.normals[corner.normal] : face_normal);
    }
    return next;
  }

  const PolygonMesh& polygons_;
  bool has_normals_ = false;
  TriangleMesh mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;  // by normal and position
};

}  // namespace

TriangleMesh Triangulated(const PolygonMesh& polygons) { return Triangulation(polygons).Run(); }

}  // namespace pbnbrdf

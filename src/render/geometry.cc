#include "geometry.h"

#include <embree3/rtcore.h>

#include <limits>

#include "base/parallel.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

struct Sphere {
  Affine to_world, to_unit;
  int material;
};

struct Mesh {
  TriangleMesh mesh;
  Vec3 tangent;
  int material, light;  // one of them is -1
};

// A shorter sum of interpolated normals is mostly rounding: the surface's own normal is taken.
constexpr double kMinNormal = 1e-6;

// Solves |o + t d| = 1 without differences of nearly equal numbers, as spheres may be small and far
// away: the discriminant comes from the point of the ray that is nearest to the center.
bool SolveUnitSphere(const Vec3& o, const Vec3& d, double* near, double* far) {
  const double a = Dot(d, d), b = -Dot(o, d), c = Dot(o, o) - 1.0;
  const Vec3 nearest = o + (b / a) * d;
  const double discriminant = a * (1.0 - Dot(nearest, nearest));
  if (!(discriminant >= 0.0)) return false;
  const double q = b + std::copysign(std::sqrt(discriminant), b);
  if (q == 0.0) return false;
  *near = std::min(c / q, q / a);
  *far = std::max(c / q, q / a);
  return true;
}

// The nearest hit in (tnear, tfar) of the ray with a sphere, as a distance; 0: none.
float HitDistance(const Sphere& sphere, const RTCRay& ray) {
  const Vec3 o = {ray.org_x, ray.org_y, ray.org_z}, d = {ray.dir_x, ray.dir_y, ray.dir_z};
  double near, far;
  if (!SolveUnitSphere(sphere.to_unit.Point(o), sphere.to_unit.Vector(d), &near, &far)) return 0;
  for (const double t : {near, far}) {
    if (t > ray.tnear && t < ray.tfar) return static_cast<float>(t);
  }
  return 0;
}

// Embree's callbacks for spheres. As rays come one at a time, an RTCRayN is an RTCRay.
template <typename Arguments>
const Sphere& SphereOf(const Arguments* args) {
  return static_cast<const Sphere*>(args->geometryUserPtr)[args->primID];
}

void BoundSphere(const RTCBoundsFunctionArguments* args) {
  const Affine& to_world = SphereOf(args).to_world;
  // An ellipsoid reaches as far along an axis as that row of its matrix is long.
  const auto& [u, v, w] = to_world.axes;
  const Vec3 reach = {std::hypot(u.x, v.x, w.x), std::hypot(u.y, v.y, w.y),
                      std::hypot(u.z, v.z, w.z)};
  const Vec3& o = to_world.origin;
  const double error = kSinglePrecision * (LargestCoordinate(o) + LargestCoordinate(reach));
  RTCBounds& bounds = *args->bounds_o;
  bounds.lower_x = static_cast<float>(o.x - reach.x - error);
  bounds.lower_y = static_cast<float>(o.y - reach.y - error);
  bounds.lower_z = static_cast<float>(o.z - reach.z - error);
  bounds.upper_x = static_cast<float>(o.x + reach.x + error);
  bounds.upper_y = static_cast<float>(o.y + reach.y + error);
  bounds.upper_z = static_cast<float>(o.z + reach.z + error);
}

void IntersectSphere(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& [ray, hit] = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const float t = HitDistance(SphereOf(args), ray);
  if (!(t > 0.0f)) return;
  ray.tfar = t;
  hit.primID = args->primID;
  hit.geomID = args->geomID;
  hit.instID[0] = args->context->instID[0];
}

void OccludeSphere(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  if (HitDistance(SphereOf(args), ray) > 0.0f) ray.tfar = -std::numeric_limits<float>::infinity();
}

RTCRay MakeRay(const Ray& ray, double distance) {
  RTCRay r = {};
  r.org_x = static_cast<float>(ray.origin.x);
  r.org_y = static_cast<float>(ray.origin.y);
  r.org_z = static_cast<float>(ray.origin.z);
  r.dir_x = static_cast<float>(ray.direction.x);
  r.dir_y = static_cast<float>(ray.direction.y);
  r.dir_z = static_cast<float>(ray.direction.z);
  r.tfar = static_cast<float>(distance);
  r.mask = ~0u;
  return r;
}

}  // namespace

struct Geometry::Embree {
  Embree() : device(rtcNewDevice(nullptr)) {
    if (device == nullptr) Fail("Embree doesn't start: error ", rtcGetDeviceError(nullptr));
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void Attach(RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void AttachMesh(const TriangleMesh& mesh, unsigned id) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.positions.size()));
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    if (vertices == nullptr || indices == nullptr) Fail("Embree: out of memory");
    for (const Vec3& p : mesh.positions) {
      for (double value : {p.x, p.y, p.z}) *vertices++ = static_cast<float>(value);
    }
    for (const auto& triangle : mesh.triangles) {
      for (unsigned index : triangle) *indices++ = index;
    }
    Attach(geometry, id);
  }

  void AttachSpheres(unsigned id) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres.size()));
    rtcSetGeometryUserData(geometry, spheres.data());
    rtcSetGeometryBoundsFunction(geometry, BoundSphere, nullptr);
    rtcSetGeometryIntersectFunction(geometry, IntersectSphere);
    rtcSetGeometryOccludedFunction(geometry, OccludeSphere);
    Attach(geometry, id);
  }

  void Build() {
    for (std::size_t i = 0; i < meshes.size(); ++i) AttachMesh(meshes[i].mesh, unsigned(i));
    if (!spheres.empty()) AttachSpheres(static_cast<unsigned>(meshes.size()));
    // One thread, as the order of building decides which of two equally near shapes a ray hits.
    WithThreads(1, [&] { rtcCommitScene(scene); });
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE) Fail("Embree can't build the scene: error ", int(error));
  }

  void HitSphere(const Sphere& sphere, const Ray& ray, double t, Hit* hit) const {
    const Vec3 n = Normalized(sphere.to_unit.Point(ray.origin + t * ray.direction));
    hit->material = sphere.material;
    hit->position = sphere.to_world.Point(n);
    hit->normal = hit->shading_normal = Normalized(sphere.to_world.Normal(n));
    hit->tangent = sphere.to_world.Vector({n.z, 0.0, -n.x});
    hit->margin = kSinglePrecision * LargestCoordinate(sphere.to_world);
  }

  void HitMesh(const Mesh& shape, unsigned triangle, double u, double v, Hit* hit) const {
    const auto& [i, j, k] = shape.mesh.triangles[triangle];
    const Vec3 a = shape.mesh.positions[i], b = shape.mesh.positions[j],
               c = shape.mesh.positions[k];
    hit->light = shape.light;
    hit->material = shape.material;
    hit->position = (1.0 - u - v) * a + u * b + v * c;
    hit->normal = hit->shading_normal = Normalized(Cross(b - a, c - a));
    hit->tangent = shape.tangent;
    hit->margin = kSinglePrecision *
                  std::max({LargestCoordinate(a), LargestCoordinate(b), LargestCoordinate(c)});
    if (shape.mesh.normals.empty()) return;
    const auto& normals = shape.mesh.normals;
    const Vec3 sum = (1.0 - u - v) * Normalized(normals[i]) + u * Normalized(normals[j]) +
                     v * Normalized(normals[k]);
    if (Length(sum) > kMinNormal) hit->shading_normal = Normalized(sum);
  }

  RTCDevice device;
  RTCScene scene;
  std::vector<Sphere> spheres;
  std::vector<Mesh> meshes;
};

Geometry::Geometry(const Scene& scene) : embree_(std::make_unique<Embree>()) {
  for (const Shape& shape : scene.shapes) {
    if (shape.sphere) {
      const Affine& map = shape.sphere->to_world;
      embree_->spheres.push_back({map, map.Inverse(), shape.material});
    } else {
      embree_->meshes.push_back({shape.mesh.mesh, shape.mesh.tangent, shape.material, -1});
    }
  }
  for (std::size_t i = 0; i < scene.rectangle_lights.size(); ++i) {
    const auto& [center, x, y, radiance] = scene.rectangle_lights[i];
    embree_->meshes.push_back({ParallelogramMesh(center, x, y), {}, -1, static_cast<int>(i)});
  }
  embree_->Build();
}

Geometry::~Geometry() = default;

bool Geometry::Intersect(const Ray& ray, Hit* hit) const {
  RTCRayHit found = {MakeRay(ray, std::numeric_limits<double>::infinity()), {}};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree_->scene, &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  *hit = {};
  if (found.hit.geomID == embree_->meshes.size()) {
    embree_->HitSphere(embree_->spheres[found.hit.primID], ray, found.ray.tfar, hit);
  } else {
    embree_->HitMesh(embree_->meshes[found.hit.geomID], found.hit.primID, found.hit.u, found.hit.v,
                     hit);
  }
  return true;
}

bool Geometry::Occluded(const Ray& ray, double distance) const {
  RTCRay r = MakeRay(ray, distance);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree_->scene, &context, &r);
  return r.tfar < 0.0f;
}

}  // namespace pbnbrdf

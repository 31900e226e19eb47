#include "app/raytrace/embree.h"

#if MIGIWA_EMBREE == 4
#include <embree4/rtcore.h>
#elif MIGIWA_EMBREE == 3
#include <embree3/rtcore.h>
#endif

#include <cstring>
#include <new>

#include "core/base/messages.h"

namespace migiwa {

const char* raysMissingAdvice() {
  return "this program was built without Embree, which ray tracing needs; install it (on Debian and Ubuntu: "
         "apt-get install libembree-dev) and build again";
}

#if MIGIWA_EMBREE > 0

namespace {

/// One for the program. Of all threads only the caller's builds, so that a mesh always gives the same tree,
/// and no instructions beyond AVX2, so that it gives the same hits on every processor that has those.
RTCDevice device() {
  static const std::shared_ptr<RTCDeviceTy> kDevice(rtcNewDevice("threads=1,start_threads=0,max_isa=avx2"),
                                                    [](RTCDevice made) {
                                                      if (made != nullptr) rtcReleaseDevice(made);
                                                    });
  if (kDevice == nullptr) throw MissingError("Embree does not start on this machine");
  return kDevice.get();
}

template <class Ray>
void setRay(Ray& ray, const Vec3f& origin, const Vec3f& direction, float from, float to) {
  ray.org_x = origin.x(), ray.org_y = origin.y(), ray.org_z = origin.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tnear = from, ray.tfar = to;
  ray.time = 0;
  ray.mask = ~0U, ray.id = 0, ray.flags = 0;
}

RTCScene sceneOf(const std::shared_ptr<void>& scene) {
  return static_cast<RTCScene>(scene.get());
}

}  // namespace

bool raysAvailable() {
  return true;
}

TriangleRays::TriangleRays(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return;
  const RTCScene scene = rtcNewScene(device());
  scene_ = std::shared_ptr<void>(scene, [](void* made) { rtcReleaseScene(static_cast<RTCScene>(made)); });
  // Robust: a ray that meets an edge never slips through between its triangles.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Vec3f), mesh.vertices.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(mesh.triangles[0]), mesh.triangles.size());
  if (vertices == nullptr || triangles == nullptr) throw std::bad_alloc();
  std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3f));
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
}

bool TriangleRays::first(const Vec3f& origin, const Vec3f& direction, float from, float to, Hit& hit) const {
  if (scene_ == nullptr) return false;
  RTCRayHit query;
  setRay(query.ray, origin, direction, from, to);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if MIGIWA_EMBREE == 4
  rtcIntersect1(sceneOf(scene_), &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(sceneOf(scene_), &context, &query);
#endif
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.distance = query.ray.tfar;
  hit.triangle = query.hit.primID;
  hit.u = query.hit.u, hit.v = query.hit.v;
  hit.normal = Vec3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  return true;
}

bool TriangleRays::any(const Vec3f& origin, const Vec3f& direction, float from, float to) const {
  if (scene_ == nullptr) return false;
  RTCRay ray;
  setRay(ray, origin, direction, from, to);
#if MIGIWA_EMBREE == 4
  rtcOccluded1(sceneOf(scene_), &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(sceneOf(scene_), &context, &ray);
#endif
  return ray.tfar < 0;
}

#else

bool raysAvailable() {
  return false;
}

TriangleRays::TriangleRays(const TriangleMesh& mesh) {
  if (!mesh.triangles.empty()) throw MissingError(raysMissingAdvice());
}

bool TriangleRays::first(const Vec3f&, const Vec3f&, float, float, Hit&) const {
  return false;
}

bool TriangleRays::any(const Vec3f&, const Vec3f&, float, float) const {
  return false;
}

#endif

}  // namespace migiwa

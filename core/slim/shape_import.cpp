#include "core/slim/shape_import.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>
#include <tuple>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "core/base/math.h"
#include "core/base/messages.h"
#include "core/slim/points.h"

namespace migiwa {

namespace {

namespace fs = std::filesystem;

/// Coordinates beyond this leave no digits for the shape.
constexpr float kLargestCoordinateRead = 1e7F;

struct Raw {
  TriangleMesh mesh;
  std::vector<OrientedPoint> points;    ///< of parts without faces
  std::size_t pointsWithoutNormal = 0;  ///< whose normal is zero
};

void requireFile(const fs::path& file) {
  std::error_code code;
  const std::string expected = "expected a mesh or a point cloud, found ";
  if (fs::is_directory(file, code)) throw InputError(file.string(), expected + "a folder");
  if (fs::exists(file, code)) {
    if (fs::is_regular_file(file, code) && fs::file_size(file, code) == 0)
      throw InputError(file.string(), expected + "an empty file");
    return;
  }
  std::string remedy;
  if (file.string().find("/glmark2/") != std::string::npos)
    remedy = "; it comes with Debian's package glmark2-data (sudo apt-get install glmark2-data)";
  throw InputError(file.string(), expected + "no such file" + remedy);
}

std::string endingOf(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending.empty() ? ending : ending.substr(1);
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  return std::move(content).str();
}

void requireFinite(const fs::path& file, const Vec3f& p, const char* kind, std::size_t number) {
  if (p.allFinite() && p.cwiseAbs().maxCoeff() <= kLargestCoordinateRead) return;
  throw InputError(file.string(), "expected coordinates that are finite and at most 1e7, found (" +
                                      std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
                                      std::to_string(p.z()) + ") in " + kind + " " +
                                      std::to_string(number + 1));
}

Vec3f vectorOf(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

void addMesh(const fs::path& file, const aiMesh& part, const aiMatrix4x4& transform, Raw& raw) {
  const aiMatrix3x3 linear(transform);
  if (part.mNumFaces == 0) {
    for (unsigned k = 0; k < part.mNumVertices; ++k) {
      const Vec3f p = vectorOf(transform * part.mVertices[k]);
      requireFinite(file, p, "point", raw.points.size());
      const Vec3f n = part.mNormals != nullptr ? vectorOf(linear * part.mNormals[k]) : Vec3f(Vec3f::Zero());
      const float length = n.norm();
      const bool known = length > 1e-6F && std::isfinite(length);
      raw.points.push_back({p, known ? Vec3f(n / length) : Vec3f(Vec3f::Zero())});
      if (!known) ++raw.pointsWithoutNormal;
    }
    return;
  }
  // Only corners of triangles count: readers leave other vertices behind.
  for (unsigned k = 0; k < part.mNumFaces; ++k) {
    const aiFace& face = part.mFaces[k];
    if (face.mNumIndices != 3) continue;
    std::array<std::uint32_t, 3> triangle{};
    for (unsigned corner = 0; corner < 3; ++corner) {
      const Vec3f p = vectorOf(transform * part.mVertices[face.mIndices[corner]]);
      requireFinite(file, p, "triangle", raw.mesh.triangles.size());
      triangle[corner] = static_cast<std::uint32_t>(raw.mesh.vertices.size());
      raw.mesh.vertices.push_back(p);
    }
    raw.mesh.triangles.push_back(triangle);
  }
}

/// What dividing polygons takes for granted, and a broken file may not have: corners that exist, a flag for
/// polygons only where there are some, and another where no face has a corner.
void makeConsistent(const fs::path& file, const aiScene& scene) {
  constexpr std::array<unsigned, 5> kKinds{aiPrimitiveType_POINT, aiPrimitiveType_POINT, aiPrimitiveType_LINE,
                                           aiPrimitiveType_TRIANGLE, aiPrimitiveType_POLYGON};
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    aiMesh& part = *scene.mMeshes[m];
    part.mPrimitiveTypes = 0;
    for (unsigned k = 0; k < part.mNumFaces; ++k) {
      const aiFace& face = part.mFaces[k];
      part.mPrimitiveTypes |= kKinds[std::min(face.mNumIndices, 4U)];
      for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
        if (face.mIndices[corner] < part.mNumVertices) continue;
        throw InputError(file.string() + ": face " + std::to_string(k),
                         "expected vertices from 0 to " + std::to_string(part.mNumVertices) + " - 1, found " +
                             std::to_string(face.mIndices[corner]));
      }
    }
  }
}

void addNode(const fs::path& file, const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent,
             Raw& raw) {
  const aiMatrix4x4 transform = parent * node.mTransformation;
  for (unsigned k = 0; k < node.mNumMeshes; ++k)
    addMesh(file, *scene.mMeshes[node.mMeshes[k]], transform, raw);
  for (unsigned k = 0; k < node.mNumChildren; ++k) addNode(file, scene, *node.mChildren[k], transform, raw);
}

}  // namespace

Bounds ImportedShape::bounds() const {
  Bounds bounds = mesh.bounds();
  for (const OrientedPoint& point : cloud.points) bounds.include(point.position.cast<double>());
  return bounds;
}

namespace {

Raw readXyzFile(const fs::path& file, std::string_view content, Vec3d& origin,
                std::vector<std::string>& notes) {
  XyzPoints read;
  if (std::string fault = readXyz(content, read, notes); !fault.empty())
    throw InputError(file.string(), std::move(fault));
  Bounds bounds;
  for (const Vec3d& p : read.positions) bounds.include(p);
  if (!read.positions.empty() && bounds.center().allFinite()) origin = bounds.center();
  Raw raw;
  for (std::size_t k = 0; k < read.positions.size(); ++k) {
    const Vec3f p = (read.positions[k] - origin).cast<float>();
    requireFinite(file, p, "point", k);
    const Vec3f normal = read.normals.empty() ? Vec3f(Vec3f::Zero()) : read.normals[k];
    raw.points.push_back({p, normal});
    if (normal.isZero()) ++raw.pointsWithoutNormal;
  }
  return raw;
}

/// `origin`: what the coordinates are relative to.
Raw readRaw(const fs::path& file, Vec3d& origin, std::vector<std::string>& notes) {
  const std::string ending = endingOf(file);
  std::string content;
  if (ending == "ply" || ending == "stl" || ending == "obj" || ending == "xyz") content = contentOf(file);
  if (ending == "xyz") return readXyzFile(file, content, origin, notes);
  std::string fault = ending == "ply"   ? plyFault(content)
                      : ending == "stl" ? repairStl(content, notes)
                                        : std::string();
  if (!fault.empty()) throw InputError(file.string(), std::move(fault));
  origin = moveToOrigin(content, ending);
  Assimp::Importer importer;
  // Everything but positions, faces and the normals of points is left out. What was changed is read from
  // memory.
  const bool changed = ending == "stl" || !origin.isZero();
  const aiScene* scene = changed
                             ? importer.ReadFileFromMemory(content.data(), content.size(), 0, ending.c_str())
                             : importer.ReadFile(file.string(), 0);
  if (scene != nullptr) {
    makeConsistent(file, *scene);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  }
  if (scene == nullptr || scene->mRootNode == nullptr)
    throw InputError(file.string(),
                     "expected a mesh (OBJ, PLY, STL, ...) or a point cloud, found a file that "
                     "cannot be read as one: " +
                         std::string(importer.GetErrorString()));
  Raw raw;
  addNode(file, *scene, *scene->mRootNode, aiMatrix4x4(), raw);
  return raw;
}

/// Puts the shape back where it came from, once all that needs its digits is done.
void moveBack(ImportedShape& shape, const Vec3d& origin) {
  if (origin.isZero()) return;
  const auto move = [&](Vec3f& p) {
    shape.exact.push_back(p.cast<double>() + origin);
    p = shape.exact.back().cast<float>();
  };
  for (Vec3f& vertex : shape.mesh.vertices) move(vertex);
  for (OrientedPoint& point : shape.cloud.points) move(point.position);
}

}  // namespace

ImportedShape importShape(const fs::path& file) {
  requireFile(file);
  ImportedShape shape;
  Vec3d origin = Vec3d::Zero();
  Raw raw = readRaw(file, origin, shape.notes);
  if (!raw.mesh.triangles.empty()) {
    shape.mesh = std::move(raw.mesh);
    RepairedMesh repaired = repairMesh(shape.mesh, file.string(), shape.notes);
    shape.closed = repaired.closed;
    shape.branching = std::move(repaired.branching);
    shape.rim = std::move(repaired.rim);
    moveBack(shape, origin);
    return shape;
  }
  shape.cloud.points = std::move(raw.points);
  if (raw.pointsWithoutNormal > 0 && raw.pointsWithoutNormal < shape.cloud.points.size()) {
    std::erase_if(shape.cloud.points, [](const OrientedPoint& point) { return point.normal.isZero(); });
    shape.notes.push_back(std::to_string(raw.pointsWithoutNormal) +
                          " points without a normal were left out, others have one");
  }
  shape.closed = repairCloud(shape.cloud.points, file.string(), shape.notes);
  shape.cloud.closed = shape.closed;
  moveBack(shape, origin);
  return shape;
}

OrientedPoints fitPoints(const ImportedShape& shape, int nodes) {
  if (!shape.isMesh()) return shape.cloud;
  if (shape.branching) throw InputError(std::vector{*shape.branching});
  return {samplePoints(shape.mesh, sampleCount(shape.mesh, nodes), 1), shape.closed};
}

namespace {

constexpr std::size_t kFewestPoints = 50;
/// Mean normal of a surface, up to which it counts as closed.
constexpr double kMostOpen = 0.1;

std::tuple<float, float, float> inOrder(const OrientedPoint& point) {
  return {point.position.x(), point.position.y(), point.position.z()};
}

/// Points nearer to each other than this share of their extent's diagonal are one.
constexpr double kSamePlace = 1e-6;

/// Leaves out points at the place of one before them.
void dropNear(std::vector<OrientedPoint>& points) {
  points.erase(
      std::unique(points.begin(), points.end(),
                  [](const OrientedPoint& a, const OrientedPoint& b) { return inOrder(a) == inOrder(b); }),
      points.end());
  Bounds bounds;
  std::vector<Vec3f> places;
  for (const OrientedPoint& point : points) {
    places.push_back(point.position);
    bounds.include(point.position.cast<double>());
  }
  const double reach = kSamePlace * bounds.size().norm();
  if (!(reach > 0)) return;
  const NearPoints near(std::move(places), reach);
  std::vector<bool> dropped(points.size(), false);
  std::vector<OrientedPoint> kept;
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    near.within(points[k].position, [&](std::uint32_t other) {
      dropped[k] = other < k && !dropped[other];
      return !dropped[k];
    });
    if (!dropped[k]) kept.push_back(points[k]);
  }
  points = std::move(kept);
}

std::size_t turnAgainstNeighbours(std::vector<OrientedPoint>& points) {
  std::size_t turned = 0;
  std::vector<std::uint32_t> around;
  for (int round = 0; round < 3; ++round) {
    PointLevels levels(points);
    const float reach = 3 * levels.spacing();
    std::vector<OrientedPoint> next(levels.points().begin(), levels.points().end());
    std::size_t before = turned;
    for (OrientedPoint& point : next) {
      levels.withinAll(point.position, reach, around);
      Vec3f mean = Vec3f::Zero();
      for (const std::uint32_t index : around) mean += levels.points()[index].normal;
      if (around.size() < 4 || mean.dot(point.normal) > -0.3F * static_cast<float>(around.size())) continue;
      point.normal = -point.normal;
      ++turned;
    }
    points = std::move(next);
    if (turned == before) break;
  }
  return turned;
}

/// Negative where most normals face the middle of the points.
double outwardFlux(const std::vector<OrientedPoint>& points) {
  Bounds bounds;
  for (const OrientedPoint& point : points) bounds.include(point.position.cast<double>());
  double flux = 0;
  for (const OrientedPoint& point : points)
    flux += point.normal.cast<double>().dot(point.position.cast<double>() - bounds.center());
  return flux;
}

void turnAll(std::vector<OrientedPoint>& points) {
  for (OrientedPoint& point : points) point.normal = -point.normal;
}

}  // namespace

bool repairCloud(std::vector<OrientedPoint>& points, const std::string& place,
                 std::vector<std::string>& notes) {
  std::stable_sort(points.begin(), points.end(),
                   [](const OrientedPoint& a, const OrientedPoint& b) { return inOrder(a) < inOrder(b); });
  const std::size_t all = points.size();
  dropNear(points);
  if (points.size() < all)
    notes.push_back(std::to_string(all - points.size()) +
                    " points at the same place as another one were left out");
  if (points.size() < kFewestPoints)
    throw InputError(place, "expected a mesh, or at least " + std::to_string(kFewestPoints) +
                                " points, found " + std::to_string(points.size()) + " points");
  if (points[0].normal.isZero()) {
    estimateNormals(points, place);
    notes.emplace_back("normals were estimated from neighbouring points, and made to face outwards");
    return true;
  }
  if (const std::size_t turned = turnAgainstNeighbours(points); turned > 0)
    notes.push_back(std::to_string(turned) + " normals were turned to agree with their neighbours");
  const bool inwards = outwardFlux(points) < 0;
  // Whole parts that face the other way than the rest.
  std::vector<OrientedPoint> agreed = points;
  if (inwards) turnAll(agreed);
  if (const std::size_t turned = orientNormals(agreed); turned > 0) {
    points = std::move(agreed);
    notes.push_back(std::to_string(turned) + " normals were turned so that all of them face outwards");
    return true;
  }

  Vec3d mean = Vec3d::Zero();
  for (const OrientedPoint& point : points)
    mean += point.normal.cast<double>() / static_cast<double>(points.size());
  const bool closed = mean.norm() < kMostOpen;
  if (!closed) {
    notes.emplace_back(
        "the points do not seem to cover a closed surface: inside and outside are known near it only");
    return false;
  }
  if (inwards) {
    turnAll(points);
    notes.emplace_back("all normals were turned: they pointed inwards");
  }
  return true;
}

Vec3d middleIfFar(const fs::path& file) {
  const std::string ending = endingOf(file);
  if (ending != "ply" && ending != "stl" && ending != "obj") return Vec3d::Zero();
  try {
    std::string content = contentOf(file);
    if (ending == "ply" && !plyFault(content).empty()) return Vec3d::Zero();
    return moveToOrigin(content, ending);
  } catch (const InputError&) {
    return Vec3d::Zero();  // said where the shape is read
  }
}

}  // namespace migiwa

#include "core/walls/slim_wall.h"

#include <cmath>

#include "core/base/messages.h"
#include "core/slim/model.h"

namespace migiwa {

namespace {

/// Passages from one origin: first hits and exits ask for the same ones in turn.
struct Passages {
  std::shared_ptr<const SlimWallData> data;
  Vec3f origin = Vec3f::Zero();
  bool inside = false;
  const float* directions = nullptr;
  std::vector<SlimPassages> of;

  bool are(const std::shared_ptr<const SlimWallData>& otherData, const Vec3f& otherOrigin, bool otherInside,
           const Directions& others) const {
    return data == otherData && origin == otherOrigin && inside == otherInside &&
           directions == others.x.data() && of.size() == others.size();
  }
  void find(std::shared_ptr<const SlimWallData> newData, const Vec3f& newOrigin, bool newInside,
            const Directions& others, float reach) {
    data = std::move(newData);
    origin = newOrigin;
    inside = newInside;
    directions = others.x.data();
    of.resize(others.size());
    slimPassages(*data->model, origin, inside, {others.x, others.y, others.z}, reach, of);
  }
};
thread_local Passages passages;

}  // namespace

template <class Visitor>
void SlimSurface::describeFit(Visitor& visitor, Visited<Visitor, SlimSource>& source) {
  visitor.integer("degree", source.degree, Range::closed(1, kLargestSlimDegree),
                  {"1", "Degree of the polynomials."});
  visitor.number("tolerance", source.tolerance, Range::closed(0, 1e6),
                 {"m",
                  "Largest distance of a polynomial to the mesh; 0: a thousandth of its diagonal, or all "
                  "nodes of a file."});
  visitor.integer("nodes", source.nodes, Range::closed(0, 5e6),
                  {"1",
                   "Fits about so many nodes instead, or takes at most so many of a file; 0: by the "
                   "tolerance."});
  if (visitor.valid({"tolerance", "nodes"}) && source.tolerance > 0 && source.nodes > 0)
    visitor.fault("nodes", "expected either tolerance or nodes, found both");
}

template <class Visitor>
void SlimSurface::describeBowl(Visitor& visitor, Visited<Visitor, Bowl>& bowl) {
  visitor.vector("center", bowl.center, {"m", "Centre of the sphere.", Presence::required});
  visitor.number("radius", bowl.radius, Range::length(kLargestCoordinate),
                 {"m", "Of the sphere midway in the wall.", Presence::required});
  visitor.number("thickness", bowl.thickness, Range::length(kLargestCoordinate),
                 {"m", "Of the wall.", Presence::required});
  visitor.number("height", bowl.height, Range::closed(0, kLargestCoordinate),
                 {"m", "Of the rim above the centre: 0 is a bowl, more a glass with a round bottom."});
  if (visitor.valid({"radius", "thickness"}) && bowl.thickness >= bowl.radius)
    visitor.fault("thickness", "expected less than the radius, found more");
}

/// `bowl`: whether there is one.
template <class Visitor>
void SlimSurface::fields(Visitor& visitor, Visited<Visitor, SlimSurface>& self,
                         Visited<Visitor, bool>& bowl) {
  describeFluid(visitor, self);
  visitor.file("file", self.slimFile_,
               {"", "A surface that migiwa slim has written, relative to the scene file."});
  visitor.file("mesh", self.meshFile_,
               {"", "Instead: a mesh or points with normals to fit, relative to the scene file."});
  visitor.object(
      "bowl",
      {"",
       "Instead: a bowl by formula, the lower half of a sphere with a rounded rim, or a "
       "glass."},
      [&](auto& inner) { describeBowl(inner, self.source_.bowl); }, &bowl);
  describeFit(visitor, self.source_);
  Transform::describe(visitor, self.source_.transform);
}

void SlimSurface::describe(FieldWriter& visitor) const {
  const bool bowl = source_.kind == SlimSource::Kind::bowl;
  fields(visitor, *this, bowl);
}

void SlimSurface::describe(FieldVisitor& visitor) {
  bool bowl = source_.kind == SlimSource::Kind::bowl;
  fields(visitor, *this, bowl);
  if (!visitor.valid({"file", "mesh", "bowl"})) return;
  const int given =
      static_cast<int>(!slimFile_.empty()) + static_cast<int>(!meshFile_.empty()) + static_cast<int>(bowl);
  if (given != 1) {
    visitor.fault("", "expected one of \"file\", \"mesh\" and \"bowl\", found " +
                          std::string(given == 0 ? "none" : "more"));
    return;
  }
  if (bowl) {
    setFile(SlimSource::Kind::bowl, {});
    prepare(visitor, "bowl");
  } else if (slimFile_.empty()) {
    setFile(SlimSource::Kind::mesh, meshFile_);
    prepare(visitor, "mesh");
  } else {
    setFile(SlimSource::Kind::slimFile, slimFile_);
    prepare(visitor, "file");
  }
}

SlimSurface::SlimSurface(const FileName& mesh, const Transform& transform, Fluid fluid)
    : fluid_(fluid), meshFile_(mesh) {
  source_.transform = transform;
  setFile(SlimSource::Kind::mesh, mesh);
  data_ = prepareSlim(source_);
}

void SlimSurface::setFile(SlimSource::Kind kind, const FileName& file) {
  source_.kind = kind;
  source_.file = file.path;
  source_.identity = file.identity;
}

void SlimSurface::prepare(FieldVisitor& visitor, std::string_view key) {
  if (!visitor.valid({"degree", "tolerance", "nodes", "transform"})) return;
  try {
    data_ = prepareSlim(source_);
  } catch (const InputError& error) {
    for (const Fault& fault : error.faults()) visitor.fault(key, fault.message + " (" + fault.place + ")");
    return;
  }
  for (const std::string& note : data_->notes) visitor.warning(key, source_.file.string() + ": " + note);
}

float SlimSurface::distance(const Vec3f& p, Vec3f& normal) const {
  const SlimModel::Nearest nearest = data_->model->nearest(p);
  normal = holdsFluid() ? Vec3f(-nearest.normal) : nearest.normal;
  return holdsFluid() ? -nearest.distance : nearest.distance;
}

float SlimSurface::statedError(const Vec3f& p) const {
  /// Faces of a mesh that meet at a right angle, and the blend between them, are farther apart than that.
  constexpr float kSmooth = 0.8F;
  const SlimModel::Nearest nearest = data_->model->nearest(p);
  const Vec3f foot = p - nearest.distance * nearest.normal;
  float error = 0, least = 1;
  data_->model->visitWithin(foot, 1e-6F * data_->model->largestRadius(), [&](std::uint32_t index) {
    const SlimNode& node = data_->model->nodes()[index];
    error = std::max(error, node.error);
    least = std::min(least, node.normal.dot(nearest.normal));
  });
  // In a corner the blend of three faces may miss as much as all of them together.
  return least < kSmooth ? 3 * error : error;
}

bool SlimSurface::project(Vec3f& p, float margin) const {
  const float coarse = data_->model->coarseDistance(p) * (holdsFluid() ? -1.0F : 1.0F);
  if (coarse - data_->model->coarseError() > margin) return false;
  return projectAlongNormals(*this, p, margin);
}

void SlimSurface::firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const {
  passages.find(data_, origin, holdsFluid(), directions, *std::max_element(hits.begin(), hits.end()));
  for (std::size_t k = 0; k < hits.size(); ++k) hits[k] = std::min(hits[k], passages.of[k][0]);
}

void SlimSurface::exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const {
  if (!passages.are(data_, origin, holdsFluid(), directions))
    passages.find(data_, origin, holdsFluid(), directions, static_cast<float>(bounds().size().norm()));
  for (std::size_t k = 0; k < exits.size(); ++k) exits[k] = passages.of[k][1];
}

float SlimSurface::thinnestPart() const {
  return holdsFluid() ? Surface::thinnestPart() : data_->thinnestPart;
}

bool SlimSurface::crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const {
  if (!slimFirstPassage(*data_->model, from, to, holdsFluid(), entry, normal)) return false;
  if (holdsFluid()) normal = -normal;
  return true;
}

void SlimSurface::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  const float side = holdsFluid() ? -1.0F : 1.0F;
  data_->model->visitWithin(p, reach, [&](std::uint32_t index) {
    const SlimNode& node = data_->model->nodes()[index];
    const Vec3f offset = p - node.centre;
    if (offset.squaredNorm() >= reach * reach) return;
    // The tangent plane of the polynomial at the ball's centre.
    const Vec3f tilted =
        node.normal - node.coefficients[1] * node.tangent - node.coefficients[2] * node.bitangent();
    const float steep = tilted.norm();
    out.push_back(
        {side / steep * tilted, side * (tilted.dot(offset) - node.coefficients[0]) / steep, node.centre});
  });
}

Bounds SlimSurface::bounds() const {
  return data_ ? data_->model->bounds() : Bounds{};
}

WallMesh SlimSurface::mesh() const {
  const SlimMesh& drawn = data_->drawnMesh();
  WallMesh mesh{drawn.surface, drawn.normals, holdsFluid()};
  if (holdsFluid()) {
    for (Vec3f& normal : mesh.normals) normal = -normal;
    for (auto& corners : mesh.surface.triangles) std::swap(corners[1], corners[2]);
  }
  return mesh;
}

void SlimSurface::drawnNodes(std::vector<WallNode>& out) const {
  for (const SlimNode& node : data_->model->nodes()) {
    const Vec3f tilted =
        (node.normal - node.coefficients[1] * node.tangent - node.coefficients[2] * node.bitangent())
            .normalized();
    out.push_back({node.centre + node.coefficients[0] * node.normal, holdsFluid() ? Vec3f(-tilted) : tilted,
                   node.radius, kSlimCore * node.radius, holdsFluid()});
  }
}

}  // namespace migiwa

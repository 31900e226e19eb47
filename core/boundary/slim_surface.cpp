#include "core/boundary/slim_surface.h"

#include <cmath>

#include "core/base/error.h"
#include "core/slim/slim_rays.h"

namespace migiwa {

namespace {

constexpr std::array<std::string_view, 2> kFluidNames{"inside", "outside"};

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

void SlimSurface::describeFluid(FieldVisitor& visitor) {
  visitor.choice("fluid", fluid_, kFluidNames,
                 {"", "The side of the wall that holds the fluid.", Presence::required});
}

void SlimSurface::describeFit(FieldVisitor& visitor) {
  visitor.integer("degree", source_.degree, Range::closed(1, kLargestSlimDegree),
                  {"1", "Degree of the polynomials."});
  visitor.number("tolerance", source_.tolerance, Range::closed(0, 1e6),
                 {"m",
                  "Largest distance of a polynomial to the mesh; 0: a thousandth of its diagonal, or all "
                  "nodes of a file."});
  visitor.integer("nodes", source_.nodes, Range::closed(0, 5e6),
                  {"1",
                   "Fits about so many nodes instead, or takes at most so many of a file; 0: by the "
                   "tolerance."});
  if (visitor.sound({"tolerance", "nodes"}) && source_.tolerance > 0 && source_.nodes > 0)
    visitor.fault("nodes", "expected either tolerance or nodes, found both");
}

void SlimSurface::describeTransform(FieldVisitor& visitor) {
  visitor.object("transform", {"", "Where the shape of the file stands in the scene."},
                 [this](FieldVisitor& fields) { source_.transform.describe(fields); });
}

void SlimSurface::describe(FieldVisitor& visitor) {
  describeFluid(visitor);
  visitor.file("file", slimFile_,
               {"", "A surface that migiwa slim has written, relative to the scene file."});
  visitor.file("mesh", meshFile_,
               {"", "Instead: a mesh or points with normals to fit, relative to the scene file."});
  bool bowl = source_.kind == SlimSource::Kind::bowl;
  visitor.object(
      "bowl",
      {"",
       "Instead: a bowl by formula, the lower half of a sphere with a rounded rim, or a "
       "glass."},
      [this](FieldVisitor& fields) {
        fields.vector("center", source_.bowl.center, {"m", "Centre of the sphere.", Presence::required});
        fields.number("radius", source_.bowl.radius, Range::positive(kLargestCoordinate),
                      {"m", "Of the sphere midway in the wall.", Presence::required});
        fields.number("thickness", source_.bowl.thickness, Range::positive(kLargestCoordinate),
                      {"m", "Of the wall.", Presence::required});
        fields.number("height", source_.bowl.height, Range::closed(0, kLargestCoordinate),
                      {"m", "Of the rim above the centre: 0 is a bowl, more a glass with a round bottom."});
        if (fields.sound({"radius", "thickness"}) && source_.bowl.thickness >= source_.bowl.radius)
          fields.fault("thickness", "expected less than the radius, found more");
      },
      &bowl);
  describeFit(visitor);
  describeTransform(visitor);
  if (!visitor.sound({"file", "mesh", "bowl"})) return;
  const int given =
      static_cast<int>(!slimFile_.empty()) + static_cast<int>(!meshFile_.empty()) + static_cast<int>(bowl);
  if (given != 1) {
    visitor.fault("", "expected one of \"file\", \"mesh\" and \"bowl\", found " +
                          std::string(given == 0 ? "none" : "more"));
    return;
  }
  source_.kind = bowl                ? SlimSource::Kind::bowl
                 : slimFile_.empty() ? SlimSource::Kind::mesh
                                     : SlimSource::Kind::slimFile;
  source_.file = bowl ? std::filesystem::path() : slimFile_.empty() ? meshFile_.path : slimFile_.path;
  prepare(visitor, bowl ? "bowl" : slimFile_.empty() ? "mesh" : "file");
}

void SlimSurface::prepare(FieldVisitor& visitor, std::string_view key) {
  if (!visitor.sound({"degree", "tolerance", "nodes", "transform"}) || (data_ && source_ == prepared_))
    return;
  try {
    data_ = prepareSlim(source_);
  } catch (const InputError& error) {
    for (const Fault& fault : error.faults()) visitor.fault(key, fault.message + " (" + fault.place + ")");
    return;
  }
  prepared_ = source_;
  for (const std::string& note : data_->notes) visitor.warning(key, source_.file.string() + ": " + note);
}

float SlimSurface::distance(const Vec3f& p, Vec3f& normal) const {
  const SlimModel::Nearest nearest = data_->model->nearest(p);
  normal = holdsFluid() ? Vec3f(-nearest.normal) : nearest.normal;
  return holdsFluid() ? -nearest.distance : nearest.distance;
}

bool SlimSurface::project(Vec3f& p, float margin) const {
  const float coarse = data_->model->coarseDistance(p) * (holdsFluid() ? -1.0F : 1.0F);
  if (coarse - data_->model->coarseError() > margin) return false;
  constexpr int kRounds = 8;
  bool moved = false;
  Vec3f before = p;
  for (int round = 0; round < kRounds; ++round) {
    Vec3f normal;
    const float missing = margin - distance(p, normal);
    if (missing <= 1e-4F * margin) return moved;
    before = p;
    p += missing * normal;
    moved = true;
  }
  // To and fro between two parts of the wall: midway.
  p = 0.5F * (before + p);
  return true;
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

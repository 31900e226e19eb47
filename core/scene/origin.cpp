// Where the positions of a scene that is far from zero are measured from. It is found in the JSON, before
// anything is made of it: shapes from files are fitted where they are.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/json.h"
#include "core/scene/scene.h"
#include "core/slim/shape_import.h"

namespace migiwa {

namespace {

/// Floats have to tell positions apart to this part of a spacing.
constexpr double kFinest = 1e-3;
/// Nearer than so many of its sizes, a scene would gain too little to be moved.
constexpr double kNear = 2;

std::optional<double> numberAt(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_number()) return std::nullopt;
  return object[key].get<double>();
}

std::optional<Vec3d> pointAt(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) return std::nullopt;
  const Json& value = object[key];
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  Vec3d point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!value[axis].is_number() || !kCoordinateRange.contains(value[axis].get<double>()))
      return std::nullopt;
    point[static_cast<Eigen::Index>(axis)] = value[axis].get<double>();
  }
  return point;
}

/// Of a box, or of a ball about one of its keys; empty for anything else.
Bounds extentOf(const Json& entry) {
  Bounds bounds;
  const auto min = pointAt(entry, "min"), max = pointAt(entry, "max");
  if (min && max) {
    bounds.include(*min);
    bounds.include(*max);
  }
  for (const char* key : {"center", "origin"})
    if (const auto center = pointAt(entry, key)) {
      Bounds ball;
      ball.include(*center);
      bounds.include(ball.grown(std::abs(numberAt(entry, "radius").value_or(0))));
    }
  return bounds;
}

/// Of the middle of a shape's own coordinates, as "transform" of `entry` has it.
Vec3d transformed(const Json& entry, Vec3d point) {
  if (!entry.contains("transform") || !entry["transform"].is_object()) return point;
  const Json& transform = entry["transform"];
  point *= numberAt(transform, "scale").value_or(1);
  if (transform.contains("rotate")) {
    const auto axis = pointAt(transform["rotate"], "axis");
    const auto degrees = numberAt(transform["rotate"], "degrees");
    if (axis && axis->norm() > 0 && degrees) point = Rotation{*axis, *degrees}.matrix() * point;
  }
  return point + pointAt(transform, "translate").value_or(Vec3d::Zero());
}

/// Where the middle of a file's shape is; of one near zero, the zero of its coordinates.
std::optional<Vec3d> placeOfFile(const Json& entry, const std::string& pointer, const FaultList& faults) {
  for (const char* key : {"file", "mesh"})
    if (entry.contains(key) && entry[key].is_string())
      return transformed(
          entry, middleIfFar(faults.folder(childPointer(pointer, key)) / entry[key].get<std::string>()));
  return std::nullopt;
}

struct PlacedObject {
  const Json* json;
  std::string pointer;
};

/// Adds the objects of a list, if it is there and one.
void addEntries(const Json& object, const std::string& key, const std::string& pointer,
                std::vector<PlacedObject>& out) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_array()) return;
  for (std::size_t k = 0; k < object[key].size(); ++k)
    if (const Json& entry = object[key][k]; entry.is_object())
      out.push_back({&entry, childPointer(pointer, k)});
}

/// Extents of what tells where the scene is, the best first: fluid, walls with an end or, where neither says
/// so, shapes from files; then points of planes.
std::vector<Bounds> extentsOf(const std::vector<PlacedObject>& fluid, const std::vector<PlacedObject>& walls,
                              const FaultList& faults) {
  std::vector<Bounds> extents;
  // What is out of range is a fault, and said where it is read.
  const auto add = [&](const Bounds& own) {
    const auto inRange = [](const Vec3d& p) { return (p.array().abs() <= kLargestCoordinate).all(); };
    if (inRange(own.min) && inRange(own.max)) extents.push_back(own);
  };
  const auto addPoint = [&](const std::optional<Vec3d>& place) {
    if (place) add({*place, *place});
  };
  for (const auto* entries : {&fluid, &walls})
    for (const auto& [entry, pointer] : *entries) {
      Bounds own = extentOf(*entry);
      if (entry->contains("bowl")) {
        const Bounds bowl = extentOf((*entry)["bowl"]);
        if (!bowl.empty()) {
          own.include(transformed(*entry, bowl.min));
          own.include(transformed(*entry, bowl.max));
        }
      }
      add(own);
    }
  if (extents.empty())
    for (const auto* entries : {&fluid, &walls})
      for (const auto& [entry, pointer] : *entries) addPoint(placeOfFile(*entry, pointer, faults));
  for (const auto& [entry, pointer] : walls) addPoint(pointAt(*entry, "point"));
  return extents;
}

/// The number with the fewest digits in an interval, and of several the one nearest to its middle: scenes are
/// moved by round numbers, and then their relative coordinates are those that they had before.
double roundest(double low, double high) {
  const double middle = 0.5 * (low + high);
  for (int exponent = 7; exponent >= -9; --exponent) {
    double power = 1;
    for (int k = 0; k < std::abs(exponent); ++k) power *= 10;
    for (const double digit : {5.0, 2.0, 1.0}) {
      // Divided, a decimal fraction is the double that its digits are read as.
      const double steps =
          std::round(exponent < 0 ? middle * power / digit : middle / (digit * power)) * digit;
      const double value = exponent < 0 ? steps / power : steps * power;
      if (low <= value && value <= high) return value;
    }
  }
  return middle;
}

}  // namespace

Vec3d originOf(const Json& root, const FaultList& faults) {
  if (!root.is_object()) return Vec3d::Zero();
  const double spacing = numberAt(root, "particle_spacing").value_or(Scene().particleSpacing);
  // The distance from which on floats are too coarse.
  const double reach = kFinest * spacing / double(std::numeric_limits<float>::epsilon());
  std::vector<PlacedObject> fluid, walls;
  addEntries(root, "fluid", "/fluid", fluid);
  addEntries(root, "emitters", "/emitters", fluid);
  if (root.contains("boundary")) addEntries(root["boundary"], "surfaces", "/boundary/surfaces", walls);
  const std::vector<Bounds> extents = extentsOf(fluid, walls, faults);
  // Walls may go on for ever: only those count that leave the fluid its digits.
  Bounds scene;
  for (const Bounds& extent : extents) {
    Bounds both = scene;
    both.include(extent);
    if (scene.empty() || both.size().maxCoeff() <= reach) scene = both;
  }
  Vec3d origin = Vec3d::Zero();
  if (scene.empty()) return origin;
  const double size = scene.size().maxCoeff();
  // Around what is a point, too, there are places as good.
  if (size == 0) scene = scene.grown(0.01 * reach);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = scene.min[axis], high = scene.max[axis];
    if (std::max(std::abs(low), std::abs(high)) <= std::max(reach, kNear * size)) continue;
    origin[axis] = roundest(low, high);
  }
  return origin;
}

}  // namespace migiwa

// Whether the parts of a scene are of one scale, in one place, and leave the fluid any room.
#include <algorithm>
#include <sstream>

#include "core/scene/json.h"
#include "core/scene/scene.h"
#include "core/walls/moving.h"

namespace migiwa {

namespace {

/// A shape from a file this many times as large as all else is in other units than that.
constexpr double kOtherUnits = 100;

struct Part {
  std::string pointer;
  Bounds bounds;
  bool fromFile = false;
  bool wall = false;
  bool vessel = false;  ///< with the fluid inside, and at rest
};

double largestSide(const Bounds& bounds) {
  return bounds.size().maxCoeff();
}

/// Distance between two boxes.
double gapBetween(const Bounds& a, const Bounds& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0).norm();
}

bool fromFile(const Json& entry) {
  return entry.contains("file") || entry.contains("mesh");
}

/// All that has an extent, in the order of the scene.
std::vector<Part> partsOf(const Scene& scene, const Json& root) {
  std::vector<Part> parts;
  const auto add = [&](const std::string& list, std::size_t index, const Bounds& bounds) -> Part* {
    if (bounds.empty() || !bounds.min.allFinite() || !bounds.max.allFinite()) return nullptr;
    Part part{list + "/" + std::to_string(index), bounds};
    if (const auto place = parsePointer(part.pointer); place && root.contains(*place)) {
      const Json& entry = root.at(*place);
      part.fromFile = fromFile(entry);
      part.vessel = entry.contains("fluid") && entry["fluid"] == "inside" && !entry.contains("motion");
    }
    parts.push_back(std::move(part));
    return &parts.back();
  };
  for (std::size_t k = 0; k < scene.fluid.size(); ++k) add("/fluid", k, scene.fluid[k]->bounds());
  for (std::size_t k = 0; k < scene.emitters.size(); ++k) add("/emitters", k, scene.emitters[k].bounds());
  for (std::size_t k = 0; k < scene.surfaces.size(); ++k)
    if (Part* part = add("/boundary/surfaces", k, sweptBounds(*scene.surfaces[k], scene.duration)))
      part->wall = true;
  return parts;
}

void checkVessels(const std::vector<Part>& parts, FaultList& faults) {
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (std::size_t before = 0; parts[k].vessel && before < k; ++before) {
      const Bounds &a = parts[before].bounds, &b = parts[k].bounds;
      if (!parts[before].vessel || (a.max.cwiseMin(b.max).array() > a.min.cwiseMax(b.min).array()).all())
        continue;
      faults.add(
          parts[k].pointer,
          "expected room for fluid, which is on the fluid side of every surface, found no place inside "
          "of both this surface and " +
              parts[before].pointer + "; make them one vessel, or put both in one group");
      break;
    }
}

std::string metres(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value << " m";
  return text.str();
}

/// Whether the shape was said to be of another scale than the rest.
bool warnOfScale(const Part& part, double rest, double spacing, FaultList& faults) {
  const double own = largestSide(part.bounds);
  if (own >= kOtherUnits * rest && rest > 0) {
    faults.warn(part.pointer, "its largest side is " + metres(own) + ", and that of all else together " +
                                  metres(rest) +
                                  "; if the file is in millimetres, \"transform\": {\"scale\": 0.001} makes "
                                  "them metres");
    return true;
  }
  if (own >= spacing) return false;
  faults.warn(part.pointer, "its largest side is " + metres(own) + ", less than particle_spacing, " +
                                metres(spacing) + ", and that of all else together " + metres(rest) +
                                "; \"transform\": {\"scale\": ...} makes it larger");
  return true;
}

void warnOfGap(const std::string& pointer, const Bounds& own, const std::string& what, const Bounds& rest,
               FaultList& faults) {
  const double gap = gapBetween(own, rest);
  if (gap <= std::max(largestSide(own), largestSide(rest))) return;
  faults.warn(pointer,
              "it is " + metres(gap) + " away from " + what + ", whose largest side is " +
                  metres(largestSide(rest)) + "; its own is " + metres(largestSide(own)) +
                  (pointer == "/boundary/surfaces"
                       ? ". Check the coordinates"
                       : "; \"transform\": {\"translate\": ..., \"scale\": ...} puts it in its place"));
}

}  // namespace

void checkPlaces(const Scene& scene, const Json& root, FaultList& faults) {
  const std::vector<Part> parts = partsOf(scene, root);
  checkVessels(parts, faults);
  bool said = false;
  Bounds fluid, walls;
  for (const Part& part : parts) {
    (part.wall ? walls : fluid).include(part.bounds);
    if (!part.fromFile) continue;
    // What was written by hand tells best; another file may be in the wrong units, too.
    Bounds rest, files;
    for (const Part& other : parts)
      if (&other != &part) (other.fromFile ? files : rest).include(other.bounds);
    if (rest.empty()) rest = files;
    if (rest.empty()) continue;
    const std::size_t before = faults.warnings().size();
    if (!warnOfScale(part, largestSide(rest), scene.particleSpacing, faults))
      warnOfGap(part.pointer, part.bounds, "all else", rest, faults);
    said = said || faults.warnings().size() > before;
  }
  const bool endless = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                   [](const auto& surface) { return surface->bounds().empty(); });
  if (!said && !endless && !fluid.empty() && !walls.empty())
    warnOfGap("/boundary/surfaces", walls, "the fluid", fluid, faults);
}

}  // namespace migiwa

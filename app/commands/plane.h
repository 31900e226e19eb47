// A plane through a scene, and what is to be shown on it, as options of several commands say it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "core/scene/scene.h"
#include "core/simulation/scene_section.h"

namespace migiwa {

struct PlaneWords {
  std::string plane, normal, field{kSectionFieldNames[0]}, divisor{kSectionDivisorNames[0]};
  std::optional<double> offset;
};
/// `group`: a heading of --help.
std::vector<Option> planeOptions(PlaneWords& words, const std::string& group);

/// A plane in the coordinates of the scene's file, and how it is called.
struct Cut {
  Vec3d normal = Vec3d::UnitZ();
  double offset = 0;  ///< along the unit normal (m)
  std::string name;
};

/// Throws InputError. Left out: the scene's cut, or its middle.
Cut cutOf(const PlaneWords& words, const Scene& scene);
/// Throws InputError: the plane does not meet the scene.
[[noreturn]] void refusePlane(const PlaneWords& words, const Cut& cut, const Scene& scene);
SectionField fieldOf(const PlaneWords& words);
SectionDivisor divisorOf(const PlaneWords& words);
/// "(0.71, 0.71, 0)", with so many decimals at most and no zero below zero.
std::string directionText(const Vec3d& direction, int decimals);

}  // namespace migiwa

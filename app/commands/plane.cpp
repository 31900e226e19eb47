#include "app/commands/plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

#include "core/base/messages.h"

namespace migiwa {
namespace {

/// Significant digits that tell places of a scene apart, however far from zero it is.
int placeDigits(const Scene& scene) {
  const Bounds bounds = scene.bounds();
  const double size = bounds.size().maxCoeff(), far = (bounds.center() + scene.origin).cwiseAbs().maxCoeff();
  return size > 0 && far > size ? std::min(6 + static_cast<int>(std::ceil(std::log10(far / size))), 15) : 6;
}

}  // namespace

std::string directionText(const Vec3d& direction, int decimals) {
  const double unit = std::pow(10, decimals);
  std::string text;
  for (const double part : direction)
    text += (text.empty() ? "(" : ", ") + formatNumber("%g", std::round(part * unit) / unit + 0.0);
  return text + ")";
}

Cut cutOf(const PlaneWords& words, const Scene& scene) {
  Cut cut;
  std::ostringstream name;
  name.precision(placeDigits(scene));
  if (!words.normal.empty()) {
    std::array<double, 3> normal{};
    const bool valid = readNumbers(words.normal, normal);
    cut.normal = Vec3d(normal[0], normal[1], normal[2]);
    if (!valid || !(cut.normal.norm() > 1e-9))
      throw InputError("--normal", "expected X,Y,Z of some length, found \"" + words.normal + "\"");
    cut.normal.normalize();
    cut.offset = words.offset ? *words.offset : cut.normal.dot(scene.bounds().center() + scene.origin);
    name << directionText(cut.normal, 6) << " · x = " << cut.offset << " m";
    cut.name = name.str();
    return cut;
  }
  if (words.offset) throw InputError("--offset", "expected --normal beside it, found none");
  std::size_t axis = static_cast<std::size_t>(scene.view.clip.axis);
  std::array<double, 1> at{};
  if (words.plane.empty()) {
    const auto k = static_cast<Eigen::Index>(axis);
    at[0] = scene.origin[k] + (scene.view.clip.enabled ? scene.view.clip.at : scene.bounds().center()[k]);
  } else {
    axis = std::min<std::size_t>(std::string_view("xyz").find(words.plane[0]), 3);
    if (axis == 3 || words.plane.size() < 3 || words.plane[1] != '=' ||
        !readNumbers(std::string_view(words.plane).substr(2), at))
      throw InputError(
          "--plane", "expected an axis and a place on it in m such as x=0.5, found \"" + words.plane + "\"");
  }
  cut.normal = Vec3d::Unit(static_cast<Eigen::Index>(axis));
  cut.offset = at[0];
  name << "xyz"[axis] << " = " << at[0] << " m";
  cut.name = name.str();
  return cut;
}

void refusePlane(const PlaneWords& words, const Cut& cut, const Scene& scene) {
  const Bounds bounds = scene.bounds();
  std::ostringstream text;
  text.precision(placeDigits(scene));
  const Eigen::IOFormat plain(Eigen::StreamPrecision, Eigen::DontAlignCols);
  text << "expected a plane that meets the scene, which reaches from ("
       << (bounds.min + scene.origin).transpose().format(plain) << ") to ("
       << (bounds.max + scene.origin).transpose().format(plain) << ") m, found " << cut.name;
  throw InputError(words.normal.empty() ? "--plane" : "--offset", text.str());
}

SectionField fieldOf(const PlaneWords& words) {
  return static_cast<SectionField>(requireOneOf("--field", words.field, kSectionFieldNames));
}

SectionDivisor divisorOf(const PlaneWords& words) {
  return static_cast<SectionDivisor>(requireOneOf("--divisor", words.divisor, kSectionDivisorNames));
}

std::vector<Option> planeOptions(PlaneWords& words, const std::string& group) {
  std::vector<Option> options{
      {.name = "--plane",
       .target = &words.plane,
       .value = "AXIS=M",
       .help = "Such as x=0.5, in m; left out: the scene's cut, or its middle."},
      {.name = "--normal",
       .target = &words.normal,
       .value = "X,Y,Z",
       .help = "A plane at an angle, by its normal, instead.",
       .excludes = {"--plane"}},
      {.name = "--offset",
       .target = &words.offset,
       .value = "M",
       .help = "How far along the unit normal it lies from the origin, in m; left out: through the middle."},
      {.name = "--field",
       .target = &words.field,
       .value = "NAME",
       .help = "density, pressure, speed, gamma, or gamma_error: gamma less its reference.",
       .shownDefault = "density"},
      {.name = "--divisor",
       .target = &words.divisor,
       .value = "sum|gamma|none",
       .help = "What the sum over the particles is divided by: the sum of the kernel, gamma, or nothing.",
       .shownDefault = "sum"}};
  for (Option& option : options) option.group = group;
  return options;
}

}  // namespace migiwa

#include "app/render/color_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace migiwa {
namespace {

struct Point {
  double a, b;
};

/// The control points of a path through Oklab's colour plane: a cubic Bezier curve whose every point lies
/// inside sRGB at its lightness.
using Path = std::array<Point, 4>;
constexpr Path kCoolPath{{{-0.004, -0.125}, {-0.06, -0.06}, {-0.175, 0.05}, {-0.036, 0.168}}};
constexpr Path kWarmPath{{{0.065, -0.075}, {0.215, -0.045}, {0.165, 0.115}, {0.0, 0.085}}};

Point pathPoint(const Path& path, double t) {
  const double s = 1 - t;
  const std::array<double, 4> weight{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  Point p{0, 0};
  for (std::size_t k = 0; k < 4; ++k) p.a += weight[k] * path[k].a, p.b += weight[k] * path[k].b;
  return p;
}

/// The path's points at equal distances along it.
std::vector<Point> evenPoints(const Path& path, int count) {
  constexpr int kPieces = 4096;
  std::vector<double> length{0};
  Point last = pathPoint(path, 0);
  for (int i = 1; i <= kPieces; ++i) {
    const Point p = pathPoint(path, static_cast<double>(i) / kPieces);
    length.push_back(length.back() + std::hypot(p.a - last.a, p.b - last.b));
    last = p;
  }
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double wanted = length.back() * i / (count - 1);
    const auto after = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
    const double piece = static_cast<double>(after - length.begin() - 1);
    points.push_back(pathPoint(path, (piece + (wanted - after[-1]) / (after[0] - after[-1])) / kPieces));
  }
  return points;
}

std::uint8_t encode(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

Rgb8 fromOklab(double lightness, const Point& p) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * p.a + 0.2158037573 * p.b);
  const double m = cube(lightness - 0.1055613458 * p.a - 0.0638541728 * p.b);
  const double s = cube(lightness - 0.0894841775 * p.a - 1.2914855480 * p.b);
  return {encode(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

ColorMap makeMap(const Path& bends) {
  const std::vector<Point> path = evenPoints(bends, kColorMapSize);
  ColorMap map{};
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double t = static_cast<double>(i) / (kColorMapSize - 1);
    map[i] = fromOklab(kColorMapDarkest + (kColorMapLightest - kColorMapDarkest) * t, path[i]);
  }
  return map;
}

}  // namespace

ColorMap makeColorMap() {
  return makeMap(kCoolPath);
}

ColorMap makeWarmColorMap() {
  return makeMap(kWarmPath);
}

}  // namespace migiwa

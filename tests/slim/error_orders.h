// Errors of SLIM surfaces with balls of one size, on shapes known exactly, and how fast they fall with it.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/slim/fit.h"
#include "core/slim/model.h"
#include "tests/slim/exact_shapes.h"

namespace migiwa::testing {

struct OrderShape {
  std::string name;
  double radius;  ///< of the balls at most (m): a good part of the radius of curvature
  /// Heights over tangent planes have no odd terms, as on a sphere: a polynomial of an even degree then
  /// misses none of the next degree, and its error has the order of the next degree.
  bool even;
  OrientedPoints points, unseen;
  std::function<void(const Vec3d& p, Vec3d& normal)> normalAt;
};

/// A sphere, a torus, and a bowl. On the bowl no order can show at the rim, where the curvature jumps: errors
/// are looked at below it.
inline std::vector<OrderShape> orderShapes() {
  const ExactSphere sphere;
  const ExactTorus torus;
  const Bowl bowl{Vec3d::Zero(), 1, 0.7};
  OrientedPoints below = bowlPoints(bowl, 7001);
  std::erase_if(below.points, [](const OrientedPoint& p) { return p.position.y() > -0.35F; });
  return {
      {"sphere", 0.5, true, sphere.points(60000), sphere.points(5001),
       [sphere](const Vec3d& p, Vec3d& n) { sphere.distance(p, n); }},
      {"torus", 0.3, false, torus.points(100000), torus.points(5001),
       [torus](const Vec3d& p, Vec3d& n) { torus.distance(p, n); }},
      {"bowl", 0.35, true, bowlPoints(bowl, 100000), below,
       [bowl](const Vec3d& p, Vec3d& n) { bowlDistance(bowl, p, n); }},
  };
}

/// Order of the distance in the radius of the balls; that of the normal is one less.
inline int expectedOrder(const OrderShape& shape, int degree) {
  return degree + 1 + (shape.even && degree % 2 == 0 ? 1 : 0);
}

struct OrderPoint {
  double radius;    ///< of the balls (m)
  double distance;  ///< root mean square of the distance at points of the exact surface (m)
  double normal;    ///< of the angle between the normals there (rad)
};

inline OrderPoint errorsAt(const OrderShape& shape, int degree, double radius, ThreadPool& pool) {
  SlimFitOptions options;
  options.degree = degree;
  options.radius = radius;
  const SlimModel model(fitSlim(shape.points, options, pool), degree, true, pool);
  double distances = 0, angles = 0;
  for (const OrientedPoint& point : shape.unseen.points) {
    const SlimModel::Nearest nearest = model.nearest(point.position);
    Vec3d exact;
    shape.normalAt(point.position.cast<double>(), exact);
    distances += std::pow(static_cast<double>(nearest.distance), 2);
    // The sine: an arc cosine near one has no digits.
    angles += nearest.normal.cast<double>().cross(exact).squaredNorm();
  }
  const auto count = static_cast<double>(shape.unseen.points.size());
  return {radius, std::sqrt(distances / count), std::sqrt(angles / count)};
}

/// Slope of the logarithms, by least squares.
inline double orderOf(const std::vector<OrderPoint>& points, double OrderPoint::*error) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(points.size());
  for (const OrderPoint& point : points) {
    const double u = std::log(point.radius), v = std::log(point.*error);
    x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace migiwa::testing

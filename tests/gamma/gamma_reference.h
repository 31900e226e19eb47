// gamma by quadrature in double, for the walls of the accuracy tests; shares nothing with the methods under
// test. All for support 1: points and radii are in units of the support radius.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/math.h"
#include "core/sph/kernels.h"
#include "tests/sph/quadrature.h"

namespace migiwa::reference {

inline constexpr double kSupport = 0.1;  ///< of the tests' particles (m)
inline constexpr std::array kKernels{KernelType::poly6, KernelType::spiky, KernelType::cubicSpline,
                                     KernelType::wendlandC2};

/// The kernels as their papers write them.
inline double kernel(KernelType type, double q) {
  constexpr double pi = std::numbers::pi;
  if (q >= 1) return 0;
  switch (type) {
    case KernelType::poly6:
      return 315 / (64 * pi) * std::pow(1 - q * q, 3);
    case KernelType::spiky:
      return 15 / pi * std::pow(1 - q, 3);
    case KernelType::cubicSpline:
      return q <= 0.5 ? 8 / pi * (1 - 6 * q * q + 6 * q * q * q) : 16 / pi * std::pow(1 - q, 3);
    case KernelType::wendlandC2:
      return 21 / (2 * pi) * std::pow(1 - q, 4) * (1 + 4 * q);
  }
  return 0;
}

/// 4 pi integral_0^r W s^2 ds.
inline double massWithin(KernelType type, double r) {
  const auto shell = [&](double s) { return 4 * std::numbers::pi * s * s * kernel(type, s); };
  r = std::min(r, 1.0);
  if (r <= 0.5) return quadrature::integrate(0, r, 2, shell);
  return quadrature::integrate(0, 0.5, 2, shell) + quadrature::integrate(0.5, r, 2, shell);
}

/// Cubic Lagrange interpolation of values at 0, 1, 2, ...
inline double interpolate(const std::vector<double>& values, double at) {
  const int first = std::clamp(static_cast<int>(at) - 1, 0, static_cast<int>(values.size()) - 4);
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    double weight = 1;
    for (int j = 0; j < 4; ++j)
      if (j != i) weight *= (at - (first + j)) / (i - j);
    sum += weight * values[static_cast<std::size_t>(first) + static_cast<std::size_t>(i)];
  }
  return sum;
}

/// massWithin as a table, fine enough for 1e-9.
class MassTable {
 public:
  explicit MassTable(KernelType type) {
    for (int k = 0; k <= kCells; ++k) values_.push_back(massWithin(type, static_cast<double>(k) / kCells));
  }
  double operator()(double r) const {
    if (r >= 1) return 1;
    return interpolate(values_, r * kCells);
  }

 private:
  static constexpr int kCells = 1024;
  std::vector<double> values_;
};

/// Integral of f over [a, b] by Gauss-Legendre panels that halve until both halves agree with their whole
/// within `tolerance`, which finds the kinks.
template <class F>
double adaptive(double a, double b, double tolerance, const F& f) {
  struct Panel {
    double from, to, value;
    int depth;
  };
  const auto over = [&](double from, double to) { return quadrature::integrate(from, to, 1, f); };
  std::vector<Panel> open{{a, b, over(a, b), 0}};
  double sum = 0;
  while (!open.empty()) {
    const Panel panel = open.back();
    open.pop_back();
    const double middle = 0.5 * (panel.from + panel.to);
    const double left = over(panel.from, middle), right = over(middle, panel.to);
    if (std::abs(left + right - panel.value) < tolerance || panel.depth > 30) {
      sum += left + right;
    } else {
      open.push_back({panel.from, middle, left, panel.depth + 1});
      open.push_back({middle, panel.to, right, panel.depth + 1});
    }
  }
  return sum;
}

/// Any walls: the kernel's mass in the fluid along each direction, averaged over all directions. The error is
/// some ten times the tolerance of a panel.
template <class FluidMass>
double overDirections(const FluidMass& fluidMass, double tolerance = 1e-7) {
  const double sum = adaptive(-1, 1, tolerance, [&](double z) {
    const double across = std::sqrt(1 - z * z);
    const auto at = [&](double angle) {
      return fluidMass(Vec3d(across * std::cos(angle), across * std::sin(angle), z));
    };
    // Four starts, or a narrow feature could hide from the first panel.
    double ring = 0;
    for (int quarter = 0; quarter < 4; ++quarter)
      ring +=
          adaptive(0.5 * std::numbers::pi * quarter, 0.5 * std::numbers::pi * (quarter + 1), tolerance, at);
    return ring;
  });
  return sum / (4 * std::numbers::pi);
}

/// Gradient of a gamma, for support 1: differences of fourth order.
template <class Gamma>
Vec3d gradientOf(const Gamma& gamma, const Vec3d& p, double step = 0.02) {
  Vec3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const auto slope = [&](double by) {
      return (gamma(p + by * Vec3d::Unit(axis)) - gamma(p - by * Vec3d::Unit(axis))) / (2 * by);
    };
    gradient[axis] = (4 * slope(step) - slope(2 * step)) / 3;
  }
  return gradient;
}

/// Where a ray from p enters an upright box; infinite if it does not.
inline double entryOf(const Vec3d& low, const Vec3d& high, const Vec3d& p, const Vec3d& w) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (w[axis] == 0) {
      if (p[axis] < low[axis] || p[axis] > high[axis]) return std::numeric_limits<double>::infinity();
      continue;
    }
    const double one = (low[axis] - p[axis]) / w[axis], other = (high[axis] - p[axis]) / w[axis];
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  }
  return enter < leave ? enter : std::numeric_limits<double>::infinity();
}

/// Inside all of some planes n.x + c >= 0 (concave) for a point at the origin.
struct PlaneAt {
  Vec3d normal;
  double distance;
};
inline double hitOf(const PlaneAt& plane, const Vec3d& w) {
  const double towards = -plane.normal.dot(w);
  return towards > 0 ? plane.distance / towards : std::numeric_limits<double>::infinity();
}

/// A wedge whose edge runs along z: the kernel's mass over the plane across the edge, ray by ray, with panels
/// that end where the nearer wall changes. `concave`: the fluid is inside both planes, else inside either.
class Wedge {
 public:
  explicit Wedge(KernelType type) {
    // Mass of the kernel within a cylinder of radius r about z, per angle: integral of s * (line integral)
    // ds.
    const auto line = [&](double s) {
      const double top = std::sqrt(std::max(1 - s * s, 0.0));
      const auto along = [&](double z) { return 2 * kernel(type, std::sqrt(s * s + z * z)); };
      const double knee = std::sqrt(std::max(0.25 - s * s, 0.0));
      return quadrature::integrate(0, knee, 1, along) + quadrature::integrate(knee, top, 2, along);
    };
    values_.push_back(0);
    for (int k = 1; k <= kCells; ++k)
      values_.push_back(values_.back() + quadrature::integrate((k - 1.0) / kCells,
                                                               static_cast<double>(k) / kCells, 1,
                                                               [&](double s) { return s * line(s); }));
  }

  double gamma(const Vec3d& firstNormal, double firstDistance, const Vec3d& secondNormal,
               double secondDistance, bool concave) const {
    const auto fluid = [&](double angle) {
      const Vec3d w(std::cos(angle), std::sin(angle), 0);
      if (concave)
        return mass(
            std::min(hitOf({firstNormal, firstDistance}, w), hitOf({secondNormal, secondDistance}, w)));
      // In the solid while behind both planes: from the later entry to the earlier exit.
      double enter = 0, leave = 1;
      for (const PlaneAt& plane :
           {PlaneAt{firstNormal, firstDistance}, PlaneAt{secondNormal, secondDistance}}) {
        const double towards = -plane.normal.dot(w);
        const double crossing = towards != 0 ? plane.distance / towards : 2;
        if (towards > 0) {
          enter = std::max(enter, crossing);
        } else if (plane.distance < 0) {
          leave = std::min(leave, crossing);
        } else {
          enter = 1;  // in front of the plane, and moving away
        }
      }
      return mass(1) - std::max(mass(leave) - mass(std::min(enter, 1.0)), 0.0);
    };
    // The integrand has kinks; many panels and the high order between them give 1e-7.
    return quadrature::integrate(0, 2 * std::numbers::pi, 400, fluid);
  }

 private:
  double mass(double r) const { return interpolate(values_, std::min(r, 1.0) * kCells); }

  static constexpr int kCells = 512;
  std::vector<double> values_;
};

/// At distance `offset` from the centre of a sphere: the part of the kernel inside the sphere, exactly, from
/// the spherical caps that it cuts from the shells.
inline double insideSphere(KernelType type, double offset, double radius) {
  const auto shell = [&](double r) {
    const double cosine = (radius * radius - offset * offset - r * r) / (2 * offset * r);
    const double part = offset < 1e-12 ? (r < radius ? 1.0 : 0.0) : std::clamp(0.5 * (1 + cosine), 0.0, 1.0);
    return 4 * std::numbers::pi * r * r * kernel(type, r) * part;
  };
  // Panels end where the shell first and last meets the sphere, and at the spline's knot.
  std::vector<double> ends{0, 0.5, 1};
  for (const double r : {std::abs(radius - offset), radius + offset})
    if (r < 1) ends.push_back(r);
  std::sort(ends.begin(), ends.end());
  double sum = 0;
  for (std::size_t k = 1; k < ends.size(); ++k) sum += quadrature::integrate(ends[k - 1], ends[k], 2, shell);
  return sum;
}

}  // namespace migiwa::reference

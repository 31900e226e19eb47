// Vectors, bounds, and functions whose last digit is the same on every machine.
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace migiwa {

// Vectors and the packed particle type that the rest of the program shares.

using Vec3f = Eigen::Vector3f;
using Vec3d = Eigen::Vector3d;

/// Three coordinates and one spare lane, loaded by one instruction. What the lane holds is said where it is
/// used.
struct alignas(16) Float4 {
  float x = 0, y = 0, z = 0, w = 0;

  Float4() = default;
  Float4(float ax, float ay, float az, float aw = 0) : x(ax), y(ay), z(az), w(aw) {}
  explicit Float4(const Vec3f& v, float aw = 0) : x(v.x()), y(v.y()), z(v.z()), w(aw) {}
  Vec3f xyz() const { return {x, y, z}; }
  void setXyz(const Vec3f& v) { x = v.x(), y = v.y(), z = v.z(); }
};

// Axis-aligned bounds in metres; empty until something is included.

struct Bounds {
  Vec3d min = Vec3d::Constant(std::numeric_limits<double>::infinity());
  Vec3d max = Vec3d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const;
  void include(const Vec3d& p);
  void include(const Bounds& other);
  Vec3d center() const;
  Vec3d size() const;
  bool contains(const Vec3d& p) const;
  Bounds grown(double by) const;
};

}  // namespace migiwa

// Elementary functions whose last digit is the same everywhere. Those of the C library differ between its
// versions and between processors, and a difference in the last digit of a particle's position grows into
// another splash. These need nothing but the operations that IEEE 754 defines to the last digit, in the order
// in which they are written (-ffp-contract=off); std::sqrt, std::floor, std::fmod and their like are exact,
// too. What reaches particles takes its functions from here; a test of the sources checks that.
namespace migiwa::portable {

/// Within 2e-16 for |angle| < 1e6 rad; beyond it, that of an angle within 1e-16 of its size.
double sin(double angle);
double cos(double angle);
/// Of y in [-1, 1] (NaN otherwise), within 1e-15; in [-pi/2, pi/2].
double asin(double y);
/// Within 4e-16 of its size; 0 below -708, infinite above 709.
double exp(double x);
/// Of x > 0, within 2e-16 + 2e-16 |log x|; -infinity at 0, NaN below.
double log(double x);
/// Within 4e-16 of its size; of negative numbers, too.
double cbrt(double x);
/// sqrt(x^2 + y^2 + z^2), for lengths whose squares neither over- nor underflow.
double hypot(double x, double y, double z = 0);

}  // namespace migiwa::portable

// The normal distribution in one, two and three variables.
namespace migiwa {

/// P(X < x).
double normalCdf(double x);
/// The x with P(X < x) = p; p in (0, 1), beyond [1e-12, 1 - 1e-12] taken as those.
double normalQuantile(double p);
/// P(X < x, Y < y) with correlation r in [-1, 1]; within 1e-7 for |r| < 0.99.
double bivariateNormalCdf(double x, double y, double r);
/// P(X < x, Y < y, Z < z) with pairwise correlations.
double trivariateNormalCdf(double x, double y, double z, double rxy, double rxz, double ryz);

}  // namespace migiwa

// A wall that is the graph of a polynomial of degree 1 to 3 over a plane, z = sum c x^i y^j in a frame at
// `origin` with z along `normal`; fluid where z is larger. It is there within `radius` of the origin only, as
// a node of a SLIM surface is ([FM] section 5).
#pragma once

#include <array>
#include <vector>

#include "core/boundary/surface.h"

namespace migiwa {

class Polynomial final : public Surface {
 public:
  /// One term: exponents i, j with i + j <= 3, and the coefficient (unit: m^(1 - i - j)).
  using Term = std::array<double, 3>;

  Polynomial() = default;
  Polynomial(const Vec3d& origin, const Vec3d& normal, const Vec3d& xAxis, double radius,
             std::vector<Term> terms);

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  /// Around the ball in which the wall exists they jump.
  bool steadyDistance() const override { return false; }
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  /// Over a dome or a saddle a ray may dip into the solid and come out.
  bool reentrant() const override { return true; }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  Bounds bounds() const override;
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Polynomial>& self);
  struct Value {
    double z, dx, dy, dxx, dxy, dyy;  ///< height of the graph and its derivatives
  };
  Value at(double x, double y) const;
  /// Calls visit(k, cubic) with the height over the graph along direction k, c[0] + c[1] t + c[2] t^2 + c[3]
  /// t^3.
  template <class Visit>
  void alongRays(const Vec3f& origin, const Directions& directions, double above, const Visit& visit) const;
  /// Height of a point over the graph.
  double heightOf(const Vec3f& p) const;
  void prepare();
  /// Whether some of the graph lies inside the ball.
  bool hasSurface() const;
  Vec3d toLocal(const Vec3f& p) const { return axes_.transpose() * (p.cast<double>() - origin_); }
  Vec3f toWorld(const Vec3d& local) const { return (origin_ + axes_ * local).cast<float>(); }
  /// The point of the graph inside the ball that is nearest to p, by Newton's method from the best of a few
  /// starts.
  Vec3d foot(const Vec3d& p) const;

  Vec3d origin_ = Vec3d::Zero(), normal_ = Vec3d::UnitY(), xAxis_ = Vec3d::UnitX();
  double radius_ = 1;
  std::vector<Term> terms_;
  std::array<double, 10> c_{};  ///< of 1, x, y, x^2, xy, y^2, x^3, x^2 y, x y^2, y^3
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
};

}  // namespace migiwa

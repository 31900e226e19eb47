// The walls of closed form: plane, sphere, box, polynomial.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/walls/surface.h"

namespace migiwa {

/// On which side of a closed surface the fluid is, as scenes name it; in the order of the enums below.
inline constexpr std::array<std::string_view, 2> kFluidNames{"inside", "outside"};

// An infinite plane wall.

class Plane final : public Surface {
 public:
  Plane() = default;
  /// `normal` need not be a unit vector; it points into the fluid.
  Plane(const Vec3d& point, const Vec3d& normal);

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  bool planar() const override { return true; }
  std::optional<ClosedForm> closedForm() const override;
  Bounds bounds() const override { return {}; }
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Plane>& self);
  void prepare();

  Vec3d point_ = Vec3d::Zero();
  Vec3d normal_ = Vec3d::UnitY();
  Vec3f unit_ = Vec3f::UnitY();
  float offset_ = 0;  ///< unit . x on the plane
};

// A sphere wall: a round vessel with the fluid inside, or a ball with the fluid outside.

class Sphere final : public Surface {
 public:
  enum class Fluid { inside, outside };

  Sphere() = default;
  Sphere(const Vec3d& center, double radius, Fluid fluid);

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  bool reentrant() const override { return fluid_ == Fluid::outside; }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  float thickness() const override;
  bool convex() const override { return fluid_ == Fluid::outside; }
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  bool enclosed(TriangleMesh& mesh) const override;
  std::optional<ClosedForm> closedForm() const override;
  Bounds bounds() const override;
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Sphere>& self);
  void prepare();

  Vec3d centerExact_ = Vec3d::Zero();
  double radiusExact_ = 1;
  Fluid fluid_ = Fluid::inside;
  Vec3f center_ = Vec3f::Zero();
  float radius_ = 1;
};

// A box wall, upright or turned about its centre: a tank with the fluid inside, or a block with the fluid
// outside.

class Box final : public Surface {
 public:
  enum class Fluid { inside, outside };

  Box() = default;
  Box(const Vec3d& min, const Vec3d& max, Fluid fluid, const Rotation& rotation = {});

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const override;
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  bool reentrant() const override { return fluid_ == Fluid::outside; }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  float thickness() const override;
  bool convex() const override { return fluid_ == Fluid::outside; }
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  bool planar() const override { return true; }
  PieceRule pieceRule() const override {
    return fluid_ == Fluid::inside ? PieceRule::fluidInsideAll : PieceRule::solidInsideAll;
  }
  /// A block is; of a tank, the half-spaces of its pieces say all.
  bool faceted() const override { return fluid_ == Fluid::outside; }
  void facets(const Vec3f& p, float supportRadius, std::vector<WallFacet>& out) const override;
  bool enclosed(TriangleMesh& mesh) const override;
  std::optional<ClosedForm> closedForm() const override;
  Bounds bounds() const override;
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;
  const BoxGeometry* tank() const override { return fluid_ == Fluid::inside ? &geometry_ : nullptr; }

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Box>& self);
  /// Where a ray enters the box and where it leaves it; no crossing unless enter < leave.
  struct Crossing {
    float enter, leave;
  };
  Crossing crossing(const Vec3f& local, const Directions& directions, std::size_t k) const;
  void prepare();
  Vec3f toLocal(const Vec3f& p) const;
  Vec3f toWorld(const Vec3f& local) const;
  Vec3d corner(int index) const;

  Vec3d min_ = Vec3d::Zero(), max_ = Vec3d::Ones();
  Rotation rotation_;
  Fluid fluid_ = Fluid::inside;
  BoxGeometry geometry_;
  Vec3f center_ = Vec3f::Constant(0.5F), half_ = Vec3f::Constant(0.5F);
  Eigen::Matrix3f toLocal_ = Eigen::Matrix3f::Identity();
  bool turned_ = false;
  std::array<Vec3f, 8> corners_{};  ///< bit k of the place: the upper end of axis k
};

// A wall that is the graph of a polynomial of degree 1 to 3 over a plane, z = sum c x^i y^j in a frame at
// `origin` with z along `normal`; fluid where z is larger. It is there within `radius` of the origin only, as
// a node of a SLIM surface is ([FM] section 5).

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
  Vec3d toLocal(const Vec3f& p) const;
  Vec3f toWorld(const Vec3d& local) const;
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

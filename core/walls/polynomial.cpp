#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "core/walls/shapes.h"

namespace migiwa {

namespace {

constexpr int kDegree = 3;

/// Place of x^i y^j in the coefficients.
int termIndex(int i, int j) {
  const int degree = i + j;
  return degree * (degree + 1) / 2 + j;
}

using Cubic = std::array<double, 4>;

double valueOf(const Cubic& c, double t) {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

/// Smallest t in (from, most) where the cubic changes its sign, which is `sign` at `from`; `most` if it does
/// not.
double nextCrossing(const Cubic& c, double sign, double from, double most) {
  // Between its extrema the cubic is monotonic: the first piece whose end has the other sign holds the
  // crossing.
  std::array<double, 3> ends{most, most, most};
  std::size_t count = 0;
  const double discriminant = c[2] * c[2] - 3 * c[3] * c[1];
  if (discriminant > 0) {
    const double q = -(c[2] + std::copysign(std::sqrt(discriminant), c[2]));
    const double one = c[3] != 0 ? q / (3 * c[3]) : most, other = q != 0 ? c[1] / q : most;
    for (const double extremum : {std::min(one, other), std::max(one, other)})
      if (extremum > from && extremum < most) ends[count++] = extremum;
  }
  double low = from;
  for (std::size_t k = 0; k <= count; ++k) {
    double high = ends[k];
    if (sign * valueOf(c, high) >= 0) {
      low = high;
      continue;
    }
    // Newton from the middle, kept inside the bracket by bisection.
    double t = 0.5 * (low + high);
    for (int step = 0; step < 40 && high - low > 1e-9 * most; ++step) {
      const double value = sign * valueOf(c, t);
      (value >= 0 ? low : high) = t;
      if (std::abs(value) < 1e-12 * most) break;
      const double newton = t - value / (sign * (c[1] + t * (2 * c[2] + 3 * c[3] * t)));
      t = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return t;
  }
  return most;
}

}  // namespace

inline Vec3d Polynomial::toLocal(const Vec3f& p) const {
  return axes_.transpose() * (p.cast<double>() - origin_);
}

inline Vec3f Polynomial::toWorld(const Vec3d& local) const {
  return (origin_ + axes_ * local).cast<float>();
}

Polynomial::Polynomial(const Vec3d& origin, const Vec3d& normal, const Vec3d& xAxis, double radius,
                       std::vector<Term> terms)
    : origin_(origin), normal_(normal), xAxis_(xAxis), radius_(radius), terms_(std::move(terms)) {
  prepare();
}

template <class Visitor>
void Polynomial::fields(Visitor& visitor, Visited<Visitor, Polynomial>& self) {
  visitor.place("origin", self.origin_,
                {"m", "Centre of the ball in which the wall exists.", Presence::required});
  visitor.vector("normal", self.normal_,
                 {"1", "The frame's z axis, into the fluid; any length but zero.", Presence::required});
  visitor.vector("x_axis", self.xAxis_,
                 {"1", "The frame's x axis; made perpendicular to the normal.", Presence::required});
  visitor.number("radius", self.radius_, Range::length(kLargestCoordinate),
                 {"m", "Radius of the ball.", Presence::required});
  visitor.triples("coefficients", self.terms_,
                  {"", "Terms [i, j, c] of z = sum c x^i y^j, with i + j at most 3; c in m^(1 - i - j).",
                   Presence::required});
}

void Polynomial::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void Polynomial::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  bool valid = visitor.valid({"origin", "normal", "x_axis", "radius", "coefficients"});
  if (valid && normal_.norm() < 1e-12) {
    visitor.fault("normal", "expected a vector that is not zero, found [0, 0, 0]");
    valid = false;
  }
  if (valid && normal_.normalized().cross(xAxis_).norm() < 1e-9 * (1 + xAxis_.norm())) {
    visitor.fault("x_axis", "expected a direction across the normal, found one along it or zero");
    valid = false;
  }
  for (const Term& term : terms_) {
    const bool whole = term[0] == std::floor(term[0]) && term[1] == std::floor(term[1]);
    if (!whole || term[0] < 0 || term[1] < 0 || term[0] + term[1] > kDegree) {
      visitor.fault("coefficients",
                    "expected whole exponents i, j from 0 with i + j at most 3 in every [i, j, c]");
      valid = false;
      break;
    }
  }
  if (!valid) return;
  prepare();
  if (!hasSurface()) {
    visitor.fault("coefficients",
                  "expected a polynomial that reaches into the ball of this radius, found one that "
                  "stays outside; a larger radius or a smaller constant term helps");
  }
}

void Polynomial::prepare() {
  const Vec3d z = normal_.normalized();
  const Vec3d y = z.cross(xAxis_).normalized();
  axes_ << y.cross(z), y, z;
  c_ = {};
  for (const Term& term : terms_)
    c_[static_cast<std::size_t>(termIndex(static_cast<int>(term[0]), static_cast<int>(term[1])))] += term[2];
}

Polynomial::Value Polynomial::at(double x, double y) const {
  return {c_[0] + x * (c_[1] + x * (c_[3] + x * c_[6])) + y * (c_[2] + y * (c_[5] + y * c_[9])) +
              x * y * (c_[4] + x * c_[7] + y * c_[8]),
          c_[1] + x * (2 * c_[3] + 3 * x * c_[6]) + y * (c_[4] + 2 * x * c_[7] + y * c_[8]),
          c_[2] + y * (2 * c_[5] + 3 * y * c_[9]) + x * (c_[4] + x * c_[7] + 2 * y * c_[8]),
          2 * c_[3] + 6 * x * c_[6] + 2 * y * c_[7],
          c_[4] + 2 * x * c_[7] + 2 * y * c_[8],
          2 * c_[5] + 2 * x * c_[8] + 6 * y * c_[9]};
}

bool Polynomial::hasSurface() const {
  constexpr int kSteps = 64;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const double x = radius_ * i / kSteps, y = radius_ * j / kSteps;
      if (Vec3d(x, y, at(x, y).z).norm() < radius_) return true;
    }
  }
  return false;
}

Vec3d Polynomial::foot(const Vec3d& p) const {
  const auto refine = [&](double x, double y) {
    for (int step = 0; step < 12; ++step) {
      const Value f = at(x, y);
      const double below = f.z - p.z();
      // Gradient and Hessian of half the squared distance to (x, y, f).
      const double gx = x - p.x() + below * f.dx, gy = y - p.y() + below * f.dy;
      double hxx = 1 + f.dx * f.dx + below * f.dxx, hyy = 1 + f.dy * f.dy + below * f.dyy;
      double hxy = f.dx * f.dy + below * f.dxy;
      double determinant = hxx * hyy - hxy * hxy;
      if (hxx <= 0 || determinant <= 0) {  // not convex here: Gauss-Newton's Hessian always is
        hxx = 1 + f.dx * f.dx, hyy = 1 + f.dy * f.dy, hxy = f.dx * f.dy;
        determinant = hxx * hyy - hxy * hxy;
      }
      const double sx = (hyy * gx - hxy * gy) / determinant, sy = (hxx * gy - hxy * gx) / determinant;
      x -= sx, y -= sy;
      // Newton squares the error: the next step would be at most about 1e-14 of the radius.
      if (sx * sx + sy * sy < 1e-14 * radius_ * radius_) break;
    }
    // Outside the ball there is no wall: the nearest that is left is near the rim.
    Vec3d q(x, y, at(x, y).z);
    for (int step = 0; step < 8 && q.norm() > radius_; ++step) {
      const double shrink = 0.999 * radius_ / q.norm();
      q.x() *= shrink, q.y() *= shrink;
      q.z() = at(q.x(), q.y()).z;
    }
    return q;
  };
  Vec3d best = refine(p.x(), p.y());
  // Where the surface bends as much as p is away, other feet may be nearer.
  const Value here = at(p.x(), p.y());
  const double bend = std::max(std::abs(here.dxx), std::abs(here.dyy)) + std::abs(here.dxy);
  const double reach = (best - p).norm();
  if (bend * reach > 0.5) {
    for (const double angle : {0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75}) {
      const double turn = angle * std::numbers::pi;
      const Vec3d other = refine(p.x() + reach * portable::cos(turn), p.y() + reach * portable::sin(turn));
      if ((other - p).norm() < (best - p).norm()) best = other;
    }
  }
  return best;
}

float Polynomial::distance(const Vec3f& p, Vec3f& normal) const {
  const Vec3d local = toLocal(p);
  const Vec3d nearest = foot(local);
  const Value f = at(nearest.x(), nearest.y());
  const Vec3d up = Vec3d(-f.dx, -f.dy, 1).normalized();
  normal = (axes_ * up).cast<float>();
  const double length = (local - nearest).norm();
  const bool below = local.z() < at(local.x(), local.y()).z && local.norm() < radius_;
  return static_cast<float>(below ? -length : length);
}

bool Polynomial::project(Vec3f& p, float margin) const {
  bool moved = false;
  // Moving along the normal of the foot is exact but for the curvature over the move.
  for (int round = 0; round < 4; ++round) {
    Vec3f normal;
    const float missing = margin - distance(p, normal);
    if (missing <= 1e-4F * margin) break;
    p += missing * normal;
    moved = true;
  }
  return moved;
}

double Polynomial::heightOf(const Vec3f& p) const {
  const Vec3d local = toLocal(p);
  return local.z() - at(local.x(), local.y()).z;
}

template <class Visit>
void Polynomial::alongRays(const Vec3f& origin, const Directions& directions, double above,
                           const Visit& visit) const {
  const Vec3d o = toLocal(origin);
  const Value f = at(o.x(), o.y());
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const Vec3d w =
        axes_.transpose() * Vec3d(static_cast<double>(directions.x[k]), static_cast<double>(directions.y[k]),
                                  static_cast<double>(directions.z[k]));
    // Taylor coefficients of the height over the graph, exact for a cubic.
    const double u = w.x(), v = w.y();
    visit(
        k, o, w,
        Cubic{above, w.z() - f.dx * u - f.dy * v, -0.5 * (f.dxx * u * u + 2 * f.dxy * u * v + f.dyy * v * v),
              -(c_[6] * u * u * u + c_[7] * u * u * v + c_[8] * u * v * v + c_[9] * v * v * v)});
  }
}

void Polynomial::firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const {
  alongRays(origin, directions, std::max(heightOf(origin), 0.0),
            [&](std::size_t k, const Vec3d& o, const Vec3d& w, const Cubic& height) {
              const double most = static_cast<double>(hits[k]);
              const double t = nextCrossing(height, 1, 0, most);
              if (t < most && (o + t * w).norm() <= radius_) hits[k] = static_cast<float>(t);
            });
}

void Polynomial::exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const {
  alongRays(origin, directions, std::max(heightOf(origin), 0.0),
            [&](std::size_t k, const Vec3d&, const Vec3d&, const Cubic& height) {
              const double most = 2 * radius_;
              const double enter = nextCrossing(height, 1, 0, most);
              const double leave = enter < most ? nextCrossing(height, -1, enter, most) : most;
              exits[k] = leave < most ? static_cast<float>(leave) : std::numeric_limits<float>::infinity();
            });
}

Bounds Polynomial::bounds() const {
  Bounds bounds;
  bounds.include(origin_);
  return bounds.grown(radius_);
}

void Polynomial::wireframe(const Bounds&, std::vector<LineSegment>& out) const {
  constexpr int kLines = 5, kSegments = 24;
  const auto point = [&](double x, double y) { return Vec3d(x, y, at(x, y).z); };
  for (int line = -kLines + 1; line < kLines; ++line) {
    const double fixed = radius_ * line / kLines;
    for (int k = 0; k < kSegments; ++k) {
      const double from = radius_ * (2.0 * k / kSegments - 1), to = radius_ * (2.0 * (k + 1) / kSegments - 1);
      for (const auto& [a, b] :
           {std::pair(point(fixed, from), point(fixed, to)), std::pair(point(from, fixed), point(to, fixed))})
        if (a.norm() <= radius_ && b.norm() <= radius_) out.push_back({toWorld(a), toWorld(b)});
    }
  }
}

}  // namespace migiwa

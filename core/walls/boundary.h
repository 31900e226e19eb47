// All walls of a scene together: the fluid is on the fluid side of every surface. Those that have a motion
// are where they are at one time, which moveTo() sets.
#pragma once

#include <memory>
#include <vector>

#include "core/walls/moving.h"
#include "core/walls/wall_index.h"

namespace migiwa {

class Boundary {
 public:
  Boundary() = default;
  /// At time 0.
  explicit Boundary(std::vector<std::shared_ptr<const Surface>> surfaces);
  /// With every wall where it is described, whether it has a motion or not.
  static Boundary atRest(std::vector<std::shared_ptr<const Surface>> surfaces);
  Boundary(const Boundary&) = delete;
  Boundary& operator=(const Boundary&) = delete;
  Boundary(Boundary&&) = default;
  Boundary& operator=(Boundary&&) = default;

  /// Whether there are walls with a motion.
  bool moves() const { return !moving_.empty(); }
  std::span<const std::shared_ptr<MovingSurface>> moving() const { return moving_; }
  /// Puts the walls where they are at `now` (s), having been at their places of `before` a step ago.
  void moveTo(double before, double now);
  /// Velocity (m/s) over the last step of the wall nearest to p, at p. Zero where no wall moves, at no cost.
  Vec3f wallVelocity(const Vec3f& p) const {
    return moving_.empty() ? Vec3f(Vec3f::Zero()) : nearestVelocity(p);
  }

  /// Whether a distance measured once goes on to tell how near walls can be: they stand still, and
  /// Surface::steadyDistance() holds for all of them.
  bool steady() const { return steady_; }
  /// A bound for how fast such a distance changes along a way.
  float steepness() const { return steepness_; }

  /// Prepares near() for a reach (m): worth it before many questions are asked about many walls.
  void indexWalls(float reach) { near_ = WallIndex(pointers(), reach, true); }
  /// The walls that come nearer than `reach` (m) to p, and the nearest of all; some more, in the order of
  /// surfaces().
  NearWalls near(const Vec3f& p, float reach = 0) const {
    return reach <= near_.reach() ? near_.near(p, reach) : near_.all();
  }

  bool empty() const { return surfaces_.empty(); }
  /// The upright vessel that is all there is; null: there is none, or more.
  const UprightVessel* onlyVessel() const {
    return surfaces_.size() == 1 ? surfaces_.front()->uprightVessel() : nullptr;
  }
  const std::vector<std::shared_ptr<const Surface>>& surfaces() const { return surfaces_; }

  /// Distance to the nearest wall (m), positive in the fluid, infinite without walls; and its normal.
  float distance(const Vec3f& p, Vec3f& normal) const;
  float distance(const Vec3f& p) const;

  /// Moves p until every wall is at least `margin` (m) away, or midway where walls leave no room. Returns
  /// whether it moved.
  bool project(Vec3f& p, float margin) const;

 private:
  Vec3f nearestVelocity(const Vec3f& p) const;
  bool projectInTurn(Vec3f& p, float margin, bool& fits) const;
  void measureSteadiness();
  std::vector<const Surface*> pointers() const;

  std::vector<std::shared_ptr<const Surface>> surfaces_;
  std::vector<std::shared_ptr<MovingSurface>> moving_;  ///< those among them that move
  bool steady_ = true;
  float steepness_ = kExactSlope;
  WallIndex near_;
};

/// The surfaces as particles of this support radius (m) meet them: Surface::forSupport().
std::vector<std::shared_ptr<const Surface>> wallsFor(
    const std::vector<std::shared_ptr<const Surface>>& surfaces, float supportRadius);

}  // namespace migiwa

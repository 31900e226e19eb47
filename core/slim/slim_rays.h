// Where rays from one point pass a SLIM surface: the hits with every ball's own polynomial inside a part of
// the ball, those of one passage blended by the balls' weights ([OBA] section 4). The balls in reach are
// gathered once for all rays of the point.
#pragma once

#include <array>
#include <span>

#include "core/slim/direction_bins.h"
#include "core/slim/slim_model.h"

namespace migiwa {

/// Distances (m) at which a ray passes the surface, in order; infinite where there are fewer.
using SlimPassages = std::array<float, 3>;

/// out[k] becomes the passages of direction k within `reach` (m) of `origin`, which is `inside` the surface
/// or outside: the first one changes the side, the second one changes it back. Thread-safe.
void slimPassages(const SlimModel& model, const Vec3f& origin, bool inside, const DirectionSet& directions,
                  float reach, std::span<SlimPassages> out);

/// The first passage of the way from `from` to `to` out of (`leaving`) or into the solid, as a part of the
/// way in [0, 1], and the surface's outward unit normal there. False where there is none.
bool slimFirstPassage(const SlimModel& model, const Vec3f& from, const Vec3f& to, bool leaving, float& at,
                      Vec3f& normal);

/// The least way through the solid (m), inwards from the nodes' centres; infinite for an open surface.
float slimThickness(const SlimModel& model);

}  // namespace migiwa

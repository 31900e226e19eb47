#include "core/scene/scene.h"

#include "core/boundary/moving_surface.h"

namespace migiwa {

Bounds Scene::bounds() const {
  Bounds bounds;
  for (const auto& source : fluid) bounds.include(source->bounds());
  for (const Emitter& emitter : emitters) bounds.include(emitter.bounds());
  for (const auto& surface : surfaces) bounds.include(sweptBounds(*surface, duration));
  return bounds;
}

}  // namespace migiwa

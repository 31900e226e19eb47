#include "core/scene/scene.h"

namespace migiwa {

Bounds Scene::bounds() const {
  Bounds bounds;
  for (const auto& source : fluid) bounds.include(source->bounds());
  for (const auto& surface : surfaces) bounds.include(surface->bounds());
  return bounds;
}

}  // namespace migiwa

// What `migiwa slim` shows of a fit: on the left the surface, on the right the nodes that it is made of.
#pragma once

#include "app/render/image.h"
#include "core/slim/slim_fitting.h"

namespace migiwa {

/// Needs no display. Throws MissingError where this machine has no EGL.
Image drawSlim(const SlimData& data, ThreadPool& pool);

}  // namespace migiwa

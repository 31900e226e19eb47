// Shapes of walls of your own: a class that a scene then names like any other.
//
//   Derive from Described<Mine, DistanceSurface>, which needs a signed distance and bounds, or from Surface;
//   registerSurface gives it its name.
#pragma once

#include "core/base/fields.h"
#include "core/walls/surface.h"

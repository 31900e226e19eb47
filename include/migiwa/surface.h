// The surface of a scene's liquid as closed meshes.
//
//   SceneSurface, which keeps the walls from frame to frame, with SurfaceOptions; SurfaceMesh,
//   enclosedVolume; surfaceFormats for files.
#pragma once

#include "core/io/surface_files.h"
#include "core/simulation/scene_surface.h"

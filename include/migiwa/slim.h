// SLIM surfaces: fitted to meshes and points, kept in files, asked for distances.
//
//   importShape, fitShape with SlimFitOptions, cutTo; slimFileText, readSlimFile; SlimModel::nearest.
#pragma once

#include "core/slim/file.h"
#include "core/slim/fit.h"
#include "core/slim/model.h"
#include "core/slim/shape_import.h"

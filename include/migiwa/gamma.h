// The walls of a scene asked at any points: gamma, its gradient, distances and normals.
//
//   WallQuery; gammaMethodNames and handlingNames for the scene's keys.
#pragma once

#include "core/gamma/gamma_method.h"
#include "core/simulation/gauges.h"

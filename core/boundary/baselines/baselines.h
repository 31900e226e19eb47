// What gamma is compared with: other ways to make up for the density that a wall takes, each from its paper.
// They meet gamma in the same solver, and act on a particle through the same GammaSample.
#pragma once

#include <memory>

#include "core/boundary/gamma_method.h"

namespace migiwa {

/// Akinci, Ihmsen, Akinci, Solenthaler, Teschner 2012: particles sampled on the walls, each with the volume
/// that it stands for.
std::unique_ptr<GammaMethod> makeBoundaryParticles(const GammaContext& context);
/// Harada, Koshizuka, Kawaguchi 2007: a wall full of resting particles, summed beforehand over the distance.
std::unique_ptr<GammaMethod> makeWallWeight(const GammaContext& context);
/// Kulasegaram, Bonet, Lewis, Profit 2004: gamma as a spline over the distance.
std::unique_ptr<GammaMethod> makeSplineGamma(const GammaContext& context);

}  // namespace migiwa

// The methods that gamma_registry.cpp lists, one file each.
#pragma once

#include <memory>

#include "core/boundary/gamma_method.h"

namespace migiwa {

/// gamma of the closest wall alone, as if it were an infinite plane.
std::unique_ptr<GammaMethod> makeNearestGamma(const GammaContext& context);
/// [FM] Eq. 14: the Gaussian-weighted mean over the pieces in reach.
std::unique_ptr<GammaMethod> makeMeanGamma(const GammaContext& context);
/// The product over planes at right angles.
std::unique_ptr<GammaMethod> makeProductGamma(const GammaContext& context);

}  // namespace migiwa

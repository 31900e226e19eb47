// How the density is corrected at walls: by gamma, by one of the baselines that it is compared with, or not
// at all. All of them are a GammaMethod, so the solver treats them alike. A baseline is one file in
// core/boundary/baselines and one line in handling_registry.cpp.
#pragma once

#include <span>
#include <string_view>

#include "core/boundary/gamma_method.h"

namespace migiwa {

/// The place of a handling in handlingNames(); baselines come after those that have a name here.
enum class BoundaryHandling : int {
  gamma,  ///< [FM] Eq. 5: divided by the part of the kernel that the solid does not cover
  none,   ///< not at all: the paper's "without correction"; walls only keep centres out
};

/// Names for the scene's "handling" key.
std::span<const std::string_view> handlingNames();

/// The method that corrects the density: the gamma method of that index for `gamma`, null for `none`, else
/// the baseline, for which the name is that of the handling.
PickedGamma makeHandling(BoundaryHandling handling, int gammaMethod, const GammaContext& context);

}  // namespace migiwa

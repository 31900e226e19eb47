// The handlings of walls that a scene can name.
#include <array>

#include "core/base/registry.h"
#include "core/boundary/baselines/baselines.h"
#include "core/boundary/handling.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<GammaMethod> (*make)(const GammaContext&);  ///< null: no baseline
};

constexpr std::array kHandlings{
    Entry{"gamma", nullptr},
    Entry{"none", nullptr},
    Entry{"particles", makeBoundaryParticles},
    Entry{"wall_weight", makeWallWeight},
    Entry{"spline", makeSplineGamma},
};

}  // namespace

std::span<const std::string_view> handlingNames() {
  return registryNames<kHandlings>();
}

PickedGamma makeHandling(BoundaryHandling handling, int gammaMethod, const GammaContext& context) {
  if (handling == BoundaryHandling::gamma) return makeGammaMethod(gammaMethod, context);
  const Entry& entry = kHandlings.at(static_cast<std::size_t>(handling));
  if (entry.make == nullptr) return {};
  std::unique_ptr<GammaMethod> method = entry.make(context);
  std::string reason = method->choice().reason;
  return {std::move(method), std::string(entry.name), std::move(reason)};
}

}  // namespace migiwa

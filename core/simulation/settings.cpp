#include "core/simulation/settings.h"

#include <string>

#include "core/base/error.h"

namespace migiwa {

void requireSteppable(const BoundaryParameters& boundary, const std::filesystem::path& scene) {
  const auto method = static_cast<std::size_t>(boundary.gammaMethod);
  if (boundary.handling != BoundaryHandling::gamma || method < steppedGammaMethodNames().size()) return;
  throw InputError(scene.string() + ":/boundary/gamma/method",
                   "expected a method that is quick enough for every step, such as \"auto\", found \"" +
                       std::string(gammaMethodNames()[method]) +
                       "\", a reference for migiwa gamma alone; --set /boundary/gamma/method=auto helps");
}

}  // namespace migiwa

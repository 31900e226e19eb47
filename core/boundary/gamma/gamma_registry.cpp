// The gamma methods a scene can name.
#include <array>

#include "core/base/registry.h"
#include "core/boundary/gamma/gamma_methods.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<GammaMethod> (*make)(const GammaContext&);
};

constexpr std::array kMethods{
    Entry{"auto", makeAutoGamma},       Entry{"product", makeProductGamma},
    Entry{"copula", makeCopulaGamma},   Entry{"directions", makeDirectionsGamma},
    Entry{"baked", makeBakedGamma},     Entry{"mean", makeMeanGamma},
    Entry{"nearest", makeNearestGamma}, Entry{"monte_carlo", makeMonteCarloGamma},
};
/// Those behind these are too slow for a step.
constexpr std::size_t kStepped = kMethods.size() - 1;

}  // namespace

std::span<const std::string_view> gammaMethodNames() {
  return registryNames<kMethods>();
}

std::span<const std::string_view> steppedGammaMethodNames() {
  return gammaMethodNames().first(kStepped);
}

PickedGamma makeGammaMethod(int index, const GammaContext& context) {
  const Entry& entry = kMethods.at(static_cast<std::size_t>(index));
  std::unique_ptr<GammaMethod> method = entry.make(context);
  const GammaChoice choice = method->choice();
  if (choice.name.empty()) return {std::move(method), std::string(entry.name), {}};
  return {std::move(method), choice.name, choice.reason};
}

}  // namespace migiwa

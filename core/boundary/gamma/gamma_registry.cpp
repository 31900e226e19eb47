// The gamma methods a scene can name, and how "auto" chooses.
#include <array>
#include <cmath>

#include "core/boundary/gamma/gamma_methods.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<GammaMethod> (*make)(const GammaContext&);
};

constexpr std::array kMethods{
    Entry{"product", makeProductGamma},
    Entry{"mean", makeMeanGamma},
    Entry{"nearest", makeNearestGamma},
};
constexpr std::size_t kProduct = 0;

PickedGamma make(std::size_t method, const GammaContext& context, std::string reason) {
  return {kMethods.at(method).make(context), std::string(kMethods.at(method).name), std::move(reason)};
}

}  // namespace

std::span<const std::string_view> gammaMethodNames() {
  static const auto names = [] {
    std::array<std::string_view, kMethods.size() + 1> result{"auto"};
    for (std::size_t k = 0; k < kMethods.size(); ++k) result[k + 1] = kMethods[k].name;
    return result;
  }();
  return names;
}

PickedGamma makeGammaMethod(int index, const GammaContext& context) {
  if (index > 0) return make(static_cast<std::size_t>(index - 1), context, {});
  // All shapes so far are made of planes. The product is exact on one, the closest at right angles, and errs
  // less than the others at any other angle.
  return make(kProduct, context, "all walls are planar; the product is the most accurate method for planes");
}

}  // namespace migiwa

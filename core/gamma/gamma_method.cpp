// The gamma methods a scene can name.
#include "core/gamma/gamma_method.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/base/fields.h"
#include "core/base/progress.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<GammaMethod> (*make)(const GammaContext&);  ///< null: walls change no density
};

constexpr std::array kMethods{
    Entry{"auto", makeAutoGamma},
    Entry{"product", makeProductGamma},
    Entry{"copula", makeCopulaGamma},
    Entry{"directions", makeDirectionsGamma},
    Entry{"facets", makeFacetsGamma},
    Entry{"baked", makeBakedGamma},
    Entry{"mean", makeMeanGamma},
    Entry{"nearest", makeNearestGamma},
    Entry{"monte_carlo", makeMonteCarloGamma},
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
  const Activity activity("preparing gamma by the method \"" + std::string(entry.name) + "\"");
  std::unique_ptr<GammaMethod> method = entry.make(context);
  const GammaChoice choice = method->choice();
  if (choice.name.empty()) return {std::move(method), std::string(entry.name), {}};
  return {std::move(method), choice.name, choice.reason};
}

// The handlings of walls that a scene can name.

namespace {

constexpr std::array kHandlings{
    Entry{"gamma", nullptr},
    Entry{"none", nullptr},
    Entry{"particles", makeBoundaryParticles},
    Entry{"wall_weight", makeWallWeight},
    Entry{"spline", makeSplineGamma},
    Entry{"penalty", makePenalty},
};

}  // namespace

std::span<const std::string_view> handlingNames() {
  return registryNames<kHandlings>();
}

PickedGamma makeHandling(BoundaryHandling handling, int gammaMethod, const GammaContext& context) {
  if (handling == BoundaryHandling::gamma) return makeGammaMethod(gammaMethod, context);
  const Entry& entry = kHandlings.at(static_cast<std::size_t>(handling));
  if (entry.make == nullptr) return {};
  const Activity activity("preparing the handling of walls \"" + std::string(entry.name) + "\"");
  std::unique_ptr<GammaMethod> method = entry.make(context);
  std::string reason = method->choice().reason;
  return {std::move(method), std::string(entry.name), std::move(reason)};
}

Vec3d MapWindow::point(int column, int row) const {
  Vec3d p;
  p[axis] = at;
  p[across] = low[0] + (high[0] - low[0]) * (column + 0.5) / columns;
  p[up] = low[1] + (high[1] - low[1]) * (row + 0.5) / rows;
  return p;
}

std::vector<float> gammaMap(const GammaMethod& method, const Boundary& boundary, const MapWindow& window,
                            ThreadPool& pool) {
  const auto columns = static_cast<std::size_t>(window.columns);
  std::vector<float> values(columns * static_cast<std::size_t>(window.rows));
  const Activity activity("evaluating gamma on a map");
  pool.run(static_cast<std::size_t>(window.rows), [&](std::size_t row) {
    std::vector<Float4> points;
    std::vector<GammaSample> samples(columns);
    for (int column = 0; column < window.columns; ++column)
      points.emplace_back(window.point(column, static_cast<int>(row)).cast<float>());
    method.evaluate(points, samples);
    for (std::size_t column = 0; column < columns; ++column) {
      const bool solid = boundary.distance(points[column].xyz()) < 0;
      values[row * columns + column] =
          solid ? std::numeric_limits<float>::quiet_NaN() : samples[column].gamma;
    }
  });
  return values;
}

PickedGamma referenceGamma(GammaContext context) {
  context.directions = 16384;
  const auto names = gammaMethodNames();
  const auto directions = std::find(names.begin(), names.end(), "directions") - names.begin();
  return makeGammaMethod(static_cast<int>(directions), context);
}

}  // namespace migiwa

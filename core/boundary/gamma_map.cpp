#include "core/boundary/gamma_map.h"

#include <algorithm>
#include <limits>

namespace migiwa {

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

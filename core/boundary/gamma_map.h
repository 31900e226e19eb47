// gamma on a plane cut through a scene, and how far it is from a fine reference: the paper's Figure 3.
#pragma once

#include <vector>

#include "core/base/parallel.h"
#include "core/boundary/gamma_method.h"

namespace migiwa {

/// A rectangle in the plane axis = at, sampled cell-centred.
struct MapWindow {
  int axis = 2;                              ///< normal of the cut: 0 x, 1 y, 2 z
  double at = 0;                             ///< (m)
  int across = 0, up = 1;                    ///< axes of the picture
  double low[2] = {0, 0}, high[2] = {1, 1};  ///< along those axes (m)
  int columns = 240, rows = 240;

  Vec3d point(int column, int row) const;
};

/// gamma of a method at the window's points, row by row; NaN in the solid.
std::vector<float> gammaMap(const GammaMethod& method, const Boundary& boundary, const MapWindow& window,
                            ThreadPool& pool);

/// What the map's error is measured against: many more directions than any method uses, within 2e-4 of the
/// truth.
PickedGamma referenceGamma(GammaContext context);

}  // namespace migiwa

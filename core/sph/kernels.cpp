#include "core/sph/kernels.h"

#include <cmath>

namespace migiwa {

RestingLattice restingLattice(KernelType type, double supportRatio) {
  return withKernel(type, [&](auto kernel) {
    using Density = decltype(kernel);
    using Pair = PairKernel<Density>;
    const int reach = static_cast<int>(std::ceil(supportRatio));
    double values = 0, besideWall = 0, squaredSlopes = 0;
    for (int k = -reach; k <= reach; ++k) {
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          const auto q =
              static_cast<float>(std::sqrt(static_cast<double>(i * i + j * j + k * k)) / supportRatio);
          values += static_cast<double>(Density::value(q));
          if (i >= 0) besideWall += static_cast<double>(Density::value(q));
          const double slope = q > 0 ? static_cast<double>(Pair::derivative(q)) : 0;
          squaredSlopes += slope * slope;
        }
      }
    }
    const double massRatio = 1 / values;
    const auto gamma = static_cast<double>(Density::planeGamma(static_cast<float>(0.5 / supportRatio)));
    // With the whole, neighbours pair up along edges; with two thirds, water settles half a hundredth too
    // high.
    constexpr double kMoved = 0.8;
    const double factor = 1 + kMoved * (massRatio * besideWall / gamma - 1);
    // factor = 1 + u (slope + bend u) at u = 1 - gamma, and factor^2 at u = 1 - gamma^2.
    const double one = 1 - gamma, two = 1 - gamma * gamma;
    const double atOne = (factor - 1) / one, atTwo = (factor * factor - 1) / two;
    const double bend = (atTwo - atOne) / (two - one);
    return RestingLattice{static_cast<float>(massRatio),
                          static_cast<float>(massRatio * massRatio * squaredSlopes),
                          static_cast<float>(atOne - bend * one), static_cast<float>(bend)};
  });
}

}  // namespace migiwa

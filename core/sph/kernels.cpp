#include "core/sph/kernels.h"

#include <cmath>

namespace migiwa {

RestingLattice restingLattice(KernelType type, double supportRatio) {
  return withKernel(type, [&](auto kernel) {
    using Density = decltype(kernel);
    using Pair = PairKernel<Density>;
    const int reach = static_cast<int>(std::ceil(supportRatio));
    double values = 0, squaredSlopes = 0;
    for (int k = -reach; k <= reach; ++k) {
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          const auto q =
              static_cast<float>(std::sqrt(static_cast<double>(i * i + j * j + k * k)) / supportRatio);
          values += static_cast<double>(Density::value(q));
          const double slope = q > 0 ? static_cast<double>(Pair::derivative(q)) : 0;
          squaredSlopes += slope * slope;
        }
      }
    }
    const double massRatio = 1 / values;
    return RestingLattice{static_cast<float>(massRatio),
                          static_cast<float>(massRatio * massRatio * squaredSlopes)};
  });
}

}  // namespace migiwa

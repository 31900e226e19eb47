#include "core/boundary/gamma/kernel_stencil.h"

#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/base/portable_math.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

/// A cube of numbers about a middle, zero outside.
class Cube {
 public:
  explicit Cube(int reach)
      : reach_(reach), side_(2 * reach + 1), values_(cubeIndex(0, 0, side_, side_, side_), 0.0) {}

  int reach() const { return reach_; }
  double& at(int x, int y, int z) { return values_[indexOf(x, y, z)]; }
  double get(int x, int y, int z) const {
    if (std::abs(x) > reach_ || std::abs(y) > reach_ || std::abs(z) > reach_) return 0;
    return values_[indexOf(x, y, z)];
  }
  template <class Body>
  void forEach(const Body& body) {
    for (int z = -reach_; z <= reach_; ++z)
      for (int y = -reach_; y <= reach_; ++y)
        for (int x = -reach_; x <= reach_; ++x) body(x, y, z, at(x, y, z));
  }

 private:
  std::size_t indexOf(int x, int y, int z) const {
    return cubeIndex(x + reach_, y + reach_, z + reach_, side_, side_);
  }

  int reach_, side_;
  std::vector<double> values_;
};

/// The integral of the kernel under the tent about a point of the lattice.
template <class Kernel>
double underTent(int x, int y, int z) {
  constexpr int kSamples = 6;  // along half of the tent
  double sum = 0;
  for (int k = -kSamples; k < kSamples; ++k) {
    for (int j = -kSamples; j < kSamples; ++j) {
      for (int i = -kSamples; i < kSamples; ++i) {
        const double u = (i + 0.5) / kSamples, v = (j + 0.5) / kSamples, w = (k + 0.5) / kSamples;
        const double q = portable::hypot(x + u, y + v, z + w) / KernelStencil::kPerSupport;
        sum += static_cast<double>(Kernel::value(static_cast<float>(q))) * (1 - std::abs(u)) *
               (1 - std::abs(v)) * (1 - std::abs(w));
      }
    }
  }
  return sum;
}

}  // namespace

KernelStencil kernelStencil(KernelType kernelType) {
  constexpr int kReach = KernelStencil::kReach;
  Cube under(kReach);
  withKernel(kernelType, [&](auto kernel) {
    // One of eight octants, the others by symmetry.
    for (int z = 0; z <= kReach; ++z) {
      for (int y = 0; y <= kReach; ++y) {
        for (int x = 0; x <= kReach; ++x) {
          const double value = underTent<decltype(kernel)>(x, y, z);
          for (int octant = 0; octant < 8; ++octant)
            under.at((octant & 1) != 0 ? -x : x, (octant & 2) != 0 ? -y : y, (octant & 4) != 0 ? -z : z) =
                value;
        }
      }
    }
  });

  // The tents' inner products, 1/6, 2/3 and 1/6 along each axis, times the weights are the integrals under
  // the tents: solved by Richardson's iteration, for the kernel is smooth on the lattice.
  constexpr int kSteps = 12;
  Cube weights = under;
  for (int step = 0; step < kSteps; ++step) {
    const Cube before = weights;
    weights.forEach([&](int x, int y, int z, double& weight) {
      double product = 0;
      for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
          for (int i = -1; i <= 1; ++i)
            product += (i == 0 ? 4 : 1) * (j == 0 ? 4 : 1) * (k == 0 ? 4 : 1) / 216.0 *
                       before.get(x + i, y + j, z + k);
      weight += under.get(x, y, z) - product;
    });
  }
  double sum = 0;
  weights.forEach([&](int, int, int, double& weight) { sum += weight; });
  KernelStencil stencil;
  stencil.weights.fill(0);
  weights.forEach([&](int x, int y, int z, double& weight) {
    stencil.weights[cubeIndex(x + kReach, y + kReach, z + kReach, KernelStencil::kSide,
                              KernelStencil::kStride)] = static_cast<float>(weight / sum);
  });
  return stencil;
}

}  // namespace migiwa

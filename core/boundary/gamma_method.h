// gamma_i of [FM] Eq. 6: the part of the kernel's support that the solid does not cover, with its gradient,
// for a batch of points. A method is one file that implements this interface and one line in
// gamma_registry.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/parallel.h"
#include "core/base/types.h"
#include "core/boundary/boundary.h"
#include "core/sph/kernel_type.h"

namespace migiwa {

/// gamma at one point. Gradients are those of gamma with respect to the point over the support radius, so
/// without a unit: multiply by 1/h for 1/m.
struct GammaSample {
  float gamma = 1;
  float distance = 0;                  ///< to the nearest wall (m), positive in the fluid
  Vec3f gradient = Vec3f::Zero();      ///< h grad gamma for the density kernel
  Vec3f pairGradient = Vec3f::Zero();  ///< the same for the kernel of the pair gradients: the wall's push
};

/// What a method that chooses among others will use for its walls, and why. Empty for one that does not
/// choose.
struct GammaChoice {
  std::string name, reason;
};

/// How a method's sample enters the density: S is what the fluid particles sum to, over rho0.
enum class WallDensity {
  divided,  ///< rho = S / gamma, [FM] Eq. 5
  added,    ///< rho = S + (1 - gamma): the walls' own density is 1 - gamma, and may exceed 1
};

class GammaMethod {
 public:
  explicit GammaMethod(WallDensity form = WallDensity::divided) : form_(form) {}
  virtual ~GammaMethod() = default;
  GammaMethod(const GammaMethod&) = delete;
  GammaMethod& operator=(const GammaMethod&) = delete;

  WallDensity form() const { return form_; }
  virtual GammaChoice choice() const { return {}; }
  /// Takes in that walls of the boundary have moved. Not while evaluate() runs.
  virtual void wallsMoved() {}
  /// Fills out[i] for points[i] (xyz in m). Thread-safe.
  virtual void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const = 0;

 private:
  WallDensity form_;
};

struct GammaContext {
  const Boundary& boundary;
  KernelType kernel;
  float supportRadius;         ///< (m)
  int directions = 256;        ///< of the method "directions"
  int samples = 100000;        ///< of the method "monte_carlo"
  Bounds region{};             ///< where the method "baked" has a grid (m); empty: about the finite walls
  ThreadPool* pool = nullptr;  ///< for what takes long; null: the calling thread alone
  std::string place{};         ///< of the method in the scene file, for errors
  float spacing = 0;           ///< of fluid particles at rest (m): what baselines put into walls
};

/// Names for the scene's gamma method, "auto" first.
std::span<const std::string_view> gammaMethodNames();
/// The first of them, which a simulation can use in every step. The others are references to compare with.
std::span<const std::string_view> steppedGammaMethodNames();
struct PickedGamma {
  std::unique_ptr<GammaMethod> method;
  std::string name;    ///< of the method that is used
  std::string reason;  ///< why "auto" took it; empty when it was asked for by name
};
PickedGamma makeGammaMethod(int index, const GammaContext& context);

}  // namespace migiwa

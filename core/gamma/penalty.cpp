// Penalty walls change no density; their force by depth is in core/solver/penalty.cpp.
#include "core/gamma/gamma_method.h"

namespace migiwa {

namespace {

class Penalty final : public GammaMethod {
 public:
  explicit Penalty(const GammaContext& context)
      : GammaMethod(WallDensity::absent), boundary_(context.boundary) {}

  GammaChoice choice() const override { return {"penalty", "a force by the depth in the wall"}; }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(points[i].xyz());
    }
  }

 private:
  const Boundary& boundary_;
};

}  // namespace

std::unique_ptr<GammaMethod> makePenalty(const GammaContext& context) {
  return std::make_unique<Penalty>(context);
}

}  // namespace migiwa

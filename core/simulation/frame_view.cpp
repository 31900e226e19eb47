#include "core/simulation/frame_view.h"

#include <cmath>

namespace migiwa {

void FrameSnapshot::assign(const FrameView& view) {
  info = view.info;
  positions.assign(view.positions.begin(), view.positions.end());
  velocities.assign(view.velocities.begin(), view.velocities.end());
  density.assign(view.density.begin(), view.density.end());
  gamma.assign(view.gamma.begin(), view.gamma.end());
  lambda.assign(view.lambda.begin(), view.lambda.end());
  pressure.assign(view.pressure.begin(), view.pressure.end());
  neighbours.assign(view.neighbours.begin(), view.neighbours.end());
  walls = view.walls;
}

ColorFieldInfo colorFieldInfo(ColorField field, double referenceSpeed, double restDensity) {
  switch (field) {
    case ColorField::density:
      return {"density ρ/ρ₀", "", 0.6, 1.2};
    case ColorField::speed:
      return {"speed |v|", "m/s", 0, referenceSpeed};
    case ColorField::gamma:
      return {"boundary correction γ", "", 0.4, 1};
    case ColorField::lambda:
      return {"multiplier λh²", "", -0.02, 0};
    case ColorField::neighbours:
      return {"neighbours", "", 0, 60};
    case ColorField::pressure:
      return {"pressure p", "kPa", 0, 1e-3 * 0.5 * restDensity * referenceSpeed * referenceSpeed};
  }
  return {};
}

void colorFieldValues(const FrameView& view, ColorField field, std::vector<float>& out) {
  switch (field) {
    case ColorField::density:
      out.assign(view.density.begin(), view.density.end());
      return;
    case ColorField::gamma:
      out.assign(view.gamma.begin(), view.gamma.end());
      return;
    case ColorField::lambda:
      out.assign(view.lambda.begin(), view.lambda.end());
      return;
    case ColorField::neighbours:
      out.resize(view.neighbours.size());
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(view.neighbours[i]);
      return;
    case ColorField::pressure:
      out.assign(view.positions.size(), 0);
      for (std::size_t i = 0; i < view.pressure.size(); ++i) out[i] = 1e-3F * view.pressure[i];
      return;
    case ColorField::speed:
      out.resize(view.velocities.size());
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = view.velocities[i].xyz().norm();
      return;
  }
}

}  // namespace migiwa

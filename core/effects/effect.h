// One physical effect beyond pressure and gravity. An effect is one file that implements this interface and
// one line in effect_registry.cpp. A scene that does not name it does not run it.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "core/base/fields.h"

namespace migiwa {

struct StepState;

class Effect {
 public:
  virtual ~Effect() = default;
  /// Visits the fields of the scene's object under "effects".
  virtual void describe(FieldVisitor& visitor) = 0;
  /// Changes the velocities once a step, after the constraint is solved.
  virtual void apply(StepState& state) const = 0;
};

/// Names for the keys of the scene's "effects", in the order of makeEffect's index.
std::span<const std::string_view> effectNames();
std::unique_ptr<Effect> makeEffect(int effect);

}  // namespace migiwa

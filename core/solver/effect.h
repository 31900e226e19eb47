// One physical effect beyond pressure and gravity. An effect is one file that implements this interface and
// one line in core/effects/effects.cpp. A scene that does not name it does not run it: its stages are not in
// the step, its buffers are not allocated and its panel is not in the window.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"

namespace migiwa {

struct StepState;

/// Memory that an effect works in: as many Float4 a particle as it resizes it to, and those of one particle
/// more where neighbour lists read it.
using EffectBuffer = std::vector<Float4>;

/// Where in a step an effect acts.
struct EffectStages {
  bool prediction = false;  ///< on the predicted positions, before the constraint is solved
  bool iteration = false;   ///< within each iteration, after the constraint's own move
  bool velocity = false;    ///< on the velocities, after the constraint is solved
};

/// Effects keep nothing from step to step: what a step needs is in the scene and in the particles.
class Effect {
 public:
  virtual ~Effect() = default;
  /// Visits the fields of the scene's object under "effects": its parameters with units, ranges and defaults.
  virtual void describe(FieldVisitor& visitor) = 0;
  virtual void describe(FieldWriter& visitor) const = 0;
  virtual std::unique_ptr<Effect> clone() const = 0;
  /// The stages that it adds to a step with the parameters as they are.
  virtual EffectStages stages() const = 0;
  /// Buffers that it needs beside the solver's own. They are shared: what one stage leaves, the next does not
  /// find.
  virtual std::size_t buffers() const { return 0; }

  /// The longest step (s) over which the effect is stable; infinite where any will do.
  virtual double longestStep(const StepState&) const { return std::numeric_limits<double>::infinity(); }

  /// Changes state.current, the predicted positions (m). Particles are sorted and have their neighbours.
  virtual void changePrediction(StepState&, std::span<EffectBuffer>) const {}
  /// Changes state.current, which an iteration has just moved and the walls have not yet kept in.
  /// state.paired holds the positions before that move, with the ghost's, state.lambda and state.density what
  /// it came from. `weight` is that of the move, as for stages::movePositions.
  virtual void changePositions(StepState&, float /*weight*/) const {}
  /// Changes the velocities (m/s). state.current holds the positions, with the ghost's; state.paired and
  /// state.previous are free.
  virtual void changeVelocities(StepState&, std::span<EffectBuffer>) const {}
};

/// An effect of the class `Derived`, which lists its fields once, as Described says.
template <class Derived>
class EffectOf : public Described<Derived, Effect> {
 public:
  std::unique_ptr<Effect> clone() const override {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

/// An effect under the name that the scene gives it: its stage.
struct NamedEffect {
  std::string name;
  std::shared_ptr<const Effect> effect;
};

/// Names for the keys of the scene's "effects", in the order of makeEffect's index, which is also the order
/// in which they act.
std::span<const std::string_view> effectNames();
std::unique_ptr<Effect> makeEffect(int effect);
/// Adds an effect from outside the library: from then on scenes may have its object under "effects". It acts
/// after those that are there. Call it before the first scene is read. Throws std::invalid_argument for a
/// name that is taken or no lower-case word.
void registerEffect(const std::string& name, std::function<std::unique_ptr<Effect>()> make);
template <class Made>
void registerEffect(const std::string& name) {
  registerEffect(name, [] { return std::make_unique<Made>(); });
}

}  // namespace migiwa

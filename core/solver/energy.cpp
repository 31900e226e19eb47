#include "core/solver/energy.h"

#include <algorithm>

#include "core/solver/state.h"

namespace migiwa {

EnergySums& EnergySums::operator+=(const EnergySums& other) {
  kinetic += other.kinetic;
  velocity += other.velocity;
  place += other.place;
  particles += other.particles;
  return *this;
}

EnergySums& EnergySums::operator-=(const EnergySums& other) {
  kinetic -= other.kinetic;
  velocity -= other.velocity;
  place -= other.place;
  particles -= other.particles;
  return *this;
}

double EnergySums::halfStepOn(const Vec3d& gravity, double dt) const {
  return kinetic + 0.5 * dt * gravity.dot(velocity) +
         0.125 * dt * dt * gravity.squaredNorm() * static_cast<double>(particles) + potential(gravity);
}

EnergySums energySums(const Particles& particles, std::size_t first, const Vec3f& centre) {
  EnergySums sums;
  for (std::size_t i = first; i < particles.size(); ++i)
    sums.add(particles.position[i].xyz(), particles.velocity[i].xyz(), centre);
  return sums;
}

double predictedEnergy(const StepState& state) {
  // 1/2 |d/dt + g dt/2|^2 - g.d = 1/2 |d/dt|^2 - 1/2 g.d and a constant, d the move of the step.
  const float inverseStep = 1 / state.timeStep;
  return parallelSum(state.pool, state.particles.size(), [&](std::size_t i) {
    const Vec3f move = state.current[i].xyz() - state.particles.position[i].xyz();
    return 0.5 * static_cast<double>((inverseStep * move).squaredNorm() - state.gravity.dot(move));
  });
}

double velocityEnergy(const StepState& state) {
  const Vec3f gain = state.timeStep * state.gravity;
  return parallelSum(state.pool, state.particles.size(), [&](std::size_t i) {
    const Vec3f velocity = state.particles.velocity[i].xyz();
    return 0.5 * static_cast<double>(velocity.squaredNorm() + gain.dot(velocity));
  });
}

void WallWork::iterate(double displacementTimesVelocity, float weight) {
  const double stretch = static_cast<double>(weight);
  const double next = before_ + stretch * (now_ + displacementTimesVelocity - before_);
  before_ = now_;
  now_ = next;
}

double wallPush(const StepState& state) {
  if (state.parameters.positionStep == PositionStep::paper) return 0;
  return parallelSum(state.pool, state.wallSlots.size(), [&](std::size_t k) {
    const WallSlot& slot = state.wallSlots[k];
    const std::size_t i = slot.particle;
    const Vec3f push = -state.supportRadius * state.wallPush(i) * slot.sample.pairGradient;
    return static_cast<double>(push.dot(state.boundary.wallVelocity(state.current[i].xyz())));
  });
}

double projectionWork(const StepState& state) {
  const float support = state.supportRadius, toGradient = -0.5F / (support * support);
  return parallelSum(state.pool, state.wallSlots.size(), [&](std::size_t k) {
    const WallSlot& slot = state.wallSlots[k];
    const std::size_t i = slot.particle;
    const Vec3f velocity = state.boundary.wallVelocity(slot.at.xyz());
    const InverseMoment& inverse = state.projection.inverse[i];
    const Float4& own = state.paired[i];
    Vec3f push;
    if (inverse.sound) {
      Vec3f differences = Vec3f::Zero(), sums = Vec3f::Zero();
      const float* factor = state.neighbours.pairValues(i);
      for (const std::uint32_t j : state.neighbours.of(i)) {
        const Float4& other = state.paired[j];
        const Vec3f offset = *factor++ * (own.xyz() - other.xyz());
        differences += (other.w - own.w) * offset;
        sums += (other.w + own.w) * offset;
      }
      push = toGradient * (sums - inverse.times(differences));
    } else {
      const float fall = (state.addsWallDensity() ? 1 : state.density[i]) * own.w / support;
      push = fall * slot.sample.pairGradient;
    }
    return static_cast<double>(state.timeStep * push.dot(velocity));
  });
}

void PressureSum::watch(bool on) {
  if (on == watched_) return;
  watched_ = on;
  clear();
}

void PressureSum::clear() {
  now_.clear();
  before_.clear();
}

void PressureSum::begin(const StepState& state) {
  if (!watched_ || state.takesPressure()) return;
  now_.assign(state.particles.size(), 0);
  before_.assign(state.particles.size(), 0);
}

void PressureSum::iterate(const StepState& state, float weight) {
  if (!watched_ || state.takesPressure()) return;
  parallelFor(state.pool, now_.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) before_[i] += weight * (now_[i] + state.lambda[i] - before_[i]);
  });
  now_.swap(before_);
}

void PressureSum::project(const StepState& state) {
  if (!watched_) return;
  now_.resize(state.particles.size());
  const float gravity = state.gravity.norm(), inverseStep = 1 / state.timeStep;
  parallelEach(state.pool, now_.size(), [&](std::size_t i) {
    now_[i] = 0.5F * state.spacing * std::min(inverseStep * state.projection.image[i], gravity);
  });
}

void PressureSum::pressures(const StepState& state, std::vector<float>& out) const {
  const double density = state.parameters.restDensity;
  if (watched_ && state.takesPressure()) {
    const std::vector<float>& pressure = state.projectedPressure;
    const bool above = state.parameters.method == SolverMethod::pbf && now_.size() == pressure.size();
    out.resize(pressure.size());
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = static_cast<float>(density * static_cast<double>(pressure[i] + (above ? now_[i] : 0)));
    return;
  }
  out.resize(now_.size());
  const double scale = -density * static_cast<double>(state.supportRadius) *
                       static_cast<double>(state.supportRadius) /
                       (static_cast<double>(state.timeStep) * static_cast<double>(state.timeStep));
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<float>(scale * static_cast<double>(now_[i]));
}

}  // namespace migiwa

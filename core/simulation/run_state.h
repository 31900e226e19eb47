// The state of a simulation: what the parts of Simulation share.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/gamma/gamma_method.h"
#include "core/scene/scene.h"
#include "core/simulation/fill.h"
#include "core/simulation/gauges.h"
#include "core/simulation/simulation.h"
#include "core/simulation/statistics.h"
#include "core/solver/step.h"
#include "core/walls/boundary.h"

namespace migiwa {

struct Simulation::State {
  State(Scene theScene, int threads, Guards guards);

  /// Takes settings over wholly, or throws and stays as it is.
  void configure(const Settings& settings);
  void advanceSubstep(double start, double dt);
  EnergySums emit(double start);
  EnergySums removeOutflow(double start);
  void partCrowded();
  void takeBackExcess(const EnergySums& before, double dt);
  void refuseNotFinite();
  void refuseOverConstrained(const OverConstrained& overConstrained, double start);
  void moveWalls(double before, double now);
  double wallSpeed(double from, double to) const;
  double largestSpeed(double start, double span) const;
  std::uint64_t hash() {
    return migiwa::stateHash(step.particles.id, step.particles.position, step.particles.velocity, pool);
  }
  /// What a picture says of the frame, but for wall times.
  void describeFrame();
  /// Takes in what the gauges show now, and of pressures the mean over the substeps of the frame.
  void readGauges();
  /// A substep of `dt` (s) has been taken: adds its pressures to those of the frame.
  void sumPressures(double dt);
  void describeGauges();

  Scene scene;
  ThreadPool pool;
  Boundary boundary;
  StepState step;
  Emission emission;
  Outflow outflow;
  GaugeReader gauges;
  std::vector<double> pressureSums;  ///< of each gauge over the frame so far (Pa s)
  PickedGamma gamma;
  EffectPipeline effects;
  RunStatistics statistics;
  Health health;
  HealthLimits limits;
  double wallsGave = 0;  ///< the largest speed of a wall so far (m/s)
  FrameInfo info;
  std::shared_ptr<const WallDrawing> drawnWalls;  ///< as they are now; null: nobody has asked
  std::vector<std::uint32_t> savedNeighbours;     ///< counts that came with a save, until the next step
  bool stepTaken = true;                          ///< false: the last step was refused
  std::vector<float> pressure;                    ///< (Pa) of the last step; empty: nobody watches
  long frame = 0;
  double time = 0;
};

}  // namespace migiwa

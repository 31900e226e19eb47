// A simulation as Python holds it: with views of its arrays that stay valid, and callbacks.
#pragma once

#include <array>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <migiwa/simulation.h>
#include <migiwa/surface.h>
#include <sys/types.h>

#include "python/bindings/bindings.h"

namespace migiwa::python {

/// The failure of a callback, kept until the frame has come to its end.
struct CallbackFailure {
  std::exception_ptr thrown;
};

/// A callback that changes velocities, as an effect of a step.
NamedEffect velocityCallback(py::function callback, std::shared_ptr<CallbackFailure> failure);

/// Guards what Python may do with a simulation. Its functions are called with the interpreter's lock, and
/// give it up while they compute. They throw where the simulation is closed, is at work in another thread,
/// callbacks of its run included, or belongs to another process.
class HeldSimulation {
 public:
  HeldSimulation(const Scene& scene, int threads);
  ~HeldSimulation();
  HeldSimulation(const HeldSimulation&) = delete;
  HeldSimulation& operator=(const HeldSimulation&) = delete;

  /// The simulation, for what takes no time.
  Simulation& use() const;
  /// Frames, one after another; ends early where the simulation stops.
  void step(long frames);
  /// To the frame on which `until` (s) falls. `eachFrame`, unless it is None, is called after every frame;
  /// False ends.
  void runUntil(double until, const py::object& eachFrame);

  /// A read-only array over the simulation's own memory. At the next step, or when the simulation ends, what
  /// is still held keeps its memory and its values, and the simulation goes on in a copy.
  py::array view(FrameArray which);
  /// Whether an array, or a part of one, shows the present frame's memory.
  bool current(const py::array& array) const;

  void apply(const Scene& scene);
  void addVelocityCallback(py::function callback);

  SurfaceMesh surface(double resolution, int smoothing, double smallest) const;
  std::string report() const;
  void save(const std::string& file);
  void resume(const std::string& file);
  void writeParticles(const std::string& file, const std::string& format,
                      const std::vector<std::string>& fields) const;
  /// Not in a callback of a run.
  void close();
  bool closed() const { return simulation_ == nullptr; }

 private:
  /// What arrays of one kind hold on to: nothing as long as the memory is the simulation's.
  struct Lease {
    std::shared_ptr<const void> memory;
  };
  class Busy;

  void detachViews();
  bool afterFrame(const py::object& eachFrame, std::exception_ptr& failure);
  void refuseInRun() const;
  void raiseTrouble() const;

  static constexpr std::size_t kArrays = static_cast<std::size_t>(FrameArray::ids) + 1;

  std::unique_ptr<Simulation> simulation_;
  SettledSampler sampler_;
  long sampledUntil_ = -1;  ///< the frame at which the sampled run ended
  std::array<std::weak_ptr<Lease>, kArrays> leases_;
  std::shared_ptr<CallbackFailure> failure_ = std::make_shared<CallbackFailure>();
  std::vector<NamedEffect> callbacks_;
  pid_t process_;
  mutable bool busy_ = false;
  /// The thread that is in a callback between two frames of a run; none elsewhere.
  std::thread::id calledBack_;
};

}  // namespace migiwa::python

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <migiwa/effects.h>
#include <migiwa/report.h>
#include <migiwa/scene.h>
#include <unistd.h>

#include "core/base/files.h"
#include "python/bindings/simulation.h"

namespace migiwa::python {

namespace {

/// Throws in a process that was forked from `process`: the threads of a simulation are not in it.
void refuseAfterFork(pid_t process) {
  if (getpid() != process)
    throw std::runtime_error(
        "expected a simulation of this process, found one from before a fork, whose threads are not here; "
        "make it after the fork");
}

/// Rows of three floats, of which copies are made.
py::array_t<float> copyOf(const std::vector<Float4>& vectors, std::size_t count) {
  py::array_t<float> array({static_cast<py::ssize_t>(count), py::ssize_t{3}});
  auto rows = array.mutable_unchecked<2>();
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    rows(row, 0) = vectors[i].x, rows(row, 1) = vectors[i].y, rows(row, 2) = vectors[i].z;
  }
  return array;
}

/// The callback gets arrays of its own, so that nothing it keeps or does to them reaches memory of a step.
class VelocityCallback final : public EffectOf<VelocityCallback> {
 public:
  VelocityCallback(py::function callback, std::shared_ptr<CallbackFailure> failure)
      : callback_(new py::function(std::move(callback)),
                  [](py::function* held) {
                    const py::gil_scoped_acquire acquire;
                    delete held;
                  }),
        failure_(std::move(failure)) {}

  static void fields(auto&, auto&) {}
  EffectStages stages() const override { return {.velocity = true}; }

  void changeVelocities(StepState& state, std::span<EffectBuffer>) const override {
    if (failure_->thrown) return;
    const py::gil_scoped_acquire acquire;
    try {
      call(state);
    } catch (...) {
      failure_->thrown = std::current_exception();
    }
    if (getpid() == process_) return;
    // The rest of the step would wait for threads that are not in this process.
    if (failure_->thrown) std::rethrow_exception(std::exchange(failure_->thrown, nullptr));
    refuseAfterFork(process_);
  }

 private:
  void call(StepState& state) const {
    const std::size_t count = state.particles.size();
    py::array_t<float> velocities = copyOf(state.particles.velocity, count);
    py::array_t<float> positions = copyOf(state.current, count);
    positions.attr("setflags")(py::arg("write") = false);
    const py::object result = (*callback_)(velocities, positions, static_cast<double>(state.timeStep));
    if (!result.is_none())
      throw py::type_error("expected None of a callback on velocities, which changes them in place, found " +
                           py::repr(py::type::of(result)).cast<std::string>());
    const auto rows = velocities.unchecked<2>();
    for (py::ssize_t i = 0; i < rows.shape(0); ++i)
      for (py::ssize_t axis = 0; axis < 3; ++axis)
        if (!std::isfinite(rows(i, axis)))
          throw py::value_error("expected finite velocities of a callback, found another in row " +
                                std::to_string(i));
    for (py::ssize_t i = 0; i < rows.shape(0); ++i)
      state.particles.velocity[static_cast<std::size_t>(i)].setXyz({rows(i, 0), rows(i, 1), rows(i, 2)});
  }

  std::shared_ptr<py::function> callback_;
  std::shared_ptr<CallbackFailure> failure_;
  pid_t process_ = getpid();
};

}  // namespace

NamedEffect velocityCallback(py::function callback, std::shared_ptr<CallbackFailure> failure) {
  return {"python", std::make_shared<const VelocityCallback>(std::move(callback), std::move(failure))};
}

/// While there is one, nothing else may use the simulation.
class HeldSimulation::Busy {
 public:
  explicit Busy(const HeldSimulation& held) : held_(held) { held_.busy_ = true; }
  ~Busy() { held_.busy_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  const HeldSimulation& held_;
};

HeldSimulation::HeldSimulation(const Scene& scene, int threads) : process_(getpid()) {
  checkedThreads(threads);
  const Unlocked unlocked;
  requireSteppable(scene.boundary, scene.file);
  simulation_ = std::make_unique<Simulation>(scene, threads);
}

HeldSimulation::~HeldSimulation() {
  if (simulation_ == nullptr) return;
  if (getpid() != process_) {
    // Its threads are those of the other process: nobody would end them here.
    static_cast<void>(simulation_.release());
    return;
  }
  detachViews();
}

Simulation& HeldSimulation::use() const {
  if (simulation_ == nullptr)
    throw std::runtime_error("expected an open simulation, found one that was closed");
  refuseAfterFork(process_);
  // Between two frames of a run it belongs to the callback: the run goes on when that is over, whatever
  // others do meanwhile.
  const bool others = calledBack_ != std::thread::id() && calledBack_ != std::this_thread::get_id();
  if (busy_ || others)
    throw std::runtime_error(
        "expected a simulation at rest, found one that is stepping, perhaps in another thread");
  return *simulation_;
}

/// Arrays that are still held get the memory for themselves.
void HeldSimulation::detachViews() {
  for (std::size_t k = 0; k < kArrays; ++k) {
    if (const std::shared_ptr<Lease> lease = leases_[k].lock())
      lease->memory = simulation_->detach(static_cast<FrameArray>(k));
    leases_[k].reset();
  }
}

void HeldSimulation::raiseTrouble() const {
  const RunStatistics& statistics = simulation_->statistics();
  const std::string what = statistics.trouble.empty()
                               ? "the simulation has stopped"
                               : statistics.trouble.back().kind + ": " + statistics.trouble.back().detail;
  const py::object type = py::module_::import("migiwa._errors").attr("NumericalError");
  PyErr_SetObject(type.ptr(), type(what).ptr());
  throw py::error_already_set();
}

void HeldSimulation::step(long frames) {
  use();
  refuseInRun();
  if (frames < 0)
    throw py::value_error("expected a number of frames from 0 on, found " + std::to_string(frames));
  for (long k = 0; k < frames; ++k) {
    refuseAtTheEnd();
    Simulation& simulation = use();
    if (simulation.stopped()) raiseTrouble();
    detachViews();
    {
      const Busy busy(*this);
      const Unlocked unlocked;
      simulation.advanceFrame();
    }
    if (failure_->thrown) std::rethrow_exception(std::exchange(failure_->thrown, nullptr));
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  if (frames > 0 && use().stopped()) raiseTrouble();
}

void HeldSimulation::runUntil(double until, const py::object& eachFrame) {
  Simulation& simulation = use();
  refuseInRun();
  if (!std::isfinite(until)) throw py::value_error("expected a finite time (s), found another");
  if (!eachFrame.is_none() && PyCallable_Check(eachFrame.ptr()) == 0)
    throw py::type_error("expected something to call for each frame, found " +
                         py::repr(eachFrame).cast<std::string>());
  if (simulation.frameAt(until) < simulation.frame()) {
    std::ostringstream text;
    text << "expected at least " << simulation.time() << " s, the time of the simulation, found " << until
         << " s";
    throw py::value_error(text.str());
  }
  requireReachable(simulation.scene(), until, "until");
  if (simulation.stopped()) raiseTrouble();
  std::exception_ptr failure;
  detachViews();
  {
    const Busy busy(*this);
    const Unlocked unlocked;
    using Clock = std::chrono::steady_clock;
    Clock::time_point looked = Clock::now();
    const bool calls = !eachFrame.is_none();
    migiwa::runUntil(simulation, until, sampler_, [&] {
      // The lock is asked for only where it is needed: others may hold it for long.
      constexpr std::chrono::milliseconds kSignals{100};
      if (!calls && !failure_->thrown && Clock::now() - looked < kSignals) return true;
      const py::gil_scoped_acquire acquire;
      looked = Clock::now();
      return afterFrame(eachFrame, failure);
    });
  }
  if (failure) std::rethrow_exception(failure);
  sampledUntil_ = simulation.frame();
  if (simulation.stopped()) raiseTrouble();
}

/// The frame is over: the callback may look at it and change settings, but not step. Returns whether to go
/// on.
bool HeldSimulation::afterFrame(const py::object& eachFrame, std::exception_ptr& failure) {
  bool goOn = true;
  try {
    refuseAtTheEnd();
    if (failure_->thrown) std::rethrow_exception(std::exchange(failure_->thrown, nullptr));
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!eachFrame.is_none()) {
      calledBack_ = std::this_thread::get_id();
      busy_ = false;
      const py::object result = eachFrame();
      refuseAfterFork(process_);
      goOn = !(py::isinstance<py::bool_>(result) && !result.cast<bool>());
    }
  } catch (...) {
    failure = std::current_exception();
    goOn = false;
  }
  busy_ = true;
  calledBack_ = {};
  detachViews();
  return goOn;
}

void HeldSimulation::refuseInRun() const {
  if (calledBack_ != std::thread::id())
    throw std::runtime_error("expected the end of a run before the next step, found a callback of it");
}

py::array HeldSimulation::view(FrameArray which) {
  const FrameView view = use().view();
  const auto at = static_cast<std::size_t>(which);
  std::shared_ptr<Lease> lease = leases_[at].lock();
  if (lease == nullptr) leases_[at] = lease = std::make_shared<Lease>();
  const py::capsule owner(new std::shared_ptr<Lease>(lease),
                          [](void* held) { delete static_cast<std::shared_ptr<Lease>*>(held); });
  const auto vectors = [&](std::span<const Float4> values) {
    constexpr py::ssize_t kFloat = sizeof(float), kRow = sizeof(Float4);
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(values.size()), 3}, strides{kRow, kFloat};
    return py::array(py::dtype::of<float>(), shape, strides, values.data(), owner);
  };
  const auto numbers = [&](const auto& values) {
    using Value = std::remove_cvref_t<decltype(values[0])>;
    return py::array(py::dtype::of<Value>(),
                     std::vector<py::ssize_t>{static_cast<py::ssize_t>(values.size())},
                     std::vector<py::ssize_t>{sizeof(Value)}, values.data(), owner);
  };
  const auto make = [&]() -> py::array {
    switch (which) {
      case FrameArray::positions:
        return vectors(view.positions);
      case FrameArray::velocities:
        return vectors(view.velocities);
      case FrameArray::density:
        return numbers(view.density);
      case FrameArray::gamma:
        return numbers(view.gamma);
      case FrameArray::lambda:
        return numbers(view.lambda);
      case FrameArray::pressure:
        return numbers(view.pressure);
      case FrameArray::ids:
        return numbers(view.ids);
    }
    throw std::logic_error("no such array");
  };
  py::array array = make();
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

bool HeldSimulation::current(const py::array& array) const {
  const FrameView view = use().view();
  const auto within = [&](const auto& values) {
    const auto* const data = static_cast<const std::byte*>(array.data());
    const auto* const begin = reinterpret_cast<const std::byte*>(values.data());
    return data >= begin && data < begin + values.size_bytes();
  };
  return within(view.positions) || within(view.velocities) || within(view.density) || within(view.gamma) ||
         within(view.lambda) || within(view.pressure) || within(view.ids);
}

void HeldSimulation::apply(const Scene& scene) {
  Simulation& simulation = use();
  if (startOf(scene) != startOf(simulation.scene()))
    throw py::value_error(
        "expected a change of the solver, of how walls are corrected or of effects, which a running "
        "simulation can take "
        "over; found one that needs a new simulation");
  Settings settings{scene.solver, scene.boundary, scene.effects};
  settings.effects.insert(settings.effects.end(), callbacks_.begin(), callbacks_.end());
  detachViews();
  const Busy busy(*this);
  const Unlocked unlocked;
  simulation.apply(settings);
}

void HeldSimulation::addVelocityCallback(py::function callback) {
  Simulation& simulation = use();
  Settings settings = simulation.settings();
  NamedEffect effect = velocityCallback(std::move(callback), failure_);
  settings.effects.push_back(effect);
  detachViews();
  simulation.apply(settings);
  callbacks_.push_back(std::move(effect));
}

SurfaceMesh HeldSimulation::surface(double resolution, int smoothing, double smallest) const {
  const auto check = [](const char* name, double value, const Range& range) {
    if (!range.contains(value))
      throw py::value_error(std::string("expected ") + name + " " + range.text() + ", found " +
                            std::to_string(value));
  };
  check("a resolution", resolution, Range::closed(0.1, 2));
  check("smoothing", smoothing, Range::closed(0, 100));
  check("the smallest piece", smallest, Range::closed(0, 1e9));
  const Simulation& simulation = use();
  const Busy busy(*this);
  const Unlocked unlocked;
  ThreadPool pool(simulation.threads());
  SceneSurface surface(simulation.scene(), {resolution, smoothing, smallest}, pool);
  return surface.mesh(simulation.view().positions, simulation.view().velocities, simulation.time());
}

std::string HeldSimulation::report() const {
  const Simulation& simulation = use();
  SettledMeasures settled;
  if (sampledUntil_ == simulation.frame()) {
    settled = sampler_.result();
  } else {
    SettledSampler now;
    now.sample(simulation);
    settled = now.result();
  }
  return reportText(makeReport(simulation, settled, {}));
}

void HeldSimulation::save(const std::string& file) {
  Simulation& simulation = use();
  const Busy busy(*this);
  const Unlocked unlocked;
  writeSave(file, simulation, sampler_, {});
}

void HeldSimulation::resume(const std::string& file) {
  Simulation& simulation = use();
  const Busy busy(*this);
  const Unlocked unlocked;
  readSave(file, simulation, sampler_);
}

void HeldSimulation::writeParticles(const std::string& file, const std::string& format,
                                    const std::vector<std::string>& fields) const {
  const Simulation& simulation = use();
  std::string names;
  for (const ParticleFieldInfo& info : particleFields())
    names += (names.empty() ? "" : ", ") + std::string(info.name);
  const auto known = [](const std::string& field) {
    return std::ranges::any_of(particleFields(),
                               [&](const ParticleFieldInfo& info) { return info.name == field; });
  };
  if (const auto unknown = std::ranges::find_if_not(fields, known); unknown != fields.end())
    throw py::value_error("expected some of " + names + " for fields, found \"" + *unknown + "\"");
  for (const ParticleFormat& candidate : particleFormats()) {
    if (candidate.name != format) continue;
    if (!fields.empty() && !candidate.holdsFields)
      throw py::value_error("expected no fields in a file of the format " + format +
                            ", which holds positions only");
    ParticleFrame frame =
        copyParticles(simulation.view(), simulation.frame(), fields, simulation.scene().origin);
    frame.sortById();
    return writeTextFile(file, candidate.text(frame));
  }
  throw py::value_error("expected a file that ends in .ply, .vtk or .obj, found \"" + file + "\"");
}

void HeldSimulation::close() {
  if (simulation_ == nullptr) return;
  use();
  refuseInRun();
  detachViews();
  simulation_.reset();
  callbacks_.clear();
}

}  // namespace migiwa::python

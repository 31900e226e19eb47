// The Python module migiwa._core: what is wrong becomes exceptions that name the place, as the program says
// it.
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>

#include <migiwa/version.h>
#include <pthread.h>

#include "core/base/messages.h"
#include "python/bindings/bindings.h"

namespace migiwa::python {

namespace {

std::atomic<int> computations = 0;
std::atomic<std::thread::id> ending;  ///< the thread that ends the interpreter; none before

/// Of the interpreter, for atexit: waits for computations of other threads. Not for ever, for a callback of
/// theirs may wait for this thread.
void waitForComputations() {
  ending = std::this_thread::get_id();
  const py::gil_scoped_release release;
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kLongest{60};
  constexpr std::chrono::milliseconds kPause{1};
  for (const Clock::time_point start = Clock::now(); computations > 0 && Clock::now() - start < kLongest;)
    std::this_thread::sleep_for(kPause);
}

/// Raises the class of that name of the module: its one argument is the list of (place, message).
void raiseInputError(const InputError& error) {
  py::list faults;
  for (const Fault& fault : error.faults()) faults.append(py::make_tuple(fault.place, fault.message));
  const py::object type = py::module_::import("migiwa._errors").attr("InputError");
  PyErr_SetObject(type.ptr(), type(faults).ptr());
}

void raiseMissingError(const MissingError& error) {
  const py::object type = py::module_::import("migiwa._errors").attr("MissingError");
  PyErr_SetObject(type.ptr(), type(error.what()).ptr());
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 names the type
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raiseInputError(error);
  } catch (const MissingError& error) {
    raiseMissingError(error);
  }
}

}  // namespace

Unlocked::Count::Count() {
  refuseAtTheEnd();
  ++computations;
}
Unlocked::Count::~Count() {
  --computations;
}
Unlocked::Unlocked() = default;

void refuseAtTheEnd() {
  const std::thread::id by = ending;
  if (by != std::thread::id() && by != std::this_thread::get_id())
    throw std::runtime_error("expected an interpreter that goes on, found one that is ending");
}

std::vector<Vec3d> pointsOf(const PointArray& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw py::value_error(std::string("expected ") + name + " of shape (N, 3), found another");
  const auto rows = array.unchecked<2>();
  std::vector<Vec3d> points;
  points.reserve(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    points.emplace_back(rows(i, 0), rows(i, 1), rows(i, 2));
    if (!points.back().allFinite())
      throw py::value_error(std::string("expected finite numbers in ") + name + ", found another in row " +
                            std::to_string(i));
  }
  return points;
}

py::array_t<double> arrayOf(const std::vector<Vec3d>& vectors) {
  py::array_t<double> array({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  auto rows = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < rows.shape(0); ++i)
    for (py::ssize_t axis = 0; axis < 3; ++axis) rows(i, axis) = vectors[static_cast<std::size_t>(i)][axis];
  return array;
}

py::array_t<double> arrayOf(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

int checkedThreads(int threads) {
  constexpr int kMost = 256;
  if (threads < 0 || threads > kMost)
    throw py::value_error("expected threads from 0, all of the machine, to 256, found " +
                          std::to_string(threads));
  return threads;
}

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of migiwa.";
  module.attr("__version__") = MIGIWA_VERSION;
  py::register_exception_translator(translate);
  // Computations of other threads are none of a process that was forked.
  pthread_atfork(nullptr, nullptr, [] { computations = 0; });
  py::module_::import("atexit").attr("register")(py::cpp_function(waitForComputations));
  bindScene(module);
  bindSlim(module);
  bindSimulation(module);
}

}  // namespace migiwa::python

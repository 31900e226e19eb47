// What the parts of the Python module share: arrays of NumPy and the functions that bind each part.
#pragma once

#include <cstddef>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "core/base/math.h"

namespace migiwa::python {

namespace py = pybind11;

/// Points as the Python side hands them over: float64, N rows of three.
using PointArray = py::array_t<double, py::array::c_style>;

/// Throws ValueError unless the array has rows of three finite numbers; `name` is that of the argument.
std::vector<Vec3d> pointsOf(const PointArray& array, const char* name);
/// New arrays of shape (N, 3) and (N,).
py::array_t<double> arrayOf(const std::vector<Vec3d>& vectors);
py::array_t<double> arrayOf(const std::vector<double>& numbers);

/// Gives the interpreter's lock up as long as it lives, for a computation of ours. The interpreter's end
/// waits until there is none: a thread that asked for the lock later would be ended in the midst of it.
/// Throws RuntimeError in the threads that go on after that.
class Unlocked {
 public:
  Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  /// Counts the computations; it goes when the lock is there again.
  struct Count {
    Count();
    ~Count();
    Count(const Count&) = delete;
    Count& operator=(const Count&) = delete;
  };
  Count count_;
  py::gil_scoped_release release_;
};
/// Throws RuntimeError when the interpreter has come to its end and this is another thread than ends it.
void refuseAtTheEnd();

/// Throws ValueError unless `threads` is in [0, 256].
int checkedThreads(int threads);

void bindScene(py::module_& module);
void bindSlim(py::module_& module);
void bindSimulation(py::module_& module);

}  // namespace migiwa::python

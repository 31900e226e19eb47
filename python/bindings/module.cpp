// The Python module migiwa._core: what is wrong becomes exceptions that name the place, as the program says
// it.
#include <cmath>
#include <exception>
#include <string>

#include <migiwa/version.h>

#include "core/base/messages.h"
#include "python/bindings/bindings.h"

namespace migiwa::python {

namespace {

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
  bindScene(module);
  bindSlim(module);
  bindSimulation(module);
}

}  // namespace migiwa::python

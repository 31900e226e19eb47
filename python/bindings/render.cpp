// The Python module migiwa._render: pictures as the program draws them. Apart from migiwa._core, so that a
// simulation needs no OpenGL.
#include <algorithm>
#include <memory>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "app/platform/context.h"
#include "app/render/image.h"
#include "app/viewer/viewer.h"
#include "core/base/messages.h"
#include "core/simulation/simulation.h"

namespace migiwa::python {

namespace py = pybind11;

namespace {

/// `simulation`: a capsule of migiwa._core. The interpreter's lock is kept, so that nothing steps meanwhile.
py::array_t<std::uint8_t> render(const py::capsule& simulation, const Scene& scene, int width, int height,
                                 bool panels) {
  constexpr int kMost = 16384;
  if (width < 16 || height < 16 || width > kMost || height > kMost)
    throw py::value_error("expected a size from 16 to " + std::to_string(kMost) + " pixels a side, found " +
                          std::to_string(width) + " by " + std::to_string(height));
  if (simulation.name() != std::string("migiwa.Simulation")) throw py::type_error("expected a simulation");
  const auto& shown = *simulation.get_pointer<const Simulation>();
  try {
    const std::unique_ptr<GlContext> context = makeEglContext();
    Viewer viewer(scene, shown.walls(), {scaleFor(width, height), panels, false, ""});
    const Image image = viewer.takePicture(shown.drawnView(), RunStatus{}, width, height);
    py::array_t<std::uint8_t> pixels({py::ssize_t{height}, py::ssize_t{width}, py::ssize_t{3}});
    auto all = pixels.mutable_unchecked<3>();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int channel = 0; channel < 3; ++channel) all(y, x, channel) = image.pixel(x, y)[channel];
    return pixels;
  } catch (const MissingError& error) {
    const py::object type = py::module_::import("migiwa._errors").attr("MissingError");
    PyErr_SetObject(type.ptr(), type(error.what()).ptr());
    throw py::error_already_set();
  }
}

}  // namespace

PYBIND11_MODULE(_render, module) {
  py::module_::import("migiwa._core");
  module.def("render", render);
}

}  // namespace migiwa::python

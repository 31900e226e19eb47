#include "python/bindings/simulation.h"

#include <algorithm>

#include <pybind11/stl.h>

namespace migiwa::python {

namespace {

/// (kind, step, detail) of each.
py::list troubleOf(const RunStatistics& statistics) {
  py::list all;
  for (const Trouble& trouble : statistics.trouble)
    all.append(py::make_tuple(trouble.kind, trouble.step, trouble.detail));
  return all;
}

template <FrameArray kWhich>
py::array viewOf(HeldSimulation& simulation) {
  return simulation.view(kWhich);
}

py::array_t<std::uint32_t> neighboursOf(const HeldSimulation& simulation) {
  const auto counts = simulation.use().view().neighbours;
  return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(counts.size()), counts.data());
}

/// Rows of three.
template <class Value, class Triples>
py::array_t<Value> rowsOf(const Triples& triples) {
  py::array_t<Value> array({static_cast<py::ssize_t>(triples.size()), py::ssize_t{3}});
  Value* row = array.mutable_data();
  for (const auto& triple : triples) row = std::copy_n(triple.data(), 3, row);
  return array;
}

/// Positions, triangles, normals, velocities, wet.
py::tuple surfaceOf(const HeldSimulation& held, double resolution, int smoothing, double smallest) {
  const SurfaceMesh mesh = held.surface(resolution, smoothing, smallest);
  py::array_t<bool> wet(static_cast<py::ssize_t>(mesh.wet.size()));
  std::ranges::copy(mesh.wet, wet.mutable_data());
  return py::make_tuple(rowsOf<float>(mesh.positions), rowsOf<std::uint32_t>(mesh.triangles),
                        rowsOf<float>(mesh.normals), rowsOf<float>(mesh.velocities), wet);
}

}  // namespace

void bindSimulation(py::module_& module) {
  py::class_<HeldSimulation>(module, "Simulation", "A scene in motion.")
      .def(py::init<const Scene&, int>(), py::arg("scene"), py::arg("threads") = 0)
      .def("_step", &HeldSimulation::step)
      .def("_run_until", &HeldSimulation::runUntil)
      .def("_apply", &HeldSimulation::apply)
      .def("_on_velocities", &HeldSimulation::addVelocityCallback)
      .def("_surface", surfaceOf)
      .def("_report", &HeldSimulation::report)
      .def("_save", &HeldSimulation::save)
      .def("_resume", &HeldSimulation::resume)
      .def("_write_particles", &HeldSimulation::writeParticles)
      .def("_is_current", &HeldSimulation::current)
      .def("_watch_pressure", [](HeldSimulation& held, bool on) { held.use().watchPressure(on); })
      .def("_scene_copy", [](const HeldSimulation& held) { return Scene(held.use().scene()); })
      .def("_capsule",
           [](const HeldSimulation& held) { return py::capsule(&held.use(), "migiwa.Simulation"); })
      .def("close", &HeldSimulation::close, "Ends it. Arrays that are still held keep their values.")
      .def_property_readonly("closed", &HeldSimulation::closed)
      .def_property_readonly("positions", viewOf<FrameArray::positions>)
      .def_property_readonly("velocities", viewOf<FrameArray::velocities>)
      .def_property_readonly("density", viewOf<FrameArray::density>)
      .def_property_readonly("gamma", viewOf<FrameArray::gamma>)
      .def_property_readonly("lambda_", viewOf<FrameArray::lambda>)
      .def_property_readonly("pressure", viewOf<FrameArray::pressure>)
      .def_property_readonly("ids", viewOf<FrameArray::ids>)
      .def_property_readonly("neighbours", neighboursOf)
      .def_property_readonly("time", [](const HeldSimulation& held) { return held.use().time(); })
      .def_property_readonly("frame", [](const HeldSimulation& held) { return held.use().frame(); })
      .def_property_readonly("threads", [](const HeldSimulation& held) { return held.use().threads(); })
      .def_property_readonly("stopped", [](const HeldSimulation& held) { return held.use().stopped(); })
      .def_property_readonly("state_hash",
                             [](const HeldSimulation& held) { return hexDigits(held.use().stateHash()); })
      .def_property_readonly("_trouble",
                             [](const HeldSimulation& held) { return troubleOf(held.use().statistics()); })
      .def("__len__", [](const HeldSimulation& held) { return held.use().view().positions.size(); });
}

}  // namespace migiwa::python

// Scenes, and their walls asked at any points.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <migiwa/gamma.h>
#include <migiwa/scene.h>
#include <pybind11/stl.h>

#include "python/bindings/bindings.h"

namespace migiwa::python {

namespace {

using Changes = std::vector<std::pair<std::string, std::string>>;

/// Of (pointer, JSON text).
std::vector<Override> overridesOf(const Changes& changes) {
  std::vector<Override> overrides;
  for (const auto& [pointer, value] : changes)
    overrides.push_back(Override::parse(std::string(pointer).append("=").append(value)));
  return overrides;
}

/// gamma, its gradient and the distance at each point.
py::tuple gammaAt(const Scene& scene, const PointArray& array, int threads) {
  const std::vector<Vec3d> points = pointsOf(array, "points");
  checkedThreads(threads);
  std::vector<double> gamma, distance;
  std::vector<Vec3d> gradient;
  {
    const Unlocked unlocked;
    for (const WallAnswer& answer : WallQuery(scene, threads).answers(points)) {
      gamma.push_back(answer.gamma);
      gradient.push_back(answer.gradient);
      distance.push_back(answer.distance);
    }
  }
  return py::make_tuple(arrayOf(gamma), arrayOf(gradient), arrayOf(distance));
}

/// Distance and normal at each point.
py::tuple distancesAt(const Scene& scene, const PointArray& array) {
  const std::vector<Vec3d> points = pointsOf(array, "points");
  std::vector<double> distances;
  std::vector<Vec3d> normals;
  {
    const Unlocked unlocked;
    const Boundary boundary(wallsFor(scene.surfaces, static_cast<float>(scene.supportRadius())));
    for (const Vec3d& point : points) {
      Vec3f normal;
      distances.push_back(
          static_cast<double>(boundary.distance((point - scene.origin).cast<float>(), normal)));
      normals.emplace_back(normal.cast<double>());
    }
  }
  return py::make_tuple(arrayOf(distances), arrayOf(normals));
}

/// A tuple of x, y, z (m).
py::tuple vectorOf(const Vec3d& vector) {
  return py::make_tuple(vector.x(), vector.y(), vector.z());
}

}  // namespace

void bindScene(py::module_& module) {
  py::class_<Scene>(module, "Scene", "A scene that was read and found valid.")
      .def_static(
          "_read",
          [](const std::string& file, const Changes& changes) {
            const Unlocked unlocked;
            return readScene(std::filesystem::path(file), overridesOf(changes));
          },
          py::arg("file"), py::arg("changes"))
      .def_static(
          "_parse",
          [](const std::string& text, const std::string& name, const Changes& changes) {
            const Unlocked unlocked;
            return parseScene(text, std::filesystem::path(name), overridesOf(changes));
          },
          py::arg("text"), py::arg("name"), py::arg("changes"))
      .def("_text", [](const Scene& scene) { return writeScene(scene); })
      .def("_gamma", gammaAt, py::arg("points"), py::arg("threads"))
      .def("_distances", distancesAt, py::arg("points"))
      .def_property_readonly("file", [](const Scene& scene) { return scene.file.string(); })
      .def_readonly("name", &Scene::name)
      .def_readonly("duration", &Scene::duration)
      .def_readonly("particle_spacing", &Scene::particleSpacing)
      .def_property_readonly("support_radius", &Scene::supportRadius)
      .def_property_readonly("time_step", [](const Scene& scene) { return scene.solver.timeStep; })
      .def_property_readonly("origin", [](const Scene& scene) { return vectorOf(scene.origin); })
      .def_readonly("warnings", &Scene::warnings)
      .def("__repr__", [](const Scene& scene) { return "<migiwa.Scene '" + scene.file.string() + "'>"; });
  module.def("_schema", sceneSchema);
}

}  // namespace migiwa::python

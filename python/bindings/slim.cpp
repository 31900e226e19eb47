// SLIM surfaces: fitted to files and points, kept in files, asked at any points.
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <migiwa/slim.h>
#include <pybind11/stl.h>

#include "core/base/files.h"
#include "python/bindings/bindings.h"

namespace migiwa::python {

namespace {

/// A fitted surface and what is needed to keep it.
class SlimFitted {
 public:
  explicit SlimFitted(SlimData data, std::vector<std::string> notes = {}, int threads = 0)
      : data_(std::move(data)), notes_(std::move(notes)) {
    ThreadPool pool(threads);
    model_ = std::make_unique<SlimModel>(data_.nodes, data_.degree, data_.closed, pool);
  }

  const SlimData& data() const { return data_; }
  const SlimModel& model() const { return *model_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  SlimData data_;
  std::vector<std::string> notes_;
  std::unique_ptr<SlimModel> model_;
};

SlimFitOptions optionsOf(int degree, double tolerance, int nodes) {
  if (degree < 1 || degree > 3)
    throw py::value_error("expected a degree from 1 to 3, found " + std::to_string(degree));
  if (!(tolerance >= 0) || std::isinf(tolerance))
    throw py::value_error("expected a tolerance of more than 0 m");
  if (nodes < 0) throw py::value_error("expected at least one node, found " + std::to_string(nodes));
  if (tolerance > 0 && nodes > 0)
    throw py::value_error("expected a tolerance or a number of nodes, found both");
  SlimFitOptions options;
  options.degree = degree;
  options.tolerance = tolerance;
  options.nodes = nodes;
  return options;
}

std::unique_ptr<SlimFitted> fitted(const ImportedShape& shape, const SlimFitOptions& options, int threads) {
  ThreadPool pool(threads);
  return std::make_unique<SlimFitted>(fitShape(shape, options, pool), shape.notes, threads);
}

std::unique_ptr<SlimFitted> fitFile(const std::string& file, int degree, double tolerance, int nodes,
                                    int threads) {
  const SlimFitOptions options = optionsOf(degree, tolerance, nodes);
  checkedThreads(threads);
  const Unlocked unlocked;
  return fitted(importShape(file), options, threads);
}

std::unique_ptr<SlimFitted> fitPointArrays(const PointArray& positions, const PointArray& normals, int degree,
                                           double tolerance, int nodes, int threads) {
  const SlimFitOptions options = optionsOf(degree, tolerance, nodes);
  checkedThreads(threads);
  const std::vector<Vec3d> places = pointsOf(positions, "points"), directions = pointsOf(normals, "normals");
  if (places.size() != directions.size())
    throw py::value_error("expected as many normals as points, found " + std::to_string(directions.size()) +
                          " and " + std::to_string(places.size()));
  const Unlocked unlocked;
  ImportedShape shape;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double length = directions[i].norm();
    shape.cloud.points.push_back(
        {places[i].cast<float>(),
         (length > 0 ? Vec3d(directions[i] / length) : Vec3d(Vec3d::Zero())).cast<float>()});
  }
  shape.closed = shape.cloud.closed = repairCloud(shape.cloud.points, "points", shape.notes);
  return fitted(shape, options, threads);
}

py::tuple distancesOf(const SlimFitted& surface, const PointArray& array) {
  const std::vector<Vec3d> points = pointsOf(array, "points");
  std::vector<double> distances;
  std::vector<Vec3d> normals;
  {
    const Unlocked unlocked;
    for (const Vec3d& point : points) {
      const SlimModel::Nearest nearest = surface.model().nearest(point.cast<float>());
      distances.push_back(static_cast<double>(nearest.distance));
      normals.emplace_back(nearest.normal.cast<double>());
    }
  }
  return py::make_tuple(arrayOf(distances), arrayOf(normals));
}

py::tuple valuesOf(const SlimFitted& surface, const PointArray& array) {
  const std::vector<Vec3d> points = pointsOf(array, "points");
  std::vector<double> values, weights;
  std::vector<Vec3d> gradients;
  for (const Vec3d& point : points) {
    const SlimModel::Value value = surface.model().evaluate(point.cast<float>());
    values.push_back(static_cast<double>(value.f));
    weights.push_back(static_cast<double>(value.weight));
    gradients.emplace_back(value.gradient.cast<double>());
  }
  return py::make_tuple(arrayOf(values), arrayOf(weights), arrayOf(gradients));
}

/// Centres and radii of the nodes (m).
py::tuple nodesOf(const SlimFitted& surface) {
  std::vector<Vec3d> centres;
  std::vector<double> radii;
  for (const SlimNode& node : surface.model().nodes()) {
    centres.emplace_back(node.centre.cast<double>());
    radii.push_back(static_cast<double>(node.radius));
  }
  return py::make_tuple(arrayOf(centres), arrayOf(radii));
}

}  // namespace

void bindSlim(py::module_& module) {
  py::class_<SlimFitted>(module, "SlimSurface", "A surface of balls with a polynomial each.")
      .def_static("_fit_file", fitFile)
      .def_static("_fit_points", fitPointArrays)
      .def_static("_read",
                  [](const std::string& file) {
                    const Unlocked unlocked;
                    return std::make_unique<SlimFitted>(readSlimFile(file));
                  })
      .def("_save",
           [](const SlimFitted& surface, const std::string& file) {
             const Unlocked unlocked;
             writeTextFile(file, slimFileText(surface.data()));
           })
      .def("_distances", distancesOf)
      .def("_values", valuesOf)
      .def("_nodes", nodesOf)
      .def_property_readonly("degree", [](const SlimFitted& surface) { return surface.model().degree(); })
      .def_property_readonly("closed", [](const SlimFitted& surface) { return surface.model().closed(); })
      .def_property_readonly("notes", &SlimFitted::notes)
      .def_property_readonly("largest_error",
                             [](const SlimFitted& surface) { return surface.data().statistics.largest; })
      .def_property_readonly("mean_error",
                             [](const SlimFitted& surface) { return surface.data().statistics.mean; })
      .def("__len__", [](const SlimFitted& surface) { return surface.model().nodes().size(); });
}

}  // namespace migiwa::python

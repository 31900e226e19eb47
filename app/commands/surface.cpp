// `migiwa surface`: the surface of the liquid as meshes, from a run or from exported particles.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/commands/command.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/io/particle_export.h"
#include "core/io/surface_files.h"
#include "core/scene/scene.h"
#include "core/simulation/scene_surface.h"
#include "core/simulation/simulation.h"

namespace migiwa {

namespace {

struct SurfaceJob {
  std::string scene;
  std::vector<std::string> particles;
  std::string out, format;
  std::optional<double> every, until;  ///< (s)
  std::optional<double> spacing;       ///< (m)
  std::optional<double> resolution;    ///< (spacings)
  std::optional<int> smoothing;
  std::optional<double> dropBelow;  ///< (particles)
  bool forBlender = false;
};

/// What was asked for, looked at before anything is simulated or written.
class SurfaceCommand {
 public:
  SurfaceCommand(const SurfaceJob& job, const CommonOptions& common) : job_(job), common_(common) {
    FaultCollector collect;
    if (!job.scene.empty()) {
      collect([&] {
        scene_ = readScene(job.scene, common.overrides);
        requireSteppable(scene_->boundary, scene_->file);
      });
    } else if (job.particles.empty()) {
      collect.add({"SCENE", "expected a scene to run, or --particles FILE..., found neither"});
    } else {
      if (!job.spacing)
        collect.add({"--spacing", "expected the particles' spacing where there is no scene, found none"});
      if (!common.overrides.empty()) collect.add({"--set", "expected a scene that it changes, found none"});
    }
    if (job.particles.empty()) {
      if (!job.every && !job.scene.empty())
        collect.add({"--every", "expected the time from one mesh to the next, found none"});
    } else {
      if (job.every) collect.add({"--every", "expected none with --particles, whose files are the times"});
      if (job.until) collect.add({"--until", "expected none with --particles, found one"});
    }
    if (job.spacing && scene_)
      collect.add({"--spacing", "expected none with a scene, which has its own, found one"});
    collect([&] { requireNumber("--every", job.every, Range::positive(kLongestRun), "s"); });
    collect([&] { requireNumber("--until", job.until, Range::closed(0, kLongestRun), "s"); });
    if (scene_ && job.until && Range::closed(0, kLongestRun).contains(*job.until))
      collect([&] { requireReachable(*scene_, *job.until, "--until"); });
    collect([&] { requireNumber("--spacing", job.spacing, Range::positive(1e6), "m"); });
    collect([&] { requireNumber("--resolution", job.resolution, Range::closed(0.1, 2), "spacings"); });
    collect([&] { requireNumber("--drop-below", job.dropBelow, Range::closed(0, 1e9), "particles"); });
    findFormat(collect);
    if (job.forBlender && format_ != nullptr && format_->name != "ply")
      collect.add({"--for-blender", "expected --format ply with it, found " + job.format});
    collect([&] { makeFolder(job.out, "--out"); });
    collect.raise();
    options_.resolution = job.resolution.value_or(options_.resolution);
    options_.smoothing = job.smoothing.value_or(options_.smoothing);
    options_.smallest = job.dropBelow.value_or(0);
    options_.place = "--resolution";
  }

  int run() {
    if (!scene_) {
      scene_.emplace();
      scene_->particleSpacing = *job_.spacing;
    }
    return job_.particles.empty() ? runScene() : convertFiles();
  }

 private:
  void findFormat(FaultCollector& collect) {
    std::vector<std::string_view> names;
    for (const SurfaceFormat& format : surfaceFormats()) {
      names.push_back(format.name);
      if (job_.format.empty() ? names.size() == 1 : format.name == job_.format) format_ = &format;
    }
    if (format_ == nullptr)
      collect.add({"--format", "expected one of " + quotedList(names) + ", found \"" + job_.format + "\""});
  }

  int runScene() {
    Simulation simulation(*scene_, common_.threads);
    ThreadPool pool(common_.threads);
    SceneSurface surface(simulation.scene(), options_, pool);
    for (const std::string& warning : simulation.scene().warnings)
      std::cerr << job_.scene << ": warning: " << warning << '\n';
    if (simulation.view().positions.empty() && scene_->emitters.empty())
      throw InputError(job_.scene,
                       "expected particles or emitters, found neither: there is no liquid to show");
    const double until = job_.until.value_or(scene_->duration);
    const long last = simulation.frameAt(until);
    const ExportSchedule times(*job_.every, scene_->solver.timeStep);
    TroubleNotes trouble(job_.scene);
    {
      ProgressBar progress(0, until, common_.quiet);
      while (true) {
        trouble.look(simulation.statistics(), progress);
        const long frame = simulation.frame();
        if (simulation.stopped()) break;
        if (times.due(frame) || frame >= last) {
          const FrameView view = simulation.view();
          const SurfaceMesh mesh = surface.mesh(view.positions, view.velocities, simulation.time());
          write(scene_->stem() + numbered(entries_.size()), mesh, simulation.time(), view.positions.size());
        }
        if (frame >= last) break;
        simulation.advanceFrame();
        progress.update(simulation.time());
      }
    }
    finish(scene_->stem());
    if (!simulation.stopped()) return kDone;
    trouble.finish(simulation.statistics());
    return kNumericalTrouble;
  }

  int convertFiles() {
    ThreadPool pool(common_.threads);
    SceneSurface surface(*scene_, options_, pool);
    ProgressBar progress(0, static_cast<double>(job_.particles.size()), common_.quiet);
    // Frames without particles at the beginning wait for one that has some.
    std::vector<std::pair<std::string, double>> waiting;
    const auto writeFrame = [&](const std::string& file, const ImportedParticles& particles, double time) {
      write(std::filesystem::path(file).stem().string() + "_surface",
            surface.mesh(particles.positions, particles.velocities, time), time, particles.positions.size());
    };
    for (const std::string& file : job_.particles) {
      const ImportedParticles particles = readParticles(file, scene_->origin);
      if (!particles.time && surface.boundary().moves())
        throw InputError(file, "expected the time of the particles, for walls move, found none in the file");
      const double time = particles.time.value_or(0);
      if (particles.positions.empty() && entries_.empty()) {
        waiting.emplace_back(file, time);
      } else {
        for (const auto& [empty, then] : waiting) writeFrame(empty, {}, then);
        waiting.clear();
        writeFrame(file, particles, time);
      }
      progress.update(static_cast<double>(entries_.size() + waiting.size()));
    }
    progress.wipe();
    if (entries_.empty())
      throw InputError(job_.particles.front(),
                       "expected particles, found none" +
                           std::string(job_.particles.size() > 1 ? ", nor in the other files" : ""));
    finish(scene_->file.empty() ? std::filesystem::path(job_.particles.front()).stem().string()
                                : scene_->stem());
    return kDone;
  }

  static std::string numbered(std::size_t number) {
    std::string digits = std::to_string(number);
    return "_surface_" + std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
  }

  void write(const std::string& stem, const SurfaceMesh& mesh, double time, std::size_t particles) {
    const std::string name = stem + "." + std::string(format_->name);
    writeTextFile(std::filesystem::path(job_.out) / name, format_->text({mesh, time, scene_->origin}));
    for (const Vec3f& p : mesh.positions) bounds_.include(p.cast<double>());
    entries_.push_back({{"file", name},
                        {"time", time},
                        {"particles", particles},
                        {"vertices", mesh.positions.size()},
                        {"triangles", mesh.triangles.size()},
                        {"wet_triangles", std::count(mesh.wet.begin(), mesh.wet.end(), std::uint8_t{1})},
                        {"volume", enclosedVolume(mesh)}});
  }

  /// The list names only files that are there.
  void finish(const std::string& stem) {
    nlohmann::ordered_json list;
    list["scene"] = job_.scene;
    list["format"] = format_->name;
    list["resolution"] = options_.resolution;
    list["files"] = entries_;
    const std::string name = stem + "_surface." + std::string(format_->name) + ".json";
    writeTextFile(std::filesystem::path(job_.out) / name, list.dump(2) + "\n");
    if (job_.forBlender) {
      const std::string script = stem + "_surface_blender.py";
      writeTextFile(std::filesystem::path(job_.out) / script, blenderScript(viewFor(name)));
      std::cout << "blender -b -P " << (std::filesystem::path(job_.out) / script).string()
                << " renders them\n";
    }
    std::cout << entries_.size() << (entries_.size() == 1 ? " mesh" : " meshes") << " written to " << job_.out
              << ", listed in " << name << '\n';
  }

  BlenderView viewFor(const std::string& list) const {
    const Bounds bounds = bounds_.empty() ? Bounds{Vec3d::Zero(), Vec3d::Ones()} : bounds_;
    const Camera camera = scene_->file.empty() ? defaultCamera(bounds, scene_->gravity) : scene_->view.camera;
    const double size = bounds.size().norm();
    // A little below what touches the floor, or both would be in one place.
    const Vec3d ground(bounds.center().x(), bounds.min.y() - 0.003 * size, bounds.center().z());
    return {list,
            camera.eye + scene_->origin,
            camera.target + scene_->origin,
            ground + scene_->origin,
            camera.fovDegrees * std::numbers::pi / 180,
            size};
  }

  const SurfaceJob& job_;
  const CommonOptions& common_;
  std::optional<Scene> scene_;
  const SurfaceFormat* format_ = nullptr;
  SurfaceOptions options_;
  std::vector<nlohmann::ordered_json> entries_;
  Bounds bounds_;  ///< of all meshes
};

std::vector<Option> surfaceOptions(SurfaceJob& job) {
  std::string formats;
  for (const SurfaceFormat& format : surfaceFormats())
    formats += (formats.empty() ? "" : "; ") + std::string(format.name) + ": " + std::string(format.holds);
  const std::string files = "From files";
  return {
      {.name = "scene",
       .target = &job.scene,
       .value = "SCENE",
       .help = "Scene file; with --particles for its walls and spacing, and not needed without walls."},
      {.name = "--out",
       .target = &job.out,
       .value = "DIR",
       .help = "Folder for the meshes and their list.",
       .required = true},
      {.name = "--every",
       .target = &job.every,
       .value = "S",
       .help = "Simulated time from one mesh to the next, in s; start and end have one, too."},
      {.name = "--until",
       .target = &job.until,
       .value = "S",
       .help = "Simulated time at the end, in s; left out: the scene's."},
      {.name = "--format",
       .target = &job.format,
       .value = "ply|obj",
       .help = "Of the meshes. " + formats + ".",
       .shownDefault = "ply"},
      {.name = "--resolution",
       .target = &job.resolution,
       .value = "X",
       .help = "Width of the grid's cells in particle spacings, from 0.1 to 2.",
       .shownDefault = "0.5"},
      {.name = "--smoothing",
       .target = &job.smoothing,
       .value = "N",
       .help = "Smoothing passes over the free surface.",
       .range = {{0, 100}},
       .shownDefault = std::to_string(SurfaceOptions{}.smoothing)},
      {.name = "--drop-below",
       .target = &job.dropBelow,
       .value = "N",
       .help = "Leaves out pieces with less volume than so many particles; left out: every droplet is kept."},
      {.name = "--for-blender",
       .target = &job.forBlender,
       .help = "Writes a script as well with which `blender -b -P` renders the meshes."},
      {.name = "--particles",
       .target = &job.particles,
       .value = "FILE...",
       .help = "Exported particles, PLY or VTK, instead of a run; one mesh for each file.",
       .group = files},
      {.name = "--spacing",
       .target = &job.spacing,
       .value = "M",
       .help = "Spacing of the particles at rest, in m, where there is no scene.",
       .group = files}};
}

}  // namespace

Command surfaceCommand() {
  return {
      "surface", "Writes the surface of the liquid as meshes, from a run or from exported particles.", [] {
        const auto job = std::make_shared<SurfaceJob>();
        return Declaration{surfaceOptions(*job),
                           [job](const CommonOptions& common) { return SurfaceCommand(*job, common).run(); }};
      }};
}

}  // namespace migiwa

#include "core/scene/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/base/available_memory.h"
#include "core/scene/fault_list.h"
#include "core/scene/include.h"
#include "core/scene/json_reader.h"
#include "core/scene/json_writer.h"
#include "core/scene/overrides.h"
#include "core/scene/particle_limit.h"
#include "core/scene/run_limit.h"
#include "core/scene/scene_files.h"

namespace migiwa {

namespace {

constexpr std::string_view kSpacing = "/particle_spacing";

/// What takes the whole scene to see: too many steps, too many particles for this machine, or too far away
/// for a float's digits.
void checkWhole(const Scene& scene, FaultList& faults) {
  if (!faults.anyBelow("/duration") && !faults.anyBelow("/solver"))
    if (const auto fault = tooShortStep(scene.solver, scene.duration))
      faults.add("/solver/time_step", *fault);
  if (faults.anyBelow("/fluid") || faults.anyBelow("/emitters") || faults.anyBelow(kSpacing)) return;
  const double spacing = scene.particleSpacing;
  const auto count = [&](double other) { return particleCount(scene, other, scene.duration); };
  if (const auto fault = tooManyParticles(count, spacing, availableMemory())) faults.add(kSpacing, *fault);

  Bounds fluid;
  for (const auto& source : scene.fluid) fluid.include(source->bounds());
  for (const Emitter& emitter : scene.emitters) fluid.include(emitter.bounds());
  if (fluid.empty()) return;
  const double farthest = std::max(fluid.min.cwiseAbs().maxCoeff(), fluid.max.cwiseAbs().maxCoeff());
  const double coarsest = farthest * double(std::numeric_limits<float>::epsilon());
  if (coarsest > spacing / 100) {
    std::ostringstream text;
    text << "expected at least " << 100 * coarsest << " m for fluid as far from the origin as " << farthest
         << " m, where positions are " << coarsest << " m apart, found " << spacing
         << " m; move the scene to the origin or use a larger spacing";
    faults.add(kSpacing, text.str());
  }
}

}  // namespace

Scene parseScene(std::string_view text, const std::filesystem::path& name,
                 const std::vector<Override>& overrides) {
  std::vector<std::filesystem::path> named;
  return parseScene(text, name, overrides, named);
}

Scene parseScene(std::string_view text, const std::filesystem::path& name,
                 const std::vector<Override>& overrides, std::vector<std::filesystem::path>& named) {
  named.clear();
  FaultList faults(name.string());
  Json root = resolveIncludes(text, name, faults);
  applyOverrides(overrides, root, faults);
  Scene scene;
  scene.file = name;
  JsonReader::read(root, "", faults, [&](FieldVisitor& fields) { describeScene(fields, scene); });
  named = faults.files();
  checkWhole(scene, faults);
  if (!faults.empty()) throw InputError(faults.faults());
  scene.warnings = faults.warnings();
  if (scene.name.empty()) scene.name = scene.stem();
  return scene;
}

std::vector<std::filesystem::path> filesNamedBy(const Scene& scene) {
  std::vector<std::filesystem::path> files;
  JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); },
                    [&](const FileName& name) {
                      for (std::filesystem::path& file : filesOfShape(name.path))
                        files.push_back(std::move(file));
                      return Json(name.written);
                    });
  return files;
}

Scene readScene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return parseScene(readTextFile(file, "a scene file"), file, overrides);
}

}  // namespace migiwa

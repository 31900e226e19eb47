#include "app/commands/render_job.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "app/commands/fault_collector.h"
#include "app/commands/option_text.h"
#include "app/ui/number_text.h"
#include "core/base/error.h"
#include "core/simulation/settings.h"

namespace migiwa {
namespace {

std::string note(const Override& change) {
  // How walls are handled stands on every picture anyway.
  if (change.pointer == "/boundary/handling") return "";
  return change.pointer.substr(change.pointer.rfind('/') + 1) + " = " + change.value;
}

void requireDistinctNames(const std::vector<double>& times) {
  std::set<std::string> names;
  for (const double time : times) {
    const std::string name = formatNumber("%.3f", time);
    if (!names.insert(name).second) {
      throw InputError(
          "--times",
          "expected times that differ in their first three decimals, found two that are " + name + " s");
    }
  }
}

void requireFolderName(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored)) {
    throw InputError("--out", "expected a folder, found the file " + folder.string());
  }
}

}  // namespace

RenderJob checkedRenderJob(const RenderOptions& options, const CommonOptions& common) {
  FaultCollector collect;
  RenderJob job;
  job.folder = options.out;
  if (!options.times.empty()) {
    collect([&] {
      job.times = parseTimes(options.times, "--times");
      requireDistinctNames(job.times);
    });
  }
  collect([&] {
    const auto [width, height] = parseSize(options.size, "--size");
    job.width = width, job.height = height;
  });
  collect([&] { requireFolderName(job.folder); });

  const auto addVariant = [&](const std::vector<Override>& overrides, const std::string& itsNote) {
    collect([&] {
      Scene scene = readScene(options.scene, overrides);
      requireSteppable(scene.boundary, scene.file);
      job.variants.push_back({overrides, itsNote, std::move(scene)});
    });
  };
  if (options.compare.empty()) {
    addVariant(common.overrides, "");
  } else {
    std::vector<Override> changes;
    collect([&] { changes = parseVariants(options.compare, "--compare"); });
    for (const Override& change : changes) {
      std::vector<Override> overrides = common.overrides;
      overrides.push_back(change);
      addVariant(overrides, note(change));
    }
    // Not even the option could be read: then the scene itself is still to be looked at.
    if (changes.empty()) addVariant(common.overrides, "");
  }
  collect.raise();

  if (job.times.empty()) {
    const double duration = job.variants.front().scene.duration;
    job.times = {0, duration / 2, duration};
  }
  return job;
}

}  // namespace migiwa

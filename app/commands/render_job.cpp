#include "app/commands/render_job.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <system_error>

#include "app/commands/fault_collector.h"
#include "app/commands/option_text.h"
#include "app/ui/number_text.h"
#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/scene/run_limit.h"
#include "core/simulation/settings.h"

namespace migiwa {
namespace {

constexpr double kBytesOfPixel = 12;  ///< of the sheet, and of what its file is made of

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

/// Cells of a sheet are drawn into one picture: as large as other programs open it.
void requireSheet(const RenderJob& job, std::size_t rows, std::size_t columns) {
  constexpr double kLargestSide = 32767;
  const double width = static_cast<double>(columns) * (job.width + kSheetGutter),
               height = static_cast<double>(rows) * (job.height + kSheetGutter);
  if (width > kLargestSide || height > kLargestSide) {
    std::ostringstream text;
    text << "expected a sheet of at most " << kLargestSide << " pixels a side, found " << columns
         << " times of " << job.width << " and " << rows << " values of " << job.height
         << " pixels; a smaller --size, or fewer of them, would do";
    throw InputError("--compare", text.str());
  }
  requireMemory(kBytesOfPixel * width * height, "a sheet", "--compare");
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
      if (!job.times.empty()) requireReachable(job.variants.back().scene, job.times.back(), "--times");
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
    collect([&] { requireSheet(job, changes.size(), options.times.empty() ? 3 : job.times.size()); });
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

// What `migiwa render` was asked for, looked at and understood before anything is drawn or written.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/commands/command.h"
#include "app/commands/pictures.h"
#include "app/session/section_session.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

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

/// What an option is that the style has no use for.
void requireStyle(const RenderOptions& options, RenderJob& job) {
  job.style = static_cast<RenderStyle>(requireOneOf("--style", options.style, kRenderStyles));
  const bool rayTraced = job.style == RenderStyle::rayTraced;
  job.samples = options.samples.value_or(job.samples);
  job.seed = static_cast<std::uint32_t>(options.seed.value_or(0));
  FaultCollector collect;
  const auto refuse = [&](bool given, const char* option, const char* other) {
    if (given)
      collect([&] {
        throw InputError(
            option, std::string("expected --style ") + other + " beside it, found --style " + options.style);
      });
  };
  refuse(rayTraced && options.panels, "--ui", "particles or water");
  refuse(rayTraced && options.timings, "--timings", "particles or water");
  refuse(rayTraced && options.scale.has_value(), "--scale", "particles or water");
  refuse(rayTraced && options.hideWalls, "--hide-walls", "particles or water");
  refuse(rayTraced && !options.section.plane.empty(), "--plane", "particles or water");
  refuse(rayTraced && !options.section.normal.empty(), "--normal", "particles or water");
  refuse(!rayTraced && options.samples.has_value(), "--samples", "raytraced");
  refuse(!rayTraced && options.seed.has_value(), "--seed", "raytraced");
  collect.raise();
}

/// Where pictures or the film go.
void requirePlace(const RenderOptions& options) {
  FaultCollector collect;
  const bool film = !options.film.empty();
  const auto beside = [&](bool given, const char* option, const std::string& message) {
    if (given) collect.add({option, message});
  };
  beside(film && !options.out.empty(), "--out", "expected it or --film, found both");
  beside(!film && options.out.empty(), "--out",
         "expected a folder for the pictures, or --film with a file, found neither");
  beside(film && !options.times.empty(), "--times", "expected --from and --to beside --film, found --times");
  const bool script = !options.script.empty();
  beside(script && !options.panels, "--script", "expected --ui beside it, found none");
  beside(script && film, "--script", "expected it or --film, found both");
  beside(script && !options.times.empty(), "--script", "expected \"play_to\" in it in place of --times");
  beside(script && !options.compare.empty(), "--script", "expected it or --compare, found both");
  const auto inScript = [&](bool given, const std::string& option) {
    beside(script && given, "--script",
           "expected its events to do what " + option + " does, found " + option);
  };
  inScript(!options.changes.empty(), "--set-at");
  inScript(options.hideWalls, "--hide-walls");
  inScript(!options.section.plane.empty(), "--plane");
  inScript(!options.section.normal.empty(), "--normal");
  beside(!film && options.fps.has_value(), "--fps", "expected --film beside it, found none");
  beside(!film && options.from.has_value(), "--from", "expected --film beside it, found none");
  beside(!film && options.to.has_value(), "--to", "expected --film beside it, found none");
  collect.raise();
}

void requireFilmName(const std::filesystem::path& film) {
  const std::vector<std::string_view> endings = filmEndings();
  std::error_code ignored;
  if (std::find(endings.begin(), endings.end(), film.extension().string()) == endings.end())
    throw InputError("--film", "expected a file whose name ends in one of " + quotedList(endings) +
                                   ", found \"" + film.string() + "\"");
  const std::filesystem::path folder = frameFolder(film);
  if (!filmEncoderInstalled(film) && std::filesystem::exists(folder, ignored))
    throw InputError("--film", "expected no " + folder.string() +
                                   " yet, for without an encoder the frames go there, found one");
}

/// The frames of a film that ends where it is told to, or else with the scene (s).
std::vector<double> filmTimes(const FilmJob& film, double to) {
  if (!(film.fps > 0) || !std::isfinite(film.from) || !std::isfinite(to)) return {};  // told already
  constexpr double kMostFrames = 20000;
  if (film.from > to) {
    std::ostringstream text;
    text << "expected a time at or before the end of the film, " << to << " s, found " << film.from << " s";
    throw InputError("--from", text.str());
  }
  // What is a whole number of frames but for rounding is one.
  const double steps = std::floor((to - film.from) * film.fps + 1e-6);
  if (steps >= kMostFrames) {
    std::ostringstream text;
    text << "expected a film of at most " << kMostFrames << " frames, found " << steps + 1
         << "; fewer --fps, or --from and --to nearer to each other, would do";
    throw InputError("--film", text.str());
  }
  std::vector<double> times;
  for (int k = 0; k <= static_cast<int>(steps); ++k) times.push_back(film.from + k / film.fps);
  return times;
}

void requireFolderName(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored)) {
    throw InputError("--out", "expected a folder, found the file " + folder.string());
  }
}

/// Cells of a sheet are drawn into one picture: as large as other programs open it.
void requireSheet(const RenderJob& job, std::size_t rows, std::size_t columns) {
  constexpr double kLargestSheetSide = 32767;
  const double width = static_cast<double>(columns) * (job.width + kSheetGutter),
               height = static_cast<double>(rows) * (job.height + kSheetGutter);
  if (width > kLargestSheetSide || height > kLargestSheetSide) {
    std::ostringstream text;
    text << "expected a sheet of at most " << kLargestSheetSide << " pixels a side, found " << columns
         << " times of " << job.width << " and " << rows << " values of " << job.height
         << " pixels; a smaller --size, or fewer of them, would do";
    throw InputError("--compare", text.str());
  }
  requireMemory(kBytesOfPixel * width * height, "a sheet", "--compare");
}

/// "S:/POINTER=VALUE".
std::pair<double, Override> laterChange(const std::string& words) {
  const std::size_t colon = words.find(':');
  std::array<double, 1> time{};
  if (colon == std::string::npos || !readNumbers(std::string_view(words).substr(0, colon), time))
    throw InputError("--set-at",
                     "expected a time in s, a colon and a change such as 0.5:/solver/tolerance=0.01, "
                     "found \"" +
                         words + "\"");
  requireNumber("--set-at", time[0], Range::closed(0, kLongestRun), "s");
  return {time[0], Override::parse(std::string_view(words).substr(colon + 1))};
}

/// Each with all that was changed before it.
std::vector<LaterSettings> laterSettings(const RenderOptions& options, const RenderVariant& variant) {
  FaultCollector collect;
  std::vector<std::pair<double, Override>> changes;
  for (const std::string& words : options.changes) collect([&] { changes.push_back(laterChange(words)); });
  collect.raise();
  std::stable_sort(changes.begin(), changes.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<LaterSettings> later;
  std::vector<Override> overrides = variant.overrides;
  const std::string start = startOf(variant.scene);
  for (const auto& [time, change] : changes) {
    overrides.push_back(change);
    const Scene scene = readScene(options.scene, overrides);
    if (startOf(scene) != start)
      throw InputError("--set-at",
                       "expected a setting that can change while a run goes on, of the solver, of an effect "
                       "or of how walls are handled, found " +
                           change.pointer);
    requireSteppable(scene.boundary, scene.file);
    later.push_back({time,
                     {scene.solver, scene.boundary, scene.effects},
                     formatNumber("%g", time) + ":" + change.pointer + "=" + change.value});
  }
  return later;
}

/// What is drawn of a section; nothing where no plane was given.
std::optional<SectionView> sectionOf(const RenderOptions& options, const Scene& scene) {
  const bool given = !options.section.plane.empty() || !options.section.normal.empty();
  FaultCollector collect;
  const auto alone = [&](bool there, const char* option) {
    if (there && !given) collect.add({option, "expected --plane or --normal beside it, found neither"});
  };
  alone(options.section.offset.has_value(), "--offset");
  alone(options.section.field != kSectionFieldNames[0], "--field");
  alone(options.section.divisor != kSectionDivisorNames[0], "--divisor");
  alone(options.noCut, "--no-cut");
  alone(options.noLines, "--no-lines");
  alone(options.fit, "--fit");
  SectionView section{.shown = true, .cut = !options.noCut, .lines = !options.noLines, .fit = options.fit};
  collect([&] { section.field = fieldOf(options.section); });
  collect([&] { section.divisor = divisorOf(options.section); });
  collect.raise();
  if (!given) return std::nullopt;
  const Cut cut = cutOf(options.section, scene);
  section.free = options.section.plane.empty();
  if (section.free)
    section.normal = cut.normal;
  else
    section.axis = static_cast<Axis>(std::string_view("xyz").find(options.section.plane[0]));
  section.at = cut.offset - cut.normal.dot(scene.origin);
  if (!planeOf(section, scene)) refusePlane(options.section, cut, scene);
  return section;
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
  collect([&] { requirePlace(options); });
  collect([&] { requireFolderName(job.folder); });
  if (!options.film.empty()) {
    job.film = {options.film, options.fps.value_or(FilmJob{}.fps), options.from.value_or(0)};
    collect([&] { requireFilmName(job.film->file); });
    collect([&] { requireNumber("--fps", job.film->fps, Range::positive(1000), "1/s"); });
    collect([&] { requireNumber("--from", job.film->from, Range::closed(0, kLongestRun), "s"); });
    collect([&] { requireNumber("--to", options.to, Range::closed(0, kLongestRun), "s"); });
  }
  collect([&] { requireStyle(options, job); });

  const auto addVariant = [&](const std::vector<Override>& overrides, const std::string& itsNote) {
    collect([&] {
      Scene scene = readScene(options.scene, overrides);
      requireSteppable(scene.boundary, scene.file);
      job.variants.push_back({overrides, itsNote, std::move(scene)});
      job.variants.back().later = laterSettings(options, job.variants.back());
      if (!job.times.empty()) requireReachable(job.variants.back().scene, job.times.back(), "--times");
      if (options.to) requireReachable(job.variants.back().scene, *options.to, "--to");
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
    const std::size_t columns = job.film ? 1 : options.times.empty() ? 3 : job.times.size();
    collect([&] { requireSheet(job, changes.size(), columns); });
    // Not even the option could be read: then the scene itself is still to be looked at.
    if (changes.empty()) addVariant(common.overrides, "");
  }
  if (!job.variants.empty()) collect([&] { job.section = sectionOf(options, job.variants.front().scene); });
  job.walls = !options.hideWalls;
  job.scale = options.scale.value_or(scaleFor(job.width, job.height));
  if (options.scale) collect([&] { requireNumber("--scale", job.scale, Range::closed(0.5, 8), "1"); });
  if (job.film && !job.variants.empty())
    collect(
        [&] { job.times = filmTimes(*job.film, options.to.value_or(job.variants.front().scene.duration)); });
  collect.raise();

  if (job.times.empty()) {
    const double duration = job.variants.front().scene.duration;
    job.times = {0, duration / 2, duration};
  }
  return job;
}

std::vector<Option> renderOptions(RenderOptions& options) {
  const std::string film = "Films", section = "A section";
  std::vector<Option> all{
      {.name = "scene", .target = &options.scene, .value = "SCENE", .help = "Scene file.", .required = true},
      {.name = "--out",
       .target = &options.out,
       .value = "DIR",
       .help = "Folder for the pictures NAME_t0.500.png, each with a .json that says what it shows."},
      {.name = "--times",
       .target = &options.times,
       .value = "S,S,...",
       .help = "Simulated times in s, with commas between them; left out: start, middle and end."},
      {.name = "--size",
       .target = &options.size,
       .value = "WIDTHxHEIGHT",
       .help = "Width and height in pixels.",
       .shownDefault = options.size},
      {.name = "--style",
       .target = &options.style,
       .value = "STYLE",
       .help = "particles: as in the window. water: the surface in place of the particles. raytraced: "
               "light is followed through water and walls of glass or matt material.",
       .shownDefault = options.style},
      {.name = "--samples",
       .target = &options.samples,
       .value = "N",
       .help = "Of each pixel of a ray-traced picture.",
       .range = {{kFewestSamples, kMostSamples}},
       .shownDefault = std::to_string(RenderJob{}.samples)},
      {.name = "--seed",
       .target = &options.seed,
       .value = "N",
       .help = "Of the random numbers of a ray-traced picture: the same one gives the same picture.",
       .range = {{0, 4294967295}},
       .shownDefault = "0"},
      {.name = "--ui", .target = &options.panels, .help = "Draws the window's panels, too."},
      {.name = "--script",
       .target = &options.script,
       .value = "FILE",
       .help = "With --ui: a list of events at the window, as docs/window.md has them, and pictures of it, "
               "which go "
               "into --out."},
      {.name = "--timings",
       .target = &options.timings,
       .help = "Shows wall times; without it two runs give the same bytes."},
      {.name = "--scale",
       .target = &options.scale,
       .value = "X",
       .help = "Size of text; left out: as suits the picture, 1 where it is 720 pixels high."},
      {.name = "--hide-walls", .target = &options.hideWalls, .help = "Draws no walls."},
      {.name = "--set-at",
       .target = &options.changes,
       .value = "S:/POINTER=VALUE",
       .help = "Changes a setting at a time of the run, in s, as --set does at its start. Repeatable.",
       .oneValueEach = true},
      {.name = "--compare",
       .target = &options.compare,
       .value = "/POINTER=A,B,...",
       .help = "Draws one sheet NAME_compare.png instead: a row for each value, a column for each time; "
               "--size is that of a cell. In a film the rows run in step."},
      {.name = "--film",
       .target = &options.film,
       .value = "FILE.webp|FILE.mp4",
       .help = "Makes a film instead of pictures, with img2webp or ffmpeg.",
       .group = film},
      {.name = "--fps",
       .target = &options.fps,
       .value = "N",
       .help = "Frames a second.",
       .shownDefault = "30",
       .group = film},
      {.name = "--from",
       .target = &options.from,
       .value = "S",
       .help = "Simulated time of the first frame, in s.",
       .shownDefault = "0",
       .group = film},
      {.name = "--to",
       .target = &options.to,
       .value = "S",
       .help = "Simulated time of the last frame, in s; left out: the scene's duration.",
       .group = film}};
  for (Option& option : planeOptions(options.section, section)) all.push_back(std::move(option));
  all.push_back({.name = "--no-cut",
                 .target = &options.noCut,
                 .help = "Leaves what lies before the section.",
                 .group = section});
  all.push_back({.name = "--no-lines",
                 .target = &options.noLines,
                 .help = "Draws no lines of equal values on it.",
                 .group = section});
  all.push_back({.name = "--fit",
                 .target = &options.fit,
                 .help = "Its colours reach from the least to the largest value that there is.",
                 .group = section});
  return all;
}

}  // namespace migiwa

// What `migiwa render` was asked for, looked at and understood before anything is drawn or written.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands/command.h"
#include "app/commands/pictures.h"
#include "app/platform/context.h"
#include "app/raytrace/embree.h"
#include "app/render/image.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/scene/json.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {

// A picture on disk: the PNG, and beside it a JSON file that says what it shows.

/// What one picture, or one cell of a sheet, shows. Holds no wall time: two runs write the same bytes.
struct PictureRecord {
  double time = 0;  ///< simulated (s)
  long steps = 0;
  std::size_t particles = 0;
  std::string handling;
  int iterations = 0;
  std::uint64_t stateHash = 0;
  std::vector<std::string> overrides;  ///< `/json/pointer=VALUE`, in order
};
PictureRecord pictureRecord(const FrameView& frame, const std::vector<Override>& overrides);

/// What all cells of a picture file share.
struct PictureContext {
  std::string scene;     ///< the scene file as it was given
  std::string renderer;  ///< driver and version
  bool panels = false;
  std::string colorField, colorUnit;
  std::array<double, 2> colorRange{0, 1};
  int samples = 0;  ///< of each pixel, where the picture is ray traced; else 0
  std::uint32_t seed = 0;
};

/// Writes `file` (.png) and its sidecar (.json).
void writePicture(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                  const PictureRecord& record);
/// The same for a sheet of cells, row by row.
void writeSheet(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                const std::vector<std::vector<PictureRecord>>& rows);

// `migiwa render SCENE`: pictures without a display.
namespace {

/// By OpenGL, as the window does.
class ViewerTaker final : public PictureTaker {
 public:
  ViewerTaker(const Scene& scene, const WallDrawing& walls, const ViewerOptions& options,
              const RenderJob& job)
      : viewer_(scene, walls, options), job_(job) {}

  Image take(const Simulation&, const FrameView& frame) override {
    return viewer_.takePicture(frame, RunStatus{}, job_.width, job_.height);
  }
  const Viewer& viewer() const { return viewer_; }

 private:
  Viewer viewer_;
  const RenderJob& job_;
};

/// Draws the scene's variants; how a picture is kept is the caller's business.
class Drawing {
 public:
  using Keep = std::function<void(std::size_t time, const Image&, const PictureRecord&)>;

  Drawing(const RenderJob& job, const RenderOptions& options, const CommonOptions& common)
      : job_(job), options_(options), common_(common) {
    pictures_.scene = options_.scene;
    if (job_.rayTraced) {
      pictures_.renderer = "ray traced";
      pictures_.samples = job_.samples;
      pictures_.seed = job_.seed;
    } else {
      context_ = makeEglContext();
      pictures_.renderer = context_->renderer();
      pictures_.panels = options_.panels;
    }
  }

  /// Hands over a picture of each time that the run reaches. Returns whether it went well; says so where it
  /// did not.
  bool run(const RenderVariant& variant, const Keep& keep) {
    Simulation simulation(variant.scene, common_.threads);
    const Scene& scene = simulation.scene();
    for (const std::string& warning : scene.warnings)
      std::cerr << options_.scene << ": warning: " << warning << '\n';

    const std::unique_ptr<PictureTaker> taker = makeTaker(simulation, variant);
    TroubleNotes trouble(options_.scene);
    {
      ProgressBar progress(0, job_.times.back(), common_.quiet);
      trouble.look(simulation.statistics(), progress);
      for (std::size_t i = 0; i < job_.times.size(); ++i) {
        const long frame = simulation.frameAt(job_.times[i]);
        while (simulation.frame() < frame && !simulation.stopped()) {
          simulation.advanceFrame();
          trouble.look(simulation.statistics(), progress);
          progress.update(simulation.time());
        }
        if (simulation.frame() < frame) break;
        const FrameView view = simulation.drawnView();
        progress.wipe();
        keep(i, taker->take(simulation, view), pictureRecord(view, variant.overrides));
      }
    }
    if (!simulation.stopped()) return true;
    trouble.finish(simulation.statistics());
    return false;
  }

  const PictureContext& pictures() const { return pictures_; }

 private:
  std::unique_ptr<PictureTaker> makeTaker(const Simulation& simulation, const RenderVariant& variant) {
    if (job_.rayTraced) return makeStillTaker(job_, common_.threads);
    const ViewerOptions shown{scaleFor(job_.width, job_.height), options_.panels, options_.timings,
                              variant.note};
    auto taker = std::make_unique<ViewerTaker>(simulation.scene(), simulation.walls(), shown, job_);
    describe(taker->viewer(), simulation.scene().view.color);
    return taker;
  }
  void describe(const Viewer& viewer, ColorField field) {
    pictures_.colorField = kColorFieldNames[static_cast<std::size_t>(field)];
    pictures_.colorUnit = viewer.colorInfo(field).unit;
    pictures_.colorRange = viewer.colorRange(field);
  }

  const RenderJob& job_;
  const RenderOptions& options_;
  const CommonOptions& common_;
  std::unique_ptr<GlContext> context_;  ///< null where rays do without
  PictureContext pictures_;
};

bool renderPictures(const RenderJob& job, Drawing& drawing) {
  const RenderVariant& only = job.variants.front();
  return drawing.run(only, [&](std::size_t time, const Image& image, const PictureRecord& record) {
    const std::string name = only.scene.stem() + "_t" + formatNumber("%.3f", job.times[time]) + ".png";
    writePicture(job.folder / name, image, drawing.pictures(), record);
    std::cout << (job.folder / name).string() << std::endl;
  });
}

/// One row for each variant, one column for each time; a cell that a run did not reach stays empty.
bool renderSheet(const RenderJob& job, Drawing& drawing) {
  const int columns = static_cast<int>(job.times.size()), rows = static_cast<int>(job.variants.size());
  Image sheet(columns * (job.width + kSheetGutter) - kSheetGutter,
              rows * (job.height + kSheetGutter) - kSheetGutter);
  std::fill(sheet.rgba.begin(), sheet.rgba.end(), std::uint8_t{255});
  std::vector<std::vector<PictureRecord>> records;
  bool good = true;
  for (int row = 0; row < rows; ++row) {
    records.emplace_back();
    const auto place = [&](std::size_t time, const Image& image, const PictureRecord& record) {
      sheet.paste(image, static_cast<int>(time) * (job.width + kSheetGutter),
                  row * (job.height + kSheetGutter));
      records.back().push_back(record);
    };
    good = drawing.run(job.variants[static_cast<std::size_t>(row)], place) && good;
  }
  const std::filesystem::path file = job.folder / (job.variants.front().scene.stem() + "_compare.png");
  writeSheet(file, sheet, drawing.pictures(), records);
  std::cout << file.string() << std::endl;
  return good;
}

int render(const RenderOptions& options, const CommonOptions& common) {
  const RenderJob job = checkedRenderJob(options, common);
  if (job.rayTraced && !raysAvailable())
    throw MissingError(std::string("--style raytraced: ") + raysMissingAdvice());
  Drawing drawing(job, options, common);
  makeFolder(job.folder, "--out");
  const bool good = options.compare.empty() ? renderPictures(job, drawing) : renderSheet(job, drawing);
  return good ? kDone : kNumericalTrouble;
}

}  // namespace

Command renderCommand() {
  return {
      "render", "Draws pictures of a scene; needs no display.", [] {
        const auto options = std::make_shared<RenderOptions>();
        return Declaration{
            {{.name = "scene",
              .target = &options->scene,
              .value = "SCENE",
              .help = "Scene file.",
              .required = true},
             {.name = "--out",
              .target = &options->out,
              .value = "DIR",
              .help = "Folder for the pictures NAME_t0.500.png, each with a .json that says what it shows.",
              .required = true},
             {.name = "--times",
              .target = &options->times,
              .value = "S,S,...",
              .help = "Simulated times in s, with commas between them; left out: start, middle and end."},
             {.name = "--size",
              .target = &options->size,
              .value = "WIDTHxHEIGHT",
              .help = "Width and height in pixels.",
              .shownDefault = options->size},
             {.name = "--style",
              .target = &options->style,
              .value = "STYLE",
              .help =
                  "particles: as in the window. raytraced: the water with its surface, and walls of glass "
                  "or matt material.",
              .shownDefault = options->style},
             {.name = "--samples",
              .target = &options->samples,
              .value = "N",
              .help = "Of each pixel of a ray-traced picture.",
              .range = {{kFewestSamples, kMostSamples}},
              .shownDefault = std::to_string(RenderJob{}.samples)},
             {.name = "--seed",
              .target = &options->seed,
              .value = "N",
              .help = "Of the random numbers of a ray-traced picture: the same one gives the same picture.",
              .range = {{0, 4294967295}},
              .shownDefault = "0"},
             {.name = "--ui", .target = &options->panels, .help = "Draws the window's panels, too."},
             {.name = "--timings",
              .target = &options->timings,
              .help = "Shows wall times; without it two runs give the same bytes."},
             {.name = "--compare",
              .target = &options->compare,
              .value = "/POINTER=A,B,...",
              .help =
                  "Draws one sheet NAME_compare.png instead: a row for each value, a column for each time; "
                  "--size is that of a cell."}},
            [options](const CommonOptions& common) { return render(*options, common); }};
      }};
}

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
  const auto style = std::find(kRenderStyles.begin(), kRenderStyles.end(), options.style);
  if (style == kRenderStyles.end()) {
    throw InputError("--style",
                     "expected one of " + quotedList(kRenderStyles) + ", found \"" + options.style + "\"");
  }
  job.rayTraced = *style == "raytraced";
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
  refuse(job.rayTraced && options.panels, "--ui", "particles");
  refuse(job.rayTraced && options.timings, "--timings", "particles");
  refuse(!job.rayTraced && options.samples.has_value(), "--samples", "raytraced");
  refuse(!job.rayTraced && options.seed.has_value(), "--seed", "raytraced");
  collect.raise();
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
  collect([&] { requireStyle(options, job); });

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

namespace {

/// Sums of steps miss round times by what a double cannot hold.
double roundedTime(double seconds) {
  return std::round(seconds * 1e9) / 1e9;
}

Json json(const PictureContext& context, const Image& image) {
  if (context.samples > 0) {
    return {{"scene", context.scene}, {"size", {image.width, image.height}},
            {"style", "raytraced"},   {"samples", context.samples},
            {"seed", context.seed},   {"renderer", context.renderer}};
  }
  return {{"scene", context.scene},
          {"size", {image.width, image.height}},
          {"panels", context.panels},
          {"color",
           {{"field", context.colorField},
            {"unit", context.colorUnit},
            {"low", context.colorRange[0]},
            {"high", context.colorRange[1]}}},
          {"renderer", context.renderer}};
}

Json json(const PictureRecord& record) {
  return {{"overrides", record.overrides},
          {"time", roundedTime(record.time)},
          {"steps", record.steps},
          {"particles", record.particles},
          {"handling", record.handling},
          {"iterations", record.iterations},
          {"state_hash", hexDigits(record.stateHash)}};
}

void write(const std::filesystem::path& file, const Image& image, const Json& sidecar) {
  std::filesystem::path beside = file;
  beside.replace_extension(".json");
  writeTextFile(file, encodePng(image));
  writeTextFile(beside, prettyJson(sidecar));
}

}  // namespace

PictureRecord pictureRecord(const FrameView& frame, const std::vector<Override>& overrides) {
  const FrameInfo& info = frame.info;
  PictureRecord record{info.time,      info.steps, frame.positions.size(), info.handling, info.iterations,
                       info.stateHash, {}};
  for (const Override& change : overrides) record.overrides.push_back(change.pointer + "=" + change.value);
  return record;
}

void writePicture(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                  const PictureRecord& record) {
  Json sidecar = json(context, image);
  sidecar.update(json(record));
  write(file, image, sidecar);
}

void writeSheet(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                const std::vector<std::vector<PictureRecord>>& rows) {
  Json sidecar = json(context, image);
  sidecar["rows"] = Json::array();
  for (const std::vector<PictureRecord>& row : rows) {
    Json cells = Json::array();
    for (const PictureRecord& cell : row) cells.push_back(json(cell));
    sidecar["rows"].push_back(cells);
  }
  write(file, image, sidecar);
}

}  // namespace migiwa

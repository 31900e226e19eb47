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
#include "app/platform/context.h"
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

inline constexpr int kSheetGutter = 6;  ///< between the cells of a sheet (pixels)

struct RenderOptions {
  std::string scene, out, times, size = "1280x720", compare;
  bool panels = false, timings = false;
};

/// One run of the scene: what is changed in it, and how that is called on the picture.
struct RenderVariant {
  std::vector<Override> overrides;
  std::string note;
  Scene scene;
};

struct RenderJob {
  std::vector<RenderVariant> variants;  ///< one, or those of --compare in the given order
  std::vector<double> times;            ///< rising (s)
  int width = 0, height = 0;            ///< of one picture or cell (pixels)
  std::filesystem::path folder;
};

/// Throws InputError with every fault found.
RenderJob checkedRenderJob(const RenderOptions& options, const CommonOptions& common);

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
};

/// Writes `file` (.png) and its sidecar (.json).
void writePicture(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                  const PictureRecord& record);
/// The same for a sheet of cells, row by row.
void writeSheet(const std::filesystem::path& file, const Image& image, const PictureContext& context,
                const std::vector<std::vector<PictureRecord>>& rows);

// `migiwa render SCENE`: pictures without a display.
namespace {

/// Draws the scene's variants; how a picture is kept is the caller's business.
class Drawing {
 public:
  using Keep = std::function<void(std::size_t time, const Image&, const PictureRecord&)>;

  Drawing(const RenderJob& job, const RenderOptions& options, const CommonOptions& common)
      : job_(job), options_(options), common_(common), context_(makeEglContext()) {}

  /// Hands over a picture of each time that the run reaches. Returns whether it went well; says so where it
  /// did not.
  bool run(const RenderVariant& variant, const Keep& keep) {
    Simulation simulation(variant.scene, common_.threads);
    const Scene& scene = simulation.scene();
    for (const std::string& warning : scene.warnings)
      std::cerr << options_.scene << ": warning: " << warning << '\n';

    Viewer viewer(scene, simulation.walls(),
                  {scaleFor(job_.width, job_.height), options_.panels, options_.timings, variant.note});
    describe(viewer, scene.view.color);
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
        keep(i, viewer.takePicture(view, RunStatus{}, job_.width, job_.height),
             pictureRecord(view, variant.overrides));
      }
    }
    if (!simulation.stopped()) return true;
    trouble.finish(simulation.statistics());
    return false;
  }

  const PictureContext& pictures() const { return pictures_; }

 private:
  void describe(const Viewer& viewer, ColorField field) {
    pictures_.scene = options_.scene;
    pictures_.renderer = context_->renderer();
    pictures_.panels = options_.panels;
    pictures_.colorField = kColorFieldNames[static_cast<std::size_t>(field)];
    pictures_.colorUnit = viewer.colorInfo(field).unit;
    pictures_.colorRange = viewer.colorRange(field);
  }

  const RenderJob& job_;
  const RenderOptions& options_;
  const CommonOptions& common_;
  std::unique_ptr<GlContext> context_;
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

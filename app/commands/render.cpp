// `migiwa render SCENE`: pictures and films without a display.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "app/commands/pictures.h"
#include "app/platform/context.h"
#include "app/raytrace/embree.h"
#include "app/render/image.h"
#include "app/session/section_session.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/scene/json.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/simulation/scene_surface.h"
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
  std::vector<std::string> changes;    ///< `S:/json/pointer=VALUE`, in the order of their times
};
PictureRecord pictureRecord(const FrameView& frame, const RenderVariant& variant);

/// What all cells of a picture file share.
struct PictureContext {
  std::string scene;     ///< the scene file as it was given
  std::string renderer;  ///< driver and version
  std::string style;     ///< one of kRenderStyles
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
/// What says what a film shows, beside it: FILE.json. `last`: of the last frame, a row for each variant.
void writeFilmRecord(const FilmJob& film, std::size_t frames, const Image& frame,
                     const PictureContext& context, const std::vector<PictureRecord>& last);

namespace {

/// By OpenGL, as the window does.
class ViewerTaker final : public PictureTaker {
 public:
  ViewerTaker(const Scene& scene, const WallDrawing& walls, ViewerOptions options, const RenderJob& job,
              int threads)
      : viewer_(scene, walls, withSection(std::move(options))),
        job_(job),
        pool_(threads),
        sections_(threads) {
    if (job.style == RenderStyle::water) surface_.emplace(scene, SurfaceOptions{}, pool_);
    viewer_.view().walls = job.walls;
    if (job.section) viewer_.view().section = *job.section;
  }

  Image take(const Simulation& simulation, const FrameView& frame) override {
    FrameView shown = frame;
    if (surface_)
      shown.water =
          std::make_shared<const SurfaceMesh>(surface_->mesh(frame.positions, {}, simulation.time()));
    if (job_.section) {
      sections_.forget(section_);
      for (int k = 0; k < 2; ++k) {  // asks, and takes in what is done
        sections_.poll(section_, *job_.section, simulation.scene(), simulation.settings(), frame);
        sections_.wait();
      }
      if (!section_.fault.empty()) throw InputError("--plane", section_.fault);
    }
    return viewer_.takePicture(shown, RunStatus{}, job_.width, job_.height);
  }
  const Viewer& viewer() const { return viewer_; }

 private:
  ViewerOptions withSection(ViewerOptions options) {
    options.section = &section_;
    return options;
  }

  SectionModel section_;
  Viewer viewer_;
  const RenderJob& job_;
  ThreadPool pool_;
  std::optional<SceneSurface> surface_;  ///< of water
  SectionSession sections_;
};

/// What draws pictures of simulations.
class Drawing {
 public:
  Drawing(const RenderJob& job, const RenderOptions& options, const CommonOptions& common)
      : job_(job), options_(options), common_(common) {
    pictures_.scene = options_.scene;
    pictures_.style = kRenderStyles[static_cast<std::size_t>(job_.style)];
    if (job_.style == RenderStyle::rayTraced) {
      pictures_.renderer = "ray traced";
      pictures_.samples = job_.samples;
      pictures_.seed = job_.seed;
    } else {
      context_ = makeEglContext();
      pictures_.renderer = context_->renderer();
      pictures_.panels = options_.panels;
    }
  }

  std::unique_ptr<PictureTaker> makeTaker(const Simulation& simulation, const RenderVariant& variant) {
    if (job_.style == RenderStyle::rayTraced) return makeStillTaker(job_, common_.threads);
    ViewerOptions shown{job_.scale, options_.panels, options_.timings, variant.note};
    shown.water = job_.style == RenderStyle::water;
    auto taker =
        std::make_unique<ViewerTaker>(simulation.scene(), simulation.walls(), shown, job_, common_.threads);
    describe(taker->viewer(), simulation.scene().view.color);
    return taker;
  }

  const RenderJob& job() const { return job_; }
  const CommonOptions& common() const { return common_; }
  const PictureContext& pictures() const { return pictures_; }

 private:
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

/// A variant of the scene in motion, and who draws it.
class DrawnRun {
 public:
  /// Says how far it is, unless `quiet`.
  DrawnRun(Drawing& drawing, const RenderVariant& variant, bool quiet)
      : variant_(variant),
        scene_(drawing.pictures().scene),
        simulation_(variant.scene, drawing.common().threads),
        trouble_(scene_) {
    for (const std::string& warning : simulation_.scene().warnings)
      std::cerr << scene_ << ": warning: " << warning << '\n';
    taker_ = drawing.makeTaker(simulation_, variant);
    progress_.emplace(0, drawing.job().times.back(), quiet);
    trouble_.look(simulation_.statistics(), *progress_);
    const std::optional<SectionView>& section = drawing.job().section;
    if (section && section->field == SectionField::pressure) simulation_.watchPressure(true);
  }

  /// Goes on to a time (s). False where the run has stopped before.
  bool reach(double time) {
    for (; next_ < variant_.later.size() && variant_.later[next_].time <= time; ++next_) {
      advanceTo(variant_.later[next_].time);
      simulation_.apply(variant_.later[next_].settings);
    }
    return advanceTo(time);
  }

  Image picture() {
    progress_->wipe();
    return taker_->take(simulation_, simulation_.drawnView());
  }
  PictureRecord record() const { return pictureRecord(simulation_.view(), variant_); }

  /// Whether it went well; says so where it did not.
  bool finish() {
    progress_.reset();
    if (simulation_.stopped()) trouble_.finish(simulation_.statistics());
    return !simulation_.stopped();
  }

 private:
  bool advanceTo(double time) {
    // After a change of the time step, frames no longer begin at its multiples.
    const auto isBefore = [&] {
      return next_ == 0 ? simulation_.frame() < simulation_.frameAt(time)
                        : simulation_.time() + 0.5 * simulation_.settings().solver.timeStep <= time;
    };
    while (isBefore() && !simulation_.stopped()) {
      simulation_.advanceFrame();
      trouble_.look(simulation_.statistics(), *progress_);
      progress_->update(simulation_.time());
    }
    return !isBefore();
  }

  const RenderVariant& variant_;
  std::size_t next_ = 0;  ///< of the later settings
  std::string scene_;
  Simulation simulation_;
  std::unique_ptr<PictureTaker> taker_;
  TroubleNotes trouble_;
  std::optional<ProgressBar> progress_;
};

bool renderPictures(const RenderJob& job, Drawing& drawing) {
  const RenderVariant& only = job.variants.front();
  DrawnRun run(drawing, only, drawing.common().quiet);
  for (const double time : job.times) {
    if (!run.reach(time)) break;
    const std::string name = only.scene.stem() + "_t" + formatNumber("%.3f", time) + ".png";
    writePicture(job.folder / name, run.picture(), drawing.pictures(), run.record());
    std::cout << (job.folder / name).string() << std::endl;
  }
  return run.finish();
}

/// White, with room for cells in rows and columns.
Image emptySheet(const RenderJob& job, std::size_t columns, std::size_t rows) {
  Image sheet(static_cast<int>(columns) * (job.width + kSheetGutter) - kSheetGutter,
              static_cast<int>(rows) * (job.height + kSheetGutter) - kSheetGutter);
  std::fill(sheet.rgba.begin(), sheet.rgba.end(), std::uint8_t{255});
  return sheet;
}

void setCell(Image& sheet, const RenderJob& job, std::size_t column, std::size_t row, const Image& cell) {
  sheet.paste(cell, static_cast<int>(column) * (job.width + kSheetGutter),
              static_cast<int>(row) * (job.height + kSheetGutter));
}

/// One row for each variant, one column for each time; a cell that a run did not reach stays empty.
bool renderSheet(const RenderJob& job, Drawing& drawing) {
  Image sheet = emptySheet(job, job.times.size(), job.variants.size());
  std::vector<std::vector<PictureRecord>> records;
  bool good = true;
  for (std::size_t row = 0; row < job.variants.size(); ++row) {
    records.emplace_back();
    DrawnRun run(drawing, job.variants[row], drawing.common().quiet);
    for (std::size_t column = 0; column < job.times.size() && run.reach(job.times[column]); ++column) {
      setCell(sheet, job, column, row, run.picture());
      records.back().push_back(run.record());
    }
    good = run.finish() && good;
  }
  const std::filesystem::path file = job.folder / (job.variants.front().scene.stem() + "_compare.png");
  writeSheet(file, sheet, drawing.pictures(), records);
  std::cout << file.string() << std::endl;
  return good;
}

/// All variants in step, one below the other. Where a run stops the film ends.
bool renderFilm(const RenderJob& job, Drawing& drawing) {
  FilmWriter film(*job.film);
  std::vector<std::unique_ptr<DrawnRun>> runs;
  for (const RenderVariant& variant : job.variants)
    runs.push_back(std::make_unique<DrawnRun>(drawing, variant, true));
  Image frame = emptySheet(job, 1, runs.size());
  {
    Activity activity("drawing " + std::to_string(job.times.size()) + " frames");
    for (const double time : job.times) {
      const auto reaches = [&](const auto& run) { return run->reach(time); };
      if (!std::all_of(runs.begin(), runs.end(), reaches)) break;
      for (std::size_t row = 0; row < runs.size(); ++row) setCell(frame, job, 0, row, runs[row]->picture());
      film.add(frame);
      activity.reach(static_cast<double>(film.frames()) / static_cast<double>(job.times.size()));
    }
  }
  bool good = true;
  std::vector<PictureRecord> last;
  for (const auto& run : runs) {
    last.push_back(run->record());
    good = run->finish() && good;
  }
  if (film.frames() == 0) return good;
  film.finish();
  writeFilmRecord(*job.film, film.frames(), frame, drawing.pictures(), last);
  std::cout << job.film->file.string() << std::endl;
  return good;
}

int render(const RenderOptions& options, const CommonOptions& common) {
  const RenderJob job = checkedRenderJob(options, common);
  if (job.style == RenderStyle::rayTraced && !raysAvailable())
    throw MissingError(std::string("--style raytraced: ") + raysMissingAdvice());
  if (!options.script.empty()) {
    makeFolder(job.folder, "--out");
    runScript(options.script, job, options, common);
    return kDone;
  }
  Drawing drawing(job, options, common);
  bool good = false;
  if (job.film) {
    good = renderFilm(job, drawing);
  } else {
    makeFolder(job.folder, "--out");
    good = options.compare.empty() ? renderPictures(job, drawing) : renderSheet(job, drawing);
  }
  return good ? kDone : kNumericalTrouble;
}

}  // namespace

Command renderCommand() {
  return {"render", "Draws pictures or a film of a scene; needs no display.", [] {
            const auto options = std::make_shared<RenderOptions>();
            return Declaration{renderOptions(*options),
                               [options](const CommonOptions& common) { return render(*options, common); }};
          }};
}

namespace {

/// Sums of steps miss round times by what a double cannot hold.
double roundedTime(double seconds) {
  return std::round(seconds * 1e9) / 1e9;
}

Json json(const PictureContext& context, const Image& image) {
  if (context.samples > 0) {
    return {{"scene", context.scene}, {"size", {image.width, image.height}},
            {"style", context.style}, {"samples", context.samples},
            {"seed", context.seed},   {"renderer", context.renderer}};
  }
  return {{"scene", context.scene},
          {"style", context.style},
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
  Json all{{"overrides", record.overrides},
           {"time", roundedTime(record.time)},
           {"steps", record.steps},
           {"particles", record.particles},
           {"handling", record.handling},
           {"iterations", record.iterations},
           {"state_hash", hexDigits(record.stateHash)}};
  if (!record.changes.empty()) all["changes"] = record.changes;
  return all;
}

void write(const std::filesystem::path& file, const Image& image, const Json& sidecar) {
  std::filesystem::path beside = file;
  beside.replace_extension(".json");
  writeTextFile(file, encodePng(image));
  writeTextFile(beside, prettyJson(sidecar));
}

}  // namespace

PictureRecord pictureRecord(const FrameView& frame, const RenderVariant& variant) {
  const FrameInfo& info = frame.info;
  PictureRecord record{
      info.time, info.steps, frame.positions.size(), info.handling, info.iterations, info.stateHash, {}, {}};
  for (const Override& change : variant.overrides)
    record.overrides.push_back(change.pointer + "=" + change.value);
  for (const LaterSettings& change : variant.later)
    if (change.time <= info.time) record.changes.push_back(change.words);
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

void writeFilmRecord(const FilmJob& film, std::size_t frames, const Image& frame,
                     const PictureContext& context, const std::vector<PictureRecord>& last) {
  Json sidecar = json(context, frame);
  sidecar["film"] = {{"frames", frames}, {"fps", film.fps}, {"from", film.from}};
  sidecar["rows"] = Json::array();
  for (const PictureRecord& row : last) sidecar["rows"].push_back(json(row));
  // Not NAME.json, which may be a scene.
  writeTextFile(film.file.string() + ".json", prettyJson(sidecar));
}

}  // namespace migiwa

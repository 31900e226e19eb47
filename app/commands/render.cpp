// `migiwa render SCENE`: pictures without a display.
#include <functional>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "app/commands/command.h"
#include "app/commands/picture_file.h"
#include "app/commands/progress_bar.h"
#include "app/commands/render_job.h"
#include "app/platform/egl_context.h"
#include "app/ui/number_text.h"
#include "app/viewer/viewer.h"
#include "core/io/output_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {
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
    {
      ProgressBar progress(0, job_.times.back(), common_.quiet);
      for (std::size_t i = 0; i < job_.times.size(); ++i) {
        const long frame = simulation.frameAt(job_.times[i]);
        while (simulation.frame() < frame && !simulation.stopped()) {
          simulation.advanceFrame();
          progress.update(simulation.time());
        }
        if (simulation.frame() < frame) break;
        const FrameView view = simulation.drawnView();
        keep(i, viewer.takePicture(view, RunStatus{}, job_.width, job_.height),
             pictureRecord(view, variant.overrides));
      }
    }
    if (!simulation.stopped()) return true;
    for (const Trouble& trouble : simulation.statistics().trouble) {
      std::cerr << options_.scene << ": " << trouble.kind << " at step " << trouble.step << ": "
                << trouble.detail << '\n';
    }
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
      "render", "Draws pictures of a scene; needs no display.", [](CLI::App& parser) {
        const auto options = std::make_shared<RenderOptions>();
        parser.add_option("scene", options->scene, "Scene file.")->required()->type_name("SCENE");
        parser
            .add_option("--out", options->out,
                        "Folder for the pictures NAME_t0.500.png, each with a .json that says what it shows.")
            ->required()
            ->type_name("DIR");
        parser
            .add_option("--times", options->times,
                        "Simulated times in s, with commas between them; left out: start, middle and end.")
            ->type_name("S,S,...");
        parser.add_option("--size", options->size, "Width and height in pixels.")
            ->type_name("WIDTHxHEIGHT")
            ->capture_default_str();
        parser.add_flag("--ui", options->panels, "Draws the window's panels, too.");
        parser.add_flag("--timings", options->timings,
                        "Shows wall times; without it two runs give the same bytes.");
        parser
            .add_option(
                "--compare", options->compare,
                "Draws one sheet NAME_compare.png instead: a row for each value, a column for each time; "
                "--size is that of a cell.")
            ->type_name("/POINTER=A,B,...");
        return [options](const CommonOptions& common) { return render(*options, common); };
      }};
}

}  // namespace migiwa

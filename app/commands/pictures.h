// What `migiwa render` was asked for, and the styles that draw it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/command.h"
#include "app/commands/plane.h"
#include "app/render/image.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {

inline constexpr int kSheetGutter = 6;  ///< between the cells of a sheet (pixels)

/// The first is the one that is taken where none is named.
enum class RenderStyle { particles, water, rayTraced };
inline constexpr std::array<std::string_view, 3> kRenderStyles{"particles", "water", "raytraced"};

inline constexpr long kFewestSamples = 2, kMostSamples = 65536;  ///< of a pixel

struct RenderOptions {
  std::string scene, out, times, size = "1280x720", compare, style{kRenderStyles[0]}, film, script;
  bool panels = false, timings = false;
  std::optional<int> samples;
  std::optional<long> seed;
  std::optional<double> fps, from, to;  ///< of a film
  std::optional<double> scale;
  std::vector<std::string> changes;  ///< --set-at, in order
  PlaneWords section;                ///< one is drawn where a plane is given
  bool hideWalls = false, noCut = false, noLines = false, fit = false;
};
/// As `migiwa render --help` lists them.
std::vector<Option> renderOptions(RenderOptions& options);

/// Settings that come into force on the way, and the options that ask for them.
struct LaterSettings {
  double time = 0;  ///< (s)
  Settings settings;
  std::string words;
};

/// One run of the scene: what is changed in it, and how that is called on the picture.
struct RenderVariant {
  std::vector<Override> overrides;
  std::string note;
  Scene scene;
  std::vector<LaterSettings> later{};  ///< in the order of their times
};

/// A film: pictures at even distances of time.
struct FilmJob {
  std::filesystem::path file;
  double fps = 30;  ///< frames a second
  double from = 0;  ///< of the first frame (s)
};

struct RenderJob {
  std::vector<RenderVariant> variants;  ///< one, or those of --compare in the given order
  std::vector<double> times;            ///< rising (s); of a film its frames
  std::optional<FilmJob> film;
  int width = 0, height = 0;  ///< of one picture or cell (pixels)
  std::filesystem::path folder;
  RenderStyle style = RenderStyle::particles;
  double scale = 1;  ///< of text
  bool walls = true;
  std::optional<SectionView> section;
  int samples = 64;  ///< of each pixel of a ray-traced picture
  std::uint32_t seed = 0;
};

/// Throws InputError with every fault found.
RenderJob checkedRenderJob(const RenderOptions& options, const CommonOptions& common);

/// Draws one run of a scene; simulations go on between its pictures.
class PictureTaker {
 public:
  virtual ~PictureTaker() = default;
  virtual Image take(const Simulation& simulation, const FrameView& frame) = 0;
};

/// By rays; `threads` as in CommonOptions. Throws MissingError where the program has none.
std::unique_ptr<PictureTaker> makeStillTaker(const RenderJob& job, int threads);

/// Carries out the events of a script at the window of the job's scene, without a display; pictures go into
/// the job's folder. Throws InputError with the line of the event that is wrong or cannot be carried out.
void runScript(const std::filesystem::path& script, const RenderJob& job, const RenderOptions& options,
               const CommonOptions& common);

// Films. An encoder makes them of the frames, a PNG each, in a folder beside the film that is gone
// afterwards.

/// The endings that films can have, each once.
std::vector<std::string_view> filmEndings();
/// Of a film of that ending without its encoder: where its frames go instead.
std::filesystem::path frameFolder(const std::filesystem::path& film);
/// Whether a program that makes films of that ending is installed.
bool filmEncoderInstalled(const std::filesystem::path& film);

class FilmWriter {
 public:
  /// Throws InputError or OutputError where the film could not be written. Says what to install where there
  /// is no encoder.
  explicit FilmWriter(const FilmJob& job);
  /// Leaves nothing of a film that was not finished.
  ~FilmWriter();
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;

  /// Writes it while the next one is drawn; what goes wrong is thrown by the next call, or by finish().
  void add(const Image& frame);
  std::size_t frames() const { return frames_; }
  /// Puts the film in its place. Throws MissingError where the encoder fails, or where there is none: then
  /// the frames are in frameFolder().
  void finish();

 private:
  void encode();

  FilmJob job_;
  std::filesystem::path work_;  ///< the folder of the frames; empty once it is gone
  std::size_t frames_ = 0;
  std::future<void> writing_;  ///< of the last frame
};

}  // namespace migiwa

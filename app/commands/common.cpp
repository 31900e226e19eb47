#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "app/commands/child_program.h"
#include "app/commands/command.h"
#include "app/commands/plots.h"
#include "app/render/image.h"
#include "app/ui/bindings.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {
namespace {

constexpr double kLatestTime = 1e6;  // (s), as long as a scene's duration can be
constexpr int kSmallestSide = 64, kLargestSide = 8192;

/// Parts at commas that stand outside brackets and quotes.
std::vector<std::string> partsAtCommas(std::string_view text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && (i == 0 || text[i - 1] != '\\')) quoted = !quoted;
    if (!quoted && (c == '[' || c == '{')) ++depth;
    if (!quoted && (c == ']' || c == '}')) --depth;
    if (c == ',' && depth == 0 && !quoted) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

bool readNumbers(std::string_view text, std::span<double> numbers) {
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const bool last = k + 1 == numbers.size();
    const std::size_t end = last ? text.size() : text.find(',');
    if (end == std::string_view::npos) return false;
    const std::optional<double> found = number<double>(text.substr(0, end));
    if (!found || !kCoordinateRange.contains(*found)) return false;
    numbers[k] = *found;
    if (!last) text.remove_prefix(end + 1);
  }
  return true;
}

void requireNumber(const std::string& option, const std::optional<double>& value, const Range& range,
                   std::string_view unit) {
  if (!value || range.contains(*value)) return;
  std::ostringstream text;
  text << "expected a number " << range.text() << " (unit: " << unit << "), found " << *value;
  throw InputError(option, text.str());
}

std::size_t requireOneOf(const std::string& option, const std::string& name,
                         std::span<const std::string_view> names) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw InputError(option, "expected one of " + quotedList(names) + ", found \"" + name + "\"");
  return static_cast<std::size_t>(at - names.begin());
}

std::vector<double> parseTimes(const std::string& text, std::string_view option) {
  const auto parse = [&](const std::string& part) {
    const std::optional<double> time = number<double>(part);
    if (time && *time >= 0 && *time <= kLatestTime) return *time;
    throw InputError(std::string(option),
                     "expected numbers in [0, 1e+06] (unit: s) with commas between them, found \"" + part +
                         "\" in \"" + text + "\"");
  };
  std::vector<double> times;
  for (const std::string& part : partsAtCommas(text)) times.push_back(parse(part));
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::array<int, 2> parseSize(const std::string& text, std::string_view option) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  const int width = number<int>(std::string_view(text).substr(0, cross)).value_or(0);
  const int height = number<int>(std::string_view(text).substr(std::min(cross + 1, text.size()))).value_or(0);
  for (const int side : {width, height}) {
    if (side < kSmallestSide || side > kLargestSide) {
      throw InputError(std::string(option),
                       "expected WIDTHxHEIGHT in pixels, each in [64, 8192], found \"" + text + "\"");
    }
  }
  return {width, height};
}

std::vector<Override> parseVariants(const std::string& text, std::string_view option) {
  try {
    const Override all = Override::parse(text);
    std::vector<Override> variants;
    for (const std::string& value : partsAtCommas(all.value)) variants.push_back({all.pointer, value});
    return variants;
  } catch (const InputError& error) {
    throw InputError(std::string(option), error.faults().front().message);
  }
}

namespace {

std::string duration(double seconds) {
  char text[32];
  if (seconds < 60) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else if (seconds < 3600) {
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60);
  } else {
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  }
  return text;
}

}  // namespace

ProgressBar::ProgressBar(double from, double until, bool quiet)
    : from_(from), until_(until), shown_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  wipe();
}

void ProgressBar::wipe() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void TroubleNotes::say(const Trouble& trouble) {
  if (!said_.insert(trouble.kind).second) return;
  std::cerr << scene_ << ": " << trouble.kind << " at step " << trouble.step << ": " << trouble.detail
            << '\n';
}

void TroubleNotes::look(const RunStatistics& run, ProgressBar& progress) {
  for (; seen_ < run.trouble.size(); ++seen_) {
    const Trouble& trouble = run.trouble[seen_];
    if (trouble.kind == "not_converged") continue;
    progress.wipe();
    say(trouble);
  }
}

void TroubleNotes::finish(const RunStatistics& run) {
  for (const Trouble& trouble : run.trouble) say(trouble);
}

void ProgressBar::update(double time) {
  const Clock::time_point now = Clock::now();
  if (!shown_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  constexpr int kCells = 30;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double part = until_ > from_ ? std::clamp((time - from_) / (until_ - from_), 0.0, 1.0) : 1;
  const int filled = static_cast<int>(part * kCells);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kCells - filled), '.');
  const std::string left = part > 0 ? duration(elapsed * (1 - part) / part) + " left" : "";
  std::fprintf(stderr, "\r[%s] %.2f of %.2f s, %.2f x real time, %s\033[K", bar.c_str(), time, until_,
               (time - from_) / elapsed, left.c_str());
  std::fflush(stderr);
}

void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script) {
  const std::string file = png.string();
  // The picture comes back through a pipe, since of a file that it cannot finish gnuplot says nothing.
  const std::optional<ProgramEnd> ended =
      runProgram({{"gnuplot"}, "set terminal " + terminal + "\n" + script}, file + " needs gnuplot");
  if (!ended) throw MissingError(file + " needs gnuplot; install gnuplot-nox (apt-get install gnuplot-nox)");
  if (ended->killed()) throw MissingError(file + " was not drawn: " + ended->killedWords("gnuplot"));
  if (ended->exitCode() != 0 || ended->printed.empty())
    throw MissingError(file + " was not drawn: gnuplot failed with exit code " +
                       std::to_string(ended->exitCode()) + (ended->printed.empty() ? " and no picture" : "") +
                       "; " + ended->lastWords() + "; the disk of its temporary files may be full");
  writeTextFile(png, ended->printed);
}

// `migiwa schema`: the scene format, for editors and for people.

Command schemaCommand() {
  return {"schema", "Prints the scene format as JSON Schema.", [] {
            const auto markdown = std::make_shared<bool>(false);
            return Declaration{{{.name = "--markdown",
                                 .target = markdown.get(),
                                 .help = "Prints a reference of all keys for people instead."}},
                               [markdown](const CommonOptions&) {
                                 std::cout << (*markdown ? sceneReference() : sceneSchema());
                                 return kDone;
                               }};
          }};
}

// `migiwa check SCENE...`: reads and validates only.

namespace {

struct CheckOptions {
  std::vector<std::string> files;
  bool print = false;
};

int check(const CheckOptions& options, const CommonOptions& common) {
  std::vector<Fault> faults;
  // With --print the scenes have the standard output to themselves.
  std::ostream& verdicts = options.print ? std::cerr : std::cout;
  for (const std::string& file : options.files) {
    try {
      const Scene scene = readScene(file, common.overrides);
      verdicts << file << ": ok (" << std::llround(particleCount(scene)) << " particles at most)\n";
      for (const std::string& warning : scene.warnings) std::cerr << file << ": warning: " << warning << '\n';
      if (options.print) std::cout << writeScene(scene);
    } catch (const InputError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  return kDone;
}

}  // namespace

Command checkCommand() {
  return {"check", "Reads scenes and lists everything that is wrong with them.", [] {
            const auto options = std::make_shared<CheckOptions>();
            return Declaration{{{.name = "scenes",
                                 .target = &options->files,
                                 .value = "SCENE",
                                 .help = "Scene files.",
                                 .required = true},
                                {.name = "--print",
                                 .target = &options->print,
                                 .help = "Prints each scene with every key and its value in force."}},
                               [options](const CommonOptions& common) { return check(*options, common); }};
          }};
}

std::filesystem::path shippedPlace(const std::filesystem::path& name, const std::string& option,
                                   const std::string& what) {
  std::error_code error;
  if (std::filesystem::exists(name, error)) return name;
  for (std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
       folder.has_relative_path(); folder = folder.parent_path())
    for (const std::filesystem::path& place : {folder / name, folder / "share" / "migiwa" / name})
      if (std::filesystem::exists(place, error)) return place;
  throw InputError(option, "expected " + what + ", found none given and no " + name.string() +
                               " here, in a folder above the program or in its share/migiwa");
}

// `migiwa view [SCENE]`: the window.
namespace {

namespace fs = std::filesystem;

struct ViewOptions {
  std::string scene;
  bool paused = false;
  std::optional<long> frames;
  int memory = static_cast<int>(TimeLine::kLimit >> 20U);  ///< (MiB)
};

/// The scene to begin with.
fs::path defaultScene() {
  return shippedPlace(fs::path("scenes") / "dam_break.json", "SCENE", "a scene file");
}

/// STEM0001ENDING and so on: the first that is not there yet.
fs::path freeName(const std::string& stem, const std::string& ending) {
  for (int number = 1;; ++number) {
    std::string digits = std::to_string(number);
    digits.insert(0, digits.size() < 4 ? 4 - digits.size() : 0, '0');
    fs::path file = stem;
    file += digits;
    file += ending;
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return file;
  }
}

void keepFile(const std::string& stem, const std::string& ending, const std::string& content) {
  try {
    const fs::path file = freeName(stem, ending);
    writeTextFile(file, content);
    std::cout << file.string() << std::endl;
  } catch (const std::exception& error) {
    // A full disk is no reason to close the window.
    std::cerr << "migiwa: " << error.what() << '\n';
  }
}

int view(const ViewOptions& options, const CommonOptions& common) {
  const fs::path file = options.scene.empty() ? defaultScene() : fs::path(options.scene);
  const auto read = [&] { return openScene(file, common.overrides); };
  WindowOptions window{common.threads,
                       common.overrides,
                       !options.paused,
                       options.frames,
                       static_cast<std::size_t>(options.memory) << 20U,
                       [](const Image& image) { keepFile("migiwa_", ".png", encodePng(image)); },
                       [](const std::string& csv) { keepFile("migiwa_section_", ".csv", csv); }};
  window.water = options.scene.empty();
  window.gallery = galleryEntries;
  window.open = [](const fs::path& other) { return openScene(other, {}); };
  runWindow(file.stem().string(), read, window);
  return kDone;
}

}  // namespace

Command viewCommand() {
  return {
      "view", "Opens a window on a scene.", [] {
        const auto options = std::make_shared<ViewOptions>();
        return Declaration{
            {{.name = "scene",
              .target = &options->scene,
              .value = "SCENE",
              .help = "A scene, mesh, points or SLIM file; left out: scenes/dam_break.json, as water."},
             {.name = "--paused", .target = &options->paused, .help = "Does not start by itself."},
             {.name = "--frames",
              .target = &options->frames,
              .value = "N",
              .help = "Closes after so many drawn frames.",
              .range = {{1, 1'000'000'000}}},
             {.name = "--memory",
              .target = &options->memory,
              .value = "MIB",
              .help =
                  "Memory that the states of the time line may take; the less, the longer the way to a time.",
              .range = {{1, 1'000'000}}}},
            [options](const CommonOptions& common) { return view(*options, common); },
            bindingsText() +
                "\nThe scene's file is watched: a change to it is taken over as soon as it is saved.\n"
                "MIGIWA_SHADERS=FOLDER in the environment takes the shaders from there."};
      }};
}

}  // namespace migiwa

// Films of `migiwa render`, by encoders that are installed.
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "app/commands/child_program.h"
#include "app/commands/pictures.h"
#include "app/render/image.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/base/progress.h"

namespace migiwa {
namespace {

namespace fs = std::filesystem;

constexpr int kDigits = 6;  ///< of a frame's number

std::string frameName(std::size_t number) {
  std::string digits = std::to_string(number);
  digits.insert(0, digits.size() < kDigits ? kDigits - digits.size() : 0, '0');
  return digits + ".png";
}

std::vector<std::string> img2webpWords(double fps, std::size_t frames, const std::string& result) {
  std::vector<std::string> words{"img2webp", "-loop", "0",     "-lossy", "-q",    "85",
                                 "-m",       "4",     "-kmin", "9",      "-kmax", "25"};
  // WebP counts whole milliseconds: frames are rounded to them each by itself, so that the film keeps time.
  long shown = 0, before = 0;
  for (std::size_t k = 0; k < frames; ++k) {
    const long until = std::lround(1000 * static_cast<double>(k + 1) / fps);
    if (const long duration = until - shown; duration != before) {
      words.insert(words.end(), {"-d", std::to_string(duration)});
      before = duration;
    }
    words.push_back(frameName(k));
    shown = until;
  }
  words.insert(words.end(), {"-o", result});
  return words;
}

std::vector<std::string> ffmpegWords(double fps, const std::vector<std::string>& coding,
                                     const std::string& result) {
  std::vector<std::string> words{
      "ffmpeg", "-loglevel", "error", "-y", "-framerate", formatNumber("%.9g", fps), "-i", "%06d.png"};
  words.insert(words.end(), coding.begin(), coding.end());
  words.push_back(result);
  return words;
}

std::vector<std::string> ffmpegWebpWords(double fps, std::size_t, const std::string& result) {
  return ffmpegWords(fps, {"-c:v", "libwebp_anim", "-loop", "0", "-quality", "85"}, result);
}

/// As players everywhere show it: halved colours, which take even sides.
std::vector<std::string> ffmpegMp4Words(double fps, std::size_t, const std::string& result) {
  return ffmpegWords(fps,
                     {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "18", "-pix_fmt",
                      "yuv420p", "-movflags", "+faststart"},
                     result);
}

/// What makes a film of numbered frames in the folder where it is run.
struct Encoder {
  std::string_view ending, program, package;
  std::vector<std::string> (*words)(double fps, std::size_t frames, const std::string& result);
};

/// Of those for an ending, the first that is installed is taken.
constexpr std::array<Encoder, 3> kEncoders{{{".webp", "img2webp", "webp", img2webpWords},
                                            {".webp", "ffmpeg", "ffmpeg", ffmpegWebpWords},
                                            {".mp4", "ffmpeg", "ffmpeg", ffmpegMp4Words}}};

const Encoder* installedEncoder(const fs::path& film) {
  for (const Encoder& encoder : kEncoders)
    if (film.extension() == encoder.ending && programExists(encoder.program)) return &encoder;
  return nullptr;
}

std::string installAdvice(const fs::path& film) {
  std::string programs, packages;
  for (const Encoder& encoder : kEncoders) {
    if (film.extension() != encoder.ending) continue;
    programs += (programs.empty() ? "" : " or ") + std::string(encoder.program);
    packages +=
        (packages.empty() ? "apt-get install " : " or apt-get install ") + std::string(encoder.package);
  }
  return "a film of this kind needs " + programs + " (" + packages + ")";
}

}  // namespace

std::vector<std::string_view> filmEndings() {
  std::vector<std::string_view> endings;
  for (const Encoder& encoder : kEncoders)
    if (endings.empty() || endings.back() != encoder.ending) endings.push_back(encoder.ending);
  return endings;
}

fs::path frameFolder(const fs::path& film) {
  return film.parent_path() / (film.stem().string() + "_frames");
}

bool filmEncoderInstalled(const fs::path& film) {
  return installedEncoder(film) != nullptr;
}

FilmWriter::FilmWriter(const FilmJob& job) : job_(job) {
  if (job_.file.has_parent_path()) makeFolder(job_.file.parent_path(), "--film");
  requireWritable(job_.file, "--film");
  if (!filmEncoderInstalled(job_.file)) {
    std::cerr << job_.file.string() << ": " << installAdvice(job_.file) << "; its frames will be in "
              << frameFolder(job_.file).string() << '\n';
  }
  // Under a name of this process alone: two that make the same film do not write into each other's.
  fs::path work = job_.file;
  work += "." + std::to_string(getpid()) + ".tmp";
  makeFolder(work, "--film");
  work_ = work;
}

FilmWriter::~FilmWriter() {
  std::error_code ignored;
  if (writing_.valid()) writing_.wait();
  if (!work_.empty()) fs::remove_all(work_, ignored);
}

void FilmWriter::add(const Image& frame) {
  if (writing_.valid()) writing_.get();
  writing_ = std::async(std::launch::async, [frame, file = work_ / frameName(frames_)] {
    writeTextFile(file, encodePng(frame, PngEffort::least));
  });
  ++frames_;
}

void FilmWriter::finish() {
  if (writing_.valid()) writing_.get();
  if (filmEncoderInstalled(job_.file)) return encode();
  const fs::path folder = frameFolder(job_.file);
  std::error_code failure;
  fs::rename(work_, folder, failure);
  if (failure) throwNotWritten(folder.string(), failure);
  work_.clear();
  throw MissingError(job_.file.string() + " was not made: " + installAdvice(job_.file) + "; its " +
                     std::to_string(frames_) + " frames are in " + folder.string());
}

void FilmWriter::encode() {
  const Encoder& encoder = *installedEncoder(job_.file);
  const std::string file = job_.file.string(), name(encoder.program);
  const std::string result = "film" + std::string(encoder.ending);
  const Activity activity("encoding " + std::to_string(frames_) + " frames");
  const std::optional<ProgramEnd> ended =
      runProgram({encoder.words(job_.fps, frames_, result), "", work_}, file + " needs " + name);
  if (!ended) throw MissingError(file + " was not made: " + installAdvice(job_.file));
  if (ended->killed()) throw MissingError(file + " was not made: " + ended->killedWords(name));
  std::error_code failure;
  if (ended->exitCode() != 0 || fs::file_size(work_ / result, failure) == 0 || failure)
    throw MissingError(file + " was not made: " + name + " failed with exit code " +
                       std::to_string(ended->exitCode()) + "; " + ended->lastWords() +
                       "; the disk may be full");
  fs::rename(work_ / result, job_.file, failure);
  if (failure) throwNotWritten(file, failure);
}

}  // namespace migiwa

#include "tests/fuzz/fuzz_targets.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <unistd.h>

#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/io/points_csv.h"
#include "core/io/save_file.h"
#include "core/io/surface_files.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/slim/file.h"
#include "core/slim/shape_import.h"
#include "core/walls/surface.h"

/// assimp leaks what it had read of a file when it refuses it.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT: the name is the sanitizer's
  return "leak:libassimp\n";
}

namespace migiwa::fuzz {

namespace {

/// A file of this process that holds the input; one a kind of ending, written anew each time.
std::filesystem::path fileWith(std::string_view input, const std::string& ending) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("migiwa_fuzz_" + std::to_string(getpid()) + ending);
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(input.data(), static_cast<std::streamsize>(input.size()));
  return file;
}

template <class Read>
void refusedOrRead(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

void scene(std::string_view input) {
  // Only the text: what it names on this machine's disk is no part of it.
  if (input.find("include") != input.npos || input.find("file") != input.npos) return;
  refusedOrRead([&] { parseScene(input, "fuzz.json"); });
}

constexpr std::string_view kScene = R"({ "format": 1, "particle_spacing": 0.1,
  "fluid": [{ "shape": "box", "min": [0, 0, 0], "max": [0.2, 0.2, 0.2] }],
  "boundary": { "surfaces": [{ "shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 1] }] } })";

/// A line an override.
void set(std::string_view input) {
  if (input.find("include") != input.npos || input.find("file") != input.npos) return;
  refusedOrRead([&] {
    std::vector<Override> overrides;
    while (!input.empty()) {
      const std::size_t end = std::min(input.find('\n'), input.size());
      overrides.push_back(Override::parse(input.substr(0, end)));
      input.remove_prefix(std::min(end + 1, input.size()));
    }
    parseScene(kScene, "fuzz.json", overrides);
  });
}

void slim(std::string_view input) {
  refusedOrRead([&] { parseSlimFile(std::string(input), "fuzz.json"); });
}

/// For each of these assimp fills 16 MiB first, so that they are a target of their own.
void obj(std::string_view input) {
  refusedOrRead([&] { importShape(fileWith(input, ".obj")); });
}

/// The first byte picks the ending.
void mesh(std::string_view input) {
  if (input.empty()) return;
  constexpr std::array<const char*, 3> kEndings{".stl", ".ply", ".xyz"};
  const std::string ending = kEndings[static_cast<unsigned char>(input.front()) % kEndings.size()];
  refusedOrRead([&] { importShape(fileWith(input.substr(1), ending)); });
}

void points(std::string_view input) {
  refusedOrRead([&] { readPoints(fileWith(input, ".csv")); });
}

void particles(std::string_view input) {
  refusedOrRead([&] { readParticles(fileWith(input, ".particles")); });
}

/// Lengths and checksum of a save are made to fit, or hardly any input would get past them.
std::string withChecksum(std::string_view input) {
  constexpr std::size_t kHead = 40, kHeaderBytes = 16, kArrayBytes = 24, kChecksum = 32;
  std::string file(input);
  if (file.size() < kHead) return file;
  const std::size_t rest = file.size() - kHead;
  std::uint64_t header = 0;
  std::memcpy(&header, &file[kHeaderBytes], sizeof header);
  header = std::min<std::uint64_t>(header, rest);
  const std::uint64_t arrays = rest - header;
  const char* const body = file.data() + kHead;
  const std::uint64_t sum = checksum(checksum(kEmptyChecksum, body, header), body + header, arrays);
  std::memcpy(&file[kHeaderBytes], &header, sizeof header);
  std::memcpy(&file[kArrayBytes], &arrays, sizeof arrays);
  std::memcpy(&file[kChecksum], &sum, sizeof sum);
  return file;
}

/// What is read goes on for a step.
void save(std::string_view input) {
  // The product is ready at once; what `auto` prepares would take longer than all the rest.
  static const Scene kLone =
      readScene(MIGIWA_SOURCE_DIR "/scenes/hard/lone_corner.json", {{"/boundary/gamma/method", "product"}});
  const auto simulation = std::make_unique<Simulation>(kLone, 1);
  SettledSampler sampler;
  refusedOrRead([&] {
    readSave(fileWith(withChecksum(input), ".save"), *simulation, sampler);
    simulation->advanceFrame();
  });
}

constexpr std::array<Target, 8> kTargets{{{"scene", scene},
                                          {"set", set},
                                          {"slim", slim},
                                          {"obj", obj},
                                          {"mesh", mesh},
                                          {"points", points},
                                          {"particles", particles},
                                          {"save", save}}};

}  // namespace

std::span<const Target> targets() {
  return kTargets;
}

}  // namespace migiwa::fuzz

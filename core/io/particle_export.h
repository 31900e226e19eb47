// Particles in files for other programs.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/simulation/frame_view.h"

namespace migiwa {

// The particles of one frame on their way to a file: positions and the chosen fields, in the order of the
// ids, so that a line of two files is the same particle as long as none came or went.

using FloatTriple = std::array<float, 3>;

/// One field of all particles.
struct ParticleField {
  enum class Kind { vectors, numbers, integers };
  std::string_view name;
  Kind kind = Kind::numbers;
  // The one that the kind names has the values.
  std::vector<FloatTriple> vectors;
  std::vector<float> numbers;
  std::vector<std::uint32_t> integers;
};

/// What can be written of a particle beside its position. An entry in the list of these is all that a field
/// takes.
struct ParticleFieldInfo {
  std::string_view name;  ///< as asked for, and as in the files
  std::string_view unit;
  std::string_view meaning;
  ParticleField::Kind kind;
  void (*copy)(const FrameView& view, ParticleField& out);
};
std::span<const ParticleFieldInfo> particleFields();

struct ParticleFrame {
  double time = 0;  ///< (s)
  long frame = 0;   ///< number of the frame in the run
  std::uint64_t stateHash = 0;
  /// What positions are relative to (m): Scene::origin. Files have their sum, in double where it is not zero.
  Vec3d origin = Vec3d::Zero();
  std::vector<FloatTriple> positions;  ///< (m)
  std::vector<ParticleField> fields;
  std::vector<std::uint32_t> ids;

  /// Whether positions take more than floats.
  bool far() const { return !origin.isZero(0); }
  std::array<double, 3> placeOf(std::size_t particle) const;
  /// Brings the particles into the order of their ids.
  void sortById();
};

/// A copy of a simulation's view with the named fields, in the view's order. `origin`: that of its scene.
ParticleFrame copyParticles(const FrameView& view, long frame, std::span<const std::string> fields,
                            const Vec3d& origin = Vec3d::Zero());

// A file format for the particles of a frame. A format is one file that defines it and one line in
// particle_formats.cpp.

struct ParticleFormat {
  std::string_view name;  ///< as asked for; also the ending of the files
  bool holdsFields;       ///< or positions only
  /// Endings of a list of all files and their times that programs for this format know; empty: none.
  std::string_view seriesEnding;
  /// The content of the file.
  std::string (*text)(const ParticleFrame& frame);
};

ParticleFormat plyFormat();
ParticleFormat vtkFormat();
ParticleFormat objFormat();

std::span<const ParticleFormat> particleFormats();

// A sequence of particle files, written by a thread of its own while the simulation goes on: NAME_000000.ply
// and so on, and NAME.ply.json, which lists them with their times and hashes. Each file is whole or not
// there, and the list names only files that are.

struct ExportOptions {
  std::filesystem::path folder;  ///< made if it is not there
  std::string name;              ///< how the files begin
  ParticleFormat format;
  std::vector<std::string> fields;     ///< names of particleFields(); none for a format that holds none
  std::string scene;                   ///< the scene file as it was given
  std::vector<std::string> overrides;  ///< `/json/pointer=VALUE`, in order
};

/// The list's name for files that begin with `name`.
std::string exportListName(const std::string& name, const ParticleFormat& format);

class ParticleExport {
 public:
  /// `firstFile` is the number of the first file. If it is not 0, the list keeps what it says of earlier
  /// files, as a resumed run's has to. Throws InputError when the folder cannot be made.
  ParticleExport(ExportOptions options, long firstFile);
  /// Waits until all is written, and is silent about errors.
  ~ParticleExport();
  ParticleExport(const ParticleExport&) = delete;
  ParticleExport& operator=(const ParticleExport&) = delete;

  /// Hands over the next file's frame; waits while kMostWaiting others have not been begun. Throws the error
  /// of an earlier one.
  void add(ParticleFrame frame);
  /// Waits until all that was added is written; throws the error of one that could not be.
  void flush();
  /// Waits until all is written; throws the error of one that could not be. Nothing can be added then.
  void finish();
  /// After finish(): how many files of an earlier, longer export follow in the folder.
  long laterFiles() const;

  static constexpr std::size_t kMostWaiting = 3;

 private:
  /// What the list says of a file.
  struct Entry {
    std::string file;
    double time;
    long frame;
    std::size_t particles;
    std::string stateHash;
  };

  void work();
  void write(ParticleFrame frame);
  void writeLists() const;
  std::string fileName(long number) const;
  void readEarlierEntries(long firstFile);
  void close();

  const ExportOptions options_;
  std::filesystem::path listFile_;
  // Of the thread alone, once it runs.
  std::vector<Entry> entries_;
  long number_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ParticleFrame> waiting_;
  bool writing_ = false, closed_ = false;
  std::exception_ptr failure_;

  std::thread thread_;
};

// Which frames of a run a sequence has: those nearest to 0, S, 2 S, ... seconds.

class ExportSchedule {
 public:
  /// `every` and `timeStep` in s, both positive.
  ExportSchedule(double every, double timeStep) : stride_(every / timeStep) {}

  bool due(long frame) const;
  /// How many frames before this one are due: the number of its file.
  long countBefore(long frame) const;

 private:
  double stride_;  ///< frames, not necessarily whole
};

}  // namespace migiwa

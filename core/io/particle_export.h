// A sequence of particle files, written by a thread of its own while the simulation goes on: NAME_000000.ply
// and so on, and NAME.ply.json, which lists them with their times and hashes. Each file is whole or not
// there, and the list names only files that are.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/io/particle_format.h"

namespace migiwa {

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

}  // namespace migiwa

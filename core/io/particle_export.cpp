#include "core/io/particle_export.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/scene/json.h"

namespace migiwa {

namespace fs = std::filesystem;

namespace {

/// Sums of steps miss round times by what a double cannot hold.
double roundedTime(double seconds) {
  return std::round(seconds * 1e9) / 1e9;
}

}  // namespace

std::string exportListName(const std::string& name, const ParticleFormat& format) {
  return name + "." + std::string(format.name) + ".json";
}

ParticleExport::ParticleExport(ExportOptions options, long firstFile)
    : options_(std::move(options)),
      listFile_(options_.folder / exportListName(options_.name, options_.format)),
      number_(firstFile) {
  makeFolder(options_.folder, "--export");
  if (firstFile > 0) readEarlierEntries(firstFile);
  thread_ = std::thread([this] { work(); });
}

ParticleExport::~ParticleExport() {
  close();
}

void ParticleExport::add(ParticleFrame frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < kMostWaiting || failure_; });
  if (failure_) std::rethrow_exception(failure_);
  waiting_.push_back(std::move(frame));
  changed_.notify_all();
}

void ParticleExport::flush() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return (waiting_.empty() && !writing_) || failure_; });
  if (failure_) std::rethrow_exception(failure_);
}

void ParticleExport::finish() {
  close();
  if (failure_) std::rethrow_exception(failure_);
}

void ParticleExport::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ParticleExport::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return !waiting_.empty() || closed_; });
    if (waiting_.empty()) return;
    ParticleFrame frame = std::move(waiting_.front());
    waiting_.pop_front();
    writing_ = true;
    lock.unlock();
    changed_.notify_all();
    std::exception_ptr failure;
    try {
      write(std::move(frame));
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    writing_ = false;
    changed_.notify_all();
    if (!failure) continue;
    // After a file that is missing, more of them are no sequence.
    failure_ = failure;
    waiting_.clear();
    return;
  }
}

void ParticleExport::write(ParticleFrame frame) {
  frame.sortById();
  const std::string name = fileName(number_++);
  writeTextFile(options_.folder / name, options_.format.text(frame));
  entries_.push_back(
      {name, roundedTime(frame.time), frame.frame, frame.positions.size(), hexDigits(frame.stateHash)});
  writeLists();
}

long ParticleExport::laterFiles() const {
  std::error_code code;
  long count = 0;
  while (fs::exists(options_.folder / fileName(number_ + count), code)) ++count;
  return count;
}

std::string ParticleExport::fileName(long number) const {
  char digits[32];
  std::snprintf(digits, sizeof digits, "_%06ld.", number);
  return options_.name + digits + std::string(options_.format.name);
}

void ParticleExport::writeLists() const {
  Json list = Json::object();
  list["scene"] = options_.scene;
  list["overrides"] = options_.overrides;
  list["format"] = options_.format.name;
  list["fields"] = Json::object();
  for (const std::string& name : options_.fields)
    for (const ParticleFieldInfo& info : particleFields())
      if (info.name == name) list["fields"][name] = {{"unit", info.unit}, {"meaning", info.meaning}};
  list["files"] = Json::array();
  Json series = {{"file-series-version", "1.0"}, {"files", Json::array()}};
  for (const Entry& entry : entries_) {
    list["files"].push_back({{"file", entry.file},
                             {"time", entry.time},
                             {"frame", entry.frame},
                             {"particles", entry.particles},
                             {"state_hash", entry.stateHash}});
    series["files"].push_back({{"name", entry.file}, {"time", entry.time}});
  }
  writeTextFile(listFile_, prettyJson(list));
  if (!options_.format.seriesEnding.empty())
    writeTextFile(options_.folder / (options_.name + std::string(options_.format.seriesEnding)),
                  prettyJson(series));
}

void ParticleExport::readEarlierEntries(long firstFile) {
  std::error_code code;
  if (!fs::exists(listFile_, code)) return;
  try {
    const Json list = readJson(readTextFile(listFile_, "a list of exported files"));
    for (const Json& entry : list.at("files")) {
      Entry earlier{entry.at("file").get<std::string>(), entry.at("time").get<double>(),
                    entry.at("frame").get<long>(), entry.at("particles").get<std::size_t>(),
                    entry.at("state_hash").get<std::string>()};
      const auto number = static_cast<long>(entries_.size());
      if (number == firstFile || earlier.file != fileName(number)) break;
      if (fs::exists(options_.folder / earlier.file, code)) entries_.push_back(std::move(earlier));
    }
  } catch (const Json::exception&) {
    throw InputError(listFile_.string(),
                     "expected the list of an earlier export, found something else; "
                     "take another folder or remove it");
  }
}

namespace {

/// Sums of steps are off round times by what a double cannot hold: halfway is rounded up all the same.
constexpr double kTie = 1e-9;

/// The frame on which the k-th time falls.
double frameOf(long k, double stride) {
  return std::floor(static_cast<double>(k) * stride + 0.5 + kTie);
}

}  // namespace

bool ExportSchedule::due(long frame) const {
  return countBefore(frame + 1) > countBefore(frame);
}

long ExportSchedule::countBefore(long frame) const {
  if (frame <= 0) return 0;
  if (stride_ <= 1) return frame;
  // The first k whose frame is not before this one, found near where it would be without rounding.
  long k = std::lround(std::max(std::floor(static_cast<double>(frame) / stride_) - 1, 0.0));
  while (frameOf(k, stride_) < static_cast<double>(frame)) ++k;
  return k;
}

}  // namespace migiwa

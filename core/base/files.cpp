#include "core/base/files.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/base/messages.h"

namespace migiwa {

namespace fs = std::filesystem;

namespace {

std::atomic<int> cacheBypasses{0};

}  // namespace

fs::path cacheFolder() {
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? fs::path() : fs::path(value);
  };
  if (fs::path own = set("MIGIWA_CACHE"); !own.empty()) return own;
  if (const fs::path cache = set("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "migiwa";
  if (const fs::path home = set("HOME"); home.is_absolute()) return home / ".cache" / "migiwa";
  return {};
}

bool writeCacheFile(const fs::path& file, const std::function<void(std::ostream&)>& write) {
  std::error_code code;
  fs::create_directories(file.parent_path(), code);
  // Under a name of this process alone: two that start at once do not write into each other's.
  fs::path temporary = file;
  temporary += "." + std::to_string(getpid()) + ".tmp";
  std::ofstream out(temporary, std::ios::binary);
  write(out);
  out.close();
  if (out) fs::rename(temporary, file, code);
  if (out && !code) return true;
  fs::remove(temporary, code);
  return false;
}

CacheBypass::CacheBypass() {
  ++cacheBypasses;
}
CacheBypass::~CacheBypass() {
  --cacheBypasses;
}
bool CacheBypass::active() {
  return cacheBypasses > 0;
}

namespace fs = std::filesystem;

namespace {

/// Something that cannot be replaced by a new file: a named pipe, or /dev/stdout wherever that leads.
bool isStream(const fs::path& file) {
  if (file.parent_path() == "/dev") return true;
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The file that a symbolic link stands for: the link itself stays.
fs::path resolved(const fs::path& file) {
  std::error_code code;
  const fs::path target = fs::canonical(file, code);
  return code ? file : target;
}

fs::path temporaryFor(const fs::path& file) {
  fs::path temporary = file;
  temporary += ".tmp";
  return temporary;
}

/// A file descriptor that closes itself. Every function leaves its reason in errno.
class OpenFile {
 public:
  OpenFile(const fs::path& file, int how) : descriptor_(::open(file.c_str(), how | O_CLOEXEC, 0666)) {}
  ~OpenFile() { close(); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  bool isOpen() const { return descriptor_ >= 0; }
  bool write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t done = ::write(descriptor_, text.data(), text.size());
      if (done >= 0) {
        text.remove_prefix(static_cast<std::size_t>(done));
      } else if (errno != EINTR) {
        return false;
      }
    }
    return true;
  }
  bool sync() const { return ::fsync(descriptor_) == 0; }
  bool close() {
    const int descriptor = std::exchange(descriptor_, -1);
    return descriptor < 0 || ::close(descriptor) == 0;
  }

 private:
  int descriptor_;
};

/// Whether a failure is one of the path that was given: another path, or a folder made first, would do.
bool isOfPath(const std::error_code& reason) {
  for (const std::errc code :
       {std::errc::no_such_file_or_directory, std::errc::not_a_directory, std::errc::is_a_directory,
        std::errc::permission_denied, std::errc::operation_not_permitted, std::errc::read_only_file_system,
        std::errc::filename_too_long, std::errc::too_many_symbolic_link_levels, std::errc::invalid_argument,
        std::errc::file_exists, std::errc::text_file_busy, std::errc::no_such_device_or_address,
        std::errc::no_such_device, std::errc::directory_not_empty, std::errc::operation_not_supported})
    if (reason == code) return true;
  return false;
}

void syncFolder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const OpenFile opened(folder, O_RDONLY | O_DIRECTORY);
  if (opened.isOpen()) static_cast<void>(opened.sync());
}

}  // namespace

void throwNotWritten(const std::string& place, const std::error_code& reason) {
  const std::string message = "could not be written: " + reason.message();
  if (isOfPath(reason)) throw InputError(place, message);
  throw OutputError(place, message);
}

void makeFolder(const fs::path& folder, std::string_view option) {
  std::error_code reason;
  fs::create_directories(folder, reason);
  // Making one that is there is none, but one that is a file is not always told as a failure.
  std::error_code ignored;
  if (!reason && fs::is_directory(folder, ignored)) return;
  if (reason && !isOfPath(reason)) throwNotWritten(folder.string(), reason);
  throw InputError(std::string(option), "expected a folder that can be made, found " + folder.string() +
                                            " (" + (reason ? reason.message() : "a file") + ")");
}

void requireWritable(const fs::path& file, std::string_view option) {
  const std::string place(option);
  if (isStream(file)) return;
  std::error_code code;
  if (file.filename().empty() || fs::is_directory(file, code))
    throw InputError(place, "expected a file name, found the folder " + file.string());
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, code))
    throw InputError(place, "expected a file in a folder that exists, found no folder " + folder.string());

  // Permissions, read-only disks and forbidden names: only trying tells.
  const fs::path temporary = temporaryFor(resolved(file));
  const bool opened = OpenFile(temporary, O_WRONLY | O_APPEND | O_CREAT).isOpen();
  const std::error_code reason(opened ? 0 : errno, std::generic_category());
  if (reason && !isOfPath(reason)) throwNotWritten(file.string(), reason);
  if (reason)
    throw InputError(
        place, "expected a file that can be written, found " + file.string() + " (" + reason.message() + ")");
  fs::remove(temporary, code);
}

void writeFile(const fs::path& file, std::span<const std::string_view> pieces, Outlasting outlasting) {
  const bool direct = isStream(file);
  const fs::path target = direct ? file : resolved(file);
  const fs::path written = direct ? file : temporaryFor(target);
  OpenFile out(written, direct ? O_WRONLY | O_APPEND : O_WRONLY | O_CREAT | O_TRUNC);
  bool good = out.isOpen();
  for (const std::string_view piece : pieces) good = good && out.write(piece);
  if (!direct && outlasting == Outlasting::theMachine) good = good && out.sync();
  const int reason = errno;
  good = out.close() && good;
  std::error_code code(reason, std::generic_category());
  if (good && !direct) {
    fs::rename(written, target, code);
    good = !code;
  }
  if (good) {
    // The new name is on the disk only once its folder is.
    if (!direct && outlasting == Outlasting::theMachine) syncFolder(target);
    return;
  }
  std::error_code ignored;
  if (!direct) fs::remove(written, ignored);
  throwNotWritten(file.string(), code);
}

void writeTextFile(const fs::path& file, std::string_view text) {
  writeFile(file, {&text, 1}, Outlasting::theProgram);
}

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double firstNumber(const char* file) {
  std::ifstream in(file);
  double value = kInfinite;
  return in >> value ? value : kInfinite;  // cgroups write "max" for no limit
}

double ofMachine() {
  std::ifstream in("/proc/meminfo");
  std::string key;
  double kibibytes = 0;
  while (in >> key >> kibibytes) {
    if (key == "MemAvailable:") return kibibytes * 1024;
    std::getline(in, key);
  }
  return kInfinite;
}

double ofContainer() {
  const double limit = firstNumber("/sys/fs/cgroup/memory.max");
  return std::isfinite(limit) ? std::max(0.0, limit - firstNumber("/sys/fs/cgroup/memory.current"))
                              : kInfinite;
}

/// As `ulimit -v` sets it.
double ofProcess() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kInfinite;
  const double used = firstNumber("/proc/self/statm") * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

}  // namespace

double availableMemory() {
  return std::min({ofMachine(), ofContainer(), ofProcess()});
}

void requireMemory(double bytes, const std::string& what, const std::string& place) {
  const double available = availableMemory();
  if (bytes <= available) return;
  constexpr double kMiB = 1024.0 * 1024;
  char text[200];
  std::snprintf(text, sizeof text,
                "expected %s with room in the %.0f MiB that are available, found that it needs %.0f MiB; a "
                "larger particle_spacing needs less",
                what.c_str(), available / kMiB, bytes / kMiB);
  throw InputError(place, text);
}

void resetPeakMemory() {
  malloc_trim(0);
  // proc(5): 5 sets the peak to what is resident now.
  std::ofstream("/proc/self/clear_refs") << 5;
}

double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<double>(usage.ru_maxrss);
}

namespace {

constexpr std::size_t kLargestFile = std::size_t{64} << 20;

}  // namespace

std::string readTextFile(const std::filesystem::path& file, std::string_view kind) {
  const std::string expected = "expected " + std::string(kind) + ", found ";
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (status.type() == std::filesystem::file_type::not_found)
    throw InputError(file.string(), expected + "no such file");
  if (std::filesystem::is_directory(status)) throw InputError(file.string(), expected + "a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string(), expected + "one that cannot be opened");
  // Read in pieces: pipes and devices do not tell their size.
  std::string text;
  std::vector<char> piece(std::size_t{1} << 16);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > kLargestFile)
      throw InputError(file.string(), expected + "more than " + std::to_string(kLargestFile >> 20) + " MiB");
  }
  if (in.bad()) throw InputError(file.string(), expected + "one that cannot be read");
  return text;
}

}  // namespace migiwa

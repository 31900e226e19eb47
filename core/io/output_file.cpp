#include "core/io/output_file.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "core/base/error.h"

namespace migiwa {

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

}  // namespace migiwa

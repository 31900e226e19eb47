#include "core/io/output_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

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

}  // namespace

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
  errno = 0;
  const bool opened = std::ofstream(temporary, std::ios::binary | std::ios::app).is_open();
  const std::string reason = std::strerror(errno);
  if (!opened)
    throw InputError(place,
                     "expected a file that can be written, found " + file.string() + " (" + reason + ")");
  fs::remove(temporary, code);
}

void writeTextFile(const fs::path& file, std::string_view text) {
  const bool direct = isStream(file);
  const fs::path target = direct ? file : resolved(file);
  const fs::path written = direct ? file : temporaryFor(target);
  std::ofstream out(written, direct ? std::ios::binary | std::ios::app : std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code code;
  if (out && !direct) fs::rename(written, target, code);
  if (out && !code) return;
  std::error_code ignored;
  if (!direct) fs::remove(written, ignored);
  throw std::runtime_error(file.string() + ": could not be written" + (code ? ": " + code.message() : ""));
}

}  // namespace migiwa

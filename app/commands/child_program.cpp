#include "app/commands/child_program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/messages.h"

namespace migiwa {
namespace {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }
  /// From where it stands to its end.
  std::string rest() const {
    std::string text;
    std::array<char, 1 << 16> piece;
    while (true) {
      const ssize_t size = ::read(number_, piece.data(), piece.size());
      if (size > 0) {
        text.append(piece.data(), static_cast<std::size_t>(size));
      } else if (size == 0 || errno != EINTR) {
        return text;
      }
    }
  }

 private:
  int number_;
};

[[noreturn]] void throwRefused(const std::string& what) {
  throw MissingError(what + ": " + std::strerror(errno));
}

/// A file in memory: no folder for temporary files that may be full, and gone when it is closed.
Descriptor memoryFile(const std::string& content, const std::string& program) {
  Descriptor file(memfd_create(program.c_str(), MFD_CLOEXEC));
  if (file.number() < 0) throwRefused("no file in memory for " + program);
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t size = ::write(file.number(), content.data() + done, content.size() - done);
    if (size < 0 && errno != EINTR) throwRefused("no room for what " + program + " reads");
    done += static_cast<std::size_t>(std::max<ssize_t>(size, 0));
  }
  ::lseek(file.number(), 0, SEEK_SET);
  return file;
}

}  // namespace

std::optional<ProgramEnd> runProgram(const ProgramCall& call, const std::string& purpose) {
  const std::string& name = call.words.front();
  const Descriptor input = memoryFile(call.input, name), complaints = memoryFile("", name);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throwRefused("no pipe to " + name);
  Descriptor readEnd(ends[0]), writeEnd(ends[1]);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, writeEnd.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, complaints.number(), STDERR_FILENO);
  if (!call.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, call.folder.c_str());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // What this program ignores its children need not.
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> words = call.words;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, name.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT) return std::nullopt;
  if (failure != 0) throw MissingError(purpose + ", which cannot be started: " + std::strerror(failure));

  writeEnd.close();
  ProgramEnd ended{0, readEnd.rest(), {}};
  while (waitpid(child, &ended.status, 0) < 0 && errno == EINTR) continue;
  ::lseek(complaints.number(), 0, SEEK_SET);
  ended.complaints = complaints.rest();
  return ended;
}

bool ProgramEnd::killed() const {
  return WIFSIGNALED(status);
}

int ProgramEnd::exitCode() const {
  return WEXITSTATUS(status);
}

std::string ProgramEnd::killedWords(const std::string& name) const {
  const int signal = WTERMSIG(status);
  return name + " was killed by signal " + std::to_string(signal) + " (" + strsignal(signal) +
         "), as the system does for want of memory; " + lastWords();
}

std::string ProgramEnd::lastWords() const {
  constexpr std::size_t kMost = 300;
  std::string text;
  for (const char c : complaints) {
    const bool space = c == '\n' || c == '\r' || c == '\t' || c == ' ';
    if (!space) text += c;
    if (space && !text.empty() && text.back() != ' ') text += ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (text.size() > kMost) text = "..." + text.substr(text.size() - kMost);
  return text.empty() ? "it said nothing" : "it said: " + text;
}

bool programExists(std::string_view name) {
  const char* const path = std::getenv("PATH");
  std::string_view folders = path == nullptr ? "/bin:/usr/bin" : path;
  while (true) {
    const std::size_t colon = std::min(folders.find(':'), folders.size());
    const std::filesystem::path file = std::filesystem::path(folders.substr(0, colon)) / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0) return true;
    if (colon == folders.size()) return false;
    folders.remove_prefix(colon + 1);
  }
}

}  // namespace migiwa

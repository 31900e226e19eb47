#include "app/commands/gnuplot.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/io/output_file.h"

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
Descriptor memoryFile(const std::string& content) {
  Descriptor file(memfd_create("gnuplot", MFD_CLOEXEC));
  if (file.number() < 0) throwRefused("no file in memory for gnuplot");
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t size = ::write(file.number(), content.data() + done, content.size() - done);
    if (size < 0 && errno != EINTR) throwRefused("no room for a script of gnuplot");
    done += static_cast<std::size_t>(std::max<ssize_t>(size, 0));
  }
  ::lseek(file.number(), 0, SEEK_SET);
  return file;
}

struct Ended {
  int status;  ///< as waitpid() says it
  std::string printed, complaints;
};

/// Runs gnuplot on a script. The picture comes back through a pipe, since of a file that it cannot finish
/// gnuplot says nothing. Throws MissingError when it cannot be started.
Ended runGnuplot(const std::string& png, const std::string& text) {
  const Descriptor script = memoryFile(text), complaints = memoryFile("");
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throwRefused("no pipe to gnuplot");
  Descriptor readEnd(ends[0]), writeEnd(ends[1]);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, script.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, writeEnd.number(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, complaints.number(), STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // What this program ignores its children need not.
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::string name = "gnuplot";
  std::array<char*, 2> words{name.data(), nullptr};
  pid_t child = 0;
  const int failure = posix_spawnp(&child, name.c_str(), &actions, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure == ENOENT)
    throw MissingError(png + " needs gnuplot; install gnuplot-nox (apt-get install gnuplot-nox)");
  if (failure != 0)
    throw MissingError(png + " needs gnuplot, which cannot be started: " + std::strerror(failure));

  writeEnd.close();
  Ended ended{0, readEnd.rest(), {}};
  while (waitpid(child, &ended.status, 0) < 0 && errno == EINTR) continue;
  ::lseek(complaints.number(), 0, SEEK_SET);
  ended.complaints = complaints.rest();
  return ended;
}

/// What a program said last, on one line.
std::string lastWords(const std::string& complaints) {
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

}  // namespace

void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script) {
  const std::string file = png.string();
  const Ended ended = runGnuplot(file, "set terminal " + terminal + "\n" + script);
  if (WIFSIGNALED(ended.status)) {
    const int signal = WTERMSIG(ended.status);
    throw MissingError(file + " was not drawn: gnuplot was killed by signal " + std::to_string(signal) +
                       " (" + strsignal(signal) + "), as the system does for want of memory; " +
                       lastWords(ended.complaints));
  }
  if (WEXITSTATUS(ended.status) != 0 || ended.printed.empty())
    throw MissingError(file + " was not drawn: gnuplot failed with exit code " +
                       std::to_string(WEXITSTATUS(ended.status)) +
                       (ended.printed.empty() ? " and no picture" : "") + "; " + lastWords(ended.complaints) +
                       "; the disk of its temporary files may be full");
  writeTextFile(png, ended.printed);
}

}  // namespace migiwa

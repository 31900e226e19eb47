#include "app/commands/gnuplot.h"

#include <array>
#include <cstdio>
#include <memory>

#include <sys/mman.h>

#include "core/base/error.h"
#include "core/io/output_file.h"

namespace migiwa {

namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct PipeCloser {
  void operator()(std::FILE* pipe) const { pclose(pipe); }
};

/// What gnuplot prints for a script; empty when it is not there or fails. The picture comes back through a
/// pipe, since of a file that it cannot finish gnuplot says nothing.
std::string printed(const std::string& text) {
  // In memory: no folder for temporary files that may be full, and gone when it is closed.
  const int descriptor = memfd_create("gnuplot", 0);
  if (descriptor < 0) return {};
  const std::unique_ptr<std::FILE, FileCloser> script(fdopen(descriptor, "w"));
  if (!script || std::fwrite(text.data(), 1, text.size(), script.get()) != text.size() ||
      std::fflush(script.get()) != 0)
    return {};
  const std::string command = "gnuplot 2>/dev/null </dev/fd/" + std::to_string(descriptor);
  std::unique_ptr<std::FILE, PipeCloser> pipe(popen(command.c_str(), "r"));
  if (!pipe) return {};
  std::string result;
  std::array<char, 1 << 16> piece;
  while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), pipe.get()))
    result.append(piece.data(), size);
  return pclose(pipe.release()) == 0 ? result : std::string();
}

}  // namespace

void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script) {
  const std::string picture = printed("set terminal " + terminal + "\n" + script);
  if (picture.empty())
    throw MissingError(png.string() + " needs gnuplot; install gnuplot-nox (apt-get install gnuplot-nox)");
  writeTextFile(png, picture);
}

}  // namespace migiwa

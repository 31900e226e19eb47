#include "app/commands/gnuplot.h"

#include <cstdio>
#include <memory>

#include "core/base/error.h"

namespace migiwa {

namespace {

struct PipeCloser {
  void operator()(std::FILE* pipe) const { pclose(pipe); }
};

}  // namespace

void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script) {
  const std::filesystem::path temporary = png.string() + ".tmp";
  const std::string text =
      "set terminal " + terminal + "\nset output '" + temporary.string() + "'\n" + script;
  int status = -1;
  {
    std::unique_ptr<std::FILE, PipeCloser> pipe(popen("gnuplot 2>/dev/null", "w"));
    if (pipe) {
      std::fwrite(text.data(), 1, text.size(), pipe.get());
      status = pclose(pipe.release());
    }
  }
  if (status != 0 || !std::filesystem::exists(temporary)) {
    std::filesystem::remove(temporary);
    throw MissingError(png.string() + " needs gnuplot; install gnuplot-nox (apt-get install gnuplot-nox)");
  }
  std::filesystem::rename(temporary, png);
}

}  // namespace migiwa

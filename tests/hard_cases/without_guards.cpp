#include "tests/hard_cases/without_guards.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <iomanip>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <sys/wait.h>

namespace migiwa::testing {

namespace {

struct Printed {
  int code = 0;
  std::string text;
};

/// Runs a probe, which without its guards may fall or find no end.
Printed probe(Guards guards, const std::string& arguments, const std::string& before = "exec") {
  const std::string program = MIGIWA_GUARD_PROBE;
  // An own shell quotes nothing: what is passed are names and numbers of this file's.
  std::FILE* const pipe = popen(
      (before + " '" + program + "' " + (guards == Guards::on ? "on " : "off ") + arguments).c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + program);
  Printed printed;
  std::array<char, 512> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) printed.text += line.data();
  const int status = pclose(pipe);
  printed.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return printed;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::string withoutGuards(const HardCase& hardCase, std::uint64_t hash) {
  const Printed printed = probe(Guards::off, "case " + hardCase.name, "exec timeout 120");
  constexpr int kTimedOut = 124;
  if (printed.code == kTimedOut) return "no end within two minutes";
  std::istringstream text(printed.text);
  std::uint64_t other = 0;
  std::string words;
  if (printed.code != 0 || !(text >> std::hex >> other >> std::ws) || !std::getline(text, words))
    return "the program falls";
  return other == hash ? "same hash" : words;
}

NormalRun normalRun(const NormalScene& scene, Guards guards) {
  const Printed printed = probe(guards, "scene '" MIGIWA_SOURCE_DIR "/scenes/" + scene.name + ".json' " +
                                            std::to_string(scene.until) + " " + scene.override);
  NormalRun run;
  std::istringstream text(printed.text);
  text >> std::hex >> run.hash >> std::dec >> run.frames >> run.steps >> run.seconds;
  if (printed.code != 0 || !text) throw std::runtime_error(scene.name + ": " + printed.text);
  return run;
}

std::vector<NormalScene> normalScenes() {
  return {{"dam_break", 0.5, ""},
          {"still_tank", 0.3, ""},
          {"corner_drop", 0.4, ""},
          // Fewer planes than it has: fitting them takes longest.
          {"bowl", 0.3, "/boundary/surfaces/0/nodes=400"}};
}

std::string normalTable() {
  constexpr int kTurns = 5;
  std::ostringstream table;
  table << "| scene | until (s) | frames | steps | hash with | hash without | ms a step with | without | "
           "with/without (quartiles) |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const NormalScene& scene : normalScenes()) {
    std::vector<double> with, without, ratio;
    NormalRun on, off;
    for (int turn = 0; turn < kTurns; ++turn) {
      // Whoever comes second does so every other time.
      const bool first = turn % 2 == 0;
      if (first) on = normalRun(scene, Guards::on);
      off = normalRun(scene, Guards::off);
      if (!first) on = normalRun(scene, Guards::on);
      with.push_back(1000 * on.seconds / static_cast<double>(on.steps));
      without.push_back(1000 * off.seconds / static_cast<double>(off.steps));
      ratio.push_back(with.back() / without.back());
    }
    std::sort(ratio.begin(), ratio.end());
    table << "| [" << scene.name << "](../../scenes/" << scene.name << ".json) | " << scene.until << " | "
          << on.frames << " | " << on.steps << " | " << std::hex << std::setfill('0') << std::setw(16)
          << on.hash << " | " << std::setw(16) << off.hash << std::dec << std::setprecision(3) << " | "
          << median(with) << " | " << median(without) << " | " << std::fixed << median(ratio) << " ("
          << ratio[kTurns / 4] << " to " << ratio[kTurns - 1 - kTurns / 4] << ") |\n"
          << std::defaultfloat;
  }
  return table.str();
}

}  // namespace migiwa::testing

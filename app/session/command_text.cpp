#include "app/session/command_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "app/session/time_line.h"

namespace migiwa {
namespace {

/// The shortest that reads back as the same number.
std::string exactNumber(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

/// Of times that are sums of steps: with the digits that tell steps apart.
std::string timeText(double seconds, double step) {
  for (int digits = 1; digits < 17; ++digits) {
    std::array<char, 32> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), seconds, std::chars_format::general, digits);
    double rounded = seconds;
    std::from_chars(text.data(), end.ptr, rounded);
    if (std::abs(rounded - seconds) < 1e-6 * step) return exactNumber(rounded);
  }
  return exactNumber(seconds);
}

class Words {
 public:
  void add(std::string_view word) { text_ += (text_.empty() ? "" : " ") + shellWord(word); }
  void add(std::string_view option, std::string_view value) {
    add(option);
    add(value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void addSettings(const ShownMoment& shown, Words& words) {
  Settings known{shown.scene.solver, shown.scene.boundary, shown.scene.effects};
  std::vector<TimeLineView::Change> history = shown.line.history;
  // What was asked for a moment ago.
  history.push_back({shown.line.time, shown.settings});
  for (std::size_t k = 0; k < history.size(); ++k) {
    // Of several at one time the last is in force.
    if (k + 1 < history.size() && history[k + 1].time == history[k].time) continue;
    const TimeLineView::Change& now = history[k];
    for (const std::string& change : changesBetween(known, now.settings))
      // Also at the start: a run that is begun with a setting is another than one that is given it.
      words.add("--set-at", timeText(now.time, now.settings.solver.timeStep) + ":" + change);
    known = now.settings;
  }
}

void addView(const ShownMoment& shown, Words& words) {
  Scene seen = shown.scene;
  seen.view.camera = shown.view.camera;
  if (shown.stretch != 1) {
    constexpr double kHalfDegree = std::numbers::pi / 360;
    double& degrees = seen.view.camera.fovDegrees;
    degrees = std::atan(std::tan(degrees * kHalfDegree) * shown.stretch) / kHalfDegree;
  }
  seen.view.clip = shown.view.clip;
  if (shown.view.color != seen.view.color) seen.view.hasColorRange = false;
  seen.view.color = shown.view.color;
  seen.view.nodes = shown.view.nodes;
  for (const std::string& change : viewChangesBetween(shown.scene, seen)) words.add("--set", change);
}

void addSection(const SectionView& section, const Vec3d& origin, Words& words) {
  const Vec3d along = section.direction();
  const std::string at = exactNumber(section.at + along.dot(origin));
  if (section.free) {
    const Vec3d& n = section.normal;
    words.add("--normal", exactNumber(n.x()) + "," + exactNumber(n.y()) + "," + exactNumber(n.z()));
    words.add("--offset", at);
  } else {
    words.add("--plane", std::string(1, "xyz"[static_cast<std::size_t>(section.axis)]) + "=" + at);
  }
  words.add("--field", kSectionFieldNames[static_cast<std::size_t>(section.field)]);
  if (section.divisor != SectionDivisor::sum)
    words.add("--divisor", kSectionDivisorNames[static_cast<std::size_t>(section.divisor)]);
  if (!section.cut) words.add("--no-cut");
  if (!section.lines) words.add("--no-lines");
  if (section.fit) words.add("--fit");
}

}  // namespace

std::string shellWord(std::string_view word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string_view::npos) return std::string(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

CommandModel commandFor(const ShownMoment& shown) {
  Words words;
  words.add("migiwa");
  words.add("render");
  words.add(shown.file.string());
  for (const Override& set : shown.overrides) words.add("--set", set.pointer + "=" + set.value);
  addSettings(shown, words);
  addView(shown, words);
  words.add("--times", timeText(shown.line.time, shown.settings.solver.timeStep));
  words.add("--size", std::to_string(shown.width) + "x" + std::to_string(shown.height));
  words.add("--scale", exactNumber(shown.scale));
  if (shown.view.water) words.add("--style", "water");
  if (!shown.view.walls) words.add("--hide-walls");
  if (shown.view.section.shown) addSection(shown.view.section, shown.scene.origin, words);
  words.add("--out", "pictures");

  CommandModel command;
  command.text = words.take();
  if (!shown.saved)
    command.lacks.emplace_back("The scene's text was changed and is not in its file: \"Save as\" first.");
  if (!shown.line.historyIsWhole)
    command.lacks.emplace_back(
        "The run did not begin with the scene, or its beginning is no longer kept: the command begins "
        "there.");
  if (shown.view.scale != ColorScale::cool)
    command.lacks.emplace_back("Colours are from blue to yellow there.");
  if (shown.inspects) command.lacks.emplace_back("The particle that is looked into is not drawn.");
  return command;
}

}  // namespace migiwa

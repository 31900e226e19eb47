// Scripts of the window: events at its widgets, by their names, and pictures of it.
#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "app/commands/pictures.h"
#include "app/platform/context.h"
#include "app/ui/shown_text.h"
#include "app/viewer/hands.h"
#include "app/viewer/scene_window.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/scene/json.h"

namespace migiwa {
namespace {

using ScriptClock = std::chrono::steady_clock;

constexpr double kLongestWait = 600;  // (s)
constexpr double kUsualWait = 60;     // (s), for a text
constexpr int kStill = 12;            ///< looks without news after which nothing is awaited
constexpr std::chrono::milliseconds kBetweenLooks(10);

struct NamedKey {
  std::string_view name;
  Key key;
};
constexpr auto kScriptKeys = std::to_array<NamedKey>({
    {"tab", Key::tab},
    {"left", Key::left},
    {"right", Key::right},
    {"up", Key::up},
    {"down", Key::down},
    {"home", Key::home},
    {"end", Key::end},
    {"delete", Key::remove},
    {"enter", Key::enter},
    {"escape", Key::escape},
    {"space", Key::space},
    {"f1", Key::f1},
    {"backspace", Key::backspace},
    {"a", Key::a},
    {"c", Key::c},
    {"h", Key::h},
    {"p", Key::p},
    {"r", Key::r},
    {"v", Key::v},
    {"x", Key::x},
    {"y", Key::y},
    {"z", Key::z},
});
constexpr std::array<std::string_view, 3> kButtonNames{"left", "right", "middle"};

/// What events there are, and which keys each may have beside its own.
struct EventKind {
  std::string_view name;
  std::vector<std::string_view> beside;
};
const std::vector<EventKind>& eventKinds() {
  static const std::vector<EventKind> kinds{
      {"press", {"at", "in"}},
      {"drag", {"from", "to", "in"}},
      {"choose", {"entry", "in"}},
      {"type", {}},
      {"key", {"control", "shift"}},
      {"move", {}},
      {"click", {"control", "shift", "button"}},
      {"double_click", {}},
      {"drag_view", {"control", "shift", "button"}},
      {"wheel", {"over", "control"}},
      {"play_to", {}},
      {"wait", {}},
      {"wait_for", {"within"}},
      {"wait_while", {"within"}},
      {"picture", {}},
  };
  return kinds;
}

/// One event of a script: its values, and faults at its line.
class ScriptEvent {
 public:
  ScriptEvent(std::string place, const Json& json) : place_(std::move(place)), json_(json) {
    if (!json.is_object()) refuse("an object such as {\"press\": \"Play\"}", describeJson(json));
    std::vector<std::string_view> names;
    for (const EventKind& kind : eventKinds()) {
      names.push_back(kind.name);
      if (json.contains(kind.name)) kind_ = kind_ == nullptr ? &kind : throw InputError(place_, both(kind));
    }
    if (kind_ == nullptr) refuse("one of " + quotedList(names), foundKeys(names));
    for (const auto& [key, value] : json.items()) {
      const auto& beside = kind_->beside;
      if (key != kind_->name && std::find(beside.begin(), beside.end(), key) == beside.end())
        refuse("nothing but " +
                   (beside.empty() ? "\"" + std::string(kind_->name) + "\"" : quotedList(beside)) + " in it",
               "\"" + key + "\"");
    }
  }

  const std::string& place() const { return place_; }
  std::string_view kind() const { return kind_->name; }
  std::string text() const { return text(kind_->name); }
  std::string text(std::string_view key) const {
    if (!json_.contains(key) || !json_.at(key).is_string())
      refuse("a text in \"" + std::string(key) + "\"", found(key));
    if (json_.at(key).get_ref<const std::string&>().empty())
      refuse("a text of at least one letter in \"" + std::string(key) + "\"", "an empty one");
    return json_.at(key).get<std::string>();
  }
  /// The title of the panel in which the widget is to be; empty: in any.
  std::string panel() const { return json_.contains("in") ? text("in") : ""; }
  /// `otherwise` where the event has none.
  double number(std::string_view key, double low, double high, std::optional<double> otherwise = {}) const {
    if (otherwise && !json_.contains(key)) return *otherwise;
    const bool there = json_.contains(key) && json_.at(key).is_number();
    const double value = there ? json_.at(key).get<double>() : low;
    if (!there || !(value >= low && value <= high))
      refuse("a number in [" + formatNumber("%g", low) + ", " + formatNumber("%g", high) + "] in \"" +
                 std::string(key) + "\"",
             found(key));
    return value;
  }
  bool flag(std::string_view key) const {
    if (!json_.contains(key)) return false;
    if (!json_.at(key).is_boolean()) refuse("true or false in \"" + std::string(key) + "\"", found(key));
    return json_.at(key).get<bool>();
  }
  /// Places over the view, as shares of its width and height, from the top left.
  std::vector<std::array<double, 2>> places(std::string_view key, std::size_t count) const {
    const Json all = !json_.contains(key) ? Json()
                     : count == 1         ? Json::array({json_.at(key)})
                                          : json_.at(key);
    std::vector<std::array<double, 2>> places;
    const auto isShare = [](const Json& v) {
      return v.is_number() && v.get<double>() >= 0 && v.get<double>() <= 1;
    };
    for (const Json& place : all.is_array() ? all : Json::array())
      if (place.is_array() && place.size() == 2 && isShare(place[0]) && isShare(place[1]))
        places.push_back({place[0].get<double>(), place[1].get<double>()});
    if (places.size() != count || all.size() != count)
      refuse(std::string(count == 1 ? "a place [x, y]" : "two places [[x, y], [x, y]]") + " in \"" +
                 std::string(key) + "\", each from 0 to 1",
             found(key));
    return places;
  }
  std::size_t oneOf(std::string_view key, std::span<const std::string_view> names) const {
    const std::string name = text(key);
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) refuse("one of " + quotedList(names), "\"" + name + "\"");
    return static_cast<std::size_t>(at - names.begin());
  }
  Hands::Held held() const {
    Hands::Held held{flag("control"), flag("shift")};
    if (json_.contains("button")) held.button = static_cast<MouseButton>(oneOf("button", kButtonNames));
    return held;
  }
  [[noreturn]] void refuse(const std::string& expected, const std::string& found) const {
    throw InputError(place_, "expected " + expected + ", found " + found);
  }

 private:
  std::string found(std::string_view key) const {
    return json_.contains(key) ? describeJson(json_.at(key)) : "none";
  }
  std::string both(const EventKind& other) const {
    return "expected one event, found both \"" + std::string(kind_->name) + "\" and \"" +
           std::string(other.name) + "\"";
  }
  std::string foundKeys(std::span<const std::string_view> names) const {
    if (json_.empty()) return "none";
    const std::string key = json_.begin().key();
    return "\"" + key + "\"; did you mean \"" + std::string(nearestName(key, names)) + "\"?";
  }

  std::string place_;
  const Json& json_;
  const EventKind* kind_ = nullptr;
};

/// Where the entries of a text begin that is a JSON array (bytes).
std::vector<std::size_t> beginsOfEntries(std::string_view text) {
  std::vector<std::size_t> begins;
  int depth = 0;
  bool quoted = false, next = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (next && std::string_view(" \t\r\n]").find(c) == std::string_view::npos) {
      begins.push_back(k);
      next = false;
    }
    if (quoted && c == '\\') ++k;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth == 1 && (c == '[' || c == ',') && (c == ',' || begins.empty())) next = true;
  }
  return begins;
}

/// Throws what can be told before anything is done.
void checkEvent(const ScriptEvent& event, const Scene& scene) {
  const std::string_view kind = event.kind();
  if (kind == "press" || kind == "drag" || kind == "choose" || kind == "type" || kind == "wait_for" ||
      kind == "wait_while" || kind == "picture")
    event.text();
  if (kind == "press") event.number("at", 0, 1, 0);
  if (kind == "drag") event.number("from", 0, 1), event.number("to", 0, 1);
  if (kind == "choose") event.text("entry");
  if (kind == "key") {
    std::vector<std::string_view> names;
    for (const NamedKey& key : kScriptKeys) names.push_back(key.name);
    event.oneOf("key", names);
  }
  if (kind == "move" || kind == "click" || kind == "double_click") event.places(kind, 1);
  if (kind == "drag_view") event.places(kind, 2);
  if (kind == "wheel") event.number("wheel", -100, 100), event.places("over", 1);
  if (kind == "play_to") requireReachable(scene, event.number("play_to", 0, kLongestRun), event.place());
  if (kind == "wait") event.number("wait", 0, kLongestWait);
  if (kind == "wait_for" || kind == "wait_while") event.number("within", 0, kLongestWait, kUsualWait);
  if (kind == "picture" && (!event.text().ends_with(".png") || event.text().find('/') != std::string::npos))
    event.refuse("a name without a folder that ends in .png", "\"" + event.text() + "\"");
  event.held();
  event.panel();
}

/// The window of a scene, and hands at it.
class ScriptedWindow {
 public:
  ScriptedWindow(const RenderJob& job, const WindowOptions& options, const SceneWindow::Look& look,
                 int threads)
      : job_(job),
        window_(job.variants.front().scene,
                std::make_unique<SimulationThread>(job.variants.front().scene, threads, Pace::realTime,
                                                   options.past),
                options, look),
        hands_([this](const InputState& input) { frame(input); }) {
    hands_.look();
  }

  void carryOut(const ScriptEvent& event) {
    const std::string_view kind = event.kind();
    if (kind == "press") {
      hands_.click(widget(event, event.text(), share(event, "at")), {});
    } else if (kind == "drag") {
      hands_.drag(widget(event, event.text(), share(event, "from")),
                  widget(event, event.text(), share(event, "to")), {});
    } else if (kind == "choose") {
      hands_.click(widget(event, event.text(), {}), {});
      hands_.look();
      const auto entry = placeOfText(event.text("entry"), true);
      hands_.click(entry ? *entry : widget(event, event.text("entry"), {}, false), {});
    } else if (kind == "type") {
      hands_.type(event.text());
    } else if (kind == "key") {
      const std::string name = event.text();
      const auto key = std::find_if(kScriptKeys.begin(), kScriptKeys.end(),
                                    [&](const NamedKey& one) { return one.name == name; });
      hands_.press(key->key, event.held());
    } else if (kind == "move") {
      hands_.moveTo(over(event, kind));
    } else if (kind == "click") {
      hands_.moveTo(over(event, kind));
      hands_.click(over(event, kind), event.held());
    } else if (kind == "double_click") {
      hands_.doubleClick(over(event, kind));
    } else if (kind == "drag_view") {
      const auto places = event.places(kind, 2);
      hands_.drag(pixel(places[0]), pixel(places[1]), event.held());
    } else if (kind == "wheel") {
      hands_.wheel(over(event, "over"), static_cast<float>(event.number(kind, -100, 100)), event.held());
    } else if (kind == "play_to") {
      playTo(event, event.number(kind, 0, kLongestRun));
    } else if (kind == "wait") {
      const auto until =
          ScriptClock::now() + std::chrono::duration<double>(event.number(kind, 0, kLongestWait));
      while (ScriptClock::now() < until) pass();
    } else if (kind == "wait_for" || kind == "wait_while") {
      waitFor(event, kind == "wait_for");
    } else {
      settle();
      const std::filesystem::path file = job_.folder / event.text();
      writeTextFile(file, encodePng(window_.viewer().picture()));
      std::cout << file.string() << std::endl;
    }
  }

  /// Pictures that keys asked for, too; throws where one could not be kept.
  void keepAll() { window_.keepAll(); }

 private:
  void frame(const InputState& input) {
    window_.poll();
    window_.draw(input, job_.width, job_.height);
    window_.carryOut();
    if (input.mouseInside) last_ = input;
  }
  /// A frame in which nothing is done, with the mouse where it was.
  void pass() {
    InputState rest = last_;
    rest.buttons = {};
    rest.wheel = 0;
    rest.seconds = 0.5;
    frame(rest);
    std::this_thread::sleep_for(kBetweenLooks);
  }
  /// Until nothing more comes of what was done.
  void settle() {
    const auto until = ScriptClock::now() + std::chrono::duration<double>(kUsualWait);
    for (int still = 0; still < kStill && ScriptClock::now() < until;) {
      const bool playing = window_.run().playing || window_.run().line.underWay;
      still = playing || window_.busy() || window_.poll() != SceneWindow::News::none ? 0 : still + 1;
      if (playing) break;
      pass();
    }
    for (int k = 0; k < 3; ++k) pass();
  }
  static std::optional<double> share(const ScriptEvent& event, std::string_view key) {
    const double value = event.number(key, 0, 1, -1);
    return value < 0 ? std::nullopt : std::optional(value);
  }
  Hands::Place pixel(const std::array<double, 2>& share) {
    const Rect& area = window_.viewer().area();
    return {static_cast<float>(area.x + share[0] * (area.width - 1)),
            static_cast<float>(area.y + share[1] * (area.height - 1))};
  }
  Hands::Place over(const ScriptEvent& event, std::string_view key) { return pixel(event.places(key, 1)[0]); }
  Hands::Place widget(const ScriptEvent& event, const std::string& name, std::optional<double> share,
                      bool inPanel = true) {
    hands_.look();
    const std::string panel = inPanel ? event.panel() : "";
    const auto place = placeOfWidget(name, share, panel);
    if (place) return *place;
    const std::vector<std::string> open = openPanels();
    if (!panel.empty() && std::find(open.begin(), open.end(), panel) == open.end())
      event.refuse("in \"in\" a panel that is open, one of " +
                       quotedList(std::vector<std::string_view>(open.begin(), open.end())),
                   "\"" + panel + "\"");
    if (!panel.empty() && placeOfWidget(name, share))
      event.refuse("\"" + name + "\" in the panel \"" + panel + "\"", "it elsewhere alone");
    const std::vector<std::string> near = namesLike(name, 5);
    event.refuse("something that is shown, such as " +
                     quotedList(std::vector<std::string_view>(near.begin(), near.end())),
                 "\"" + name + "\"");
  }
  /// Frame by frame, so that it ends at that time and not near it.
  void playTo(const ScriptEvent& event, double time) {
    SimulationThread& simulation = window_.simulation();
    settle();
    simulation.pause();
    const TimeLineView line = simulation.status().line;
    if (time < line.time - 0.5 * window_.viewer().settings().solver.timeStep)
      event.refuse("a time at or after that of now, " + formatNumber("%g s", line.time),
                   formatNumber("%g s", time));
    for (RunStatus run = simulation.status();; run = simulation.status()) {
      const double step = window_.viewer().settings().solver.timeStep;
      if (run.stopped)
        event.refuse("a run that reaches " + formatNumber("%g s", time), "that it stopped: " + run.trouble);
      if (run.line.time + 0.5 * step > time) break;
      simulation.step();
      for (int waits = 0; simulation.status().line.frame == run.line.frame && !simulation.status().stopped;
           ++waits)
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      window_.poll();
    }
    hands_.look();
  }
  /// Until the text is shown, or no longer.
  void waitFor(const ScriptEvent& event, bool shown) {
    const double within = event.number("within", 0, kLongestWait, kUsualWait);
    const auto until = ScriptClock::now() + std::chrono::duration<double>(within);
    while ((shownText().find(event.text()) != std::string::npos) != shown) {
      if (ScriptClock::now() > until) {
        const std::string expected = "\"" + event.text() + "\" to be " + (shown ? "shown" : "gone") +
                                     " within " + formatNumber("%g s", within);
        if (!shown) event.refuse(expected, "it still there");
        const std::vector<std::string> near = namesLike(event.text(), 3);
        event.refuse(expected, "nothing nearer than " +
                                   quotedList(std::vector<std::string_view>(near.begin(), near.end())));
      }
      pass();
    }
  }

  const RenderJob& job_;
  SceneWindow window_;
  Hands hands_;
  InputState last_;
};

}  // namespace

void runScript(const std::filesystem::path& script, const RenderJob& job, const RenderOptions& options,
               const CommonOptions& common) {
  const std::string text = readTextFile(script, "a script");
  const JsonDocument document = parseJson(text);
  FaultCollector collect;
  std::vector<Fault> faults;
  for (const DocumentFault& fault : document.faults)
    faults.push_back({script.string() + ":" + fault.pointer, fault.message});
  // Of a text that is no JSON the place is a line.
  if (!document.broken) {
    const std::vector<int> lines = linesOfFaults(faults, text, script);
    for (std::size_t k = 0; k < faults.size(); ++k)
      faults[k] = {script.string() + ":" + std::to_string(lines[k]),
                   document.faults[k].pointer + ": " + document.faults[k].message};
  }
  for (Fault& fault : faults) collect.add(std::move(fault));
  collect.raise();
  if (!document.root.is_array())
    throw InputError(script.string(), "expected a list of events, found " + describeJson(document.root));
  std::vector<ScriptEvent> events;
  const std::vector<std::size_t> offsets = beginsOfEntries(text);
  std::ptrdiff_t line = 1, from = 0;
  for (std::size_t k = 0; k < document.root.size(); ++k) {
    const auto at = static_cast<std::ptrdiff_t>(offsets.at(k));
    line += std::count(text.begin() + std::exchange(from, at), text.begin() + at, '\n');
    collect([&] {
      events.emplace_back(script.string() + ":" + std::to_string(line) + ": event " + std::to_string(k + 1),
                          document.root[k]);
      checkEvent(events.back(), job.variants.front().scene);
    });
  }
  collect.raise();

  const auto context = makeEglContext();
  int pictures = 0, sections = 0;
  const auto number = [](int count) {
    const std::string digits = std::to_string(count);
    return std::string(4 - std::min<std::size_t>(digits.size(), 4), '0') + digits;
  };
  WindowOptions window;
  window.threads = common.threads;
  window.overrides = common.overrides;
  window.playing = false;
  window.water = job.style == RenderStyle::water;
  window.savePicture = [&](const Image& image) {
    writeTextFile(job.folder / ("migiwa_" + number(++pictures) + ".png"), encodePng(image));
  };
  window.saveSection = [&](const std::string& csv) {
    writeTextFile(job.folder / ("migiwa_section_" + number(++sections) + ".csv"), csv);
  };
  ScriptedWindow stage(job, window, {.scale = job.scale, .timings = options.timings}, common.threads);
  for (const ScriptEvent& event : events) stage.carryOut(event);
  stage.keepAll();
}

}  // namespace migiwa

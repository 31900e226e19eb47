#include "app/session/undo.h"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "app/session/time_line.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

/// Of plain numbers: bytes tell at once that nothing has changed, as mostly.
template <class Parameters>
bool sameBytes(const Parameters& a, const Parameters& b) {
  static_assert(std::is_trivially_copyable_v<Parameters>);
  return std::memcmp(&a, &b, sizeof a) == 0;
}

bool same(const Settings& a, const Settings& b) {
  const bool parameters = (sameBytes(a.solver, b.solver) && sameBytes(a.boundary, b.boundary)) ||
                          changesBetween({a.solver, a.boundary, {}}, {b.solver, b.boundary, {}}).empty();
  // Effects never change: another value is another object.
  return parameters && std::equal(a.effects.begin(), a.effects.end(), b.effects.begin(), b.effects.end(),
                                  [](const NamedEffect& one, const NamedEffect& other) {
                                    return one.name == other.name && one.effect == other.effect;
                                  });
}

std::string onOff(const char* what, bool on) {
  return std::string(what) + (on ? " on" : " off");
}

std::string sectionChange(const SectionView& before, const SectionView& now) {
  if (before.shown != now.shown) return onOff("section", now.shown);
  if (before.field != now.field)
    return "section: " + std::string(kSectionFieldNames[static_cast<std::size_t>(now.field)]);
  if (before.divisor != now.divisor)
    return "section: divided by " + std::string(kSectionDivisorNames[static_cast<std::size_t>(now.divisor)]);
  if (before.free != now.free || before.axis != now.axis || before.normal != now.normal)
    return "section: its plane";
  if (before.at != now.at) return formatNumber("section at %.4g m", now.at);
  if (before.cut != now.cut) return onOff("section cuts away", now.cut);
  if (before.lines != now.lines) return onOff("section: lines", now.lines);
  return onOff("section: fit", now.fit);
}

/// Empty where nothing is different.
std::string viewChange(const ViewState& before, const ViewState& now) {
  if (before.color != now.color)
    return "colour: " + std::string(kColorFieldNames[static_cast<std::size_t>(now.color)]);
  if (before.water != now.water) return onOff("water", now.water);
  if (before.walls != now.walls) return onOff("walls", now.walls);
  if (before.nodes != now.nodes) return onOff("nodes", now.nodes);
  if (before.panels != now.panels) return onOff("panels", now.panels);
  if (before.clip.enabled != now.clip.enabled) return onOff("cut", now.clip.enabled);
  if (before.clip != now.clip) return formatNumber("cut at %.4g m", now.clip.at);
  if (before.section != now.section) return sectionChange(before.section, now.section);
  if (before.theme != now.theme)
    return "theme: " + std::string(kThemeNames[static_cast<std::size_t>(now.theme)]);
  if (before.scale != now.scale)
    return "colours: " + std::string(kColorScaleNames[static_cast<std::size_t>(now.scale)]);
  if (before.plotted != now.plotted)
    return "plot: " + std::string(now.plotted < kMeasureCount ? kMeasureNames[now.plotted] : "all measures");
  return before.camera == now.camera ? "" : "camera";
}

/// `state` with what differs between the two as it is in `to`: all of it where they are of different scenes.
Undoable taken(Undoable state, const Undoable& from, const Undoable& to) {
  if (from.applied != to.applied) return to;
  if (!same(from.settings, to.settings)) state.settings = to.settings;
  if (!(from.view == to.view)) state.view = to.view;
  if (from.text != to.text) state.text = to.text;
  return state;
}

}  // namespace

bool Undoable::operator==(const Undoable& other) const {
  return same(settings, other.settings) && view == other.view && text == other.text &&
         applied == other.applied;
}

std::string changeName(const Undoable& before, const Undoable& now) {
  if (before.applied != now.applied) return "scene taken over";
  if (before.text != now.text) return "scene text";
  if (!same(before.settings, now.settings)) {
    const std::vector<std::string> changes = changesBetween(before.settings, now.settings);
    if (!changes.empty())
      return changes.front() +
             (changes.size() > 1 ? ", " + std::to_string(changes.size() - 1) + " more" : "");
  }
  const std::string view = viewChange(before.view, now.view);
  return view.empty() ? "settings" : view;
}

void UndoHistory::begin(Undoable now) {
  done_.clear();
  undone_.clear();
  last_ = seen_ = std::move(now);
  still_ = 0;
}

void UndoHistory::look(const Undoable& now, bool busy, double seconds) {
  // Where nothing happens no frame is drawn: what was at rest for long is a change before this one.
  if (!busy_ && pending() && still_ + seconds >= kPause) push(Undoable(seen_));
  const bool changed = !(now == seen_);
  still_ = changed || busy ? 0 : still_ + seconds;
  seen_ = now;
  busy_ = busy;
  if (busy || changed || now == last_) return;
  // The wheel has no end that can be seen: the camera and a plane count once they have come to rest.
  Undoable moved = now;
  moved.view.camera = last_.view.camera;
  moved.view.section.at = last_.view.section.at;
  if (!(moved == last_) || still_ >= kPause) push(now);
}

void UndoHistory::push(const Undoable& now) {
  done_.push_back({changeName(last_, now), last_, now});
  if (done_.size() > kMost) done_.pop_front();
  undone_.clear();
  last_ = now;
}

void UndoHistory::follow(const Undoable& now) {
  if (pending()) push(Undoable(seen_));
  last_ = seen_ = now;
  still_ = 0;
  while (!done_.empty() && taken(now, done_.back().after, done_.back().before) == now) done_.pop_back();
}

const Undoable& UndoHistory::undo() {
  if (pending()) push(Undoable(seen_));
  Entry entry = std::move(done_.back());
  done_.pop_back();
  // What a scene brought with it, it has again.
  if (entry.before.applied != entry.after.applied) entry.after = last_;
  last_ = seen_ = taken(std::move(last_), entry.after, entry.before);
  undone_.push_back(std::move(entry));
  return last_;
}

const Undoable& UndoHistory::redo() {
  Entry entry = std::move(undone_.back());
  undone_.pop_back();
  last_ = seen_ = taken(std::move(last_), entry.before, entry.after);
  done_.push_back(std::move(entry));
  return last_;
}

std::vector<std::string> UndoHistory::done() const {
  std::vector<std::string> names;
  if (pending()) names.push_back(changeName(last_, seen_));
  for (auto entry = done_.rbegin(); entry != done_.rend(); ++entry) names.push_back(entry->name);
  return names;
}

std::vector<std::string> UndoHistory::undone() const {
  std::vector<std::string> names;
  if (pending()) return names;
  for (auto entry = undone_.rbegin(); entry != undone_.rend(); ++entry) names.push_back(entry->name);
  return names;
}

}  // namespace migiwa

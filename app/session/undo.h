// What a person has changed in the window, to be taken back and done again: settings, view and the scene's
// text. No window, no OpenGL.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "app/session/ui_state.h"

namespace migiwa {

/// All that can be undone, at one moment.
struct Undoable {
  Settings settings;
  ViewState view;
  std::string text;     ///< of the scene, as it stands in the editor
  std::string applied;  ///< the text that was last taken over

  bool operator==(const Undoable& other) const;
};

class UndoHistory {
 public:
  /// Changes that are kept; beyond that the oldest go.
  static constexpr std::size_t kMost = 200;

  /// Forgets everything: from here on changes count.
  void begin(Undoable now);
  /// The state after a frame. `busy`: a change is still being made, such as by a slider that is held. Turns
  /// of the wheel within `kPause` s are one change.
  void look(const Undoable& now, bool busy, double seconds);
  /// The state has changed, but by nobody: it is not a change of its own. What was changed before counts, and
  /// what an entry then would not change any more is dropped.
  void follow(const Undoable& now);

  bool canUndo() const { return !done_.empty() || pending(); }
  bool canRedo() const { return !undone_.empty() && !pending(); }
  /// Takes back the last change: the present state with what the change was of, settings, view or text, as it
  /// was before. Needs canUndo().
  const Undoable& undo();
  /// Does the one again that was taken back last. Needs canRedo().
  const Undoable& redo();

  /// Names of changes: those that undo() takes back, the last first, and those that redo() does again.
  std::vector<std::string> done() const;
  std::vector<std::string> undone() const;

 private:
  static constexpr double kPause = 0.6;
  struct Entry {
    std::string name;
    Undoable before, after;
  };

  /// A change whose end has not been seen yet is one, too.
  bool pending() const { return !(seen_ == last_); }
  void push(const Undoable& now);

  Undoable last_;     ///< the state of the last entry's end
  Undoable seen_;     ///< in the last frame
  double still_ = 0;  ///< how long it has been so (s)
  bool busy_ = false;
  std::deque<Entry> done_, undone_;
};

/// What is different, in words such as "/solver/tolerance=0.01" or "camera".
std::string changeName(const Undoable& before, const Undoable& now);

}  // namespace migiwa

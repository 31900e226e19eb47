// The scene's JSON in the window: a text to edit with its faults marked at their lines. What it asks for is
// carried out by whoever owns the scene's file.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace migiwa {

struct SceneEditor {
  struct Fault {
    int line = 0;  ///< in the text, from 1; 0: elsewhere
    std::string message;
  };

  std::string fileName;  ///< whose text it is
  std::string text;
  std::string known;          ///< what the file holds
  std::vector<Fault> faults;  ///< of the last text that was tried
  std::string note;           ///< one line on what became of the last wish
  std::string saveName;
  bool open = false;
  bool apply = false, save = false, revert = false;  ///< what the user asks for; cleared by whoever does it

  int goTo = 0;             ///< line to put the caret on in the next frames; 0: none
  int caretLine = 1;        ///< where the caret is
  bool wantsFocus = false;  ///< the text is to take the keyboard in the next frame

  std::optional<std::string> replacement;  ///< for the widget, which has a copy of its own while it is edited

  bool edited() const { return text != known; }
  /// Another text, also while the caret is in it.
  void replaceText(std::string with) {
    text = with;
    replacement = std::move(with);
  }
};

struct Rect;
struct Fonts;

/// Draws the editor's window over `area`, if it is open.
void sceneEditorWindow(SceneEditor& editor, const Rect& area, const Fonts& fonts);

}  // namespace migiwa

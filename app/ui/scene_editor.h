// The scene's JSON in the window: a text to edit with its faults marked at their lines. What it asks for is
// carried out by whoever owns the scene's file.
#pragma once

#include <string>
#include <utility>
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

  bool active = false;  ///< the text has the keyboard
  int generation = 0;   ///< of the text: one that replaces another has nothing of that one's to undo

  bool edited() const { return text != known; }
  /// Another text, also while the caret is in it.
  void replaceText(std::string with) {
    text = std::move(with);
    ++generation;
    // The widget is a new one, and goes on where the old one was.
    if (active) wantsFocus = true, goTo = caretLine;
  }
};

struct Rect;
struct Fonts;

/// Draws the editor's window over `area`, if it is open.
void sceneEditorWindow(SceneEditor& editor, const Rect& area, const Fonts& fonts);

}  // namespace migiwa

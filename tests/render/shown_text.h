// What the panels show, and what they have put on the clipboard.
#pragma once

#include <string>

#include "app/ui/shown_text.h"

namespace migiwa {

/// What the current Ui has on its clipboard.
std::string clipboardText();

}  // namespace migiwa

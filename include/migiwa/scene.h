// Scenes: read from files and texts, written, checked.
//
//   readScene, parseScene, writeScene, sceneSchema, Override, Scene, InputError with its faults.
#pragma once

#include "core/base/messages.h"
#include "core/scene/scene_file.h"

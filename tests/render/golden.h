// Whether golden pictures are compared with or written.
#pragma once

namespace migiwa {

inline bool updateGolden = false;

}  // namespace migiwa

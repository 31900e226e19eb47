// Whether a PLY file holds all that its header promises. assimp 5.2 never comes back from a header that does
// not end, makes up zeros for what is missing of the rest, and asks for memory for as many corners as a face
// says.
#pragma once

#include <string>
#include <string_view>

namespace migiwa {

/// What is wrong with a PLY file of this content, as "expected ..., found ..."; empty where it seems whole.
std::string plyFault(std::string_view content);

}  // namespace migiwa

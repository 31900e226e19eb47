# Headers that nearly every file of ours reads, parsed once a target: reading them is two thirds of compiling a file.
set(migiwa_common_headers
  <algorithm> <array> <atomic> <charconv> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory>
  <numbers> <numeric> <optional> <span> <sstream> <string> <string_view> <unordered_map> <utility> <variant> <vector>
  <Eigen/Core> <Eigen/Geometry>)

# Files that are compiled once for every instruction set include themselves again, after the library that does so: they
# take no precompiled headers, and are joined with no other.
function(migiwa_skip_precompiled_in_vector_files)
  foreach(source IN LISTS ARGN)
    file(STRINGS ${source} vectors REGEX "hwy/foreach_target" LIMIT_COUNT 1)
    if(vectors)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
endfunction()

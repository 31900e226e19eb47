# The files of a room are compiled as one, which saves a third of the program's build: what
# they have in common, above all the JSON library and Eigen, is read and instantiated once. Files that have options of
# their own stay apart: those of the hot rooms, so that a change of the step compiles that file alone. Builds of the type Debug
# compile every file by itself, which shows what each must include.
function(migiwa_join_rooms target)
  if(CMAKE_BUILD_TYPE STREQUAL Debug)
    return()
  endif()
  # GCC takes every file that another includes for a header, in which classes with members from an unnamed namespace would
  # be a mistake.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME room)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(NOT options)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${room})
    endif()
  endforeach()
endfunction()

# migiwa_add_test(NAME SOURCES file... LABELS label... [LONG regex] [THREADS regex] [SUITES] [LINK library...] [TIMEOUT seconds])
#
# One GoogleTest program over migiwa_core, every TEST of it known to ctest by its own name; with SUITES, where tests take
# milliseconds, every suite by its name. Labels say what a test needs: unit (core only, short), accuracy (compares with
# slow quadratures), simulation (runs a scene), hard (a case of scenes/hard), golden (states to the last bit), render (a
# picture: needs EGL), window (needs a display), threads (worth running under the thread sanitizer). The target
# tests_LABEL builds all programs with that label. Tests whose names match THREADS have the label threads, too. Those
# that match LONG have the label long: ./run test leaves them to ./run check.
include(GoogleTest)
find_package(GTest REQUIRED)

set(migiwa_test_cache ${CMAKE_BINARY_DIR}/test_cache)
add_test(NAME test_cache_emptied COMMAND ${CMAKE_COMMAND} -E rm -rf ${migiwa_test_cache})
set_tests_properties(test_cache_emptied PROPERTIES FIXTURES_SETUP test_cache)

# Gives each of them a folder of its own.
add_library(migiwa_test_folder OBJECT ${PROJECT_SOURCE_DIR}/tests/support/own_folder.cpp)
target_link_libraries(migiwa_test_folder PUBLIC GTest::gtest_main)
migiwa_target_options(migiwa_test_folder)

# What all test programs read, parsed once for all of them.
file(WRITE ${CMAKE_BINARY_DIR}/precompiled_for_tests.cpp "// Nothing but the precompiled headers.\n")
add_library(migiwa_test_headers OBJECT ${CMAKE_BINARY_DIR}/precompiled_for_tests.cpp)
target_link_libraries(migiwa_test_headers PRIVATE migiwa_core GTest::gtest)
migiwa_target_options(migiwa_test_headers)
target_precompile_headers(migiwa_test_headers PRIVATE <gtest/gtest.h> ${migiwa_common_headers}
  "${PROJECT_SOURCE_DIR}/core/scene/scene.h" "${PROJECT_SOURCE_DIR}/core/simulation/simulation.h")

# Reads them in the files of a test program, whose own code is not what takes time.
function(migiwa_reuse_test_headers name)
  target_precompile_headers(${name} REUSE_FROM migiwa_test_headers)
  get_target_property(sources ${name} SOURCES)
  list(TRANSFORM sources PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  migiwa_skip_precompiled_in_vector_files(${sources})
endfunction()

function(migiwa_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SUITES" "TIMEOUT;LONG;THREADS" "SOURCES;LABELS;LINK")
  if(NOT arg_SOURCES OR NOT arg_LABELS OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "migiwa_add_test(${name}): expected SOURCES and LABELS, found '${ARGN}'")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()

  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE migiwa_core migiwa_test_folder ${arg_LINK})
  target_compile_definitions(${name} PRIVATE MIGIWA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  migiwa_target_options(${name})
  migiwa_reuse_test_headers(${name})
  # Half of what a test file takes is what it has in common with others. Each has a namespace of its own, named after it.
  if(NOT CMAKE_BUILD_TYPE STREQUAL Debug)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 5)
  endif()

  # Grids of gamma and fits of meshes are kept for one run of ctest: the first test that asks makes them, and none is left
  # from an earlier run, which would be no test of this one.
  # Labels are set by a file of our own that ctest reads after the discovery's: on its way through the discovery a list
  # of several labels would fall apart.
  set(labels_file ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
  set(program ${CMAKE_CURRENT_BINARY_DIR}/${name})
  if(arg_SUITES)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake @ONLY CONTENT [=[
set(listed)
if(EXISTS "@program@")
  execute_process(COMMAND "@program@" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
endif()
string(REGEX MATCHALL "\n[^ \n]+\\." @name@_list "\n${listed}")
list(TRANSFORM @name@_list REPLACE "\n(.+)\\." "\\1")
foreach(suite IN LISTS @name@_list)
  add_test("${suite}" "@program@" "--gtest_filter=${suite}.*")
  set_tests_properties("${suite}" PROPERTIES TIMEOUT @arg_TIMEOUT@ ENVIRONMENT "MIGIWA_CACHE=@migiwa_test_cache@" FIXTURES_REQUIRED test_cache)
endforeach()
]=])
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  else()
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES TEST_LIST ${name}_list
      PROPERTIES TIMEOUT ${arg_TIMEOUT} ENVIRONMENT "MIGIWA_CACHE=${migiwa_test_cache}" FIXTURES_REQUIRED test_cache)
  endif()
  set(targets ${arg_LABELS})
  if(arg_THREADS)
    list(APPEND targets threads)
  endif()
  foreach(pattern arg_LONG arg_THREADS)
    if(NOT ${pattern})
      set(${pattern} "^$")
    endif()
  endforeach()
  file(CONFIGURE OUTPUT ${labels_file} @ONLY CONTENT [=[
foreach(test IN LISTS @name@_list)
  set(labels "@arg_LABELS@")
  if(test MATCHES "@arg_LONG@")
    list(APPEND labels long)
  endif()
  if(test MATCHES "@arg_THREADS@")
    list(APPEND labels threads)
  endif()
  set_tests_properties(${test} PROPERTIES LABELS "${labels}")
endforeach()
]=])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels_file})

  foreach(label IN LISTS targets)
    if(NOT TARGET tests_${label})
      add_custom_target(tests_${label})
    endif()
    add_dependencies(tests_${label} ${name})
  endforeach()
endfunction()

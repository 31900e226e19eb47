# What every target of ours is compiled with. Debian's libraries are not held to our warnings.
function(migiwa_target_options target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion)
  if(MIGIWA_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  # GCC sees overlapping copies in every std::string concatenation (its bug 105651), with precompiled headers accesses
  # beyond the bounds of strings that have room, and from 13 on null dereferences where the standard library fills vectors
  # that are never empty.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread
      -Wno-array-bounds)
    if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
      target_compile_options(${target} PRIVATE -Wno-null-dereference)
    endif()
  endif()
  # No contraction and no fast-math: the state hash must not depend on what the compiler fuses.
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno)
  if(MIGIWA_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${MIGIWA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(${target} PRIVATE -fsanitize=${MIGIWA_SANITIZE})
    # Every temporary of Eigen's and every vector of lanes is an object on the stack: to poison each as it goes out of scope
    # makes the tests two to four times slower and takes up to half of the compilation. The preset fuzz keeps it.
    if(MIGIWA_SANITIZE MATCHES address AND NOT MIGIWA_SANITIZE MATCHES fuzzer)
      target_compile_options(${target} PRIVATE -fno-sanitize-address-use-after-scope)
    endif()
    # GCC sees null dereferences and uninitialised values in code that the sanitizers insert.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-null-dereference -Wno-maybe-uninitialized)
    endif()
  endif()
endfunction()

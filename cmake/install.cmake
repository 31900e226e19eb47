# What `cmake --install` puts where: the program with scenes and shaders (component program), and the library with its
# headers and CMake files (component dev).
include(CMakePackageConfigHelpers)

set(MIGIWA_DATA_DIR ${CMAKE_INSTALL_DATADIR}/migiwa)
set(migiwa_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/migiwa)

install(TARGETS migiwa_core EXPORT migiwaTargets ARCHIVE COMPONENT dev)
if(MIGIWA_SHARED)
  install(TARGETS migiwa_shared EXPORT migiwaTargets LIBRARY COMPONENT dev NAMELINK_COMPONENT dev)
endif()
install(EXPORT migiwaTargets NAMESPACE migiwa:: DESTINATION ${migiwa_cmake_dir} COMPONENT dev)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/migiwaConfig.cmake.in ${PROJECT_BINARY_DIR}/migiwaConfig.cmake
  INSTALL_DESTINATION ${migiwa_cmake_dir} PATH_VARS MIGIWA_DATA_DIR)
# Before 1.0 a new minor version may change what is public.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/migiwaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/migiwaConfig.cmake ${PROJECT_BINARY_DIR}/migiwaConfigVersion.cmake
  DESTINATION ${migiwa_cmake_dir} COMPONENT dev)
install(FILES ${PROJECT_BINARY_DIR}/include/migiwa/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/migiwa COMPONENT dev)
install(CODE "
  execute_process(COMMAND \${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}
    -DDESTINATION=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}
    -P ${PROJECT_SOURCE_DIR}/cmake/install_headers.cmake COMMAND_ERROR_IS_FATAL ANY)" COMPONENT dev)

if(MIGIWA_PROGRAM)
  install(TARGETS migiwa RUNTIME COMPONENT program)
endif()
# Whoever builds on the library alone gets the scenes with it.
if(NOT MIGIWA_PROGRAM)
  set(component dev)
else()
  set(component program)
endif()
install(DIRECTORY scenes DESTINATION ${MIGIWA_DATA_DIR} COMPONENT ${component}
  FILES_MATCHING PATTERN *.json PATTERN *.obj PATTERN README.md PATTERN thumbnails/*.png
  PATTERN studies EXCLUDE)
install(DIRECTORY shaders DESTINATION ${MIGIWA_DATA_DIR} COMPONENT ${component})

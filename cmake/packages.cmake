# The man page and the completion, of what the program itself says, and Debian packages by CPack.
option(MIGIWA_MANUAL "Write the man page and the completion for bash, which needs Python" OFF)
if(MIGIWA_PROGRAM)
  install(FILES ${PROJECT_SOURCE_DIR}/packaging/migiwa.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications
    COMPONENT program)
  install(FILES ${PROJECT_SOURCE_DIR}/packaging/migiwa.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps
    COMPONENT program)
endif()
if(MIGIWA_PROGRAM AND MIGIWA_MANUAL)
  set(manual ${PROJECT_BINARY_DIR}/manual)
  add_custom_command(OUTPUT ${manual}/migiwa.1 ${manual}/migiwa.bash
    COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/packaging/describe_program.py $<TARGET_FILE:migiwa> ${PROJECT_VERSION}
            ${manual}
    DEPENDS migiwa ${PROJECT_SOURCE_DIR}/packaging/describe_program.py
    VERBATIM)
  add_custom_target(migiwa_manual ALL DEPENDS ${manual}/migiwa.1 ${manual}/migiwa.bash)
  install(FILES ${manual}/migiwa.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${manual}/migiwa.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME migiwa
    COMPONENT program)
endif()

set(package_of_program migiwa)
set(package_of_dev libmigiwa-dev)
set(package_of_python python3-migiwa)
foreach(component program dev python)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package_of_${component}}
    RENAME copyright COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program dev)
if(MIGIWA_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGE_NAME migiwa)
set(CPACK_PACKAGE_VENDOR "The authors of Migiwa")
set(CPACK_PACKAGE_CONTACT "The authors of Migiwa <migiwa@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "particle fluids with the density corrected at walls")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME ${package_of_program})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "particle fluids with the density corrected at walls
 Simulates liquids with particles, position based. At walls the density is
 divided by the part of a particle's neighbourhood that no solid covers.
 With a window, pictures that need no display, and reports.")
# What shared libraries do not say: drivers without a graphics card, the font, gnuplot for maps, the bunny of two scenes,
# img2webp for films.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libegl1, libgl1, libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox, glmark2-data, webp")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME ${package_of_dev})
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "particle fluids with the density corrected at walls: library
 Headers, static and shared library and CMake files of Migiwa.")
# zlib1g-dev: Debian 12's libassimp-dev links it, and does not depend on it.
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev, libassimp-dev, zlib1g-dev, libhwy-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "migiwa")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME ${package_of_python})
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "particle fluids with the density corrected at walls: Python
 The Python package migiwa: scenes in motion as arrays of NumPy.")
if(MIGIWA_PYTHON)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), \
python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "migiwa")
include(CPack)

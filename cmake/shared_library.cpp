// The shared library is the static one as a whole. CMake wants a source for it.

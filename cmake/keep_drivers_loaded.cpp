// Compiled into sanitizer builds only. Graphics drivers leave a few bytes behind when they are unloaded, and
// a leak in an unloaded library cannot be told from one of ours. Keeping them loaded leaves those bytes
// reachable.
extern "C" int dlclose(void* handle);

extern "C" int dlclose(void*) {
  return 0;
}

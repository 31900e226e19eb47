"""known_race.py LIBRARY: two threads of Python race in a library that is built as the bindings are. The sanitizer has to
report it: as in the bindings, nothing but Python's lock is there to guard what is called, and it is given up."""

import ctypes
import sys
import threading

library = ctypes.CDLL(sys.argv[1])
threads = [threading.Thread(target=library.race) for _ in range(2)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()

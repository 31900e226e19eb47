"""How soon `migiwa view` answers while it plays, and what it costs when nothing happens.

Moves the mouse onto a button and off it again, through the display's test extension, and waits until the button looks
different on the display. Then drags the view, and waits until the picture is another. Then pauses, and counts the processor
time of ten seconds in which nothing is touched.

Needs a display without a window manager: xvfb-run -a -s "-screen 0 1280x720x24 -noreset" python3 THIS MIGIWA SCENE [OPTION...]
"""

import os
import pathlib
import statistics
import subprocess
import sys
import time

from Xlib import X

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "render"))
from window_hands import LEFT, Hands

ON, OFF = (60, 40), (300, 700)  # the button "Edit scene", and a place in the panels that has nothing
BUTTON = (12, 34, 30, 12)  # left, top, width, height of a part of it
VIEW = (700, 300, 200, 150)
TIMES, PATIENCE = 60, 5
REST = 10  # (s)


def seen(part):
    return hands.window.get_image(*part, X.ZPixmap, 0xFFFFFFFF).data


def until_different(part, before):
    """Seconds; reading the display takes a fraction of a millisecond."""
    start = time.monotonic()
    while seen(part) == before:
        if time.monotonic() > start + PATIENCE:
            sys.exit(f"the window did not answer within {PATIENCE} s")
    return time.monotonic() - start


def tell(what, seconds):
    ordered = sorted(1e3 * s for s in seconds)
    share = lambda part: ordered[min(int(part * len(ordered)), len(ordered) - 1)]
    print(f"{what}: median {statistics.median(ordered):.1f} ms, 90 % within {share(0.9):.1f} ms, all within {ordered[-1]:.1f} ms")


def hover():
    answers = []
    for k in range(TIMES):
        before = seen(BUTTON)
        hands.move(ON if k % 2 == 0 else OFF)
        answers.append(until_different(BUTTON, before))
        time.sleep(0.15 + 0.007 * (k % 11))  # at all phases of a frame
    return answers


def turn():
    answers = []
    hands.move((800, 350))
    time.sleep(0.5)
    hands.fake(X.ButtonPress, LEFT)
    time.sleep(0.5)
    for k in range(TIMES):
        before = seen(VIEW)
        hands.move((800 + 40 * (1 - k % 2 * 2), 350))
        answers.append(until_different(VIEW, before))
        time.sleep(0.15 + 0.007 * (k % 11))
    hands.fake(X.ButtonRelease, LEFT)
    return answers


def processor_seconds():
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


process = subprocess.Popen([sys.argv[1], "view", *sys.argv[2:]])
try:
    hands = Hands(lambda: process.poll() is None)
    hands.move(OFF)
    time.sleep(5)
    tell("a button under the mouse, playing", hover())
    hands.key("space")
    time.sleep(2)
    tell("a button under the mouse, paused", hover())
    tell("the view turned, paused", turn())
    hands.move(OFF)
    time.sleep(3)
    before = processor_seconds()
    time.sleep(REST)
    print(f"paused and untouched: {100 * (processor_seconds() - before) / REST:.2f} % of a core")
    hands.close()
    process.wait(60)
finally:
    process.kill()

"""Drives `migiwa view` as a hasty person would: clicks, drags, keys, the wheel, resizes, and scenes that change on the
disk, all drawn at random from a seed, through the display's own test extension (XTEST).

The window has to survive, to write only scenes that can be read again (a number that is not finite could not), and to
end with exit code 0 when it is closed. Driven for five minutes or more, its memory has to stay flat: the median of the
last quarter is at most a tenth above that of the second. The first quarter is for warming up.

Needs a display without a window manager, such as xvfb-run's. Everything lies in a scratch folder.

usage: drive_window.py SOURCE_FOLDER MIGIWA SECONDS [SEED]
"""

import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

from Xlib import X, XK, display
from Xlib.ext import xtest
from Xlib.protocol import event

SCENES = ("dam_break", "corner_drop", "stirred_tank", "bowl", "droplet", "faucet")
COARSER = 2
SCREEN = (1400, 900)
JUDGED_FROM = 300  # seconds of driving
MOST_GROWTH = 1.1
LEFT, MIDDLE, RIGHT, UP, DOWN = 1, 2, 3, 4, 5
# Typed text names no folder: there is no slash.
LETTERS = "abcdefghijklmnopqrstuvwxyz0123456789.,-[]= "
NAMES = {".": "period", ",": "comma", "-": "minus", "[": "bracketleft", "]": "bracketright", "=": "equal", " ": "space"}
KEYS = ("space", "Right", "r", "c", "p", "Tab", "Escape", "Return", "BackSpace", "Delete", "Home", "End", "Up", "Down", "Left")
EDITING = "acvxyz"  # with the control key

source, program, seconds = pathlib.Path(sys.argv[1]), sys.argv[2], float(sys.argv[3])
rng = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 1)


def fail(message):
    print(message, flush=True)
    print((scratch / "errors").read_text()[-4000:])
    process.kill()
    sys.exit(1)


def coarse(name):
    scene = json.loads((source / "scenes" / f"{name}.json").read_text())
    scene["particle_spacing"] *= COARSER
    return json.dumps(scene, indent=2)


class Window:
    """The one window on the display, and a person's hands."""

    def __init__(self):
        self.display = display.Display()
        self.window = None
        end = time.monotonic() + 60
        while self.window is None:
            if time.monotonic() > end or process.poll() is not None:
                fail("no window has opened")
            time.sleep(0.1)
            for child in self.display.screen().root.query_tree().children:
                if child.get_attributes().map_state == X.IsViewable and child.get_geometry().width > 100:
                    self.window = child
        self.window.set_input_focus(X.RevertToPointerRoot, X.CurrentTime)
        self.resize(1280, 720)

    def fake(self, kind, detail=0, x=0, y=0):
        xtest.fake_input(self.display, kind, detail, x=x, y=y)
        self.display.sync()

    def resize(self, width, height):
        self.size = (width, height)
        self.window.configure(x=0, y=0, width=width, height=height)
        self.display.sync()

    def anywhere(self):
        """Most often in the panels, at the left, and now and then where the editor, if open, has its buttons."""
        width, height = self.size
        where = rng.random()
        if where < 0.6:
            width = min(width, 330)
        top = max(height - 90, 0) if where > 0.85 else 0
        return rng.randrange(width), rng.randrange(top, height)

    def move(self, place):
        self.fake(X.MotionNotify, x=place[0], y=place[1])

    def click(self, button=LEFT, times=1):
        for _ in range(times):
            self.fake(X.ButtonPress, button)
            self.fake(X.ButtonRelease, button)

    def drag(self):
        start, end = self.anywhere(), self.anywhere()
        button, steps = rng.choice((LEFT, LEFT, MIDDLE, RIGHT)), rng.randint(1, 12)
        self.move(start)
        self.fake(X.ButtonPress, button)
        for k in range(1, steps + 1):
            self.move([a + (b - a) * k // steps for a, b in zip(start, end)])
            time.sleep(0.005)
        self.fake(X.ButtonRelease, button)

    def key(self, name, held=None):
        codes = [self.display.keysym_to_keycode(XK.string_to_keysym(n)) for n in (held, name) if n]
        for code in codes:
            self.fake(X.KeyPress, code)
        for code in reversed(codes):
            self.fake(X.KeyRelease, code)

    def type(self):
        for _ in range(rng.randint(1, 8)):
            letter = rng.choice(LETTERS)
            self.key(NAMES.get(letter, letter), rng.choice((None, None, "Shift_L")))

    def close(self):
        atom = self.display.intern_atom
        message = (32, [atom("WM_DELETE_WINDOW"), X.CurrentTime, 0, 0, 0])
        self.window.send_event(event.ClientMessage(window=self.window, client_type=atom("WM_PROTOCOLS"), data=message))
        self.display.sync()


class Disk:
    """The scratch folder. What the window saved there has to be a scene, or a text that was not changed."""

    def __init__(self):
        self.texts = {name: coarse(name) for name in SCENES}
        self.written = {}
        self.saved = 0
        self.turn = 0
        self.write(scratch / "scene.json", self.texts[SCENES[0]])

    def write(self, file, text):
        new = file.with_name("new.tmp")
        new.write_text(text)
        new.replace(file)
        self.written[file] = text

    def look(self):
        for picture in scratch.glob("*.png"):
            picture.unlink()
        for file in scratch.glob("*.json"):
            text = file.read_text()
            if self.written.get(file) == text:
                continue
            self.written[file] = text
            self.saved += 1
            check = subprocess.run([program, "check", str(file)], capture_output=True, text=True, env=environment)
            if check.returncode != 0:
                fail(f"{file.name} was saved by the window and cannot be read:\n{check.stderr}{text}")

    def reload(self):
        """The next scene in turn, now and then with a fault; into every file, for the window may show any."""
        self.look()
        self.turn += 1
        text = self.texts[SCENES[self.turn % len(SCENES)]]
        if rng.random() < 0.25:
            at = rng.randrange(len(text))
            text = text[:at] + rng.choice(LETTERS) + text[at + rng.randint(0, 2) :]
        for file in list(scratch.glob("*.json")):
            self.write(file, text)


def act(window, disk):
    if rng.random() < 0.6:
        window.move(window.anywhere())
    kind = rng.choices(range(9), weights=(36, 14, 12, 8, 6, 4, 4, 4, 3))[0]
    if kind == 0:
        window.click(rng.choice((LEFT, LEFT, LEFT, RIGHT, MIDDLE)), rng.choice((1, 1, 1, 2)))
    elif kind == 1:
        window.drag()
    elif kind == 2:
        window.key(rng.choice(KEYS))
    elif kind == 3:
        window.click(rng.choice((UP, DOWN)), rng.randint(1, 6))
    elif kind == 4:
        window.type()
    elif kind == 5:
        window.key(rng.choice(EDITING), "Control_L")
    elif kind == 6:
        tiny = rng.random() < 0.1
        window.resize(*(rng.randint(1, 40) if tiny else rng.randint(200, most) for most in SCREEN))
    elif kind == 7:
        # Panels hidden and shown again; in a text field these are letters.
        for _ in range(2):
            window.key("h")
            time.sleep(0.05)
    else:
        disk.reload()
    time.sleep(rng.uniform(0, 0.06))


def resident():
    """Bytes of memory that are the process's own."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return 1024 * int(status.split("RssAnon:")[1].split()[0])


with tempfile.TemporaryDirectory(prefix="migiwa_window_") as folder:
    scratch = pathlib.Path(folder) / "scenes"
    scratch.mkdir()
    environment = os.environ | {"HOME": folder, "MIGIWA_CACHE": folder}
    disk = Disk()
    with (scratch / "errors").open("w") as errors:
        process = subprocess.Popen([program, "view", "scene.json"], cwd=scratch, env=environment, stdout=errors, stderr=errors)
    window = Window()
    start, memory, acts = time.monotonic(), [], 0
    while (since := time.monotonic() - start) < seconds:
        act(window, disk)
        acts += 1
        if process.poll() is not None:
            fail(f"the window ended with exit code {process.returncode} after {since:.1f} s and {acts} acts")
        if since >= len(memory):
            memory.append(resident())
    disk.look()
    window.close()
    try:
        code = process.wait(600)
    except subprocess.TimeoutExpired:
        fail("the window did not close within ten minutes")
    if code != 0:
        fail(f"the window was closed and ended with exit code {code}")
    quarters = [statistics.median(memory[len(memory) * k // 4 :][: max(len(memory) // 4, 1)]) / 2**20 for k in range(4)]
    print(f"{acts} acts in {seconds:.0f} s, {disk.turn} reloads, {disk.saved} scenes saved, all valid; exit code 0")
    print("memory, medians of the quarters (MiB): " + ", ".join(f"{quarter:.1f}" for quarter in quarters))
    if seconds >= JUDGED_FROM and quarters[3] > MOST_GROWTH * quarters[1]:
        print(f"the last quarter's is more than {MOST_GROWTH} times that of the second")
        sys.exit(1)

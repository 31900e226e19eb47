"""Drives `migiwa view` as a hasty person would: clicks, drags, keys, the wheel, resizes, and scenes that change on the
disk, all drawn at random from a seed, through the display's own test extension (XTEST).

First it saves, on purpose, the scene as it is and with the walls' correction off; both have to come, to read back and to
run, and the second to say so. Then, at random, the window has to survive, to write only scenes that can be read again (a
number that is not finite could not), and to end with exit code 0 when it is closed. Driven for five minutes or more, its
memory has to stay flat: the median of the last quarter is at most a tenth above that of the second. The first quarter is
for warming up.

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

from Xlib import X, XK

sys.dont_write_bytecode = True
from window_hands import DOWN, LEFT, MIDDLE, RIGHT, UP, Hands

SCENES = ("dam_break", "corner_drop", "stirred_tank", "bowl", "droplet", "faucet")
COARSER = 2
SCREEN = (1400, 900)
JUDGED_FROM = 300  # seconds of driving
MOST_GROWTH = 1.1
# Where the buttons are in a window of 1280 x 720.
EDIT_SCENE, SAVE_AS, NAME_FIELD, IN_THE_SCENE = (60, 40), (905, 637), (1100, 637), (500, 600)
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


class Person(Hands):
    """Hands that do anything anywhere, and one thing on purpose: they save the scene."""

    def __init__(self):
        super().__init__(lambda: process.poll() is None)
        self.resize(1280, 720)

    def resize(self, width, height):
        self.size = (width, height)
        super().resize(width, height)

    def anywhere(self):
        """Most often in the panels, at the left, and now and then where the editor, if open, has its buttons."""
        width, height = self.size
        where = rng.random()
        if where < 0.6:
            width = min(width, 330)
        top = max(height - 90, 0) if where > 0.85 else 0
        return rng.randrange(width), rng.randrange(top, height)

    def drag(self):
        start, end = self.anywhere(), self.anywhere()
        button, steps = rng.choice((LEFT, LEFT, MIDDLE, RIGHT)), rng.randint(1, 12)
        self.move(start)
        self.fake(X.ButtonPress, button)
        for k in range(1, steps + 1):
            self.move([a + (b - a) * k // steps for a, b in zip(start, end)])
            time.sleep(0.005)
        self.fake(X.ButtonRelease, button)

    def type(self):
        for _ in range(rng.randint(1, 8)):
            letter = rng.choice(LETTERS)
            self.key(NAMES.get(letter, letter), rng.choice((None, None, "Shift_L")))

    def learn_pace(self):
        """How long the window takes to see something and to show it, where a picture that is kept tells so."""
        for _ in range(3):
            begin, known = time.monotonic(), set(scratch.glob("*.png"))
            self.key("p")
            while set(scratch.glob("*.png")) == known:
                if time.monotonic() > begin + 120 or process.poll() is not None:
                    fail("no picture was kept")
                time.sleep(0.02)
            # The first one waits for the window to open, too.
            self.pace = max(0.2, 2 * (time.monotonic() - begin))

    def do(self, kind, detail=0, place=(0, 0)):
        self.fake(kind, detail, *place)
        time.sleep(self.pace)

    def press(self, place):
        """As a person does: first there, then down, then up, and each is seen."""
        self.do(X.MotionNotify, 0, place)
        self.do(X.ButtonPress, LEFT)
        self.do(X.ButtonRelease, LEFT)

    def save_as(self, name):
        """In a window of 1280 x 720 with the editor open."""
        self.press(NAME_FIELD)
        control, a = (self.display.keysym_to_keycode(XK.string_to_keysym(key)) for key in ("Control_L", "a"))
        for kind, code in ((X.KeyPress, control), (X.KeyPress, a), (X.KeyRelease, a), (X.KeyRelease, control)):
            self.do(kind, code)
        for letter in name:
            self.key(NAMES.get(letter, letter))
        time.sleep(self.pace)
        self.press(SAVE_AS)


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


def saved_scene(name, disk):
    """Waits for the file, runs what it says, and returns it."""
    file, end = scratch / f"{name}.json", time.monotonic() + 120
    while not file.exists():
        if time.monotonic() > end or process.poll() is not None:
            fail(f"{file.name} was not saved")
        time.sleep(0.1)
    before = disk.saved
    disk.look()
    if disk.saved != before + 1:
        fail(f"{disk.saved - before} scenes were saved where {file.name} alone was asked for")
    report = scratch / "report.txt"
    run = subprocess.run(
        [program, "simulate", str(file), "--until", "0.02", "--report", str(report)],
        capture_output=True,
        text=True,
        env=environment,
    )
    if run.returncode != 0:
        fail(f"{file.name} was saved by the window and does not run:\n{run.stderr}")
    if json.loads(report.read_text())["particles"] == 0:
        fail(f"{file.name} was saved without its water")
    return json.loads(file.read_text())


def save_on_purpose(window, disk):
    window.learn_pace()
    window.press(EDIT_SCENE)
    window.save_as("asitis")
    asked = json.loads(disk.texts[SCENES[0]])
    saved = saved_scene("asitis", disk)
    for key in ("name", "particle_spacing", "fluid"):
        if saved.get(key) != asked.get(key):
            fail(f"asitis.json has another {key}: {saved.get(key)}")
    if saved["boundary"]["handling"] != "gamma":
        fail(f"asitis.json handles walls by {saved['boundary']['handling']}")
    # Out of the name, or it would be a letter there.
    window.press(IN_THE_SCENE)
    window.key("c")
    time.sleep(window.pace)
    window.save_as("without")
    handling = saved_scene("without", disk)["boundary"]["handling"]
    if handling != "none":
        fail(f"without.json was saved with the correction off and handles walls by {handling}")


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
        process = subprocess.Popen([program, "view", "scene.json", "--memory", "16"], cwd=scratch, env=environment, stdout=errors, stderr=errors)
    try:
        window = Person()
    except TimeoutError as error:
        fail(error)
    save_on_purpose(window, disk)
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

"""The window on the display, and a person's hands: keys, buttons, the wheel and the mouse, through the display's own test
extension (XTEST). Needs a display without a window manager, such as xvfb-run's, that has one window.

As a program it does what it reads, line by line, until there is no more:
    key NAME        presses and releases a key
    click X Y       moves there (pixels of the window, from the top left) and clicks
    move X Y        moves there
    drag X Y U V    presses at X, Y, moves to U, V in steps, and lets go
    wheel N         turns the wheel N notches, away where N is positive
    drop FILE       drops the file on the window, as a file manager would
    wait S          waits so many seconds
    close           asks the window to close, as its frame's button would
"""

import sys
import time

from Xlib import X, XK, display
from Xlib.ext import xtest
from Xlib.protocol import event

LEFT, MIDDLE, RIGHT, UP, DOWN = 1, 2, 3, 4, 5


class Hands:
    """`alive`: whether there is still somebody to open a window. Raises TimeoutError when none is there within a minute."""

    def __init__(self, alive=lambda: True):
        self.display = display.Display()
        self.window = None
        end = time.monotonic() + 60
        while self.window is None:
            if time.monotonic() > end or not alive():
                raise TimeoutError("no window has opened")
            time.sleep(0.1)
            for child in self.display.screen().root.query_tree().children:
                if child.get_attributes().map_state == X.IsViewable and child.get_geometry().width > 100:
                    self.window = child
        self.window.set_input_focus(X.RevertToPointerRoot, X.CurrentTime)
        self.display.sync()

    def fake(self, kind, detail=0, x=0, y=0):
        xtest.fake_input(self.display, kind, detail, x=x, y=y)
        self.display.sync()

    def resize(self, width, height):
        self.window.configure(x=0, y=0, width=width, height=height)
        self.display.sync()

    def move(self, place):
        self.fake(X.MotionNotify, x=place[0], y=place[1])

    def click(self, button=LEFT, times=1):
        for _ in range(times):
            self.fake(X.ButtonPress, button)
            self.fake(X.ButtonRelease, button)

    def key(self, name, held=None):
        codes = [self.display.keysym_to_keycode(XK.string_to_keysym(n)) for n in (held, name) if n]
        for code in codes:
            self.fake(X.KeyPress, code)
        for code in reversed(codes):
            self.fake(X.KeyRelease, code)

    def drop(self, file):
        """By the protocol XDND; returns when the window has taken the name, or after ten seconds."""
        atom, screen = self.display.intern_atom, self.display.screen()
        source = screen.root.create_window(0, 0, 1, 1, 0, screen.root_depth)
        source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)
        for name, data in (
            ("XdndEnter", [source.id, 5 << 24, atom("text/uri-list"), 0, 0]),
            ("XdndPosition", [source.id, 0, (600 << 16) | 300, X.CurrentTime, atom("XdndActionCopy")]),
            ("XdndDrop", [source.id, 0, X.CurrentTime, 0, 0]),
        ):
            self.window.send_event(event.ClientMessage(window=self.window, client_type=atom(name), data=(32, data)))
        self.display.sync()
        end = time.monotonic() + 10
        while time.monotonic() < end:
            if not self.display.pending_events():
                time.sleep(0.02)
                continue
            asked = self.display.next_event()
            if asked.type == X.SelectionRequest:
                asked.requestor.change_property(asked.property, asked.target, 8, f"file://{file}\r\n".encode())
                asked.requestor.send_event(
                    event.SelectionNotify(
                        time=asked.time,
                        requestor=asked.requestor,
                        selection=asked.selection,
                        target=asked.target,
                        property=asked.property,
                    )
                )
                self.display.sync()
            elif asked.type == X.ClientMessage and asked.client_type == atom("XdndFinished"):
                break

    def close(self):
        atom = self.display.intern_atom
        message = (32, [atom("WM_DELETE_WINDOW"), X.CurrentTime, 0, 0, 0])
        self.window.send_event(event.ClientMessage(window=self.window, client_type=atom("WM_PROTOCOLS"), data=message))
        self.display.sync()


def main():
    hands = Hands()
    place = hands.window.get_geometry()
    for line in sys.stdin:
        word, *rest = line.split()
        if word == "key":
            hands.key(rest[0])
        elif word in ("click", "move"):
            hands.move((place.x + int(rest[0]), place.y + int(rest[1])))
            # The pointer is seen there before the button is.
            time.sleep(0.1)
            if word == "click":
                hands.click()
        elif word == "drag":
            (x, y), (u, v) = (tuple(int(n) for n in rest[k : k + 2]) for k in (0, 2))
            hands.move((place.x + x, place.y + y))
            time.sleep(0.1)
            hands.fake(X.ButtonPress, LEFT)
            for k in range(1, 9):
                time.sleep(0.05)
                hands.move((place.x + x + (u - x) * k // 8, place.y + y + (v - y) * k // 8))
            time.sleep(0.1)
            hands.fake(X.ButtonRelease, LEFT)
        elif word == "wheel":
            hands.click(UP if int(rest[0]) > 0 else DOWN, abs(int(rest[0])))
        elif word == "drop":
            hands.drop(rest[0])
        elif word == "wait":
            time.sleep(float(rest[0]))
        elif word == "close":
            hands.close()
        else:
            sys.exit(f"expected key, click, move, drag, wheel, drop, wait or close, found {line!r}")


if __name__ == "__main__":
    main()

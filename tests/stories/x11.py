"""An X server without a screen, a window manager, and the hands on its keyboard and pointer (XTEST)."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
import shutil
import struct
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from PySide6.QtGui import QImage

from tests.stories.patience import until

SIZE = (1280, 800)
_OBEYS = 20.0  # s
NEEDED = ("Xvfb", "openbox", "xdotool", "setxkbmap")
BUTTONS = {"left": 1, "middle": 2, "right": 3, "wheel up": 4, "wheel down": 5}
MODIFIERS = {
    "shift": "Shift_L",
    "ctrl": "Control_L",
    "alt": "Alt_L",
    "meta": "Super_L",
    "altgr": "ISO_Level3_Shift",
}
APART = 2  # ms at least between two strokes of one key: Qt takes an up and a down of one moment for a repeat
_HEADER = 100  # bytes of an XWD header without the window's name


def missing() -> str:
    """Why there can be no X server here; empty where there can."""
    gone = [name for name in NEEDED if shutil.which(name) is None]
    gone += [f"lib{name}" for name in ("X11", "Xtst", "Xi") if ctypes.util.find_library(name) is None]
    return f"not installed: {', '.join(gone)}" if gone else ""


class Server:
    """A server of our own, with what a hand can do to it. Keys by X's names, or by their codes."""

    def __init__(self, folder: Path, size: tuple[int, int] = SIZE) -> None:
        self._folder, self._size = folder, size
        folder.mkdir(parents=True, exist_ok=True)
        self._running: list[subprocess.Popen[bytes]] = []
        self.name = self._serve()
        self._x, self._test = _library("X11"), _library("Xtst")
        self._x.XOpenDisplay.restype = ctypes.c_void_p
        self._x.XStringToKeysym.restype = ctypes.c_ulong
        self._x.XkbKeycodeToKeysym.restype = ctypes.c_ulong
        self._display = ctypes.c_void_p(self._x.XOpenDisplay(self.name.encode()))
        assert self._display, f"no answer from the server at {self.name}"
        self._down: list[int] = []
        self._last = 0  # the key that moved last
        self._buttons: list[int] = []

    def _serve(self) -> str:
        """Start it on a display that is free; it tells which."""
        read, write = os.pipe()
        width, height = self._size
        words = ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24"]
        words += ["-nolisten", "tcp", "-fbdir", str(self._folder)]
        self._begin(words, pass_fds=(write,))
        os.close(write)
        with os.fdopen(read, "rb") as told:
            number = told.readline().decode().strip()
        assert number, "Xvfb does not start"
        return f":{number}"

    def _begin(self, words: Sequence[str], pass_fds: tuple[int, ...] = ()) -> None:
        self._running.append(
            subprocess.Popen(
                words,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=self.environment if pass_fds == () else None,
                pass_fds=pass_fds,
            )
        )

    @property
    def environment(self) -> dict[str, str]:
        """For whoever shall show itself here."""
        return os.environ | {"DISPLAY": self.name, "QT_QPA_PLATFORM": "xcb"}

    def manage(self, *options: str) -> None:
        """Start the window manager, and wait until it manages."""
        self._begin(["openbox", "--sm-disable", *options])
        until(
            lambda: "window id" in self.run("xprop", "-root", "_NET_SUPPORTING_WM_CHECK"), lambda: "openbox"
        )

    def run(self, *words: str) -> str:
        """A command on this display, and what it says."""
        done = subprocess.run(words, capture_output=True, text=True, env=self.environment, check=False)
        return done.stdout

    def close(self) -> None:
        """Everything is let go, and the server ends."""
        self.let_go()
        self._x.XCloseDisplay(self._display)
        for each in reversed(self._running):
            _end(each)

    # --- keys ----------------------------------------------------------------------------------------

    def code(self, key: str | int) -> int:
        """The code of a key; by the name of what stands on it, in the layout of now."""
        if isinstance(key, int):
            return key
        symbol = self._x.XStringToKeysym(key.encode())
        assert symbol, f"X knows no key {key}"
        number = int(self._x.XKeysymToKeycode(self._display, ctypes.c_ulong(symbol)))
        assert number, f"no key of this layout is {key}"
        return number

    def down(self, *keys: str | int) -> None:
        """Keys go down, in this order, at once."""
        for key in keys:
            self._key(self.code(key), down=True)
        self._x.XSync(self._display, 0)

    def up(self, *keys: str | int) -> None:
        """Keys come up."""
        for key in keys:
            self._key(self.code(key), down=False)
        self._x.XSync(self._display, 0)

    def _key(self, code: int, *, down: bool) -> None:
        later = int(down and code == self._last) * APART
        self._last = code
        if down:
            self._down.append(code)
        elif code in self._down:
            self._down.remove(code)
        self._test.XTestFakeKeyEvent(self._display, code, int(down), later)

    def write(self, text: str) -> None:
        """Every character by the key, and the shift, on which it stands in the layout of now."""
        for character in text:
            code, level = self._where(character)
            shifts = (MODIFIERS["shift"],) * (level & 1) + (MODIFIERS["altgr"],) * (level >> 1)
            self.down(*shifts, code)
            self.up(code, *reversed(shifts))

    def _where(self, character: str) -> tuple[int, int]:
        wanted = ord(character) if ord(character) < 0x100 else 0x1000000 + ord(character)
        for level in range(4):
            for code in range(8, 256):
                if self._x.XkbKeycodeToKeysym(self._display, code, 0, level) == wanted:
                    return code, level
        raise AssertionError(f"no key of this layout writes {character!r}")

    def layout(self, name: str) -> None:
        """Another layout of the keyboard, as ``setxkbmap`` sets it."""
        self.run("setxkbmap", *name.split())
        self._x.XCloseDisplay(self._display)
        self._display = ctypes.c_void_p(self._x.XOpenDisplay(self.name.encode()))

    def repeats(self, delay: int, interval: int) -> None:
        """A held key repeats after ``delay``, every ``interval`` milliseconds."""
        self._x.XkbSetAutoRepeatRate(self._display, 0x100, delay, interval)
        self._x.XSync(self._display, 0)

    # --- pointer -------------------------------------------------------------------------------------

    def point(self, x: float, y: float) -> None:
        """The pointer goes there."""
        self._test.XTestFakeMotionEvent(self._display, 0, round(x), round(y), 0)
        self._x.XSync(self._display, 0)

    def button(self, name: str, *, down: bool) -> None:
        """A button of the mouse."""
        number = BUTTONS[name]
        (self._buttons.append if down else self._buttons.remove)(number)
        self._test.XTestFakeButtonEvent(self._display, number, int(down), 0)
        self._x.XSync(self._display, 0)

    def let_go(self) -> None:
        """Hands off."""
        for code in tuple(self._down):
            self._key(code, down=False)
        for number in self._buttons:
            self._test.XTestFakeButtonEvent(self._display, number, 0, 0)
        self._buttons.clear()
        self._x.XSync(self._display, 0)

    # --- what is on the screen -------------------------------------------------------------------------

    def picture(self, path: Path) -> None:
        """What the server shows, as PNG."""
        data = (self._folder / "Xvfb_screen0").read_bytes()
        head = struct.unpack(">25I", data[:_HEADER])
        size, width, height, line, colours = head[0], head[4], head[5], head[12], head[19]
        start = size + 12 * colours
        image = QImage(data[start:], width, height, line, QImage.Format.Format_RGB32)
        path.parent.mkdir(parents=True, exist_ok=True)
        image.save(str(path))


def _library(name: str) -> ctypes.CDLL:
    found = ctypes.util.find_library(name)
    assert found is not None
    return ctypes.CDLL(found)


@contextmanager
def another_client(server: Server, what: str) -> Iterator[None]:
    """Somebody else here: a ``window`` in front, or one that covers the whole screen (``cover``), a ``grab``
    of keyboard and pointer, or of ``keys`` alone.

    A screen lock is such a grab.
    """
    x = _library("X11")
    x.XOpenDisplay.restype = ctypes.c_void_p
    x.XDefaultRootWindow.restype = x.XCreateSimpleWindow.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x.XOpenDisplay(server.name.encode()))
    root, now = ctypes.c_ulong(x.XDefaultRootWindow(display)), ctypes.c_ulong(0)
    if what in {"window", "cover"}:
        place = (100, 100, 400, 300) if what == "window" else (0, 0, *SIZE)
        window = x.XCreateSimpleWindow(display, root, *place, 0, 0, 0)
        x.XMapRaised(display, ctypes.c_ulong(window))
    else:
        assert x.XGrabKeyboard(display, root, 1, 1, 1, now) == 0
        if what == "grab":
            none = ctypes.c_ulong(0)
            assert x.XGrabPointer(display, root, 1, 4, 1, 1, none, none, now) == 0
    x.XSync(display, 0)
    try:
        yield
    finally:
        x.XCloseDisplay(display)


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process; one that does not obey is killed, because the next test needs its display and memory."""
    process.terminate()
    try:
        process.wait(_OBEYS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


@contextmanager
def server(folder: Path, size: tuple[int, int] = SIZE) -> Iterator[Server]:
    """With a window manager; ended afterwards."""
    made = Server(folder, size)
    try:
        made.manage()
        yield made
    finally:
        made.close()

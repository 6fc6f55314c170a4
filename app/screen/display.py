"""Whether a display can be opened: tried in a child process first, because Qt aborts where it cannot.

An X server that is gone, a compositor that does not run, a library that is missing or a platform that Qt does
not have would all end the program with a core dump; here they are one sentence.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import select
import signal
import sys
import time
from pathlib import Path

from core.message import Message

_PATIENCE = 15.0  # s for a display that does not answer
_CHUNK = 1 << 14


def trouble() -> str:
    """Why no window can be opened here, and what to do; empty when one can."""
    if sys.platform != "linux":
        return ""
    from PySide6 import QtGui  # before the child is made: it has it then

    if QtGui.QGuiApplication.instance() is not None or not hasattr(os, "fork"):
        return ""  # it is open already
    opened, said = _tried(QtGui)
    return "" if opened else _why(said)


def _tried(gui: object) -> tuple[bool, str]:
    """A child that opens the display and ends; whether it could, and what Qt said."""
    reads, writes = os.pipe()
    child = os.fork()
    if child == 0:
        _open(gui, writes)
    os.close(writes)
    said = _heard(reads, child)
    os.close(reads)
    _, status = os.waitpid(child, 0)
    return status == 0, said


def _open(gui: object, writes: int) -> None:
    """In the child: nothing of the parent may be run through or written by it."""
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(writes, 2)
        gui.QGuiApplication(["turndesk"])  # type: ignore[attr-defined]
        os._exit(0)
    finally:
        os._exit(1)


def _heard(reads: int, child: int) -> str:
    """What the child says until it ends; one that hangs on a dead display is ended."""
    said, end = b"", time.monotonic() + _PATIENCE
    while (left := end - time.monotonic()) > 0.0:
        if not select.select([reads], [], [], left)[0]:
            break
        data = os.read(reads, _CHUNK)
        if not data:
            return said.decode("utf-8", "replace")
        said += data
    with contextlib.suppress(ProcessLookupError):
        os.kill(child, signal.SIGKILL)
    return said.decode("utf-8", "replace") + "no answer"


def _why(said: str) -> str:
    """Of what Qt says, what a person can act on."""
    platform = os.environ.get("QT_QPA_PLATFORM", "")
    if "Could not find the Qt platform plugin" in said:
        return Message(
            "QT_QPA_PLATFORM={platform}: Qt has no platform plugin with this name; remove this "
            "environment variable",
            platform=platform,
        )
    missing = _missing_library()
    if missing and (platform.startswith("xcb") or os.environ.get("DISPLAY")):
        return Message("{missing}; install the system packages listed in README.md", missing=missing)
    tried = [f"{name}={os.environ[name]}" for name in ("WAYLAND_DISPLAY", "DISPLAY") if os.environ.get(name)]
    if not tried:
        return "neither DISPLAY nor WAYLAND_DISPLAY is set; start turndesk from a desktop, or set DISPLAY"
    if "uthorization" in said:
        return Message(
            "{tried} does not accept this user; start turndesk as the user who is logged in to the desktop",
            tried=" and ".join(tried),
        )
    template = (
        ("no display at {tried} responded in time; start the X server or compositor, or correct this setting")
        if said.endswith("no answer")
        else "no display found at {tried}; start the X server or compositor, or correct this setting"
    )
    return Message(template, tried=" or ".join(tried))


def _missing_library() -> str:
    """A library that the window system's part of Qt needs and this computer has not; empty: all are there."""
    import PySide6

    part = Path(PySide6.__file__).parent / "Qt" / "plugins" / "platforms" / "libqxcb.so"
    try:
        ctypes.CDLL(str(part))
    except OSError as error:
        return str(error)
    return ""

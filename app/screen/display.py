"""Test in a child process of whether Qt can open the display.

Qt aborts the process if it cannot open the display. A missing X server, compositor, library or Qt platform
would therefore end the program with a core dump. This module returns an error text instead.
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

_TIMEOUT_S = 15.0  # Seconds that a display has to respond.
_CHUNK_BYTES = 1 << 14


def find_display_error() -> str:
    """Return why no window can be opened, with a remedy, or an empty string if a window can be opened."""
    if sys.platform != "linux":
        return ""
    from PySide6 import QtGui  # Import before the fork, so that the child process has the module.

    if QtGui.QGuiApplication.instance() is not None or not hasattr(os, "fork"):
        return ""  # The display is already open.
    opened, said = _try_open(QtGui)
    return "" if opened else _explain_error(said)


def _try_open(gui: object) -> tuple[bool, str]:
    """Try to open the display in a child process.

    Return whether the display was opened, and the messages of Qt.
    """
    reads, writes = os.pipe()
    child = os.fork()
    if child == 0:
        _open_display(gui, writes)
    os.close(writes)
    said = _read_result(reads, child)
    os.close(reads)
    _, status = os.waitpid(child, 0)
    return status == 0, said


def _open_display(gui: object, writes: int) -> None:
    """Open the display, then exit.

    This runs in the child process, which must not run the cleanup functions of the parent process.
    """
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


def _read_result(reads: int, child: int) -> str:
    """Return the output of the child process.

    If the display does not respond, kill the child process.
    """
    said, end = b"", time.monotonic() + _TIMEOUT_S
    while (left := end - time.monotonic()) > 0.0:
        if not select.select([reads], [], [], left)[0]:
            break
        data = os.read(reads, _CHUNK_BYTES)
        if not data:
            return said.decode("utf-8", "replace")
        said += data
    with contextlib.suppress(ProcessLookupError):
        os.kill(child, signal.SIGKILL)
    return said.decode("utf-8", "replace") + "no answer"


def _explain_error(qt_messages: str) -> str:
    """Return an error text with a remedy, based on the messages of Qt."""
    platform = os.environ.get("QT_QPA_PLATFORM", "")
    if "Could not find the Qt platform plugin" in qt_messages:
        return Message(
            "QT_QPA_PLATFORM={platform}: Qt has no platform plugin with this name; remove this "
            "environment variable",
            platform=platform,
        )
    missing = _find_missing_library()
    if missing and (platform.startswith("xcb") or os.environ.get("DISPLAY")):
        return Message("{missing}; install the system packages listed in README.md", missing=missing)
    tried = [f"{name}={os.environ[name]}" for name in ("WAYLAND_DISPLAY", "DISPLAY") if os.environ.get(name)]
    if not tried:
        return "neither DISPLAY nor WAYLAND_DISPLAY is set; start turndesk from a desktop, or set DISPLAY"
    if "uthorization" in qt_messages:
        return Message(
            "{tried} does not accept this user; start turndesk as the user who is logged in to the desktop",
            tried=" and ".join(tried),
        )
    template = (
        ("no display at {tried} responded in time; start the X server or compositor, or correct this setting")
        if qt_messages.endswith("no answer")
        else "no display found at {tried}; start the X server or compositor, or correct this setting"
    )
    return Message(template, tried=" or ".join(tried))


def _find_missing_library() -> str:
    """Return an error text about a missing library that Qt's X11 plugin needs.

    Return an empty string if no library is missing.
    """
    import PySide6

    part = Path(PySide6.__file__).parent / "Qt" / "plugins" / "platforms" / "libqxcb.so"
    try:
        ctypes.CDLL(str(part))
    except OSError as error:
        return str(error)
    return ""

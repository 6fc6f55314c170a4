"""Reserved slot of a control in the data folder, which consists of a socket and two locks.

Each control owns one slot, which is ``control.sock``, or ``control-2.sock`` and so on while the owners of
the earlier slots are running. The kernel releases a lock when the last process that holds it has ended. A
killed control therefore leaves at most an old socket, which the next owner replaces.
"""

from __future__ import annotations

import fcntl
import os
import socket
import time
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path

from app.compose.control.control_start import DRIVERS_TIMEOUT_S, SLOT_NAMES, list_socket_paths
from core.ports import DriverError

_LOOK = 0.05  # s between two attempts to lock


class ControlSlot:
    """First slot in a data folder without a running owner, reserved for this process.

    ``drivers_lock`` is the file descriptor of a lock that a driver host inherits. The lock prevents another
    control from using the drivers of this slot before that driver host has ended. Both locks are None if
    the folder is not writable, or if all slots have owners.
    """

    def __init__(self, folder: Path, drivers_timeout_s: float = DRIVERS_TIMEOUT_S) -> None:
        """Reserve a slot. Raises DriverError if the drivers of its last owner do not end in time."""
        self._path: Path | None = None
        self._owner: int | None = None
        self.drivers_lock: int | None = None
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            for path in (folder / name for name in SLOT_NAMES):
                self._owner = _locked(path.with_suffix(".lock"))
                if self._owner is not None:
                    self._path = path
                    break
        if self._path is not None:
            try:
                self.drivers_lock = _locked_later(
                    folder / f"{self._path.name}-drivers.lock", drivers_timeout_s
                )
            except OSError:
                self.drivers_lock = None
            except DriverError:
                self.close()
                raise

    def create_listener(self) -> ScreenListener | None:
        """Create the socket through which screens find this control, and return its listener.

        An old socket is replaced. The result is None if the socket cannot be created. Other screens cannot
        find the control in this case.
        """
        if self._path is None or not list_socket_paths(self._path.parent):
            return None
        try:
            return ScreenListener(self._path.with_suffix(".sock"))
        except OSError:
            return None

    def close(self) -> None:
        """Release the slot, so that another control can reserve it."""
        for file in (self._owner, self.drivers_lock):
            if file is not None:
                os.close(file)
        self._owner = self.drivers_lock = None


def _locked_later(path: Path, limit: float) -> int:
    """Wait until the last owner's drivers have ended, and return the locked file's descriptor.

    Raises DriverError if they do not end within ``limit`` seconds, and OSError if the file cannot be
    opened.
    """
    until = time.monotonic() + limit
    while (file := _locked(path)) is None:
        if time.monotonic() >= until:
            raise DriverError("the drivers of the control that has ended are still running")
        time.sleep(_LOOK)
    return file


def _locked(path: Path) -> int | None:
    """Return the descriptor of the exclusively locked file, or None if another process locked it.

    Raises OSError if the file cannot be opened.
    """
    file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(file)
        if isinstance(error, BlockingIOError):
            return None
        raise
    return file


class ScreenListener:
    """Socket in the data folder through which a screen finds the control.

    The constructor replaces an old socket. It raises OSError if the socket cannot be created.
    """

    def __init__(self, path: Path) -> None:
        path.unlink(missing_ok=True)
        self._path, self._socket = path, socket.socket(socket.AF_UNIX)
        before = os.umask(0o177)
        try:
            self._socket.bind(str(path))
        finally:
            os.umask(before)
        self._socket.listen()
        self._inode = path.stat().st_ino

    def accept_screen(self) -> Connection:
        """Wait for a screen and return the connection to it. Raises OSError if the socket is closed."""
        return Connection(self._socket.accept()[0].detach())

    def close(self) -> None:
        """Stop listening, and delete the socket file if it belongs to this socket."""
        with suppress(OSError):
            if self._path.stat().st_ino == self._inode:
                self._path.unlink()
        self._socket.close()

"""The process of the control: ``python -m app.compose.control.control_process FD ZERO FOLDER``.

The machine comes over stdin. FD is the socket to the screen that has started it; another screen finds the
control at the socket of the data folder FOLDER.
"""

from __future__ import annotations

import gc
import os
import pickle
import signal
import socket
import sys
import threading
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path

from app.compose.control.control_messages import Failed, is_own_user
from app.compose.control.control_server import LOOK, ControlServer
from app.compose.control.control_start import socket_path
from app.compose.control.rights import acquire_rights
from app.compose.runs.error_log import Log
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.waiting import RealClock

_GIVE_WAY = 0.001  # s after which a thread that reads a program lets the executor go on
LOG_FILE = "control.log"


def main(arguments: list[str]) -> int:
    """Drive the machine until the screen closes it, or no screen has come back."""
    first, clock, folder = Connection(int(arguments[0])), RealClock(float(arguments[1])), Path(arguments[2])
    machine = pickle.load(sys.stdin.buffer)  # of our own parent, over a pipe that nobody else has
    assert isinstance(machine, Machine)
    sys.setswitchinterval(_GIVE_WAY)
    log = Log(LOG_FILE)
    rights = acquire_rights()
    try:
        server = ControlServer(machine, clock, folder, rights)
    except DriverError as error:
        with suppress(OSError):
            first.send(Failed(error.fault if isinstance(error.fault, str) else str(error)))
        log.close()
        return 1
    gc.collect()
    gc.freeze()  # modules and the like: collections need not look at them again
    for number in (signal.SIGTERM, signal.SIGINT):  # of a computer that shuts down
        signal.signal(number, lambda *_: server.closing.set())
    server.start()
    _serve(server, first)  # before anybody else finds the control
    listener = ScreenListener.at(socket_path(folder))
    if listener is not None:
        threading.Thread(target=_serve_screens, args=(server, listener), name="screens", daemon=True).start()
    while not server.closing.wait(LOOK):
        server.look()
    server.close()
    if listener is not None:
        listener.close()
    log.close()
    return 0


def _serve_screens(server: ControlServer, listener: ScreenListener) -> None:
    """Talk to one screen after the other that finds the control."""
    while not server.closing.is_set():
        with suppress(OSError, EOFError):
            connection = listener.accept()
            if is_own_user(connection):
                _serve(server, connection)
            else:
                connection.close()


def _serve(server: ControlServer, connection: Connection) -> None:
    """On a thread of its own: a second screen is answered while another is connected."""
    threading.Thread(target=server.serve, args=(connection,), name="screen", daemon=True).start()


class ScreenListener:
    """The socket in the data folder at which a screen finds the control. Raises OSError."""

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        self._path, self._socket = path, socket.socket(socket.AF_UNIX)
        before = os.umask(0o177)
        try:
            self._socket.bind(str(path))
        finally:
            os.umask(before)
        self._socket.listen()
        self._inode = path.stat().st_ino

    @classmethod
    def at(cls, path: Path | None) -> ScreenListener | None:
        """Return one at this path; None where there can be none: no other screen finds this control."""
        if path is None or _listens(path):
            return None
        try:
            return cls(path)
        except OSError:
            return None

    def accept(self) -> Connection:
        """Wait for a screen and return its connection. Raises OSError."""
        return Connection(self._socket.accept()[0].detach())

    def close(self) -> None:
        """Listen no more. The file goes, if it is still that of this socket. Raises nothing."""
        with suppress(OSError):
            if self._path.stat().st_ino == self._inode:
                self._path.unlink()
        self._socket.close()


def _listens(path: Path) -> bool:
    """Return whether another control has the socket."""
    try:
        with socket.socket(socket.AF_UNIX) as other:
            other.setblocking(False)
            other.connect(str(path))
    except BlockingIOError:
        return True  # so many wait there
    except OSError:
        return False
    return True


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

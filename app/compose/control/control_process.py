"""The control process: ``python -m app.compose.control.control_process FD ZERO FOLDER``.

The machine is read from stdin. FD is the socket to the screen that started the process. Another screen finds
the control at the socket in the data folder FOLDER.
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

_GIVE_WAY = 0.001  # s after which a thread that reads a program yields to the executor
LOG_FILE = "control.log"


def main(arguments: list[str]) -> int:
    """Run the machine until the screen closes it, or until no screen reconnects in time."""
    first, clock, folder = Connection(int(arguments[0])), RealClock(float(arguments[1])), Path(arguments[2])
    machine = pickle.load(sys.stdin.buffer)  # from the parent process, over a pipe that no other process has
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
    gc.freeze()  # modules and other permanent objects need not be scanned again
    for number in (signal.SIGTERM, signal.SIGINT):  # sent when the computer shuts down
        signal.signal(number, lambda *_: server.closing.set())
    server.start()
    _serve(server, first)  # before another screen can find the control
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
    """Accept screens that find the control, one after the other."""
    while not server.closing.is_set():
        with suppress(OSError, EOFError):
            connection = listener.accept()
            if is_own_user(connection):
                _serve(server, connection)
            else:
                connection.close()


def _serve(server: ControlServer, connection: Connection) -> None:
    """Serve a screen in a new thread, so that a second screen gets a response at the same time."""
    threading.Thread(target=server.serve, args=(connection,), name="screen", daemon=True).start()


class ScreenListener:
    """Socket in the data folder at which a screen finds the control.

    The constructor raises OSError if the socket cannot be created.
    """

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
        """Return a listener at this path, or None if the path cannot be used.

        Another screen cannot find a control without a listener.
        """
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
        """Stop listening and delete the socket file if it belongs to this socket. Raises no exception."""
        with suppress(OSError):
            if self._path.stat().st_ino == self._inode:
                self._path.unlink()
        self._socket.close()


def _listens(path: Path) -> bool:
    """Return whether another control is listening at the socket."""
    try:
        with socket.socket(socket.AF_UNIX) as other:
            other.setblocking(False)
            other.connect(str(path))
    except BlockingIOError:
        return True  # its queue of connections is full
    except OSError:
        return False
    return True


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

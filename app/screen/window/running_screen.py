"""Transfer of a program from a second instance of TurnDesk to the running instance.

The running screen listens on a local socket that belongs to its data folder. Only processes of the same
user can connect to the socket. A request is one line with the absolute path of a program. The reply is one
line.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtNetwork import QLocalServer, QLocalSocket

from app.desk.data_folder import find_data_folder

ACCEPTED_REPLY = b"accepted\n"
TIMEOUT_MS = 2000  # ms for each step of a request; a screen that does not reply by then is not used
MAX_REQUEST_BYTES = 8192  # bytes of a request
_MOST_PATH = 100  # bytes of a socket's path that every system accepts


def find_socket_name() -> str:
    """Return the path of the data folder's local socket, or a short name if the path is too long."""
    path = os.fsencode(find_data_folder() / "screen.sock")
    if os.name == "posix" and len(path) <= _MOST_PATH:
        return os.fsdecode(path)
    return f"turndesk-{hashlib.sha256(path).hexdigest()[:16]}"


def hand_over_program(program_path: str) -> bool:
    """Ask the running screen to open a program, and return False if no screen is running."""
    path = Path(program_path).absolute()
    if not path.is_file():
        return False
    socket = QLocalSocket()
    socket.connectToServer(find_socket_name())
    if not socket.waitForConnected(TIMEOUT_MS):
        return False
    socket.write(os.fsencode(path) + b"\n")
    if not socket.waitForReadyRead(TIMEOUT_MS):
        return False
    return socket.readLine().data() == ACCEPTED_REPLY


class OpenProgramReceiver(QObject):
    """Server that opens the programs that a second instance of TurnDesk passes on.

    ``open_file`` is called with the path of each program.
    """

    def __init__(self, open_file: Callable[[Path], None], parent: QObject) -> None:
        super().__init__(parent)
        self._open_file = open_file
        self._server = QLocalServer(self)
        self._server.setSocketOptions(QLocalServer.SocketOption.UserAccessOption)
        self._server.newConnection.connect(self._connect)

    def start_listening(self) -> bool:
        """Start to listen on the socket.

        Return False if another screen already listens for this data folder.
        """
        name = find_socket_name()
        probe = QLocalSocket()
        probe.connectToServer(name)
        if probe.waitForConnected(TIMEOUT_MS):  # listen() would replace the socket of the other screen
            return False
        QLocalServer.removeServer(name)  # left by a screen that was killed
        return self._server.listen(name)

    def _connect(self) -> None:
        while (socket := self._server.nextPendingConnection()) is not None:
            socket.readyRead.connect(lambda socket=socket: self._read(socket))
            socket.disconnected.connect(socket.deleteLater)
            self._read(socket)

    def _read(self, socket: QLocalSocket) -> None:
        """Open the program of a complete request.

        Ignore a request that is too long or does not name a file.
        """
        if not socket.canReadLine():
            if socket.bytesAvailable() > MAX_REQUEST_BYTES:
                socket.abort()
            return
        path = Path(os.fsdecode(bytes(socket.readLine(MAX_REQUEST_BYTES).data()).rstrip(b"\n")))
        if not path.is_absolute() or not path.is_file():
            socket.abort()
            return
        socket.write(ACCEPTED_REPLY)
        socket.flush()
        self._open_file(path)

"""The server of the status page: a socket that listens, and the threads that answer browsers."""

from __future__ import annotations

import errno
import logging
import socket
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from core.ports import DriverError

if TYPE_CHECKING:
    from _typeshed.wsgi import WSGIApplication

_THREADS = 3  # that answer browsers
_WAITING = 100  # connections
_SILENT = 10  # s after which a browser that neither asks nor reads is given up
_TURN = 0.5  # s
ENDS = 2.0  # s that closing waits for its threads


class PageServer:
    """Answers browsers on a socket that listens, until it is closed."""

    def __init__(self, page: WSGIApplication, listening: socket.socket, between: Callable[[], None]) -> None:
        """``between`` is called twice a second by the server's own thread."""
        from waitress import wasyncore
        from waitress.server import create_server
        from waitress.task import ThreadedTaskDispatcher

        self._loop, self._close_all = wasyncore.loop, wasyncore.close_all
        self._between = between
        self._channels: dict[int, Any] = {}
        self._workers = ThreadedTaskDispatcher()
        self._workers.queue_logger.setLevel(logging.ERROR)  # that one browser waits for another is no warning
        self._workers.set_thread_count(_THREADS)
        create_server(
            page,
            self._channels,
            _dispatcher=self._workers,
            sockets=[listening],
            ident="",
            channel_timeout=_SILENT,
            cleanup_interval=_SILENT // 2,
            connection_limit=_WAITING,
            max_request_body_size=1,
        )
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="status-page", daemon=True)

    def start(self) -> None:
        """Once."""
        self._thread.start()

    def close(self) -> None:
        """No browser is answered any more."""
        self._closing.set()
        self._thread.join(ENDS)
        self._workers.shutdown()

    def _serve(self) -> None:
        while not self._closing.is_set():
            self._loop(timeout=_TURN, map=self._channels, count=1)
            self._between()
        self._close_all(self._channels)


def listening_at(bind: str, port: int) -> socket.socket:
    """The socket on which browsers ask. Raises DriverError."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(bind, port, type=socket.SOCK_STREAM)[0]
        found = socket.socket(family, kind, protocol)
    except OSError as error:
        raise DriverError(_why(bind, port, error)) from error
    try:
        if sys.platform != "win32":  # elsewhere it lets two programs listen at one port
            found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        found.bind(address)
        found.listen(_WAITING)
    except OSError as error:
        found.close()
        raise DriverError(_why(bind, port, error)) from error
    return found


def _why(bind: str, port: int, error: OSError) -> str:
    at = f"[status_page] {bind}:{port}"
    if error.errno == errno.EADDRINUSE:
        return f"{at}: another program listens there; give this desk another port"
    if error.errno == errno.EADDRNOTAVAIL or isinstance(error, socket.gaierror):
        return f"{at}: this computer has no such address"
    return f"{at}: {error.strerror or error}"

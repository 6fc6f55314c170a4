"""Server of the status page, with a listening socket and threads that respond to browsers."""

from __future__ import annotations

import errno
import logging
import math
import socket
import sys
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from core.message import Message
from core.ports import DriverError

if TYPE_CHECKING:
    from _typeshed.wsgi import WSGIApplication

_THREADS = 3  # threads that answer browsers
_WAITING = 100  # connections that the system queues until they are accepted
_LONGEST = 16 * 1024  # bytes of a request
_TURN = 0.5  # seconds
CLOSE_TIMEOUT_S = 2.0  # seconds that closing waits for its threads


class StatusPageServer:
    """Server that sends the status page to browsers until it is closed."""

    def __init__(
        self,
        application: WSGIApplication,
        listening_socket: socket.socket,
        perform_idle_work: Callable[[], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Create the server.

        The thread of the server calls ``perform_idle_work`` twice per second.
        """
        from waitress import wasyncore
        from waitress.server import create_server
        from waitress.task import ThreadedTaskDispatcher

        from app.extras.office.page_connections import MAX_CONNECTIONS, BrowserConnection

        self._loop, self._close_all = wasyncore.loop, wasyncore.close_all
        self._between, self._clock = perform_idle_work, clock
        self._channels: dict[int, Any] = {}
        self._workers = ThreadedTaskDispatcher()
        # a browser that waits for another one is not worth a warning
        self._workers.queue_logger.setLevel(logging.ERROR)
        self._workers.set_thread_count(_THREADS)
        server: Any = create_server(
            application,
            self._channels,
            _dispatcher=self._workers,
            sockets=[listening_socket],
            ident="",
            connection_limit=2 * MAX_CONNECTIONS,  # never reached, because Connection has lower limits
            max_request_body_size=1,
            max_request_header_size=_LONGEST,
        )
        self._server = server
        server.channel_class = partial(BrowserConnection, clock=clock)
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="status-page", daemon=True)

    def start(self) -> None:
        """Start the server thread. This method may be called only once."""
        self._thread.start()

    def close(self) -> None:
        """Stop responding to browsers."""
        self._closing.set()
        self._thread.join(CLOSE_TIMEOUT_S)

    def _serve(self) -> None:
        looked = -math.inf
        while not self._closing.is_set():
            self._loop(timeout=_TURN, map=self._channels, count=1)
            for connection in tuple(self._server.active_channels.values()):
                connection.end_if_late()
            if self._clock() - looked >= _TURN:
                looked = self._clock()
                self._between()
        self._workers.shutdown(timeout=1)  # first, because a finished response still needs the sockets
        self._close_all(self._channels)


def open_listening_socket(bind: str, port: int) -> socket.socket:
    """Return the listening socket for browsers.

    Raises DriverError if the address cannot be used.
    """
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(bind, port, type=socket.SOCK_STREAM)[0]
        found = socket.socket(family, kind, protocol)
    except OSError as error:
        raise DriverError(_why(bind, port, error)) from error
    try:
        if sys.platform != "win32":  # On Windows, this option would let two programs listen on one port.
            found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        found.bind(address)
        found.listen(_WAITING)
    except OSError as error:
        found.close()
        raise DriverError(_why(bind, port, error)) from error
    return found


def _why(bind: str, port: int, error: OSError) -> str:
    at = Message("[status_page] {bind}:{port}", bind=bind, port=port)
    if error.errno == errno.EADDRINUSE:
        return Message(
            "{position}: another program already uses this port; choose a different port for this control",
            position=at,
        )
    if error.errno == errno.EADDRNOTAVAIL or isinstance(error, socket.gaierror):
        return Message("{position}: this computer does not have this address", position=at)
    return Message("{position}: {cause}", position=at, cause=error.strerror or error)

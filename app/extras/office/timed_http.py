"""HTTP exchanges with a deadline for the whole of each, however slowly its bytes arrive."""

from __future__ import annotations

import io
import socket
import time
from collections.abc import Callable
from functools import partial
from http.client import HTTPConnection, HTTPResponse, HTTPSConnection
from typing import Any
from urllib.request import BaseHandler, HTTPHandler, HTTPSHandler, OpenerDirector, Request, build_opener

Clock = Callable[[], float]


class _TimedReader(io.RawIOBase):
    """The bytes of a socket until ``left`` seconds are used up. Raises TimeoutError."""

    def __init__(self, raw: io.RawIOBase, sock: socket.socket, left: Callable[[], float]) -> None:
        self._raw, self._socket, self._left = raw, sock, left

    def readable(self) -> bool:
        """Always."""
        return True

    def readinto(self, buffer: Any, /) -> int | None:
        """Wait for some bytes, for the rest of the time at most."""
        if (left := self._left()) <= 0.0:
            raise TimeoutError("timed out")
        self._socket.settimeout(left)
        return self._raw.readinto(buffer)

    def close(self) -> None:
        """Close the socket as well."""
        self._raw.close()
        super().close()


class _TimedResponse(HTTPResponse):
    """An answer that is read for ``left`` seconds at most."""

    def __init__(self, sock: socket.socket, *args: Any, left: Callable[[], float], **more: Any) -> None:
        super().__init__(sock, *args, **more)
        raw = self.fp.detach()
        self.fp = io.BufferedReader(_TimedReader(raw, sock, left))


def _timed(kind: Callable[..., HTTPConnection], clock: Clock, host: str, **more: Any) -> HTTPConnection:
    """A connection whose time runs from now, for as long as urllib waits for a part of it."""
    connection, end = kind(host, **more), clock() + more["timeout"]
    connection.response_class = partial(_TimedResponse, left=lambda: end - clock())  # type: ignore[assignment]
    return connection


class _TimedHandler(HTTPHandler, HTTPSHandler):
    def __init__(self, clock: Clock) -> None:
        super().__init__()
        self._clock = clock

    def http_open(self, req: Request) -> HTTPResponse:
        """Ask without TLS."""
        return self.do_open(partial(_timed, HTTPConnection, self._clock), req)

    def https_open(self, req: Request) -> HTTPResponse:
        """Ask with TLS; the certificate of the other side is verified."""
        return self.do_open(partial(_timed, HTTPSConnection, self._clock), req)


def timed_opener(*handlers: BaseHandler | type[BaseHandler], clock: Clock = time.monotonic) -> OpenerDirector:
    """An opener of urllib whose ``timeout`` is the deadline of the whole exchange after connecting."""
    return build_opener(_TimedHandler(clock), *handlers)

"""HTTP exchanges with a deadline for the whole of each, and why another computer could not be reached."""

from __future__ import annotations

import io
import logging
import socket
import ssl
import time
from collections.abc import Callable
from functools import partial
from http.client import (
    BadStatusLine,
    HTTPConnection,
    HTTPResponse,
    HTTPSConnection,
    InvalidURL,
    RemoteDisconnected,
)
from typing import Any
from urllib.error import URLError
from urllib.parse import urlsplit
from urllib.request import BaseHandler, HTTPHandler, HTTPSHandler, OpenerDirector, Request, build_opener

from core.message import Message

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


LONGEST = 200  # characters of what the other side says that a sentence repeats
NO_ANSWER = "no answer"
_NO_TLS = frozenset({"WRONG_VERSION_NUMBER", "RECORD_LAYER_FAILURE", "HTTP_REQUEST"})
_TLS_ALERT = "\x15\x03"
_CAUSES = 10  # that are told of one trouble: somebody may answer otherwise each time


def cause_of(error: Exception) -> str:
    """In the words of the system or of the other side, without numbers, passwords and tokens."""
    cause = error.reason if isinstance(error, URLError) else error  # it wraps what the system has said
    match cause:
        case TimeoutError() if cause.errno is None:
            words = NO_ANSWER
        case ssl.SSLCertVerificationError():
            words = Message(
                "the server certificate cannot be verified: {verify_message}",
                verify_message=cause.verify_message,
            )
        case ssl.SSLError() if cause.reason in _NO_TLS:
            words = "the server does not support TLS; use an address that begins with http://"
        case RemoteDisconnected():
            words = "the server closed the connection without a response"
        case BadStatusLine() if str(cause).startswith(_TLS_ALERT):
            words = "the server accepts TLS only; use an address that begins with https://"
        case BadStatusLine():
            words = "the server's response is not HTTP"
        case InvalidURL():  # its sentence has the address with the token
            words = "the address contains characters that are not allowed in an address"
        case _:
            words = str(getattr(cause, "strerror", None) or cause)
    return one_line(words)


def host_of(address: str) -> str:
    """Scheme, host and port of a web address: the rest may hold a password or a token."""
    parts = urlsplit(address)
    return f"{parts.scheme}://{parts.netloc.rpartition('@')[2]}"


def one_line(words: str) -> str:
    """What somebody else has said, without what a terminal obeys."""
    return "".join(sign for sign in words if sign.isprintable())[:LONGEST]


class Trouble:
    """Says to a log why somebody cannot be told: each cause once, until he was told again."""

    def __init__(self, log: logging.Logger, who: str) -> None:
        self._log, self._who = log, who
        self._said = set[str]()

    def say(self, why: str) -> None:
        """From any thread."""
        if why not in self._said and len(self._said) < _CAUSES:
            self._said.add(why)
            self._log.warning("%s cannot be told: %s", self._who, why)

    def over(self) -> None:
        """The next time all of it is news again."""
        self._said.clear()

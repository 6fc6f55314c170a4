"""Why another computer could not be reached, in a few words for a log or a page."""

from __future__ import annotations

import logging
import ssl
from http.client import BadStatusLine, InvalidURL, RemoteDisconnected
from urllib.error import URLError
from urllib.parse import urlsplit

from core.message import Message

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

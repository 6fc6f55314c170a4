"""PINs: never kept as they are, and slower with every wrong one.

Kept is scrypt (RFC 7914) of the PIN with a salt of its own: N 2¹⁴, r 8, p 1, some 50 ms and 16 MiB.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
from dataclasses import dataclass
from typing import NamedTuple

from core.coded_error import CodedError

SHORTEST, LONGEST = 4, 12
_SALT, _LENGTH = 16, 32  # bytes
_N, _R, _P = 2**14, 8, 1


class PinError(CodedError):
    """No such PIN can be; the sentence says why."""


class Hashed(NamedTuple):
    """What is kept of a PIN."""

    salt: bytes
    hash: bytes


def check_pin(pin: str) -> None:
    """Raises PinError for what is no PIN: 4 to 12 figures, not all the same."""
    if not (pin.isascii() and pin.isdigit() and SHORTEST <= len(pin) <= LONGEST):
        raise PinError(f"a PIN has {SHORTEST} to {LONGEST} figures", "pin-length")
    if len(set(pin)) == 1:
        raise PinError(
            "a PIN of one figure again and again is guessed at once; take another", "pin-too-simple"
        )


def hashed(pin: str, salt: bytes | None = None) -> Hashed:
    """The PIN as it is kept, with a new salt where none is given. Takes its time: on a worker."""
    salt = salt if salt is not None else secrets.token_bytes(_SALT)
    return Hashed(salt, hashlib.scrypt(pin.encode(), salt=salt, n=_N, r=_R, p=_P, dklen=_LENGTH))


def is_pin(pin: str, kept: Hashed) -> bool:
    """Whether this is the PIN. Takes its time: on a worker."""
    return hmac.compare_digest(hashed(pin, kept.salt).hash, kept.hash)


FREE = 2  # wrong ones after which the next is taken at once
_FIRST, _MOST = 5.0, 300.0  # s


def wait_after(wrong: int) -> float:
    """Seconds for which no PIN is taken after so many wrong ones in a row: 0, 0, 5, 10, 20 … 300."""
    return min(_MOST, _FIRST * 2.0 ** (wrong - FREE - 1)) if wrong > FREE else 0.0


@dataclass(slots=True)
class WrongPins:
    """How many were wrong in a row, whoever typed them; ``since`` is monotonic, seconds.

    A control that is started anew waits anew: ``count`` is kept, the time is not.
    """

    count: int = 0
    since: float = 0.0

    def left(self, now: float) -> float:
        """Seconds until a PIN is taken again; 0: now."""
        return max(0.0, self.since + wait_after(self.count) - now)

    def wrong(self, now: float) -> None:
        """One more."""
        self.count, self.since = self.count + 1, now

    def right(self) -> None:
        """It was the PIN: all is forgotten."""
        self.count = 0

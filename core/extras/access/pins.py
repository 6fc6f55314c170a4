"""PINs: stored only as slow hashes, and slower with every wrong one.

TurnDesk stores scrypt (RFC 7914) of the PIN with its own salt. One try takes at least 0.5 s and 64 MiB, so
that all PINs of four digits take more than an hour, also for a reader of the file.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
from dataclasses import dataclass
from typing import NamedTuple

from core.message import CodedError, Message

SHORTEST, LONGEST = 4, 12
_SALT, _LENGTH = 16, 32  # bytes
_MOST_MEMORY = 2**28  # bytes


class Cost(NamedTuple):
    """The parameters of scrypt: the base-2 logarithm of N, r and p, each one byte in front of the hash."""

    log2_n: int
    r: int
    p: int


COST = Cost(16, 8, 8)  # of new hashes
_FIRST_COST = Cost(14, 8, 1)  # of hashes without these bytes, from older versions


class PinError(CodedError):
    """No such PIN can be; the sentence says why."""


class Hashed(NamedTuple):
    """What is kept of a PIN."""

    salt: bytes
    hash: bytes


def check_pin(pin: str) -> None:
    """Raises PinError for what is no PIN: 4 to 12 figures, not all the same."""
    if not (pin.isascii() and pin.isdigit() and SHORTEST <= len(pin) <= LONGEST):
        raise PinError(
            Message("a PIN must have {shortest} to {longest} digits", shortest=SHORTEST, longest=LONGEST),
            "pin-length",
        )
    if len(set(pin)) == 1:
        raise PinError("a PIN of one repeated digit is too easy to guess; choose another", "pin-too-simple")


def hashed(pin: str, salt: bytes | None = None) -> Hashed:
    """Hash the PIN at today's cost, with a new salt where none is given. Takes its time: on a worker."""
    salt = salt if salt is not None else secrets.token_bytes(_SALT)
    return Hashed(salt, bytes(COST) + _scrypt(pin, salt, COST))


def is_pin(pin: str, kept: Hashed) -> bool:
    """Return whether this is the PIN; an empty hash has none. Takes its time: on a worker."""
    cost = _cost_of(kept)
    digest = kept.hash[-_LENGTH:]
    return cost is not None and hmac.compare_digest(_scrypt(pin, kept.salt, cost), digest)


def is_outdated(kept: Hashed) -> bool:
    """Return whether the hash was made at another cost than today's."""
    return _cost_of(kept) != COST


def _cost_of(kept: Hashed) -> Cost | None:
    head = kept.hash[:-_LENGTH]
    if len(kept.hash) == _LENGTH:
        return _FIRST_COST
    return Cost(*head) if len(head) == len(COST) else None


def _scrypt(pin: str, salt: bytes, cost: Cost) -> bytes:
    return hashlib.scrypt(
        pin.encode(), salt=salt, n=1 << cost.log2_n, r=cost.r, p=cost.p, dklen=_LENGTH, maxmem=_MOST_MEMORY
    )


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

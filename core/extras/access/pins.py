"""PINs, stored only as slow hashes, with delays after wrong attempts.

TurnDesk stores the scrypt hash (RFC 7914) of each PIN with a separate salt. One attempt takes at least 0.5
s and 64 MiB. Trying all four-digit PINs therefore takes more than an hour, even with a copy of the file.
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


class ScryptCost(NamedTuple):
    """Cost parameters of scrypt (log2 of N, r and p), each stored as one byte in front of the hash."""

    log2_n: int
    block_size: int
    parallelism: int


DEFAULT_COST = ScryptCost(16, 8, 8)  # parameters of new hashes
_FIRST_COST = ScryptCost(14, 8, 1)  # parameters of hashes from older versions, which do not store them


class PinError(CodedError):
    """An error raised if a PIN is not acceptable; the text states the reason."""


class PinHash(NamedTuple):
    """The stored hash of a PIN and its salt."""

    salt: bytes
    hash: bytes


def check_pin(pin: str) -> None:
    """Raise PinError unless the PIN has 4 to 12 digits that are not all the same."""
    if not (pin.isascii() and pin.isdigit() and SHORTEST <= len(pin) <= LONGEST):
        raise PinError(
            Message("a PIN must have {shortest} to {longest} digits", shortest=SHORTEST, longest=LONGEST),
            "pin-length",
        )
    if len(set(pin)) == 1:
        raise PinError("a PIN of one repeated digit is too easy to guess; choose another", "pin-too-simple")


def hash_pin(pin: str, salt: bytes | None = None) -> PinHash:
    """Hash a PIN with ``salt``, or with a new salt if ``salt`` is None.

    The calculation is slow, so call this function in a worker thread.
    """
    salt = salt if salt is not None else secrets.token_bytes(_SALT)
    return PinHash(salt, bytes(DEFAULT_COST) + _scrypt(pin, salt, DEFAULT_COST))


def is_pin_correct(pin: str, stored_hash: PinHash) -> bool:
    """Return whether the PIN matches the hash. The result is False for an empty hash.

    The calculation is slow, so call it in a worker thread.
    """
    cost = _cost_of(stored_hash)
    digest = stored_hash.hash[-_LENGTH:]
    return cost is not None and hmac.compare_digest(_scrypt(pin, stored_hash.salt, cost), digest)


def is_hash_outdated(stored_hash: PinHash) -> bool:
    """Return whether the hash was made with parameters that are no longer used for new hashes."""
    return _cost_of(stored_hash) != DEFAULT_COST


def _cost_of(kept: PinHash) -> ScryptCost | None:
    head = kept.hash[:-_LENGTH]
    if len(kept.hash) == _LENGTH:
        return _FIRST_COST
    return ScryptCost(*head) if len(head) == len(DEFAULT_COST) else None


def _scrypt(pin: str, salt: bytes, cost: ScryptCost) -> bytes:
    return hashlib.scrypt(
        pin.encode(),
        salt=salt,
        n=1 << cost.log2_n,
        r=cost.block_size,
        p=cost.parallelism,
        dklen=_LENGTH,
        maxmem=_MOST_MEMORY,
    )


FREE_ATTEMPT_COUNT = 2  # wrong PINs that cause no delay
_FIRST, _MOST = 5.0, 300.0  # s


def calculate_retry_delay(wrong_attempts: int) -> float:
    """Return the delay in seconds after a number of consecutive wrong PINs.

    The delays are 0, 0, 5, 10, 20 and so on, up to 300 s.
    """
    return (
        min(_MOST, _FIRST * 2.0 ** (wrong_attempts - FREE_ATTEMPT_COUNT - 1))
        if wrong_attempts > FREE_ATTEMPT_COUNT
        else 0.0
    )


@dataclass(slots=True)
class WrongPinCounter:
    """Counter of consecutive wrong PINs of all users.

    ``last_attempt_s`` is the monotonic time of the last wrong PIN in seconds. ``wrong_pin_count`` is stored,
    but the time is not, so the delay starts again after a restart.
    """

    wrong_pin_count: int = 0
    last_attempt_s: float = 0.0

    def get_remaining_delay(self, now: float) -> float:
        """Return the time in seconds until the next PIN is accepted, or 0 if it is accepted now."""
        return max(0.0, self.last_attempt_s + calculate_retry_delay(self.wrong_pin_count) - now)

    def count_wrong_pin(self, now: float) -> None:
        """Increment the count and record ``now`` as the time of the last wrong PIN."""
        self.wrong_pin_count, self.last_attempt_s = self.wrong_pin_count + 1, now

    def reset_count(self) -> None:
        """Reset the count of wrong PINs after a correct PIN."""
        self.wrong_pin_count = 0

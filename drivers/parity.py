"""Parity of seven-bit characters on a line of eight bits."""

from __future__ import annotations

PARITIES = {"E": 0, "O": 1}  # what the count of ones in a character is, modulo 2
_TOP = 0x80


def parity_of(character: int) -> int:
    """Its ones, modulo 2."""
    return character.bit_count() & 1


def table_of(parity: str) -> bytes:
    """For ``bytes.translate``: the top bit of each seven-bit character is its parity bit."""
    odd = PARITIES[parity]
    return bytes(c & ~_TOP | (_TOP if parity_of(c & ~_TOP) != odd else 0) for c in range(256))

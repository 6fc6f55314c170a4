"""Addresses in a machine file: ``401.6200.1.0`` is node, object, sub-index and bit on the CAN bus."""

from __future__ import annotations

import re
from dataclasses import dataclass

_CAN = re.compile(r"([A-Za-z0-9_]+)\.([0-9A-Fa-f]{4})\.(\d{1,3})(?:\.(\d{1,2}))?")
_SDO = re.compile(r"([0-9A-Fa-f]{4}):(\d{1,3})")
PLAIN_MODULE = "401"  # means the first I/O module


@dataclass(frozen=True, slots=True)
class CanTerminal:
    """One bit (``bit`` from 0) or one whole number (``bit`` -1) of an object."""

    node: str
    index: int
    sub: int
    bit: int


def can_terminal(text: str) -> CanTerminal | None:
    """The address, or None where it is none."""
    found = _CAN.fullmatch(text)
    if found is None:
        return None
    node, index, sub, bit = found.groups()
    return CanTerminal(node, int(index, 16), int(sub), int(bit) if bit else -1)


def sdo_address(text: str) -> tuple[int, int] | None:
    """``6007:0`` as index and sub-index, or None."""
    found = _SDO.fullmatch(text)
    if found is None or int(found[2]) > 255:
        return None
    return int(found[1], 16), int(found[2])

"""Who answers at the other end: ``$I``. Nothing is assumed that is not said there."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from core.ports import DriverError

_LEAST_BUFFER = 256


class Identity(NamedTuple):
    """``blocks`` of the planner, ``buffer`` bytes for lines, axis letters in the order of the reports."""

    version: str
    blocks: int
    buffer: int
    axes: str
    options: frozenset[str]
    inputs: int  # auxiliary digital inputs
    outputs: int
    letters: str = ""  # of its build: V variable spindle, M mist

    @property
    def lathe(self) -> bool:
        """Whether it says that it is in lathe mode."""
        return any(option.startswith("LATHE") for option in self.options)


def read_identity(lines: Iterable[str]) -> Identity:
    """From the lines that ``$I`` is answered with. Raises DriverError for what is no grblHAL."""
    told: dict[str, str] = {}
    for line in lines:
        found = re.fullmatch(r"\[([A-Z ]+):(.*)\]", line)
        if found:
            told.setdefault(found[1], found[2])
    letters, *sizes = told.get("OPT", "").split(",")
    if "VER" not in told or len(sizes) < 2 or not all(size.isdecimal() for size in sizes[:2]):
        raise DriverError("what answers is no grblHAL: $I says neither [VER:…] nor [OPT:…,blocks,bytes,…]")
    blocks, buffer = int(sizes[0]), int(sizes[1])
    if buffer < _LEAST_BUFFER:
        raise DriverError(
            f"the controller's buffer of {buffer} bytes is too small; {_LEAST_BUFFER} are needed"
        )
    axes = told.get("AXS", "3:XYZ").partition(":")[2]
    options = frozenset(told.get("NEWOPT", "").split(",")) - {""}
    ports = [int(port) if port.isdecimal() else 0 for port in told.get("AUX IO", "0,0").split(",")]
    inputs, outputs = (*ports, 0, 0)[:2]
    return Identity(told["VER"], blocks, buffer, axes, options, inputs, outputs, letters)

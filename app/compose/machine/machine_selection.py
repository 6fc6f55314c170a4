"""Selection of a shipped machine that can run a program, used if no machine is specified."""

from __future__ import annotations

import re

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.dialects import SharedProgram
from core.language.source import Dialect, ProgramSource

MILL_NAMES = ("ac-table-mill", "bc-table-mill", "head-table-mill", "fork-head-mill")
_MAX_CHECKED_BLOCKS = 20_000  # blocks of a program that are checked
_MOVE_PATTERN = re.compile(r"^[\s/]*[0-9]*[\s/]*(?:L\b|PLANE\s+AXIAL\b)(.*)$", re.IGNORECASE)
_ROTARY_PATTERN = re.compile(r"(?<![A-Z])I?([ABC])(?=\s*[+-]?\s*[0-9.Q])", re.IGNORECASE)


def select_mill_for_program(source: ProgramSource) -> str:
    """Return the name of the first shipped mill that can run a Klartext program.

    If no mill can run the program, the result is the first mill with the program's rotary axes. For other
    languages the result is empty, because the shipped lathe runs them.
    """
    if source.dialect is not Dialect.KLARTEXT:
        return ""
    reading = SharedProgram(source)
    having = list_mills_with_axes(find_rotary_axes(source)) or MILL_NAMES
    return next((name for name in having if _runs(reading, name)), having[0])


def list_mills_with_axes(axis_names: frozenset[str]) -> tuple[str, ...]:
    """Return the shipped mills that have all of these rotary axes."""
    return tuple(
        name for name in MILL_NAMES if axis_names <= {axis.name for axis in load_shipped_machine(name).axes}
    )


def find_rotary_axes(source: ProgramSource) -> frozenset[str]:
    """Return the rotary axes that the program names in L and PLANE AXIAL blocks."""
    moved = (match.group(1) for text in source.lines if (match := _MOVE_PATTERN.match(text.split(";", 1)[0])))
    return frozenset(axis.upper() for words in moved for axis in _ROTARY_PATTERN.findall(words))


def _runs(reading: SharedProgram, name: str) -> bool:
    run = reading.start_pass(
        create_power_up_setup(load_shipped_machine(name), tool_offsets={}, secondary_offsets={})
    )
    for block in run.generate_blocks(stops_at_first_error=True):
        if block.n >= _MAX_CHECKED_BLOCKS:
            break
    return not run.has_errors

"""Selection of a shipped machine that can run a program, if no machine is specified."""

from __future__ import annotations

import re

from app.compose.machine.machine_files import shipped_machine
from app.compose.machine.machine_setup import setup_for
from core.interpreter.dialects import ReadProgram
from core.language.source import Dialect, Source

MILLS = ("ac-table-mill", "bc-table-mill", "head-table-mill", "fork-head-mill")
_SHORT = 20_000  # blocks of a program that are checked
_MOVED = re.compile(r"^[\s/]*[0-9]*[\s/]*(?:L\b|PLANE\s+AXIAL\b)(.*)$", re.IGNORECASE)
_ROTARY = re.compile(r"(?<![A-Z])I?([ABC])(?=\s*[+-]?\s*[0-9.Q])", re.IGNORECASE)


def fitting_machine(source: Source) -> str:
    """Return the name of the first shipped mill that can run a Klartext program.

    If none can, the result is the first mill with the program's rotary axes. For other languages the result
    is empty, because the shipped lathe reads them.
    """
    if source.dialect is not Dialect.KLARTEXT:
        return ""
    reading = ReadProgram(source)
    having = mills_with(rotary_axes(source)) or MILLS
    return next((name for name in having if _runs(reading, name)), having[0])


def mills_with(axes: frozenset[str]) -> tuple[str, ...]:
    """Return the shipped mills that have all of these rotary axes."""
    return tuple(name for name in MILLS if axes <= {axis.name for axis in shipped_machine(name).axes})


def rotary_axes(source: Source) -> frozenset[str]:
    """Return the rotary axes that the program moves by name in L and PLANE AXIAL."""
    moved = (match.group(1) for text in source.lines if (match := _MOVED.match(text.split(";", 1)[0])))
    return frozenset(axis.upper() for words in moved for axis in _ROTARY.findall(words))


def _runs(reading: ReadProgram, name: str) -> bool:
    run = reading.begin(setup_for(shipped_machine(name), tools={}, secondary={}))
    for block in run.blocks(to_first_error=True):
        if block.n >= _SHORT:
            break
    return not run.failed

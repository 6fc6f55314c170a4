"""The controller's settings: read, written where they are not as the machine file says, and read back."""

from __future__ import annotations

import math
from collections.abc import Mapping

from drivers.grblhal.asking import asked
from drivers.grblhal.controller import Controller
from drivers.grblhal.scripting import Script, ScriptError

# Machine position, buffers, line numbers, speeds, pins, offsets, overrides; the number of an alarm.
_REPORTS = 0x7F | 0x400
_PARSER = 0x200  # parser state unasked, which would look like an answer to $G
_RESTORE = 0x2  # of the feed hold: the spindle starts by itself when it ends
_LISTED = 6.0  # s for all of them: some hundred lines at whatever speed the line has
_MASK, _MODE, _LATHE, _AFTER_HOLD = 10, 32, 2, 63


def settings(c: Controller) -> Script:
    """Write what is not as it must be, and read it back."""
    there = c.settings = _values((yield from asked(c, "$$", _LISTED)))
    wrong = {n: value for n, value in _wanted(c, there).items() if not same(there.get(n), value)}
    if not wrong:
        return
    for n, value in wrong.items():
        yield from asked(c, f"${n}={written(value)}")
    there = c.settings = _values((yield from asked(c, "$$", _LISTED)))
    for n, value in wrong.items():
        if not same(there.get(n), value):
            raise ScriptError(
                f"setting ${n}={written(value)} was written and reads {there.get(n, 'nothing')}"
            )


def _wanted(c: Controller, there: Mapping[int, str]) -> dict[int, float | str]:
    wanted: dict[int, float | str] = dict(c.config.settings)
    always = c.identity is not None and c.identity.lathe and _MODE not in there
    if always and wanted.get(_MODE) == _LATHE:
        del wanted[_MODE]  # firmware that is built for lathes alone has no such setting
    wanted[_MASK] = (int(float(there.get(_MASK, "0"))) | _REPORTS) & ~_PARSER
    if _AFTER_HOLD in there:
        wanted[_AFTER_HOLD] = int(float(there[_AFTER_HOLD])) & ~_RESTORE
    return wanted


def _values(lines: list[str]) -> dict[int, str]:
    pairs = (line[1:].split("=", 1) for line in lines if line.startswith("$") and "=" in line)
    return {int(n): value for n, value in pairs}


def same(there: str | None, wanted: float | str) -> bool:
    """Whether a setting reads as it was written: each is told with decimals of its own."""
    if there is None or isinstance(wanted, str):
        return there == wanted
    decimals = len(there.partition(".")[2])
    try:
        return math.isclose(float(there), wanted, rel_tol=1e-6, abs_tol=0.5001 * 10.0**-decimals)
    except ValueError:
        return False


def written(value: float | str) -> str:
    """Without exponents, which the controller does not read."""
    if isinstance(value, str):
        return value
    return f"{value:.6f}".rstrip("0").rstrip(".")

"""The pieces that scripts are made of: one line and its answer, a full report, the settings."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator

from drivers.grblhal import codes
from drivers.grblhal.controller import Controller
from drivers.grblhal.scripting import Script, ScriptError, Step
from drivers.grblhal.stream import Ask

ANSWER = 2.0  # s for a line
MISSED = "the controller sends no status report"
_TRIES = 3
_REPORTS = (
    0x7F | 0x400
)  # $10: machine position, buffers, line numbers, speeds, pins, offsets, overrides, alarm
_PARSER = 0x200  # $10: parser state unasked, which would look like an answer to $G


def full_report(c: Controller, within: float = ANSWER) -> Script:
    """A report with everything in it."""
    before = c.fulls
    c.question(full=True)
    yield lambda: c.fulls > before, within, MISSED


def speed_of(c: Controller, letter: str) -> float:
    """The controller's own greatest speed of an axis, mm/s; 0 where it does not tell."""
    return figure(c, 110, letter) / 60.0


def figure(c: Controller, first: int, letter: str) -> float:
    """A setting that there is once for each axis, in their order."""
    index = letters(c).find(letter)
    return float(c.settings.get(first + index, "0")) if index >= 0 else 0.0


def fresh(c: Controller) -> Script:
    """An empty line ends half a line and a standing error; from ``$G`` on answers count again."""
    for _ in range(_TRIES):
        c.stream.void()
        c.realtime(ord("\n"))
        ask, by = c.send("$G"), c.clock.now() + ANSWER / _TRIES
        yield _by(c, ask, by), ANSWER, ""
        if ask.done:
            return
    raise ScriptError("the controller does not answer '$G'")


def _by(c: Controller, ask: Ask, by: float) -> Callable[[], bool]:
    return lambda: ask.done or c.clock.now() >= by


def asked(c: Controller, line: str, within: float = ANSWER) -> Generator[Step, None, list[str]]:
    """Send a line and wait for its ``ok``; what was told before it."""
    ask = c.send(line)
    yield lambda: ask.done, within, f"the controller does not answer {line!r}"
    if ask.error:
        raise ScriptError(codes.error_text(ask.error, line))
    return ask.lines


def demand_modes(c: Controller) -> Script:
    told = " ".join(line for line in (yield from asked(c, "$G")) if line.startswith("[GC:"))
    words = told.removeprefix("[GC:").rstrip("]").split()
    missing = [mode for mode in codes.MODES if mode not in words]
    if missing:
        lathe = "; is it in lathe mode ($32=2)?" if "G8" in missing else ""
        raise ScriptError(f"the controller does not keep {' '.join(missing)}: {told}{lathe}")


def settings(c: Controller) -> Script:
    """Write what is not as the machine file says, and read it back."""
    there = c.settings = _values((yield from asked(c, "$$")))
    wanted: dict[int, float | str] = dict(c.config.settings)
    reports = int(float(there.get(10, "0")))
    wanted[10] = (reports | _REPORTS) & ~_PARSER
    wrong = {n: value for n, value in wanted.items() if not _same(there.get(n), value)}
    if not wrong:
        return
    for n, value in wrong.items():
        yield from asked(c, f"${n}={_written(value)}")
    there = c.settings = _values((yield from asked(c, "$$")))
    for n, value in wrong.items():
        if not _same(there.get(n), value):
            raise ScriptError(
                f"setting ${n}={_written(value)} was written and reads {there.get(n, 'nothing')}"
            )


def _values(lines: list[str]) -> dict[int, str]:
    pairs = (line[1:].split("=", 1) for line in lines if line.startswith("$") and "=" in line)
    return {int(n): value for n, value in pairs}


def _same(there: str | None, wanted: float | str) -> bool:
    if there is None or isinstance(wanted, str):
        return there == wanted
    try:
        return math.isclose(float(there), wanted, abs_tol=1e-9)
    except ValueError:
        return False


def _written(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:g}"


def letters(c: Controller) -> str:
    return c.identity.axes if c.identity is not None else "XYZ"


def demand_axes(c: Controller) -> None:
    missing = [axis.name for axis in c.config.axes if axis.wired and axis.name not in letters(c)]
    if missing:
        raise ScriptError(f"the controller has axes {letters(c)}, not {', '.join(missing)}")

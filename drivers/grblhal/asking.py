"""The pieces that scripts are made of: one line and its answer, a full report, the modes."""

from __future__ import annotations

from collections.abc import Callable, Generator

from drivers.grblhal import codes
from drivers.grblhal.controller import Controller
from drivers.grblhal.scripting import Script, ScriptError, Step
from drivers.grblhal.stream import Ask

ANSWER = 2.0  # s for a line
MISSED = "the controller sends no status report"
_TRIES = 3


def full_report(c: Controller, within: float = ANSWER) -> Script:
    """A report with everything in it."""
    before = c.fulls
    c.question(full=True)
    yield lambda: c.fulls > before, within, MISSED


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


def modes(c: Controller) -> Script:
    """Send the modes, end what another host has left behind, and read all of it back."""
    yield from asked(c, "".join(codes.MODES))
    told = yield from _words(c)
    cures = dict.fromkeys(codes.CURES[_stem(word)] for word in told if _stem(word) in codes.CURES)
    for cure in cures:
        yield from asked(c, cure)
    told = (yield from _words(c)) if cures else told
    missing = [mode for mode in codes.MODES if mode not in told and mode not in codes.SILENT]
    kept = [word for word in told if _stem(word) in codes.CURES]
    if missing or kept:
        lathe = "; is it in lathe mode ($32=2)?" if "G8" in missing else ""
        wrong = f"does not keep {' '.join(missing)}" if missing else f"stays in {' '.join(kept)}"
        raise ScriptError(f"the controller {wrong}: [GC:{' '.join(told)}]{lathe}")


def _stem(word: str) -> str:
    """``G43.1`` is a kind of G43, ``G51:X`` of G51."""
    return word.partition(":")[0].partition(".")[0]


def _words(c: Controller) -> Generator[Step, None, list[str]]:
    """The parser's state; what it tells that is nobody's business stays in."""
    told = " ".join(line for line in (yield from asked(c, "$G")) if line.startswith("[GC:"))
    return told.removeprefix("[GC:").rstrip("]").split()


def demand_axes(c: Controller) -> None:
    """Raises ScriptError when an axis of the machine file is missing."""
    missing = [axis.name for axis in c.wired if axis.name not in c.letters]
    if missing:
        raise ScriptError(f"the controller has axes {c.letters}, not {', '.join(missing)}")

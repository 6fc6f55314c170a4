"""What takes several questions: to connect, to verify the modes, to stop, to clear an alarm, to home.

Each is a generator that the controller's pump carries on; what goes wrong is raised as ScriptError.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator

from core.ports import DriverError
from drivers.grblhal import codes
from drivers.grblhal.controller import Controller, Script, ScriptError, Step
from drivers.grblhal.identity import read_identity
from drivers.grblhal.stream import Ask

_ANSWER = 2.0  # s for a line
_LATE = 0.4  # s, beyond its ramp, for a stop to be seen
_BANNER = 3.0  # s that a reset takes
_BOOT = 6.0  # s; some boards start when their port is opened
_HOMING = 120.0
_TRIES = 3
_REPORTS = (
    0x7F | 0x400
)  # $10: machine position, buffers, line numbers, speeds, pins, offsets, overrides, alarm
_PARSER = 0x200  # $10: parser state unasked, which would look like an answer to $G
_MISSED = "the controller sends no status report"


def connect(c: Controller) -> Script:
    """From an open wire to verified modes; a controller in alarm stays there for the operator."""
    yield from full_report(c, _BOOT)
    if c.report is not None and c.report.state not in {"Idle", "Alarm"}:
        yield from _stop(c)
    yield from _fresh(c)
    try:
        c.identity = read_identity((yield from _asked(c, "$I")))
    except DriverError as error:
        raise ScriptError(str(error)) from error
    _demand_axes(c)
    c.stream.use(c.identity.buffer)
    yield from _settings(c)
    yield from full_report(c)
    if c.report is not None and c.report.state == "Alarm":
        number = c.report.sub or c.alarm
        c.alarm = number
        if number != codes.HOMING_REQUIRED:
            c.fail(codes.alarm_text(number))
        return
    yield from verify(c)


def verify(c: Controller) -> Script:
    """Send the modes, read them back, and see that positions are radii in a frame without offsets."""
    yield from _fresh(c)
    yield from _asked(c, "".join(codes.MODES))
    yield from _demand_modes(c)
    yield from full_report(c)
    if any(abs(offset) > 1e-9 for offset in c.offset):
        yield from _asked(c, "G10L2P1" + "".join(f"{letter}0" for letter in _letters(c)))
        yield from _asked(c, "G92.1")
        yield from _asked(c, "G49")
        yield from full_report(c)
    if any(abs(offset) > 1e-9 for offset in c.offset):
        raise ScriptError(f"the controller keeps offsets {c.offset}; blocks go out in machine coordinates")
    if c.diameter:
        raise ScriptError("X counts in diameter (D:1) although G8 is in force")
    if c.report is None or c.report.state not in {"Idle", "Jog"}:
        raise ScriptError(f"the controller is in state {c.report.state if c.report else 'unknown'}, not Idle")
    c.ready = c.fault == ""


def abort(c: Controller) -> Script:
    """To rest, the queue void, the modes verified; the position is kept where the controller allows that."""
    c.void()
    if c.report is not None and c.report.state == "Alarm":
        return
    yield from _stop(c)
    if c.report is not None and c.report.state != "Alarm":
        yield from verify(c)


def recover(c: Controller) -> Script:
    """The operator has cleared the alarm: reset, unlock, verify. What stood in the planner is gone."""
    c.void()
    yield from full_report(c)
    if c.report is not None and "E" in c.report.pins:
        raise ScriptError("E-stop is pressed at the controller: release it, then Reset")
    if c.report is not None and c.report.moves:
        yield from _stop(c)
    yield from _reset(c)
    yield from full_report(c)
    if c.report is not None and c.report.state == "Alarm":
        number = c.report.sub or c.alarm
        if number == codes.HOMING_REQUIRED:
            return
        yield from _fresh(c)
        yield from _asked(c, "$X")
    yield from verify(c)


def home(c: Controller, letter: str) -> Script:
    """Look for the switch of one axis."""
    yield from _fresh(c)
    yield from _asked(c, f"$H{letter}", _HOMING)
    yield from full_report(c)
    if c.report is not None and c.report.state != "Alarm":
        yield from verify(c)


def jog_end(c: Controller) -> Script:
    """Behind a cancelled jog: to rest, and no line may be left that is never answered."""
    began = c.reports
    yield (
        lambda: c.reports > began + 1 and c.report is not None and not c.report.moves,
        _ANSWER,
        "a cancelled jog does not end",
    )
    yield from verify(c)


def full_report(c: Controller, within: float = _ANSWER) -> Script:
    """A report with everything in it."""
    before = c.fulls
    c.question(full=True)
    yield lambda: c.fulls > before, within, _MISSED


def _stop(c: Controller) -> Script:
    """0x19 decelerates and keeps the position; where that does not end: hold, then reset."""
    after = c.reports + 1  # one report may still be on its way from before
    by = c.clock.now() + _stopping(c)
    c.realtime(codes.STOP)

    def rests() -> bool:
        return c.reports > after and c.report is not None and c.report.state in {"Idle", "Alarm"}

    yield lambda: rests() or c.clock.now() >= by, _stopping(c) + 1.0, _MISSED
    if rests():
        return
    c.realtime(codes.HOLD)
    by = c.clock.now() + _stopping(c)
    yield lambda: _held(c) or c.clock.now() >= by, _stopping(c) + 1.0, _MISSED
    yield from _reset(c)


def _stopping(c: Controller) -> float:
    """Seconds that the slowest slide takes to brake, by the controller's own figures where it tells them."""
    wired = [axis for axis in c.config.axes if axis.wired]
    ramps = [axis.vmax / axis.amax for axis in wired]
    for axis in wired:
        speed, accel = speed_of(c, axis.name), _figure(c, 120, axis.name)
        if speed and accel:
            ramps.append(speed / accel)
    return _LATE + max(ramps)


def speed_of(c: Controller, letter: str) -> float:
    """The controller's own greatest speed of an axis, mm/s; 0 where it does not tell."""
    return _figure(c, 110, letter) / 60.0


def _figure(c: Controller, first: int, letter: str) -> float:
    """A setting that there is once for each axis, in their order."""
    index = _letters(c).find(letter)
    return float(c.settings.get(first + index, "0")) if index >= 0 else 0.0


def _held(c: Controller) -> bool:
    return c.report is not None and c.report.state == "Hold" and not c.report.sub


def _reset(c: Controller) -> Script:
    """Soft reset, and its banner."""
    before = c.banners
    c.expect_reset()
    c.realtime(codes.RESET)
    yield (
        lambda: c.banners > before,
        _BANNER,
        "the controller does not come back from its reset; is E-stop pressed?",
    )


def _fresh(c: Controller) -> Script:
    """An empty line ends half a line and a standing error; from ``$G`` on answers count again."""
    for _ in range(_TRIES):
        c.stream.void()
        c.realtime(ord("\n"))
        ask, by = c.send("$G"), c.clock.now() + _ANSWER / _TRIES
        yield _by(c, ask, by), _ANSWER, ""
        if ask.done:
            return
    raise ScriptError("the controller does not answer '$G'")


def _by(c: Controller, ask: Ask, by: float) -> Callable[[], bool]:
    return lambda: ask.done or c.clock.now() >= by


def _asked(c: Controller, line: str, within: float = _ANSWER) -> Generator[Step, None, list[str]]:
    """Send a line and wait for its ``ok``; what was told before it."""
    ask = c.send(line)
    yield lambda: ask.done, within, f"the controller does not answer {line!r}"
    if ask.error:
        raise ScriptError(codes.error_text(ask.error, line))
    return ask.lines


def _demand_modes(c: Controller) -> Script:
    told = " ".join(line for line in (yield from _asked(c, "$G")) if line.startswith("[GC:"))
    words = told.removeprefix("[GC:").rstrip("]").split()
    missing = [mode for mode in codes.MODES if mode not in words]
    if missing:
        lathe = "; is it in lathe mode ($32=2)?" if "G8" in missing else ""
        raise ScriptError(f"the controller does not keep {' '.join(missing)}: {told}{lathe}")


def _settings(c: Controller) -> Script:
    """Write what is not as the machine file says, and read it back."""
    there = c.settings = _values((yield from _asked(c, "$$")))
    wanted: dict[int, float | str] = dict(c.config.settings)
    reports = int(float(there.get(10, "0")))
    wanted[10] = (reports | _REPORTS) & ~_PARSER
    wrong = {n: value for n, value in wanted.items() if not _same(there.get(n), value)}
    if not wrong:
        return
    for n, value in wrong.items():
        yield from _asked(c, f"${n}={_written(value)}")
    there = c.settings = _values((yield from _asked(c, "$$")))
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


def _letters(c: Controller) -> str:
    return c.identity.axes if c.identity is not None else "XYZ"


def _demand_axes(c: Controller) -> None:
    missing = [axis.name for axis in c.config.axes if axis.wired and axis.name not in _letters(c)]
    if missing:
        raise ScriptError(f"the controller has axes {_letters(c)}, not {', '.join(missing)}")

"""What takes several questions: to connect, to verify the modes, to stop, to clear an alarm, to home.

Each is a generator that the controller's pump carries on; what goes wrong is raised as ScriptError.
"""

from __future__ import annotations

from core.ports import DriverError
from drivers.grblhal import codes
from drivers.grblhal.asking import (
    ANSWER,
    MISSED,
    asked,
    demand_axes,
    demand_modes,
    figure,
    fresh,
    full_report,
    letters,
    settings,
    speed_of,
)
from drivers.grblhal.controller import Controller
from drivers.grblhal.identity import read_identity
from drivers.grblhal.scripting import Script, ScriptError

_LATE = 0.4  # s, beyond its ramp, for a stop to be seen
_BANNER = 3.0  # s that a reset takes
_BOOT = 6.0  # s; some boards start when their port is opened
_HOMING = 120.0


def connect(c: Controller) -> Script:
    """From an open wire to verified modes; a controller in alarm stays there for the operator."""
    yield from full_report(c, _BOOT)
    if c.report is not None and c.report.state not in {"Idle", "Alarm"}:
        yield from _stop(c)
    yield from fresh(c)
    try:
        c.identity = read_identity((yield from asked(c, "$I")))
    except DriverError as error:
        raise ScriptError(str(error)) from error
    demand_axes(c)
    c.stream.use(c.identity.buffer)
    yield from settings(c)
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
    yield from fresh(c)
    yield from asked(c, "".join(codes.MODES))
    yield from demand_modes(c)
    yield from full_report(c)
    if any(abs(offset) > 1e-9 for offset in c.offset):
        yield from asked(c, "G10L2P1" + "".join(f"{letter}0" for letter in letters(c)))
        yield from asked(c, "G92.1")
        yield from asked(c, "G49")
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
        yield from fresh(c)
        yield from asked(c, "$X")
    yield from verify(c)


def home(c: Controller, letter: str) -> Script:
    """Look for the switch of one axis."""
    yield from fresh(c)
    yield from asked(c, f"$H{letter}", _HOMING)
    yield from full_report(c)
    if c.report is not None and c.report.state != "Alarm":
        yield from verify(c)


def jog_end(c: Controller) -> Script:
    """Behind a cancelled jog: to rest, and no line may be left that is never answered."""
    began = c.reports
    yield (
        lambda: c.reports > began + 1 and c.report is not None and not c.report.moves,
        ANSWER,
        "a cancelled jog does not end",
    )
    yield from verify(c)


def _stop(c: Controller) -> Script:
    """0x19 decelerates and keeps the position; where that does not end: hold, then reset."""
    after = c.reports + 1  # one report may still be on its way from before
    by = c.clock.now() + _stopping(c)
    c.realtime(codes.STOP)

    def rests() -> bool:
        return c.reports > after and c.report is not None and c.report.state in {"Idle", "Alarm"}

    yield lambda: rests() or c.clock.now() >= by, _stopping(c) + 1.0, MISSED
    if rests():
        return
    c.realtime(codes.HOLD)
    by = c.clock.now() + _stopping(c)
    yield lambda: _held(c) or c.clock.now() >= by, _stopping(c) + 1.0, MISSED
    yield from _reset(c)


def _stopping(c: Controller) -> float:
    """Seconds that the slowest slide takes to brake, by the controller's own figures where it tells them."""
    wired = [axis for axis in c.config.axes if axis.wired]
    ramps = [axis.vmax / axis.amax for axis in wired]
    for axis in wired:
        speed, accel = speed_of(c, axis.name), figure(c, 120, axis.name)
        if speed and accel:
            ramps.append(speed / accel)
    return _LATE + max(ramps)


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

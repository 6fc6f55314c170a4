"""What takes several questions: to connect, to verify the modes, to stop, to clear an alarm, to home.

Each is a generator that the controller's pump carries on; what goes wrong is raised as ScriptError.
"""

from __future__ import annotations

from collections.abc import Callable

from core.ports import DriverError
from drivers.grblhal import codes
from drivers.grblhal.asking import ANSWER, asked, demand_axes, fresh, full_report, modes
from drivers.grblhal.braking import reset, stop
from drivers.grblhal.controller import Controller
from drivers.grblhal.identity import read_identity
from drivers.grblhal.scripting import Script, ScriptError
from drivers.grblhal.settings import settings

_BOOT = 6.0  # s; some boards start when their port is opened
_HOMING = 120.0
_COASTING, _LOOK = 8.0, 0.1  # s a spindle is given to stand, between two looks at it
_STANDS = 5.0  # rpm
_ALONE = 2  # of $22: one axis may be homed without the others


def connect(c: Controller) -> Script:
    """From an open wire to verified modes; a controller in alarm stays there for the operator."""
    yield from full_report(c, _BOOT)
    if c.report is not None and c.report.state not in {"Idle", "Alarm"}:
        yield from stop(c)
    yield from fresh(c)
    try:
        c.identity = read_identity((yield from asked(c, "$I")))
    except DriverError as error:
        raise ScriptError(str(error), error.code) from error
    demand_axes(c)
    c.stream.use(c.identity.buffer)
    number = _alarm_of(c)
    if number not in codes.CRITICAL:
        yield from settings(c)
    yield from full_report(c)
    number = _alarm_of(c)
    if number:
        c.alarm = number
        if number != codes.HOMING_REQUIRED:
            c.fail(codes.alarm_text(number), codes.alarm_code(number))
        return
    yield from _quiet(c)
    yield from verify(c)


def _quiet(c: Controller) -> Script:
    """Spindle and coolant off: a control that was killed has left them as they were."""
    for code in codes.OFF:
        yield from asked(c, code)
    by = c.clock.now() + _COASTING
    while _turns(c) and c.clock.now() < by:
        yield _past(c, c.clock.now() + _LOOK), 2.0 * _LOOK, ""
        yield from full_report(c)


def _turns(c: Controller) -> bool:
    """The controller's own spindle, as its encoder tells it."""
    measured = c.report.measured if c.report is not None else None
    return c.config.own_spindle and (measured or 0.0) > _STANDS


def _past(c: Controller, t: float) -> Callable[[], bool]:
    return lambda: c.clock.now() >= t


def verify(c: Controller) -> Script:
    """Send the modes, read them back, and see that positions are radii in a frame without offsets."""
    yield from fresh(c)
    yield from modes(c)
    yield from full_report(c)
    if any(abs(offset) > 1e-9 for offset in c.offset):
        yield from asked(c, "G10L2P1" + "".join(f"{letter}0" for letter in c.letters))
        yield from asked(c, "G92.1")
        yield from asked(c, "G49")
        yield from full_report(c)
    if any(abs(offset) > 1e-9 for offset in c.offset):
        raise ScriptError(
            f"the controller keeps offsets {c.offset}; blocks go out in machine coordinates",
            "controller-modes",
        )
    if c.diameter:
        raise ScriptError("X counts in diameter (D:1) although G8 is in force", "controller-modes")
    if c.report is None or c.report.state not in {"Idle", "Jog"}:
        raise ScriptError(f"the controller is in state {c.report.state if c.report else 'unknown'}, not Idle")
    c.ready = c.fault == ""


def abort(c: Controller) -> Script:
    """To rest, the queue void, the modes verified; the position is kept where the controller allows that."""
    waits = c.index_wait
    c.void()
    if c.alarm:
        yield from reset(c)  # an alarm has stopped the slides alone: spindle and coolant end with a reset
        return
    if _alarm_of(c):
        return
    yield from stop(c, waits=waits)
    yield from full_report(c)
    if not (_alarm_of(c) or _door(c)):
        yield from verify(c)


def recover(c: Controller) -> Script:
    """The operator has cleared the alarm: reset, unlock, verify. What stood in the planner is gone."""
    c.void()
    yield from full_report(c)
    if c.report is not None and "E" in c.report.pins:
        raise ScriptError("E-stop is pressed at the controller: release it, then Reset", "controller-estop")
    if c.report is not None and c.report.moves:
        yield from stop(c)
    yield from reset(c)
    yield from full_report(c)
    if _door(c):
        raise ScriptError(f"{codes.DOOR}: close it, then Reset", "door")
    number = _alarm_of(c)
    if number == codes.HOMING_REQUIRED:
        return
    yield from fresh(c)
    if number:
        yield from asked(c, "$X")
    yield from settings(c)
    yield from verify(c)


def home(c: Controller, letter: str) -> Script:
    """Look for the switch of one axis, or take where it stands for its home."""
    axis = next(axis for axis in c.config.axes if axis.name == letter)
    yield from fresh(c)
    if axis.here is not None:
        yield from full_report(c)
        c.origin[letter] = c.position[letter] + c.origin.get(letter, 0.0) - axis.here
    elif not (axis.absolute and not c.homing):  # else the operator's word for where it is told to stand
        yield from _look_for_switch(c, letter)
    yield from full_report(c)
    c.alarm = _alarm_of(c)  # with "homing on startup required" it stays locked until the last axis is homed
    if not c.alarm:
        yield from verify(c)


def _look_for_switch(c: Controller, letter: str) -> Script:
    c.origin.pop(letter, None)
    if not c.homing or c.homing & _ALONE:
        yield from asked(c, f"$H{letter}", _HOMING)
    elif not c.is_homed(letter):
        yield from asked(c, "$H", _HOMING)  # all of them together, and the next finds itself homed


def jog_end(c: Controller) -> Script:
    """Behind a cancelled jog: to rest, and no line may be left that is never answered."""
    began = c.reports
    yield (
        lambda: c.reports > began + 1 and c.report is not None and not c.report.moves,
        ANSWER,
        "a cancelled jog does not end",
    )
    yield from verify(c)


def _door(c: Controller) -> bool:
    """Whether it reads no lines for its door."""
    return c.report is not None and c.report.state == "Door"


def _alarm_of(c: Controller) -> int:
    """The alarm that the last report tells, 0 without one."""
    if c.report is None or c.report.state != "Alarm":
        return 0
    return c.report.sub or c.alarm or codes.LOCKED

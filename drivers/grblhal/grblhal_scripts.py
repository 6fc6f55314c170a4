"""Scripts for tasks with several requests: connect, verify modes, stop, clear an alarm and home.

Each script is a generator that ``Controller.pump`` advances. A script raises ScriptError if it fails.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Mapping

from core.message import Message
from drivers.grblhal import grblhal_codes
from drivers.grblhal.grblhal_config import ESTOP, HARDWARE
from drivers.grblhal.grblhal_controller import Controller
from drivers.grblhal.grblhal_report import Identity, read_identity
from drivers.grblhal.grblhal_wire import Ask, Script, ScriptError, Step

# --- Parts of scripts: one line with its reply, a full report, the modes.


ANSWER = 2.0  # Seconds for a line.
MISSED = "the controller does not send status reports"
_TRIES = 3


def full_report(c: Controller, within: float = ANSWER) -> Script:
    """Request a full report and wait for it."""
    before = c.fulls
    c.question(full=True)
    yield lambda: c.fulls > before, within, MISSED


def fresh(c: Controller) -> Script:
    """Synchronize with the controller: clear a partial line and a sticky error, and wait for ``$G``.

    Replies are counted again from ``$G`` on.
    """
    # The controller reads these lines before ``$G``.
    slow = max((c.wait_of(ask.line) for ask in c.stream.unanswered), default=0.0)
    for _ in range(_TRIES):
        c.stream.void()
        c.realtime(ord("\n"))
        ask, by = c.send("$G"), c.clock.now() + ANSWER / _TRIES + slow
        yield _by(c, ask, by), ANSWER + slow, ""
        if ask.done:
            return
    raise ScriptError("no response from the controller to '$G'")


def _by(c: Controller, ask: Ask, by: float) -> Callable[[], bool]:
    return _by_time(c, lambda: ask.done, by)


def _by_time(c: Controller, ready: Callable[[], bool], by: float) -> Callable[[], bool]:
    """Return a function that is true when ``ready`` is true or the time has passed."""
    return lambda: ready() or c.clock.now() >= by


def asked(c: Controller, line: str, within: float = ANSWER) -> Generator[Step, None, list[str]]:
    """Send a line, wait for its ``ok`` and return the lines received before it.

    Raises ScriptError if the controller rejects the line.
    """
    ask = c.send(line)
    yield (
        lambda: ask.done,
        within + c.wait_of(line),
        Message("no response from the controller to {line}", line=f"{line!r}"),
    )
    if ask.error:
        raise ScriptError(grblhal_codes.error_text(ask.error, line))
    return ask.lines


def modes(c: Controller) -> Script:
    """Send the modes, end foreign modes that another host has left active, and verify the result."""
    yield from asked(c, "".join(grblhal_codes.MODES))
    told = yield from _words(c)
    cures = dict.fromkeys(
        grblhal_codes.CURES[_stem(word)] for word in told if _stem(word) in grblhal_codes.CURES
    )
    for cure in cures:
        yield from asked(c, cure)
    told = (yield from _words(c)) if cures else told
    missing = [mode for mode in grblhal_codes.MODES if mode not in told and mode not in grblhal_codes.SILENT]
    kept = [word for word in told if _stem(word) in grblhal_codes.CURES]
    if missing or kept:
        template = (
            "{wrong}; the controller reports [GC:{details}]; check that the controller is in lathe mode "
            "($32=2)"
            if "G8" in missing
            else "{wrong}; the controller reports [GC:{details}]"
        )
        wrong = (
            Message("the controller does not stay in mode {missing}", missing=" ".join(missing))
            if missing
            else Message("the controller stays in mode {saved}", saved=" ".join(kept))
        )
        raise ScriptError(template, wrong=wrong, details=" ".join(told))


def _stem(word: str) -> str:
    """Return the basic code of a word: G43 for ``G43.1``, G51 for ``G51:X``."""
    return word.partition(":")[0].partition(".")[0]


def _words(c: Controller) -> Generator[Step, None, list[str]]:
    """Request the parser state and return its words, including those that the driver does not use."""
    told = " ".join(line for line in (yield from asked(c, "$G")) if line.startswith("[GC:"))
    return told.removeprefix("[GC:").rstrip("]").split()


def demand(c: Controller, identity: Identity) -> None:
    """Raise ScriptError if the controller lacks an axis of the machine file or the E-stop input."""
    missing = [axis.name for axis in c.wired if axis.name not in identity.axes]
    if missing:
        raise ScriptError(
            "the controller has axes {axes}, but not {missing}",
            axes=identity.axes,
            missing=", ".join(missing),
        )
    estop = c.config.inputs.get(ESTOP)
    if estop is not None and not identity.has_pin(estop.terminal.removeprefix("pn.")):
        raise ScriptError(
            "the controller's board does not have the input {terminal} for the E-stop: it reports "
            "[SIGNALS:{signals}]. Use a board or firmware that has this input; if the E-stop only cuts "
            'the power, write io.in.estop = {{ at = "{hardware}" }}',
            "controller-estop",
            terminal=estop.terminal,
            signals=identity.signals,
            hardware=HARDWARE,
        )


# --- Stops that preserve the position.
# 0x18 and 0x19 do not brake. Both stop the step pulses at once, and only 0x18 reports by ALARM:3 that the
# position is lost. After 0x19, the line that is being planned enters the cleared planner and moves. Therefore
# a feed hold or a jog cancel is sent first, and 0x18 after the axes are at rest.


_LATE = 0.4  # Seconds in addition to the ramp until a stop is detected.
_BANNER = 3.0  # Duration of a reset in s.
_NO_RESET = "the controller does not respond after its reset; check that the E-stop is released"
_STALE = 0.5  # Seconds in which reports from before a reset may still arrive.
_MUTE = 0.4  # Seconds without a report in a thread, which then waits for its index and reacts only to a stop.
_INDEX = 7.0  # Longest duration of that wait in s.


def stop(c: Controller, *, waits: bool = False) -> Script:
    """Brake, then reset to clear the queue; the position is lost only if an axis does not come to rest.

    ``waits``: a thread pass is running and may wait for its index at rest. In this case, 0x18 would lose the
    position, but 0x19 acts as a reset. An alarm is not changed.
    """
    if c.state != "Home":  # Only a reset ends the state Home.
        yield from _brake(c)
    if c.state == "Alarm":
        return
    if not (waits and c.clock.now() - c.heard_at > _MUTE):
        yield from reset(c)
        return
    before, reports = c.banners, c.reports
    c.expect_reset()
    c.realtime(grblhal_codes.STOP)
    yield lambda: c.banners > before or c.reports > reports, _INDEX, MISSED
    if c.state != "Alarm" and c.banners == before:
        yield from reset(c)


def reset(c: Controller) -> Script:
    """Perform a soft reset and wait for its banner.

    If reports arrive instead, the controller has ignored the reset and the script fails.
    """
    before, reports, began = c.banners, c.reports, c.clock.now()

    def answers() -> bool:
        return c.reports > reports and c.heard_at > began + _STALE

    c.expect_reset()
    c.realtime(grblhal_codes.RESET)
    yield lambda: c.banners > before or answers(), _BANNER, _NO_RESET
    yield lambda: c.banners > before, 0.0, _NO_RESET


def _brake(c: Controller) -> Generator[Step, None, None]:
    """Brake until the axes rest, the controller is silent, or the time has passed."""
    after, began = c.reports + 1, c.clock.now()  # One earlier report may still arrive.
    by = began + _stopping(c)
    c.realtime(grblhal_codes.JOG_CANCEL, grblhal_codes.HOLD)

    def rests() -> bool:
        return c.reports > after and c.report is not None and not c.report.moves

    yield lambda: rests() or c.clock.now() >= by, _stopping(c) + 1.0, MISSED


def _stopping(c: Controller) -> float:
    """Return the seconds that the slowest axis needs to brake, by the controller's settings if reported."""
    ramps = [axis.vmax / axis.amax for axis in c.wired]
    for axis in c.wired:
        speed, accel = c.speed_of(axis.name), c.figure(120, axis.name)
        if speed and accel:
            ramps.append(speed / accel)
    return _LATE + max(ramps)


# --- Settings: read, corrected according to the machine file, and read back.


# Machine position, buffers, line numbers, speeds, pins, offsets, overrides; the number of an alarm.
_REPORTS = 0x7F | 0x400
_PARSER = 0x200  # Unrequested parser state, which would look like a reply to $G.
_RESTORE = 0x2  # Feed hold option: the spindle restarts automatically.
_LISTED = 6.0  # Seconds for all settings, which are a few hundred lines.
_MASK, _MODE, _LATHE, _AFTER_HOLD = 10, 32, 2, 63


def settings(c: Controller) -> Script:
    """Write settings that differ from the required values, and read them back."""
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
                "${number}={written} was written, but the setting reads back as {number2}",
                number=n,
                written=written(value),
                number2=there.get(n, "nothing"),
            )


def _wanted(c: Controller, there: Mapping[int, str]) -> dict[int, float | str]:
    wanted: dict[int, float | str] = dict(c.config.table.settings)
    always = c.identity is not None and c.identity.lathe and _MODE not in there
    if always and wanted.get(_MODE) == _LATHE:
        del wanted[_MODE]  # Firmware built for lathes only does not have this setting.
    wanted[_MASK] = (int(float(there.get(_MASK, "0"))) | _REPORTS) & ~_PARSER
    if _AFTER_HOLD in there:
        wanted[_AFTER_HOLD] = int(float(there[_AFTER_HOLD])) & ~_RESTORE
    return wanted


def _values(lines: list[str]) -> dict[int, str]:
    pairs = (line[1:].split("=", 1) for line in lines if line.startswith("$") and "=" in line)
    return {int(n): value for n, value in pairs}


def same(there: str | None, wanted: float | str) -> bool:
    """Return whether a setting equals the required value within its reported decimals."""
    if there is None or isinstance(wanted, str):
        return there == wanted
    decimals = len(there.partition(".")[2])
    try:
        return math.isclose(float(there), wanted, rel_tol=1e-6, abs_tol=0.5001 * 10.0**-decimals)
    except ValueError:
        return False


def written(value: float | str) -> str:
    """Return a setting value as text without an exponent, which the controller cannot read."""
    if isinstance(value, str):
        return value
    return f"{value:.6f}".rstrip("0").rstrip(".")


_BOOT = 6.0  # Seconds; some boards restart when their port is opened.
_HOMING = 120.0
_COASTING, _LOOK = 8.0, 0.1  # Seconds for the spindle to stop, and between two checks.
_STANDS = 5.0  # rpm
_TELLS = 0.5  # Seconds for the modes by a real-time byte, which firmware before 2020 ignores.
_LASTING = ("G8", "G18")  # Required modes that a reset would change.
_AT_ZERO = 0.002  # Mm; reports have three decimals.
_ALONE = 2  # Bit of $22: axes can be homed one at a time.


def connect(c: Controller) -> Script:
    """Set up a controller after opening; an alarm remains active until the operator clears it."""
    yield from full_report(c, _BOOT)
    yield from _set_up(c)


def reconnect(c: Controller) -> Script:
    """Set up a controller after a lost connection and record the accessories that were still on."""
    unheard = c.clock.now() - c.heard_at
    yield from full_report(c, _BOOT)
    yield from same_session(c)
    on = c.accessories[1] if c.accessories is not None else ""
    yield from _set_up(c)
    c.found_on = (unheard, on) if on else None


def same_session(c: Controller) -> Script:
    """Detect a restart of the controller during the silence.

    After a reset, the modes differ from those of TurnDesk (G17 by ``gc_init``). A restarted controller counts
    from 0, so any other position proves that it has not restarted.
    """
    by = c.clock.now() + _TELLS
    c.question_modes()
    yield _by_time(c, lambda: c.modes != "", by), ANSWER, ""
    told = c.modes.removeprefix("[GC:").rstrip("]").split()
    places = c.report.position if c.report is not None else None
    if all(mode in told for mode in _LASTING) or any(abs(place) > _AT_ZERO for place in places or ()):
        return
    c.restarted = True
    c.origin.clear()


def _set_up(c: Controller) -> Script:
    if c.report is not None and c.report.state not in {"Idle", "Alarm"}:
        yield from stop(c)
    yield from fresh(c)
    identity = read_identity((yield from asked(c, "$I")))
    demand(c, identity)
    c.identity = identity
    c.stream.use(c.identity.buffer)
    number = _alarm_of(c)
    if number not in grblhal_codes.CRITICAL:
        yield from settings(c)
    yield from full_report(c)
    number = _alarm_of(c)
    if number:
        c.alarm = number
        c.trusted = c.trusted and number not in grblhal_codes.LOST
        if number != grblhal_codes.HOMING_REQUIRED:
            c.fail(grblhal_codes.alarm_text(number), grblhal_codes.alarm_code(number))
        return
    yield from _quiet(c)
    yield from verify(c)


def _quiet(c: Controller) -> Script:
    """Switch off spindle and coolant, which may still be on if the control was killed."""
    for code in grblhal_codes.OFF:
        yield from asked(c, code)
    by = c.clock.now() + _COASTING
    while _turns(c) and c.clock.now() < by:
        yield _past(c, c.clock.now() + _LOOK), 2.0 * _LOOK, ""
        yield from full_report(c)


def _turns(c: Controller) -> bool:
    """Return whether the controller's own spindle turns, as measured by its encoder."""
    measured = c.report.measured if c.report is not None else None
    return c.config.own_spindle and (measured or 0.0) > _STANDS


def _past(c: Controller, t: float) -> Callable[[], bool]:
    return lambda: c.clock.now() >= t


def verify(c: Controller) -> Script:
    """Send and verify the modes; check that X is a radius and that no offsets are active.

    Raises ScriptError if the check fails.
    """
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
            "the controller applies offsets {offset}, but TurnDesk sends blocks in machine coordinates",
            "controller-modes",
            offset=c.offset,
        )
    if c.diameter:
        raise ScriptError("X is in diameter mode (D:1) although G8 is active", "controller-modes")
    if c.report is None or c.report.state not in {"Idle", "Jog"}:
        raise ScriptError(
            "the controller is in state {state}, not Idle", state=c.report.state if c.report else "unknown"
        )
    c.ready = c.fault == ""


def abort(c: Controller) -> Script:
    """Stop, discard the queue and verify the modes; the position is preserved where possible."""
    waits = c.index_wait
    c.void()
    if c.alarm:
        yield from reset(c)  # An alarm stops only the axes; a reset stops spindle and coolant.
        return
    if _alarm_of(c):
        return
    yield from stop(c, waits=waits)
    yield from full_report(c)
    if not (_alarm_of(c) or _door(c)):
        yield from verify(c)


def recover(c: Controller) -> Script:
    """Reset, unlock and verify after the operator has cleared an alarm; the planner is empty afterwards."""
    c.void()
    unheard = c.mute
    yield from full_report(c)
    if unheard:
        yield from same_session(c)
    if c.report is not None and "E" in c.report.pins:
        raise ScriptError(
            "E-stop is pressed at the controller: release it, then press Reset", "controller-estop"
        )
    if c.report is not None and c.report.moves:
        yield from stop(c)
    yield from reset(c)
    yield from full_report(c)
    if _door(c):
        raise ScriptError("{door}: close the door, then press Reset", "door", door=grblhal_codes.DOOR)
    number = _alarm_of(c)
    if number == grblhal_codes.HOMING_REQUIRED:
        return
    yield from fresh(c)
    if number:
        yield from asked(c, "$X")
    yield from settings(c)
    yield from verify(c)


def home(c: Controller, letter: str) -> Script:
    """Home one axis on its switch, or set its home at the present position."""
    axis = next(axis for axis in c.config.axes if axis.name == letter)
    yield from fresh(c)
    if axis.here is not None:
        yield from full_report(c)
        c.origin[letter] = c.position[letter] + c.origin.get(letter, 0.0) - axis.here
    elif not (axis.absolute and not c.homing):  # Otherwise the operator confirms the position.
        yield from _look_for_switch(c, letter)
    yield from full_report(c)
    # With "homing on startup required", the controller stays locked until all axes are homed.
    c.alarm = _alarm_of(c)
    if not c.alarm:
        yield from verify(c)


def _look_for_switch(c: Controller, letter: str) -> Script:
    c.origin.pop(letter, None)
    if not c.homing or c.homing & _ALONE:
        yield from asked(c, f"$H{letter}", _HOMING)
    elif not c.is_homed(letter):
        yield from asked(c, "$H", _HOMING)  # All axes are homed together, so the next one is already homed.


def jog_end(c: Controller) -> Script:
    """Wait for rest after a canceled jog, then verify the modes to account for discarded lines."""
    began = c.reports
    yield (
        lambda: c.reports > began + 1 and c.report is not None and not c.report.moves,
        ANSWER,
        "the jog was canceled, but the axes do not stop",
    )
    yield from verify(c)


def _door(c: Controller) -> bool:
    """Return whether the controller reads no lines because its door is open."""
    return c.report is not None and c.report.state == "Door"


def _alarm_of(c: Controller) -> int:
    """Return the alarm number of the last report, or 0 without an alarm."""
    if c.report is None or c.report.state != "Alarm":
        return 0
    return c.report.sub or c.alarm or grblhal_codes.LOCKED

"""What takes several questions: to connect, to verify the modes, to stop, to clear an alarm, to home.

Each is a generator that the controller's pump carries on; what goes wrong is raised as ScriptError.
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

# --- The pieces that scripts are made of: one line and its answer, a full report, the modes.


ANSWER = 2.0  # s for a line
MISSED = "the controller does not send status reports"
_TRIES = 3


def full_report(c: Controller, within: float = ANSWER) -> Script:
    """A report with everything in it."""
    before = c.fulls
    c.question(full=True)
    yield lambda: c.fulls > before, within, MISSED


def fresh(c: Controller) -> Script:
    """An empty line ends half a line and a standing error; from ``$G`` on answers count again."""
    slow = max((c.wait_of(ask.line) for ask in c.stream.unanswered), default=0.0)  # read before ``$G``
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
    """Ready, or the time is over: what is not told then goes on without."""
    return lambda: ready() or c.clock.now() >= by


def asked(c: Controller, line: str, within: float = ANSWER) -> Generator[Step, None, list[str]]:
    """Send a line and wait for its ``ok``; what was told before it."""
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
    """Send the modes, end what another host has left behind, and read all of it back."""
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
    """``G43.1`` is a kind of G43, ``G51:X`` of G51."""
    return word.partition(":")[0].partition(".")[0]


def _words(c: Controller) -> Generator[Step, None, list[str]]:
    """The parser's state; what it tells that is nobody's business stays in."""
    told = " ".join(line for line in (yield from asked(c, "$G")) if line.startswith("[GC:"))
    return told.removeprefix("[GC:").rstrip("]").split()


def demand(c: Controller, identity: Identity) -> None:
    """Raises ScriptError when an axis of the machine file is missing, or its E-stop."""
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


# --- To rest without losing the position.
# 0x18 and 0x19 do not brake: both end the steps where they are, and only 0x18 tells by ALARM:3 that the
# position is lost by that. Behind 0x19 the line that is being planned goes on into the emptied planner, and
# moves. So a feed hold comes first, or a jog cancel, and 0x18 when all is at rest.


_LATE = 0.4  # s, beyond its ramp, for a stop to be seen
_BANNER = 3.0  # s that a reset takes
_NO_RESET = "the controller does not respond after its reset; check that the E-stop is released"
_STALE = 0.5  # s in which reports from before a reset may still come
_MUTE = 0.4  # s without a report behind a thread: it waits for its index and hears nothing but a stop
_INDEX = 7.0  # s until that wait is over, whatever comes


def stop(c: Controller, *, waits: bool = False) -> Script:
    """Brake, then reset, which voids its queue; the position is kept unless it did not come to rest.

    ``waits``: a thread pass is under way, which may be waiting for its index with nothing moving; there 0x18
    would be a lost position, and 0x19 is a reset. An alarm is left alone.
    """
    if c.state != "Home":  # which nothing but a reset ends
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
    """Soft reset, and its banner, before which no question is answered: a report says that none comes."""
    before, reports, began = c.banners, c.reports, c.clock.now()

    def answers() -> bool:
        return c.reports > reports and c.heard_at > began + _STALE

    c.expect_reset()
    c.realtime(grblhal_codes.RESET)
    yield lambda: c.banners > before or answers(), _BANNER, _NO_RESET
    yield lambda: c.banners > before, 0.0, _NO_RESET


def _brake(c: Controller) -> Generator[Step, None, None]:
    """Until it rests, is mute, or its time is over."""
    after, began = c.reports + 1, c.clock.now()  # one report may still be on its way from before
    by = began + _stopping(c)
    c.realtime(grblhal_codes.JOG_CANCEL, grblhal_codes.HOLD)

    def rests() -> bool:
        return c.reports > after and c.report is not None and not c.report.moves

    yield lambda: rests() or c.clock.now() >= by, _stopping(c) + 1.0, MISSED


def _stopping(c: Controller) -> float:
    """Seconds that the slowest slide takes to brake, by the controller's own figures where it tells them."""
    ramps = [axis.vmax / axis.amax for axis in c.wired]
    for axis in c.wired:
        speed, accel = c.speed_of(axis.name), c.figure(120, axis.name)
        if speed and accel:
            ramps.append(speed / accel)
    return _LATE + max(ramps)


# --- The controller's settings: read, written where they are not as the machine file says, and read back.


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
                "${number}={written} was written, but the setting reads back as {number2}",
                number=n,
                written=written(value),
                number2=there.get(n, "nothing"),
            )


def _wanted(c: Controller, there: Mapping[int, str]) -> dict[int, float | str]:
    wanted: dict[int, float | str] = dict(c.config.table.settings)
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


_BOOT = 6.0  # s; some boards start when their port is opened
_HOMING = 120.0
_COASTING, _LOOK = 8.0, 0.1  # s a spindle is given to stand, between two looks at it
_STANDS = 5.0  # rpm
_TELLS = 0.5  # s for the modes, asked by a byte: firmware from before 2020 does not know it
_LASTING = ("G8", "G18")  # of our modes, those that no reset leaves
_AT_ZERO = 0.002  # mm: reports have three decimals
_ALONE = 2  # of $22: one axis may be homed without the others


def connect(c: Controller) -> Script:
    """From an open wire to verified modes; a controller in alarm stays there for the operator."""
    yield from full_report(c, _BOOT)
    yield from _set_up(c)


def reconnect(c: Controller) -> Script:
    """The same on a wire that was lost: what has become of it meanwhile is looked at first."""
    unheard = c.clock.now() - c.heard_at
    yield from full_report(c, _BOOT)
    yield from same_session(c)
    on = c.accessories[1] if c.accessories is not None else ""
    yield from _set_up(c)
    c.found_on = (unheard, on) if on else None


def same_session(c: Controller) -> Script:
    """Whether it is what it was when it was last heard. A reset or a restart leaves other modes than ours
    (G17, by ``gc_init``); and one that has restarted counts from 0, at any other place it has not.
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
    """Spindle and coolant off: a control that was killed has left them as they were."""
    for code in grblhal_codes.OFF:
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
        "the jog was canceled, but the axes do not stop",
    )
    yield from verify(c)


def _door(c: Controller) -> bool:
    """Whether it reads no lines for its door."""
    return c.report is not None and c.report.state == "Door"


def _alarm_of(c: Controller) -> int:
    """The alarm that the last report tells, 0 without one."""
    if c.report is None or c.report.state != "Alarm":
        return 0
    return c.report.sub or c.alarm or grblhal_codes.LOCKED

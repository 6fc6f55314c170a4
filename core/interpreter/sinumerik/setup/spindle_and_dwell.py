"""Spindle words, live tool and dwells of SINUMERIK.

The spindle words are S, LIMS, G25, G26, G96, G97, M3 to M5, M19, M70, SPOS and SETMS.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import copysign

from core.interpreter.shared.actions import (
    Dwell,
    OutputSwitch,
    SpindleLock,
    SpindlePositioning,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.units import MM_PER_INCH, MM_S_PER_M_MIN
from core.interpreter.sinumerik.motion.linear_moves import AxisTravel, compute_c_travel, make_travel_block
from core.interpreter.sinumerik.motion.third_axis import WRONG_MODULO_POSITION, compute_modulo_travel
from core.interpreter.sinumerik.sinumerik_state import SinumerikState, require_positive_number
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import PositionMode, Word
from core.language.sinumerik.word_table import DWELL_GROUP, FEED_TYPE_GROUP, NON_MODAL_GROUP
from core.message import Message

_MAX_SURFACE_SPEED = 100_000.0  # mm/s; ten times the limit of any tool
_MAX_DWELL_S = 3600.0  # s
_AXIS_MODE = 70  # M70
_TURN = 360.0
_SURFACE = frozenset({96, 961, 962})
_FEET = 12.0 * MM_PER_INCH / 60.0  # mm/s per ft/min


def has_spindle_words(statement: Statement) -> bool:
    """Return whether a block contains spindle words."""
    return bool(statement.m_words or _WORDS & statement.words.keys() or FEED_TYPE_GROUP in statement.g_words)


_WORDS = frozenset({"S", "LIMS", "SPOS", "SPOSA", "SETMS"})


def execute_spindle_words(state: SinumerikState, statement: Statement) -> Iterator[Block]:
    """Yield the spindle actions of a program block, which precede its motion.

    Raises ProgramError for invalid words.
    """
    before = (state.modal.spindle, state.rpm, state.css)
    _modes(state, statement)
    _limit(state, statement)
    if statement.get_g_code(NON_MODAL_GROUP) not in {25, 26}:
        _speed(state, statement)
    if 5 in statement.m_words:
        state.set_modal_state(state.modal._replace(spindle=0, c_locked=False, oriented=None))
        yield state.action(statement.lexed_block.line_number, "M5", SpindleStop())
    elif word := _positions(statement):
        yield from _position_spindle(state, statement, word)
    else:
        yield from _run(state, statement, before)


def _run(
    state: SinumerikState, statement: Statement, before: tuple[int, float, float | None]
) -> Iterator[Block]:
    direction = next((m for m in (3, 4) if m in statement.m_words), 0)
    if direction:
        _check_start(state, statement, statement.m_words[direction])
        state.set_modal_state(
            state.modal._replace(spindle=1 if direction == 3 else -1, c_locked=False, oriented=None)
        )
    if direction or (state.modal.spindle and before != (state.modal.spindle, state.rpm, state.css)):
        yield state.action(
            statement.lexed_block.line_number, _text(statement), SpindleRun(state.rpm, state.css)
        )


def _text(statement: Statement) -> str:
    words = [statement.g_words.get(FEED_TYPE_GROUP), statement.words.get("S"), statement.words.get("LIMS")]
    return " ".join(
        word.text for word in (*words, statement.m_words.get(3), statement.m_words.get(4)) if word is not None
    )


# --- the spindle as an axis: M19, M70, SPOS


def _positions(statement: Statement) -> Word | None:
    found = [statement.m_words[code] for code in (19, 70) if code in statement.m_words]
    found += [statement.words[name] for name in ("SPOS", "SPOSA") if name in statement.words]
    return found[0] if found else None


def _position_spindle(state: SinumerikState, statement: Statement, word: Word) -> Iterator[Block]:
    """Yield the blocks that stop the spindle and orient it, by its drive or as the C axis.

    Raises ProgramError if the spindle cannot be positioned.
    """

    def make_positioning_error(text: str, hint: str) -> ProgramError:
        return statement.make_error(
            word, "spindle-position", Message("{word}: {what}", word=word.text, what=text), hint
        )

    if word.name == "M" and word.value == _AXIS_MODE:
        check_spindle_c_axis(state, make_positioning_error)
        state.set_modal_state(state.modal._replace(spindle=0, c_locked=True))
        yield state.action(statement.lexed_block.line_number, word.text, SpindleLock(orient=False))
        return
    check_spindle_positioning(state, make_positioning_error)
    if is_oriented_by_drive(state):
        action = _orient(state, statement, word)
        state.set_modal_state(state.modal._replace(spindle=0, oriented=action.angle))
        yield state.action(statement.lexed_block.line_number, word.text, action)
        return
    limits = state.setup.limits
    state.set_modal_state(state.modal._replace(spindle=0, c_locked=True))
    yield state.action(statement.lexed_block.line_number, word.text, SpindleLock(orient=False))
    turn = _spindle_turn(state, statement, word)
    if turn:
        x, z, c, modal = state.x, state.z, state.c, state.modal
        travel = AxisTravel(x, z, c, x, z, c + turn, modal, modal.offset_x, modal.offset_z)
        made = make_travel_block(state, statement, travel, BlockKind.ROTATE, limits.max_axis_speeds[2])
        made.per_rev, made.rpm, made.text = False, copysign(limits.max_axis_speeds[2] / 6.0, turn), word.text
        yield made


def is_oriented_by_drive(state: SinumerikState) -> bool:
    """Return whether the spindle drive can orient the spindle, and the spindle is not the C axis."""
    limits = state.setup.limits
    return limits.can_orient_spindle and not (limits.is_c_enabled and limits.is_spindle_c_axis)


def check_spindle_positioning(state: SinumerikState, make_error: Callable[[str, str], ProgramError]) -> None:
    """Raise the error that ``make_error`` returns if the spindle cannot be positioned at an angle.

    ``make_error`` is called with a text and a hint.
    """
    if not is_oriented_by_drive(state):
        check_spindle_c_axis(state, make_error)


def check_spindle_c_axis(state: SinumerikState, make_error: Callable[[str, str], ProgramError]) -> None:
    """Raise the error that ``make_error`` returns if the spindle is not the C axis.

    ``make_error`` is called with a text and a hint.
    """
    limits = state.setup.limits
    if limits.is_c_enabled and limits.is_spindle_c_axis:
        return
    if limits.can_orient_spindle:
        text = (
            "the spindle of this machine is not a C axis because C has a separate drive; the spindle "
            "drive can only turn the spindle to an angle."
            if limits.is_c_enabled
            else "the spindle of this machine is not a C axis because the machine has no C axis; the "
            "spindle drive can only turn the spindle to an angle."
        )
        raise make_error(text, "Select the machine sinumerik-live, whose spindle is the C axis.")
    text = (
        "the spindle of this machine cannot be oriented because C has a separate drive and the machine "
        "file does not enable orientation by the spindle drive."
        if limits.is_c_enabled
        else "the spindle of this machine cannot be oriented because the machine has no C axis and the "
        "machine file does not enable orientation by the spindle drive."
    )
    raise make_error(
        text,
        "Set oriented = true under [spindle] in the machine file if the drive can stop the spindle at an "
        "angle, or write M5 and index the part with C.",
    )


def _orient(state: SinumerikState, statement: Statement, word: Word) -> SpindlePositioning:
    """Return the target angle (0 to less than 360 degrees) and the direction of M19 or SPOS."""
    if word.name == "M":
        return SpindlePositioning(0.0)
    form, at = word.position_mode, state.modal.oriented
    value = state.number(statement, word)
    if form is PositionMode.IC:
        if at is None:
            text = (
                "{word} is relative to a spindle angle, but the spindle has not been positioned at an angle."
            )
            hint = "Write SPOS with an angle before this block."
            raise statement.make_error(word, "spindle-position", text, hint, word=word.text)
        text = "{word}: on this drive, a spindle positioning move must be less than one revolution."
        hint = "Enter an angle of less than 360 degrees."
        statement.require_condition(abs(value) < _TURN, word, "spindle-position", text, hint, word=word.text)
        return SpindlePositioning((at + value) % _TURN, int(copysign(1, value)) if value else 0)
    text = "{word}: {value} is not a valid spindle angle."
    hint = "Enter an angle from 0 to less than 360 degrees."
    statement.require_condition(
        0.0 <= value < _TURN, word, WRONG_MODULO_POSITION, text, hint, word=word.text, value=value
    )
    sense = {PositionMode.ACP: 1, PositionMode.ACN: -1}.get(form, 0)
    if form is PositionMode.AC and at is not None:  # AC never crosses 0
        sense = int(copysign(1, value - at)) if value != at else 0
    return SpindlePositioning(value, sense)


def compute_shortest_c_travel(state: SinumerikState, angle: float) -> float:
    """Return the shortest signed travel of C to a program angle, in degrees."""
    at = state.c - state.modal.offset_c
    if not state.setup.limits.is_c_modulo:
        return angle - at
    return compute_modulo_travel(PositionMode.DC, angle, at)


def _spindle_turn(state: SinumerikState, statement: Statement, word: Word) -> float:
    """Return the signed travel of C for a spindle word, in degrees.

    If the word does not specify a direction or form (such as DC or ACP), a modulo C axis takes the shorter
    distance.
    """
    if word.name == "M":
        word = word._replace(value=0.0, formula=None)
    at = state.c - state.modal.offset_c
    modulo = state.setup.limits.is_c_modulo
    form = (
        word.position_mode
        if word.position_mode is not PositionMode.PLAIN
        else PositionMode.DC
        if modulo
        else PositionMode.AC
    )
    return compute_c_travel(state, statement, word, form, at)


# --- G96, G97 and their kin, LIMS, G25, G26


def _modes(state: SinumerikState, statement: Statement) -> None:
    word, code = statement.g_words.get(FEED_TYPE_GROUP), statement.get_g_code(FEED_TYPE_GROUP)
    if code in _SURFACE:
        _demand_controlled(state, statement, word)
        state.set_modal_state(state.modal._replace(css=True))
    elif code is not None and state.modal.css:
        # G97 retains the present speed. G94 and G95 restore the earlier S.
        rpm = abs(state.rpm) if state.modal.spindle else state.modal.rpm
        rpm = state.modal.rpm or rpm if code in {94, 95} else rpm
        state.set_modal_state(state.modal._replace(css=False, rpm=rpm))
    if code == 973:
        state.set_modal_state(state.modal._replace(max_css_rpm=None))


def _limit(state: SinumerikState, statement: Statement) -> None:
    word = statement.words.get("LIMS")
    if word is not None:
        _demand_controlled(state, statement, word)
        highest = require_positive_number(statement, word, state.number(statement, word), "the speed limit")
        state.set_modal_state(state.modal._replace(max_css_rpm=highest))
    word = statement.words.get("S")
    code = statement.get_g_code(NON_MODAL_GROUP)
    if word is None or code not in {25, 26}:
        return
    _demand_controlled(state, statement, word)
    value = state.number(statement, word)
    if value < 0 or (code == 26 and not value):
        text = "{word} is not a valid speed limit."
        raise statement.make_error(word, "not-positive", text, "Correct the value.", word=word.text)
    lowest, highest = (value, state.highest) if code == 25 else (state.lowest, value)
    highest = min(highest, state.setup.limits.max_rpm)
    if lowest > highest:
        text = "{word}: the minimum speed {lowest} is above the maximum speed {highest}."
        raise statement.make_error(
            word, "speed-limits", text, "Correct G25 or G26.", word=word.text, lowest=lowest, highest=highest
        )
    state.lowest, state.highest = lowest, highest
    state.set_modal_state(state.modal._replace(min_css_rpm=lowest))


def _speed(state: SinumerikState, statement: Statement) -> None:
    """Set S, which is in rpm under G97 and in m/min under G96."""
    word = statement.words.get("S")
    if word is None or statement.get_g_code("dwell") is not None:
        return
    _demand_controlled(state, statement, word)
    value = state.number(statement, word)
    text = "{word}: the speed cannot be negative; M3 and M4 set the direction."
    statement.require_condition(value >= 0, word, "speed-sign", text, "Remove the sign.", word=word.text)
    if state.modal.css:
        speed = value * (MM_S_PER_M_MIN if state.modal.metric else _FEET)
        if speed > _MAX_SURFACE_SPEED:
            text = "a surface speed of {word} m/min is too high for any tool."
            raise statement.make_error(word, "speed-range", text, "Write G97 if S is in rpm.", word=word.text)
        state.set_modal_state(state.modal._replace(surface_speed=speed))
        return
    highest = state.setup.limits.max_rpm
    state.set_modal_state(state.modal._replace(rpm=min(value, highest)))
    text = "{word} is above the spindle maximum of {highest} rpm."
    statement.require_condition(
        value <= highest, word, "speed-range", text, "Lower S.", word=word.text, highest=highest
    )


def _demand_controlled(state: SinumerikState, statement: Statement, word: Word | None) -> None:
    if word is not None and not state.setup.limits.is_spindle_controlled:
        text = "{word} needs a controlled spindle, which this machine does not have."
        hint = "Remove this text from the program."
        raise statement.make_error(word, "no-controlled-spindle", text, hint, word=word.text)


def _check_start(state: SinumerikState, statement: Statement, word: Word) -> None:
    limits = state.setup.limits
    if not limits.is_spindle_controlled:
        state.set_modal_state(state.modal._replace(rpm=limits.max_rpm))  # the spindle has only one speed
    if not (state.modal.surface_speed if state.modal.css else state.modal.rpm):
        text = "{word} starts the spindle, but S is 0 or not programmed."
        raise statement.make_error(word, "speed-missing", text, "Write S in the block.", word=word.text)
    if not state.modal.collet_closed and not limits.can_start_with_collet_open:
        text = "{word} starts the spindle with the collet open."
        raise statement.make_error(word, "collet-open", text, "Close the collet first.", word=word.text)


def make_dwell_block(state: SinumerikState, statement: Statement) -> Block:
    """Return the block of G4 with F in seconds or S in revolutions.

    The active F and S do not change. Raises ProgramError if the dwell is negative or longer than 3600 s.
    For a dwell in revolutions, also raises ProgramError if the spindle is stopped or not controlled.
    """
    word = statement.words.get("F") or statement.words["S"]
    value = state.number(statement, word)
    text = "{word}: a dwell cannot be negative."
    statement.require_condition(value >= 0, word, "dwell-range", text, "Correct the value.", word=word.text)
    seconds = value if word.name == "F" else value / _turning(state, statement, word) * 60.0
    if seconds > _MAX_DWELL_S:
        raise statement.make_error(
            word,
            "dwell-range",
            "{word} is a dwell of {seconds} s; the maximum is {longest_dwell} s.",
            "Enter F in seconds or S in revolutions.",
            word=word.text,
            seconds=f"{seconds:.0f}",
            longest_dwell=_MAX_DWELL_S,
        )
    return state.action(statement.lexed_block.line_number, statement.lexed_block.text, Dwell(seconds))


def _turning(state: SinumerikState, statement: Statement, word: Word) -> float:
    """Return the spindle speed in rpm for a dwell in revolutions.

    Raises ProgramError if the spindle is stopped, or if the machine has no controlled spindle.
    """
    _demand_controlled(state, statement, word)
    rpm = abs(state.rpm)
    text = "G4 {word} waits for spindle revolutions, but the spindle is stopped."
    hint = "Start the spindle with M3 or M4, or write G4 F."
    statement.require_condition(rpm, word, "dwell-spindle-stopped", text, hint, word=word.text)
    return rpm


LIVE_SPINDLE_NUMBER = 2
_TURNS = frozenset({3, 4, 5})


def separate_live_tool_words(state: SinumerikState, statement: Statement) -> None:
    """Move the words of the live tool to ``statement.live_tool_words``.

    Raises ProgramError if the block contains words of spindle 2 and the machine has no live tool.
    """
    for word in statement.live_tool_words:
        _demand(state, statement, word)
    masters = [
        each
        for each in (*statement.live_tool_words, statement.words.get("SETMS"))
        if each and each.name == "SETMS"
    ]
    if masters:
        state.master = LIVE_SPINDLE_NUMBER if masters[0].spindle_number == LIVE_SPINDLE_NUMBER else 1
    if state.master != LIVE_SPINDLE_NUMBER or DWELL_GROUP in statement.g_words:
        return
    if (speed := statement.words.get("S")) and not speed.spindle_number:
        statement.live_tool_words.append(statement.words.pop("S"))
    for code in _TURNS & statement.m_words.keys():
        if not statement.m_words[code].spindle_number:
            statement.live_tool_words.append(statement.m_words.pop(code))


def _demand(state: SinumerikState, statement: Statement, word: Word) -> None:
    text = "{word}: this machine has one spindle and no output for a live tool."
    hint = "Remove this word, or define an output named live under [io.out] in the machine file."
    statement.require_condition(
        state.setup.limits.live_tool_output, word, "one-spindle", text, hint, word=word.text
    )


def switch_live_tool(state: SinumerikState, statement: Statement) -> Iterator[Block]:
    """Yield the blocks that set the speed of the live tool and start or stop it.

    Raises ProgramError for invalid words.
    """
    for word in statement.live_tool_words:
        if word.name == "S":
            _live_speed(state, statement, word)
    for word in statement.live_tool_words:
        if word.name == "M":
            yield from _turn(state, statement, word)


def _live_speed(state: SinumerikState, statement: Statement, word: Word) -> None:
    value = state.number(statement, word)
    text = "{word}: the speed cannot be negative; M3 and M4 set the direction."
    statement.require_condition(value >= 0.0, word, "speed-sign", text, "Remove the sign.", word=word.text)
    state.live_speed_rpm = value
    if state.live_rpm:
        state.live_rpm = value
    if "live-speed" not in state.logged_functions:
        state.logged_functions.add("live-speed")
        text = Message(
            "{word}: this machine only switches the live tool on and off; the speed is set at "
            "the drive of the live tool.",
            word=word.text,
        )
        state.log_finding(
            statement.make_warning(
                word,
                "live-speed",
                text,
                Message("Set the live tool to {value} rpm by hand.", value=f"{value:g}"),
            )
        )


def _turn(state: SinumerikState, statement: Statement, word: Word) -> Iterator[Block]:
    code = int(word.value or 0)
    text = "{word}: the live tool turns in only one direction."
    hint = "Write M3, and use a tool that cuts in that direction."
    statement.require_condition(code != 4, word, "live-direction", text, hint, word=word.text)
    on = code == 3
    if on and not state.live_speed_rpm:
        text = "{word} starts the live tool, but its speed is not programmed with S."
        raise statement.make_error(word, "speed-missing", text, "Write S2= in the block.", word=word.text)
    state.live_rpm = state.live_speed_rpm if on else 0.0
    name = state.setup.limits.live_tool_output
    outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
    state.set_modal_state(state.modal._replace(outputs=outputs))
    yield state.action(statement.lexed_block.line_number, word.text, OutputSwitch(name, on))

"""S, LIMS, G96, G97, M3, M4, M5, and dwells by time or by revolutions."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.actions import Dwell, SpindleRun, SpindleStop
from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.sinumerik_state import State, positive
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.interpreter.units import METRES_PER_MINUTE
from core.language.sinumerik.sinumerik_words import Word

_FASTEST_SURFACE = 100_000.0  # mm/s; ten times what any tool stands
_LONGEST_DWELL = 3600.0  # s


def spindle_words(state: State, statement: Statement) -> Iterator[Block]:
    """The spindle's part of a block, which acts before its motion. Raises ProgramError."""
    before = (state.modal.spindle, state.rpm, state.css)
    _modes(state, statement)
    _limit(state, statement)
    _speed(state, statement)
    if 5 in statement.m:
        state.adopt(state.modal._replace(spindle=0))
        yield state.action(statement.line.number, "M5", SpindleStop())
        return
    direction = next((m for m in (3, 4) if m in statement.m), 0)
    if direction:
        _check_start(state, statement, statement.m[direction])
        state.adopt(state.modal._replace(spindle=1 if direction == 3 else -1))
    if direction or (state.modal.spindle and before != (state.modal.spindle, state.rpm, state.css)):
        yield state.action(statement.line.number, _text(statement), SpindleRun(state.rpm, state.css))


def _text(statement: Statement) -> str:
    words = [statement.g.get("kind of spindle speed"), statement.words.get("S"), statement.words.get("LIMS")]
    return " ".join(
        word.text for word in (*words, statement.m.get(3), statement.m.get(4)) if word is not None
    )


def _modes(state: State, statement: Statement) -> None:
    code = statement.code("kind of spindle speed")
    if code == 96 and not state.modal.css:
        _demand_controlled(state, statement, statement.g["kind of spindle speed"])
        state.adopt(state.modal._replace(css=True))
        if not state.modal.per_rev:
            _warn_of_minutes(state, statement)
    elif code == 97 and state.modal.css:
        # The spindle goes on at the speed it has; going back to an old S would be a surprise.
        rpm = abs(state.rpm) if state.modal.spindle else state.modal.rpm
        state.adopt(state.modal._replace(css=False, rpm=rpm))


def _warn_of_minutes(state: State, statement: Statement) -> None:
    """Some controls read F as mm a revolution from G96 on; this one goes by G94 and G95 alone."""
    text = "G96 is in force and F counts in mm/min (G94)."
    hint = "Write G95 where F is meant as mm a revolution."
    state.log.add(statement.warning(statement.g["kind of spindle speed"], "g96-by-minute", text, hint))


def _limit(state: State, statement: Statement) -> None:
    word = statement.words.get("LIMS")
    if word is not None:
        _demand_controlled(state, statement, word)
        highest = positive(statement, word, state.number(statement, word), "the limit of the speed")
        state.adopt(state.modal._replace(css_max=highest))


def _speed(state: State, statement: Statement) -> None:
    """S: rpm under G97, m/min under G96."""
    word = statement.words.get("S")
    if word is None or statement.code("dwell") is not None:
        return
    _demand_controlled(state, statement, word)
    value = state.number(statement, word)
    if value < 0:
        text = f"{word.text}: the speed has no sign; M3 and M4 say the direction."
        raise statement.refuse(word, "speed-sign", text, "Take the sign out.")
    if state.modal.css:
        if value * METRES_PER_MINUTE > _FASTEST_SURFACE:
            text = f"{word.text} m/min is no surface speed that a tool can stand."
            raise statement.refuse(word, "speed-range", text, "G97 makes S rpm.")
        state.adopt(state.modal._replace(surface_speed=value * METRES_PER_MINUTE))
        return
    highest = state.setup.limits.max_rpm
    state.adopt(state.modal._replace(rpm=min(value, highest)))
    if value > highest:
        raise statement.refuse(
            word, "speed-range", f"{word.text} is over the spindle's {highest:g} rpm.", "Lower S."
        )


def _demand_controlled(state: State, statement: Statement, word: Word) -> None:
    if not state.setup.limits.spindle_controlled:
        text = f"{word.text} needs a controlled spindle, which this machine does not have."
        raise statement.refuse(word, "no-controlled-spindle", text, "Take it out.")


def _check_start(state: State, statement: Statement, word: Word) -> None:
    limits = state.setup.limits
    if not limits.spindle_controlled:
        state.adopt(state.modal._replace(rpm=limits.max_rpm))  # it has one speed
    if not (state.modal.surface_speed if state.modal.css else state.modal.rpm):
        text = f"{word.text} starts the spindle and no S has said how fast."
        raise statement.refuse(word, "speed-missing", text, "Write S in the block.")
    if not state.modal.collet_closed and not limits.start_with_collet_open:
        raise statement.refuse(
            word, "collet-open", f"{word.text} starts the spindle with the collet open.", "Close it."
        )


def dwell(state: State, statement: Statement) -> Block:
    """G4 F in seconds, G4 S in revolutions of the spindle; the F and S in force stay. Raises ProgramError."""
    word = statement.words.get("F") or statement.words["S"]
    value = state.number(statement, word)
    if value < 0:
        raise statement.refuse(word, "dwell-range", f"{word.text}: a dwell is 0 or longer.", "Correct it.")
    seconds = value if word.name == "F" else value / _turning(state, statement, word) * 60.0
    if seconds > _LONGEST_DWELL:
        text = f"{word.text} is a dwell of {seconds:.0f} s; {_LONGEST_DWELL:g} are the most."
        raise statement.refuse(word, "dwell-range", text, "F counts in seconds, S in revolutions.")
    return state.action(statement.line.number, statement.line.text, Dwell(seconds))


def _turning(state: State, statement: Statement, word: Word) -> float:
    """The speed by which revolutions become seconds, rpm."""
    _demand_controlled(state, statement, word)
    rpm = abs(state.rpm)
    if not rpm:
        text = f"G4 {word.text} waits for revolutions of a spindle that stands."
        raise statement.refuse(word, "dwell-spindle-stopped", text, "Start it with M3 or M4, or write G4 F.")
    return rpm

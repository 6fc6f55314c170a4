"""Spindle words: M03 M04 M05, S, and constant surface speed."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.actions import SpindleRun, SpindleStop
from core.interpreter.elementary_blocks import Block
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.units import FEET_PER_MINUTE, METRES_PER_MINUTE

_FASTEST_SURFACE = 100_000.0  # mm/s; ten times what any tool stands


def spindle_modes(state: State, made: Statement) -> None:
    """G96, G97, G76 and G77 of a line; S next to G76 or G77 is theirs."""
    if not made.modal:
        return
    modal = state.modal
    if 96 in made.modal and not modal.css:
        state.adopt(state.modal._replace(css=True))
    elif 97 in made.modal and modal.css:
        # The drive goes on at the speed it has; jumping back to an old S would be a surprise.
        rpm = abs(state.rpm_at(state.x)) if modal.spindle else modal.rpm
        state.adopt(state.modal._replace(css=False, rpm=rpm))
    if 76 in made.modal:
        state.adopt(state.modal._replace(css_min=_limit(made, 76)))
    if 77 in made.modal:
        state.adopt(state.modal._replace(css_max=_limit(made, 77)))
    modal = state.modal
    if modal.css_max is not None and modal.css_min > modal.css_max:
        message = f"G76 ({modal.css_min:g} rpm) is over G77 ({modal.css_max:g} rpm)."
        state.adopt(state.modal._replace(css_min=modal.css_max))
        raise made.refuse("S", "speed-limits", message, "Correct one of them.")


def _limit(made: Statement, code: int) -> float:
    speed = made.value("S")
    if speed is None or speed < 0:
        message = f"G{code} needs S, a speed in rpm."
        raise made.refuse("S", "word-missing", message, f"Write G{code}Sn.")
    return speed


def speed_word(state: State, made: Statement) -> None:
    """S of a line: rpm under G97, surface speed under G96."""
    word = made.words.get("S")
    if word is None or word.value is None or made.s_is_limit:
        return
    modal = state.modal
    if word.value < 0:
        message = f"{word.text}: the speed has no sign; M03 and M04 say the direction."
        raise made.refuse(word, "speed-sign", message, "Take the sign out.")
    if modal.css:
        unit = METRES_PER_MINUTE if modal.metric else FEET_PER_MINUTE
        if word.value * unit > _FASTEST_SURFACE:
            message = f"{word.text} is no surface speed that a tool can stand."
            raise made.refuse(word, "speed-range", message, "G97 makes S rpm.")
        state.adopt(state.modal._replace(surface_speed=word.value * unit))
        return
    highest = state.setup.limits.max_rpm
    if word.value > highest:
        state.adopt(
            state.modal._replace(rpm=highest)
        )  # so that what follows is judged by the spindle that there is
        message = f"{word.text} is over the spindle's {highest:g} rpm."
        raise made.refuse(word, "speed-range", message, "Lower S.")
    state.adopt(state.modal._replace(rpm=word.value))


def run_block(state: State, made: Statement) -> Iterator[Block]:
    """The spindle block of a line with M03, M04 or S; none where the spindle stands and shall stand."""
    direction = {3: 1, 4: -1}.get(made.m or 0, 0)
    if direction:
        _check_start(state, made)
        state.reported.discard("spindle-stopped")
        state.adopt(state.modal._replace(spindle=direction))
    elif "S" not in made.words or made.m == 5 or not state.modal.spindle or made.s_is_limit:
        return
    state.reported.discard("spindle-stopped")
    rpm = state.rpm_at(state.x)
    surface = state.modal.css_speed
    yield state.action(made.line, made.part("spindle"), SpindleRun(rpm, surface))


def _check_start(state: State, made: Statement) -> None:
    modal = state.modal
    if modal.c_locked:
        message = f"M{made.m:02d} starts the spindle, which is locked as the axis C."
        raise made.refuse("M", "spindle-locked", message, "Release it with M05 first.")
    if not (modal.surface_speed if modal.css else modal.rpm):
        message = f"M{made.m:02d} starts the spindle and no S has said how fast."
        raise made.refuse("M", "speed-missing", message, "Write S on the line.")
    if not modal.collet_closed and not state.setup.limits.start_with_collet_open:
        message = f"M{made.m:02d} starts the spindle with the collet open."
        raise made.refuse("M", "collet-open", message, "Close it with M12 first.")


def stop_block(state: State, made: Statement) -> Iterator[Block]:
    """The block of M05: the spindle stops, and C is released."""
    state.adopt(state.modal._replace(spindle=0, c_locked=False, c_rpm=None))
    yield state.action(made.line, made.part("m"), SpindleStop())

"""Spindle words: M03 M04 M05, S, and constant surface speed."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.omniturn.codes.code_rules import check_when, checked, number
from core.interpreter.omniturn.codes.code_table import G_CODES, LETTERS, M_CODES
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import SpindleRun, SpindleStop
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.units import FEET_PER_MINUTE, METRES_PER_MINUTE
from core.message import Message


def spindle_modes(state: State, statement: Statement) -> None:
    """G96, G97, G76 and G77 of a line; S next to G76 or G77 is theirs."""
    if not statement.modal:
        return
    modal = state.modal
    if 96 in statement.modal and not modal.css:
        state.adopt(state.modal._replace(css=True))
    elif 97 in statement.modal and modal.css:
        # The drive goes on at the speed it has; jumping back to an old S would be a surprise.
        rpm = abs(state.rpm_at(state.x)) if modal.spindle else modal.rpm
        state.adopt(state.modal._replace(css=False, rpm=rpm))
    if 76 in statement.modal:
        state.adopt(state.modal._replace(css_min=_limit(state, statement, 76)))
    if 77 in statement.modal:
        state.adopt(state.modal._replace(css_max=_limit(state, statement, 77)))
    modal = state.modal
    if modal.css_max is not None and modal.css_min > modal.css_max:
        message = Message(
            "G76 ({css_min} rpm) is higher than G77 ({css_max} rpm).",
            css_min=f"{modal.css_min:g}",
            css_max=f"{modal.css_max:g}",
        )
        state.adopt(state.modal._replace(css_min=modal.css_max))
        raise statement.refuse("S", "speed-limits", message, "Correct G76 or G77.")


def _limit(state: State, statement: Statement, code: int) -> float:
    return number(state, statement, "S", G_CODES[code]) or 0.0


def speed_word(state: State, statement: Statement) -> None:
    """S of a line: rpm under G97, surface speed under G96."""
    word = statement.words.get("S")
    if word is None or word.value is None or statement.s_is_limit:
        return
    modal, speed = state.modal, word.value
    if modal.css:
        unit = METRES_PER_MINUTE if modal.metric else FEET_PER_MINUTE
        checked(state, statement, "S", speed * unit, G_CODES[96])
        state.adopt(modal._replace(surface_speed=speed * unit))
        return
    if speed >= 0:  # after an error too, so that what follows is judged by the spindle that there is
        state.adopt(modal._replace(rpm=min(speed, state.setup.limits.max_rpm)))
    number(state, statement, "S", LETTERS["S"])


def run_block(state: State, statement: Statement) -> Iterator[Block]:
    """The spindle block of a line with M03, M04 or S; none where the spindle stands and shall stand."""
    direction = {3: 1, 4: -1}.get(statement.m or 0, 0)
    if direction:
        check_when(state, statement, M_CODES[statement.m or 0])
        state.reported.discard("spindle-stopped")
        state.adopt(state.modal._replace(spindle=direction))
    elif "S" not in statement.words or statement.m == 5 or not state.modal.spindle or statement.s_is_limit:
        return
    state.reported.discard("spindle-stopped")
    rpm = state.rpm_at(state.x)
    surface = state.modal.css_speed
    yield state.action(statement.line, statement.part("spindle"), SpindleRun(rpm, surface))


def stop_block(state: State, statement: Statement) -> Iterator[Block]:
    """The block of M05: the spindle stops, and C is released."""
    state.adopt(state.modal._replace(spindle=0, c_locked=False, c_rpm=None))
    yield state.action(statement.line, statement.part("m"), SpindleStop())

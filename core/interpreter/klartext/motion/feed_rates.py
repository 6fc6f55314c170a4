"""Feeds that count a revolution or a tooth (FU, FZ, M136), and the factor for plunging (M103).

They become feeds a minute with the speed that is programmed when their block comes: FU · S, FZ · teeth · S.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from core.interpreter.klartext.klartext_state import SAME_POINT, State
from core.language.diagnostics import Severity
from core.language.klartext.klartext_faults import INPUT_VALUE, WRONG_RPM, unsupported
from core.language.klartext.klartext_nodes import MCode

REVOLUTION, TOOTH = "U", "Z"
MOST_FEED = 99_999.999
_LITTLE = 0.001  # degrees by which a way is tried
_ON_THE_AXIS = 1e-6  # mm a degree
_TENTHS = 10.0  # an F of an INCH program counts tenths of an inch


def switch(state: State, codes: Sequence[MCode]) -> None:
    """M136 and M137: F counts a revolution, or a minute again. M103 F..: factor for plunging, percent.

    With M136 and M137 no feed is in force any more: the number of the one before meant something else.
    Raises ProgramError.
    """
    for code in codes:
        if code.number in {136, 137}:
            _count_revolutions(state, code)
        elif code.number == 103:
            state.plunging = None if code.feed is None else _factor(state, code)


def _count_revolutions(state: State, code: MCode) -> None:
    if code.number == 136 and state.scale != 1.0:
        raise unsupported(state.line, code.column, "M136 in an INCH program")
    if state.per_revolution != (code.number == 136):
        state.feed = state.tool_feed = None
    state.per_revolution = code.number == 136


def _factor(state: State, code: MCode) -> float:
    value = code.feed.value if code.feed is not None else None
    assert value is not None  # read so
    if value.q is not None:
        raise unsupported(state.line, value.column, "M103 with a Q parameter")
    if not 0.0 < value.number <= 100.0:
        text = "M103 F{number} must be above 0 and at most 100 percent."
        hint = "Write M103 F20 for a fifth of the feed."
        raise state.refuse(value.column, INPUT_VALUE, text, hint, number=value.number)
    return value.number / 100.0


def per_minute(state: State, feed: float, per: str, column: int) -> float:
    """A feed as F counts it: mm a minute, tenths of an inch a minute.

    Raises ProgramError where the spindle stands, the teeth are not known or it comes out too high.
    """
    if not per:
        return feed
    word = "F under M136" if state.per_revolution and per == REVOLUTION else f"F{per}"
    rpm = state.modal.rpm if state.modal.spindle else 0.0
    if rpm <= 0.0:
        text = "{word} depends on the spindle speed, but the spindle is stopped."
        hint = "Start the spindle with M3 or M4 before this block."
        raise state.refuse(column, WRONG_RPM, text, hint, word=word)
    made = feed * rpm * (_teeth(state, column) if per == TOOTH else 1)
    made *= 1.0 if state.scale == 1.0 else _TENTHS
    if made > MOST_FEED:
        text = "{word} {feed} at S{rpm} gives a feed rate of {count}, which is above the maximum."
        hint = "Correct the feed rate."
        raise state.refuse(column, INPUT_VALUE, text, hint, word=word, feed=feed, rpm=rpm, count=made)
    text = "{word} uses the programmed S, so the spindle override does not change the feed rate."
    state.tell_once(column, Severity.NOTE, "feed-by-programmed-speed", text, word=word)
    return made


def _teeth(state: State, column: int) -> int:
    tool = state.modal.tool
    row = state.setup.mill_tools.get(tool)
    if row is None or row.teeth < 1:
        text = "FZ is feed per tooth, but the number of teeth (CUT) of tool {tool} is not in the tool table."
        hint = "Enter the number of teeth (CUT) in the tool table, or program F."
        raise state.refuse(column, INPUT_VALUE, text, hint, tool=tool)
    return row.teeth


def plunged(state: State, feed: float | None, length: float, down: float) -> float | None:
    """M103: the feed at which Z, on a way of ``length`` that goes down by ``down``, keeps its share of F."""
    if state.plunging is None or feed is None or down <= SAME_POINT:
        return feed
    return feed * min(1.0, state.plunging * length / down)


def rotary_feed(state: State, feed: float, goals: Mapping[str, float]) -> float:
    """Degrees/s at which rotary axes alone go to ``goals`` with F.

    F counts degrees a minute; under M116 mm a minute of the tip on the workpiece, by its distance from the
    axes where the block begins. On their line it has none, and degrees count.
    """
    way = {name: goal - state.rotary[name] for name, goal in goals.items()}
    whole = math.hypot(*way.values())
    if not state.rotary_by_way or whole <= SAME_POINT:
        return feed / 60.0
    begin = {name: state.rotary[name] + way.get(name, 0.0) * _LITTLE / whole for name in state.rotary}
    there, here = (
        state.kinematics.place(angles, tool_length=state.tool_length).point(state.slides)
        for angles in (begin, state.rotary)
    )
    per_degree = math.dist(there, here) / _LITTLE
    return state.path_feed(feed) / per_degree if per_degree > _ON_THE_AXIS else feed / 60.0

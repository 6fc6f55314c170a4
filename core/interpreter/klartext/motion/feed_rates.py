"""Feeds per revolution or per tooth (FU, FZ, M136), and the plunging factor (M103).

They are converted to feeds per minute with the spindle speed that is programmed at their block.
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
_LITTLE = 0.001  # degrees; test distance of a rotary move
_ON_THE_AXIS = 1e-6  # mm per degree
_TENTHS = 10.0  # F of an INCH program is in tenths of an inch


def switch(state: State, codes: Sequence[MCode]) -> None:
    """Execute M136 and M137 (feed per revolution or per minute), and M103 (plunging factor in percent).

    M136 and M137 cancel the active feed, because its number has another unit. Raises ProgramError.
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
    assert value is not None  # guaranteed by the reader
    if value.q is not None:
        raise unsupported(state.line, value.column, "M103 with a Q parameter")
    if not 0.0 < value.number <= 100.0:
        text = "M103 F{number} must be above 0 and at most 100 percent."
        hint = "Write M103 F20 for a fifth of the feed."
        raise state.refuse(value.column, INPUT_VALUE, text, hint, number=value.number)
    return value.number / 100.0


def per_minute(state: State, feed: float, per: str, column: int) -> float:
    """Return a feed per minute in mm, or in tenths of an inch in an INCH program.

    Raises ProgramError if the spindle is stopped, the number of teeth is unknown, or the feed is too high.
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
    """Return the feed of a move of ``length`` that descends by ``down``, reduced by the factor of M103."""
    if state.plunging is None or feed is None or down <= SAME_POINT:
        return feed
    return feed * min(1.0, state.plunging * length / down)


def rotary_feed(state: State, feed: float, goals: Mapping[str, float]) -> float:
    """Return the feed of a move of only rotary axes to ``goals``, in degrees/s.

    F is in degrees/min. Under M116, F is in mm/min of the tip on the workpiece, calculated from its distance
    to the axes at the start; on the axis line, degrees apply.
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

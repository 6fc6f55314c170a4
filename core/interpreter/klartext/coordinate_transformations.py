"""Datum shift, mirroring, rotation and scaling (TRANS, cycles 7, 8, 10 and 11).

The datum is shifted by what is programmed, whatever else is in force: mirroring, rotation and scaling happen
about it.
"""

from __future__ import annotations

from dataclasses import replace

from core.geometry.rotation_frames import Vector
from core.interpreter.klartext import word_values
from core.interpreter.klartext.klartext_state import ORIGIN, SLIDES, State
from core.language.klartext.klartext_faults import INPUT_VALUE, WRONG_AXIS
from core.language.klartext.klartext_nodes import Datum, Transform

MOST_FACTOR = 99.999999


def datum(state: State, node: Datum) -> None:
    """TRANS DATUM and cycle 7: in the workpiece's system, within the plane while one is in force."""
    if node.reset:
        state.datum = state.shift = ORIGIN
    elif node.axes:
        now = dict(zip(SLIDES, state.shift if state.plane is not None else state.datum, strict=True))
        for word in node.axes:
            value = word_values.coordinate(state, word)
            if word.axis not in now:
                _demand_no_turn(state, word.axis, value, word.column)
                continue
            now[word.axis] = now[word.axis] + value if word.incremental else value
        made: Vector = (now["X"], now["Y"], now["Z"])
        if state.plane is not None:
            state.shift = made
        else:
            state.datum = made
    state.derive()


def _demand_no_turn(state: State, axis: str, value: float, column: int) -> None:
    if value:
        text = f"A datum shift of the rotary axis {axis} is not built."
        raise state.refuse(column, WRONG_AXIS, text, "Turn the axis with L, or tell the plane.")


def transform(state: State, node: Transform) -> None:
    """TRANS MIRROR, ROTATION and SCALE, cycles 8, 10 and 11. Raises ProgramError."""
    figure = state.figure
    if node.form == "MIRROR":
        state.figure = replace(figure, mirrored=node.axes)
        return
    if node.value is None:
        state.figure = (
            replace(figure, rotation=0.0) if node.form == "ROTATION" else replace(figure, factor=1.0)
        )
        return
    if node.form == "ROTATION":
        value = word_values.number(state, node.value, "ROT", 360.0)
        state.figure = replace(figure, rotation=figure.rotation + value if node.incremental else value)
        return
    factor = word_values.number(state, node.value, "SCL", MOST_FACTOR, 0.0)
    if factor <= 0.0:
        text = "A factor of 0 leaves nothing."
        raise state.refuse(node.column, INPUT_VALUE, text, "Write SCL with a factor such as 0.99.")
    state.figure = replace(figure, factor=factor)

"""Datum shift, mirroring, rotation and scaling (TRANS, cycles 7, 8, 10 and 11).

The datum shift is as programmed, independent of the other transformations, which act about the datum.
"""

from __future__ import annotations

from dataclasses import replace

from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import ORIGIN, ROTARY, SLIDES, State
from core.language.klartext.klartext_faults import INPUT_VALUE, NO_TABLE, WRONG_AXIS
from core.language.klartext.klartext_nodes import AxisWord, Datum, Transform, Value

MOST_FACTOR = 99.999999
MOST_ROW = 999_999.0


def datum(state: State, node: Datum) -> None:
    """Execute TRANS DATUM or cycle 7, in the workpiece system or within the active plane."""
    if node.row is not None:
        node = Datum(_of_the_table(state, node.row, node.column))
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


def _of_the_table(state: State, row: Value, column: int) -> tuple[AxisWord, ...]:
    """Return the axis words of a row of the datum table. Raises ProgramError without the table or row."""
    if state.datum_table is None:
        text = "No datum table is selected."
        raise state.refuse(column, NO_TABLE, text, "Select the file with SEL TABLE before this block.")
    number = int(word_values.number(state, row, "#", MOST_ROW, 0.0))
    found = state.datum_table.get(number)
    if found is None:
        text = "The datum table has no row {number}."
        raise state.refuse(column, NO_TABLE, text, "Correct the row number, or add the row.", number=number)
    told = ((axis, found[axis]) for axis in (*SLIDES, *ROTARY) if axis in found)
    return tuple(
        AxisWord(axis, Value(value / (state.scale if axis in SLIDES else 1.0)), column=column)
        for axis, value in told
    )


def _demand_no_turn(state: State, axis: str, value: float, column: int) -> None:
    text = "A datum shift of rotary axis {axis} is not supported."
    hint = "Position the rotary axis with an L block, or program the plane with PLANE."
    state.check(not value, column, WRONG_AXIS, text, hint, axis=axis)


def transform(state: State, node: Transform) -> None:
    """Execute TRANS MIRROR, ROTATION or SCALE, or cycles 8, 10 and 11. Raises ProgramError."""
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
    text = "A scaling factor of 0 is not allowed."
    state.check(factor > 0.0, node.column, INPUT_VALUE, text, "Program SCL with a factor such as 0.99.")
    state.figure = replace(figure, factor=factor)

"""Datum shift, mirroring, rotation and scaling (TRANS, or cycles 7, 8, 10 and 11).

Mirroring, rotation and scaling have the datum as their center. They do not change a programmed datum shift.
"""

from __future__ import annotations

from dataclasses import replace

from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import LINEAR_AXES, ORIGIN_POINT, ROTARY_AXES, State
from core.language.klartext.klartext_faults import DATUM_TABLE_MISSING, INPUT_VALUE_INCORRECT, WRONG_AXIS
from core.language.klartext.klartext_nodes import CoordinateTransform, DatumShift
from core.language.klartext.klartext_words import AxisWord, Value

MAX_SCALE_FACTOR = 99.999999
MAX_TABLE_ROW = 999_999.0


def execute_datum_shift(state: State, node: DatumShift) -> None:
    """Shift the datum as programmed by TRANS DATUM or cycle 7.

    The shift is in the workpiece system, or in the active plane if a plane is active.
    """
    if node.table_row is not None:
        node = DatumShift(_read_table_row(state, node.table_row, node.column))
    if node.is_reset:
        state.datum = state.shift = ORIGIN_POINT
    elif node.axis_words:
        now = dict(
            zip(LINEAR_AXES, state.shift if state.active_plane is not None else state.datum, strict=True)
        )
        for word in node.axis_words:
            value = word_values.evaluate_coordinate(state, word)
            if word.axis not in now:
                _demand_no_turn(state, word.axis, value, word.column)
                continue
            now[word.axis] = now[word.axis] + value if word.is_incremental else value
        made: Vector = (now["X"], now["Y"], now["Z"])
        if state.active_plane is not None:
            state.shift = made
        else:
            state.datum = made
    state.update_derived_values()


def _read_table_row(state: State, row: Value, column: int) -> tuple[AxisWord, ...]:
    """Return the axis words of a row of the datum table.

    Raises ProgramError if the table or row is missing.
    """
    if state.datum_table_rows is None:
        text = "No datum table is selected."
        raise state.make_error(
            column, DATUM_TABLE_MISSING, text, "Select the file with SEL TABLE before this block."
        )
    number = word_values.whole_number(state, row, "#", MAX_TABLE_ROW)
    found = state.datum_table_rows.get(number)
    if found is None:
        text = "The datum table has no row {number}."
        raise state.make_error(
            column, DATUM_TABLE_MISSING, text, "Correct the row number, or add the row.", number=number
        )
    axis_values = ((axis, found[axis]) for axis in (*LINEAR_AXES, *ROTARY_AXES) if axis in found)
    return tuple(
        AxisWord(axis, Value(value / (state.mm_per_unit if axis in LINEAR_AXES else 1.0)), column=column)
        for axis, value in axis_values
    )


def _demand_no_turn(state: State, axis: str, value: float, column: int) -> None:
    text = "A datum shift of rotary axis {axis} is not supported."
    hint = "Position the rotary axis with an L block, or program the plane with PLANE."
    state.check_condition(not value, column, WRONG_AXIS, text, hint, axis=axis)


def execute_transformation(state: State, node: CoordinateTransform) -> None:
    """Execute TRANS MIRROR, ROTATION or SCALE, or cycle 8, 10 or 11.

    Raises ProgramError for invalid values.
    """
    figure = state.transformation
    if node.transformation_kind == "MIRROR":
        state.transformation = replace(figure, mirrored_axes=node.mirrored_axes)
        return
    if node.value is None:
        state.transformation = (
            replace(figure, rotation_deg=0.0)
            if node.transformation_kind == "ROTATION"
            else replace(figure, scale_factor=1.0)
        )
        return
    if node.transformation_kind == "ROTATION":
        value = word_values.number(state, node.value, "ROT", 360.0)
        state.transformation = replace(
            figure, rotation_deg=figure.rotation_deg + value if node.is_incremental else value
        )
        return
    factor = word_values.number(state, node.value, "SCL", MAX_SCALE_FACTOR, 0.0)
    text = "A scaling factor of 0 is not allowed."
    state.check_condition(
        factor > 0.0, node.column, INPUT_VALUE_INCORRECT, text, "Program SCL with a factor such as 0.99."
    )
    state.transformation = replace(figure, scale_factor=factor)

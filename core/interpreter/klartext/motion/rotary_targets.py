"""Calculation of the target angles of rotary axes in a path function."""

from __future__ import annotations

from collections.abc import Mapping

from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import State
from core.language.klartext.klartext_nodes import PathFunction
from core.language.klartext.klartext_words import AxisWord


def find_rotary_targets(state: State, node: PathFunction, zero: Mapping[str, float]) -> dict[str, float]:
    """Return the target angles of the rotary axes; modulo axes move the shorter distance.

    The axis words are relative to ``zero``. With M127, the travel is the difference of the displayed
    angles. An incremental word specifies the travel directly.
    """
    found = {}
    for axis in state.kinematics.rotary_axes:
        word: AxisWord | None = node.find_word(axis.name)
        if word is not None:
            value, now = word_values.evaluate_coordinate(state, word), state.position_by_axis[axis.name]
            state.is_table_positioned = state.is_table_positioned or not word.is_incremental
            begin = now - zero[axis.name]
            travel_deg = (
                axis.find_travel(begin, value)
                if state.uses_shorter_rotation
                else value - axis.get_displayed_angle(begin)
            )
            found[axis.name] = now + (value if word.is_incremental else travel_deg)
    return found

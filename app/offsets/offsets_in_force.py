"""From the rows of the store to what the interpreter counts with: tools, secondary offsets, the preset."""

from __future__ import annotations

from collections.abc import Mapping

from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.sinumerik.sinumerik_words import MOST_R
from core.store.store_rows import PresetRow, SecondaryRow, ToolRow

PRESET = "preset"  # the setting that keeps which one is in force


R_PARAMETERS = "r-parameters"  # the setting that keeps those that have a value, by their number as text


def r_parameters(kept: object) -> dict[int, float]:
    """R parameters as the setting keeps them; what is none is left out."""
    pairs = kept.items() if isinstance(kept, dict) else ()
    return {
        int(number): float(value)
        for number, value in pairs
        if str(number).isdecimal() and int(number) <= MOST_R and isinstance(value, int | float)
    }


def preset_of(kept: object, presets: Mapping[int, PresetRow]) -> int:
    """The number of the preset in force; one that is not in the table is none."""
    return kept if isinstance(kept, int) and kept in presets else 0


def tool_offsets(rows: Mapping[int, ToolRow]) -> dict[int, ToolOffset]:
    """Of the tools: geometry and wear together."""
    return {n: ToolOffset(*row.offset, row.nose_radius, row.quadrant, row.remark) for n, row in rows.items()}


def secondary_offsets(rows: Mapping[int, SecondaryRow]) -> dict[int, SecondaryOffset]:
    """X, Z and nose radius of the secondary offsets."""
    return {n: SecondaryOffset(*row) for n, row in rows.items()}

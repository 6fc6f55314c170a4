"""From the rows of the store to what the interpreter counts with, on lathes and mills."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from core.interpreter.shared.job_setup import MillTool, SecondaryOffset, Setup, ToolOffset
from core.store.store_rows import MillRow, PresetRow, SecondaryRow, ToolRow

if TYPE_CHECKING:
    from core.geometry.rotary_axes import DatumPreset


PRESET = "preset"  # the setting that keeps which one is in force


R_PARAMETERS = "r-parameters"  # the setting that keeps those that have a value, by their number as text


def r_parameters(kept: object) -> dict[int, float]:
    """R parameters as the setting keeps them; what is none is left out."""
    from core.language.sinumerik.sinumerik_words import MOST_R

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


@dataclass(frozen=True, slots=True)
class MillOffsets:
    """The tables by number, and which preset is in force; 0: that of the machine file."""

    tools: Mapping[int, MillRow] = field(default_factory=dict)
    presets: Mapping[int, PresetRow] = field(default_factory=dict)
    preset: int = 0


def with_mill(setup: Setup, offsets: MillOffsets) -> Setup:
    """The circumstances with the tables of a mill; those of a lathe are left alone.

    Only what the tool table shows counts: rows of a lathe's offsets, which a store may have too, do not.
    ``setup.kinematics`` must be as the machine file has it.
    """
    machine = setup.kinematics
    if machine is None:
        return setup
    from core.geometry.rotary_axes import DatumPreset

    presets = {0: DatumPreset(machine.origin, machine.basic_rotation)}
    presets |= {number: datum_of(row) for number, row in offsets.presets.items()}
    active = offsets.preset if offsets.preset in presets else 0
    return replace(
        setup,
        tools={number: _offset(row) for number, row in offsets.tools.items()},
        tool_names={row.name.upper(): number for number, row in offsets.tools.items() if row.name},
        mill_tools={number: _row(row) for number, row in offsets.tools.items()},
        presets=presets,
        preset=active,
        kinematics=machine.with_preset(presets[active]),
    )


def rows_of(tools: Mapping[int, ToolRow]) -> dict[int, MillRow]:
    """Tools of an offsets file as rows of a mill's table: Z is the length, the remark the name."""
    return {number: MillRow(row.remark, row.z + row.wear_z, row.nose_radius) for number, row in tools.items()}


def datum_of(row: PresetRow) -> DatumPreset:
    """A row of the preset table as it is reckoned with."""
    from core.geometry.rotary_axes import DatumPreset

    return DatumPreset((row.x, row.y, row.z), row.rotation, tuple(zeros_of(row).items()))


def zeros_of(row: PresetRow) -> dict[str, float]:
    """Where the rotary axes read 0, by name, degrees in the machine."""
    return {"A": row.a, "B": row.b, "C": row.c}


def _offset(row: MillRow) -> ToolOffset:
    """Length and radius with what they are off by."""
    return ToolOffset(z=row.length + row.dl, nose_radius=max(row.radius + row.dr, 0.0), name=row.name)


def _row(row: MillRow) -> MillTool:
    return MillTool(
        row.length, row.radius, row.corner, row.dl, row.dr, row.dr2, row.teeth, row.point, row.life
    )

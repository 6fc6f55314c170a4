"""Conversion of stored offset rows to the offsets of the interpreter, for lathes and mills."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from core.interpreter.shared.job_setup import InterpreterSetup, MillTool, SecondaryOffset, ToolOffset
from core.store.store_rows import MillToolRow, PresetRow, SecondaryOffsetRow, ToolOffsetRow

if TYPE_CHECKING:
    from core.geometry.rotary_axes import DatumPreset


PRESET_SETTING = "preset"  # Setting with the number of the preset in force.


R_PARAMETERS_SETTING = (
    "r-parameters"  # Setting with the R parameters that have a value, by their number as text.
)


def parse_r_parameters(stored: object) -> dict[int, float]:
    """Return the R parameters from the value of a stored setting. Invalid entries are ignored."""
    if not stored or not isinstance(stored, dict):
        return {}
    from core.language.sinumerik.block_reader import MAX_R_NUMBER

    return {
        int(number): float(value)
        for number, value in stored.items()
        if str(number).isdecimal() and int(number) <= MAX_R_NUMBER and isinstance(value, int | float)
    }


def find_active_preset(stored: object, presets: Mapping[int, PresetRow]) -> int:
    """Return the number of the active preset, or 0 if the stored number is not in the preset table."""
    return stored if isinstance(stored, int) and stored in presets else 0


def make_tool_offsets(rows: Mapping[int, ToolOffsetRow]) -> dict[int, ToolOffset]:
    """Return the tool offsets by number, each as the sum of geometry and wear."""
    return {n: ToolOffset(*row.offset, row.nose_radius, row.quadrant, row.remark) for n, row in rows.items()}


def make_secondary_offsets(rows: Mapping[int, SecondaryOffsetRow]) -> dict[int, SecondaryOffset]:
    """Return the secondary offsets by number, each with X, Z and nose radius."""
    return {n: SecondaryOffset(*row) for n, row in rows.items()}


@dataclass(frozen=True, slots=True)
class MillOffsets:
    """Tool table, preset table and active preset number of a mill.

    Both tables are mappings by number. Preset 0 is the preset of the machine file.
    """

    tools: Mapping[int, MillToolRow] = field(default_factory=dict)
    presets: Mapping[int, PresetRow] = field(default_factory=dict)
    active_preset: int = 0


def add_mill_offsets(job_setup: InterpreterSetup, offsets: MillOffsets) -> InterpreterSetup:
    """Return the job setup with the offset tables of a mill added.

    The setup of a lathe is returned unchanged.

    Only tools of the mill's tool table are used, and lathe tool offsets in the same store are ignored.
    ``job_setup.kinematics`` must be the kinematics of the machine file, without a preset.
    """
    machine = job_setup.kinematics
    if machine is None:
        return job_setup
    from core.geometry.rotary_axes import DatumPreset

    presets = {0: DatumPreset(machine.origin, machine.basic_rotation_deg)}
    presets |= {number: make_datum_preset(row) for number, row in offsets.presets.items()}
    active = offsets.active_preset if offsets.active_preset in presets else 0
    return replace(
        job_setup,
        tools={number: _make_tool_offset(row) for number, row in offsets.tools.items()},
        tool_names={row.name.upper(): number for number, row in offsets.tools.items() if row.name},
        mill_tools={number: _row(row) for number, row in offsets.tools.items()},
        presets=presets,
        preset=active,
        kinematics=machine.apply_preset(presets[active]),
    )


def make_mill_rows(tools: Mapping[int, ToolOffsetRow]) -> dict[int, MillToolRow]:
    """Return the tools of an offsets file as rows of a mill's tool table.

    Z becomes the length, and the remark becomes the name.
    """
    return {
        number: MillToolRow(row.remark, row.z + row.wear_z, row.nose_radius) for number, row in tools.items()
    }


def make_datum_preset(row: PresetRow) -> DatumPreset:
    """Return a row of the preset table as the datum that the kinematics calculation uses."""
    from core.geometry.rotary_axes import DatumPreset

    return DatumPreset((row.x, row.y, row.z), row.rotation, tuple(find_rotary_zero_positions(row).items()))


def find_rotary_zero_positions(row: PresetRow) -> dict[str, float]:
    """Return the machine positions at which the rotary axes read 0, in degrees by axis name."""
    return {"A": row.a, "B": row.b, "C": row.c}


def _make_tool_offset(row: MillToolRow) -> ToolOffset:
    """Return the length and radius of a mill tool. The length includes DL, and the radius includes DR."""
    return ToolOffset(z=row.length + row.dl, nose_radius=max(row.radius + row.dr, 0.0), name=row.name)


def _row(row: MillToolRow) -> MillTool:
    return MillTool(
        row.length, row.radius, row.corner, row.dl, row.dr, row.dr2, row.teeth, row.point, row.life
    )

"""Data of a part that are known before the part is proved, such as the tools and clamping.

The store has the stock of each program, by program name. The stock is never written to the program text.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from app.desk.command_errors import convert_to_command_error
from app.desk.data_folder import find_data_folder
from app.desk.stored_part import EMPTY_STORED_PART, StoredPart, load_stored_part
from core.interpreter.shared.job_setup import ToolOffset
from core.machine.machine_model import Machine
from core.part.stock import Clamping
from core.part.tool_shape import ToolShape
from core.proving.checks.machine_checks import LIVE_TOOL_PREFIX
from core.proving.checks.thread_checks import DriveLimits
from core.proving.program_tools import PartSettings
from core.store.store_file import has_store

if TYPE_CHECKING:
    pass

MACHINE_FILE_REASON = "set by the machine file"


def make_part_settings(
    machine: Machine,
    tools: Mapping[int, ToolOffset],
    shapes: Mapping[int, ToolShape],
    stick_out_mm: float | None = None,
) -> PartSettings:
    """Return the part settings, without a stock.

    ``stick_out_mm`` is the stick-out for the program in mm. If it is None, the stick-out in the machine
    file is used.
    """
    return PartSettings(
        shapes=shapes,
        nose_radii={number: tool.nose_radius for number, tool in tools.items()},
        clamping=_stock_clamping(machine, stick_out_mm),
        drives=DriveLimits(machine.axes[1].max_acceleration, machine.spindle.deceleration_rpm_s),
        gang={n: (tool.z, tool.x) for n, tool in tools.items()} if machine.tooling_kind == "gang" else {},
        live_codes=any(
            on and name.startswith(LIVE_TOOL_PREFIX) for name, on in machine.m_code_outputs.values()
        ),
        silenced=dict.fromkeys(machine.silenced_checks, MACHINE_FILE_REASON),
        travel=_axis_travel(machine),
    )


def apply_stored_clamping(
    part_settings: PartSettings, machine: Machine, stored_part: StoredPart, *, is_explicit: bool = False
) -> PartSettings:
    """Return the part settings with the stored stick-out and the stored list of silenced checks.

    If ``is_explicit`` is true, the current stick-out is retained, because the user specified it.
    """
    if stored_part.stick_out_mm is not None and not is_explicit and machine.clamping.diameter:
        part_settings = replace(part_settings, clamping=_stock_clamping(machine, stored_part.stick_out_mm))
    return replace(part_settings, silenced={**part_settings.silenced, **stored_part.silenced_checks})


def _axis_travel(machine: Machine) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return the travel of X and Z in mm, or None if an axis has unlimited travel."""
    x, z = machine.axes[0].travel, machine.axes[1].travel
    return (x, z) if x is not None and z is not None else None


def _stock_clamping(machine: Machine, stick_out: float | None) -> Clamping | None:
    """Return how the chuck, collet and tailstock hold the stock, or None if the clamping is unknown.

    Without a stick-out, only the chuck's speed limit and the tailstock apply.
    """
    held = machine.clamping
    out = held.stick_out if stick_out is None else stick_out
    if not out and not held.max_rpm and not held.quill_diameter:
        return None
    return Clamping(
        held.diameter if out else 0.0,
        out,
        held.jaws,
        held.jaw_diameter or held.diameter,
        held.max_rpm,
        held.quill_diameter,
        held.centre_point,
        held.centre_at,
    )


def read_stored_part(program: str) -> StoredPart:
    """Return the stored data of a program's part, or empty data if there is no store.

    Raises CommandError if the store cannot be read.
    """
    return read_stored_parts([program]).get(program, EMPTY_STORED_PART)


def read_stored_parts(programs: Iterable[str]) -> dict[str, StoredPart]:
    """Return the stored part data by program name, for the programs that have such data.

    Raises CommandError if the store cannot be read.
    """
    folder = find_data_folder()
    if not has_store(folder):
        return {}
    from core.store.store import Store, StoreError

    with convert_to_command_error(StoreError), Store.open(folder, read_only=True) as store:
        found = {program: load_stored_part(store.settings.read_setting, program) for program in programs}
    return {program: kept for program, kept in found.items() if kept != EMPTY_STORED_PART}


def save_stock(program: str, text: str, stick_out_mm: float | None) -> None:
    """Save the stock text and the stick-out of a program.

    If ``stick_out_mm`` is None, the stored stick-out does not change. Raises CommandError if the store
    cannot be read or written.
    """
    from core.store.store import Store, StoreError

    with convert_to_command_error(StoreError), Store.open(find_data_folder()) as store:
        kept = replace(load_stored_part(store.settings.read_setting, program), stock_text=text)
        kept = kept if stick_out_mm is None else replace(kept, stick_out_mm=stick_out_mm)
        for key, value in kept.make_stored_settings(program).items():
            store.settings.save_setting(key, value).result()

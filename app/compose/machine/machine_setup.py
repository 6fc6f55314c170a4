"""Reading of the machine file, and creation of the setup in which a program is executed.

The machine in use is the machine for which the operator screen was last opened. Commands for offsets check
values against the travel of this machine.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError, convert_to_command_error
from core.interpreter.shared.job_setup import (
    ControlLimits,
    InterpreterSetup,
    SecondaryOffset,
    ToolOffset,
    ZeroOffset,
)
from core.message import Message

if TYPE_CHECKING:
    from app.compose.machine.accepted_machine import SettingsReader
    from app.desk.persistence import Persistence
    from core.geometry.rotary_axes import Kinematics
    from core.machine.machine_model import Machine

_SETTINGS_KEY = (
    "machine in use"  # key of the setting with the path of the file or the name of a shipped machine
)


def read_machine(path: str | None) -> Machine:
    """Return the machine for a file path or for the name of a shipped machine.

    If ``path`` is None, return the shipped lathe. Raises CommandError that lists every finding.
    """
    from app.compose.machine.machine_files import load_named_machine
    from core.table_schema import MachineFileError

    with convert_to_command_error(MachineFileError):
        return load_named_machine(path)


def get_control_limits(machine: Machine) -> ControlLimits:
    """Return the properties of a machine that the interpreter needs."""
    c_axis = machine.axes[2]
    return ControlLimits(
        max_feed_mm_s=machine.limits.max_feed,
        max_rpm=machine.spindle.max_rpm,
        resolution_mm=machine.limits.resolution,
        z_acceleration_mm_s2=machine.axes[1].max_acceleration,
        can_unclamp_while_turning=machine.interlocks.unclamp_while_turning,
        can_start_with_collet_open=machine.interlocks.spindle_with_collet_open,
        m_code_outputs=machine.m_code_outputs,
        disabled_m_codes=machine.disabled_m_codes,
        ignored_m_codes=machine.ignored_m_codes,
        is_c_enabled=machine.is_c_enabled,
        has_c_feedback=machine.has_c_feedback,
        max_c_rpm=c_axis.max_speed / 6.0,  # 1 rpm is 6 degrees a second
        c_acceleration_deg_s2=c_axis.max_acceleration,
        c_resolution_deg=c_axis.count_size,
        is_c_modulo=machine.is_c_axis_modulo,
        is_c_linear=machine.is_third_axis_linear,
        c_travel_range=c_axis.travel if machine.is_third_axis_linear else None,
        is_spindle_c_axis=machine.is_spindle_c_axis,
        live_tool_output=machine.live_tool_output,
        control_model=machine.control_model,
        third_axis_name=machine.third_axis_name,
        is_spindle_controlled=machine.spindle.controlled,
        can_orient_spindle=machine.spindle.oriented,
        fixed_points={axis.name: axis.fixed_points for axis in machine.axes if axis.fixed_points},
        max_axis_speeds=(machine.axes[0].max_speed, machine.axes[1].max_speed, c_axis.max_speed),
    )


@dataclass(frozen=True, slots=True)
class InputStates:
    """Picklable states of inputs by name, for conditional calls. An input without a state is open."""

    states_by_name: Mapping[str, bool]

    def __call__(self, terminal: str) -> bool:
        """Return whether the input of this terminal is closed."""
        return self.states_by_name.get(terminal, False)


def create_power_up_setup(
    machine: Machine,
    *,
    tool_offsets: Mapping[int, ToolOffset],
    secondary_offsets: Mapping[int, SecondaryOffset],
    zero_offsets: Mapping[int, ZeroOffset] | None = None,
    r_parameters: Mapping[int, float] | None = None,
    input_states: Mapping[str, bool] | None = None,
    block_delete: bool = False,
    is_strict: bool = False,
) -> InterpreterSetup:
    """Return the setup of a program that starts after power-up, with the axes at machine home.

    Inputs that are not specified are open.
    """
    return InterpreterSetup(
        start=(0.0,) * len(machine.axes),
        kinematics=_read_kinematics(machine),
        tools=tool_offsets,
        secondary=secondary_offsets,
        zero=zero_offsets or {},
        r=r_parameters or {},
        limits=get_control_limits(machine),
        block_delete=block_delete,
        strict=is_strict,
        metric=not machine.is_inch,
        last_rapid=machine.limits.manual_rapid,
        inputs=InputStates(dict(input_states or {})),
    )


def _read_kinematics(machine: Machine) -> Kinematics | None:
    """Return the kinematic chain of a mill, or None for other machines."""
    if machine.kinematics is None:
        return None
    from app.compose.machine.kinematics_chain import build_kinematics

    return build_kinematics(machine)


def save_machine_in_use(machine_file: str | None, persistence: Persistence) -> None:
    """Store which machine file is in use. None means the shipped lathe."""
    path = Path(machine_file) if machine_file else None
    place = str(path.resolve()) if path is not None and path.exists() else machine_file
    if persistence.read_setting(_SETTINGS_KEY) != place:
        persistence.save_setting(_SETTINGS_KEY, place)


def read_machine_file_in_use(settings: SettingsReader) -> str | None:
    """Return the path of the machine file in use, or the name of the shipped machine in use.

    The result is None if neither is stored.
    """
    place = settings.read_setting(_SETTINGS_KEY)
    return place if isinstance(place, str) else None


def load_machine_in_use(settings: SettingsReader) -> Machine:
    """Return the machine in use. Raises CommandError if its file cannot be read or has errors.

    Raises StoreError if the settings cannot be read.
    """
    try:
        return read_machine(read_machine_file_in_use(settings))
    except CommandError as error:
        raise CommandError(
            Message("the travel of the current machine is unknown: {error}. Use --machine FILE", error=error),
            error.code,
        ) from error

"""Backend for LinuxCNC HAL."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import resources
from app.compose.backends.backend_entry import (
    Backend,
    get_axis_arguments,
    has_own_station,
    list_input_row_names,
)
from core.machine.hardware_model import HomingModel
from core.machine.machine_model import Axis, Machine
from core.ports import Clock, DriverError
from drivers.driver_host.host_server import DriverBundle
from drivers.hal.boards.board_table import ETHERCAT, MESA_SERVO, SIM, BoardTable
from drivers.hal.hal_config import HalAxis, HalConfig, HalInput, HalOutput, HalPot, HalSpindleConfig
from drivers.hal.hal_machine import HalMachine
from drivers.hal.hal_session import HalSession
from drivers.hal.hal_table import HalTable
from drivers.operator_station import OnScreenStation
from drivers.wakeups import RealClock


def create_hal_config(machine: Machine) -> HalConfig:
    """Return the configuration of HAL. Raises DriverError if the machine file does not have a [hal] table."""
    hal = machine.hardware.find_driver_table(HalTable)
    if hal is None:
        raise DriverError("{source}: the [hal] table is missing", source=machine.source)
    spindle = machine.spindle
    return HalConfig(
        hal_table=hal,
        hal_file=_hal_path(machine, hal.file),
        commit_time_s=machine.timing.commit_time_s,
        axes=tuple(_axis(axis, machine, hal) for axis in machine.axes),
        spindle=HalSpindleConfig(
            hal.spindle,
            spindle.max_rpm,
            spindle.acceleration_rpm_s,
            spindle.deceleration_rpm_s,
            has_encoder=bool(spindle.encoder_ppr),
            is_driven_by_hal=machine.hardware.spindle_driver == "hal",
        ),
        outputs={
            name: HalOutput(out.terminal, out.safe_state, name in machine.lamp_outputs)
            for name, out in machine.outputs.items()
        },
        inputs={
            name: HalInput(wired.terminal, wired.is_active_low) for name, wired in machine.inputs.items()
        },
        pots={
            name: HalPot(pot.terminal, pot.low_value, pot.high_value, pot.switch)
            for name, pot in machine.hardware.analog_inputs.items()
        },
    )


def _hal_path(machine: Machine, name: str) -> Path:
    """Return the path of the HAL file, which is in the machine file's folder or is a shipped file."""
    local_path = Path(machine.source).parent / name
    return resources.get_hal_path(name) if not Path(machine.source).exists() else local_path.resolve()


def _axis(axis: Axis, machine: Machine, hal: HalTable) -> HalAxis:
    home = machine.hardware.homing_models.get(axis.name) or HomingModel()
    return HalAxis(
        **get_axis_arguments(axis, machine),
        pins=hal.axes.get(axis.name),
        home_method=home.method,
        home_latch_speed=home.latch,
        home_offset=home.offset,
        is_spindle_c_axis=_is_spindle(axis, machine, hal),
    )


def _is_spindle(axis: Axis, machine: Machine, hal: HalTable) -> bool:
    spindle_is_c = machine.is_spindle_c_axis and machine.hardware.spindle_driver == "hal"
    return axis.name == "C" and spindle_is_c and axis.name in hal.axes


def create_hal_drivers(machine: Machine, clock: Clock) -> DriverBundle:
    """Return the drivers of the machine on HAL for the driver host.

    Raises DriverError if HAL cannot be used.
    """
    config = create_hal_config(machine)
    zero = clock.origin_s if isinstance(clock, RealClock) else 0.0
    owned = HalMachine(config, clock, lambda: HalSession(config, zero))
    ports = owned.ports
    if has_own_station(machine):
        return DriverBundle(ports, owned.run_cycle, owned.close)
    wired = ports.station if {"handwheel", "spindle_load"} & machine.hardware.analog_inputs.keys() else None
    panel = OnScreenStation(clock, ports.io.inputs, wired)
    return DriverBundle(replace(ports, station=panel), owned.run_cycle, owned.close, panel)


def _survey_rows(machine: Machine, _clock: Clock) -> Iterator[tuple[str, str, str, str]]:
    """Yield each pin named in the machine file, with any error that HAL reports for it."""
    session = HalSession(create_hal_config(machine), 0.0, check_only=True)
    session.close()
    for each in session.pin_verdicts:
        yield each.machine_file_key, each.pin_name, each.error_text, each.error_text


def _measured_rows(machine: Machine) -> Iterator[str]:
    """Yield the names of the check rows with values that hardware measures.

    These are the rows of all inputs, and of the axes and the spindle if they have encoders. A simulated
    board has no such rows. The position of a step drive is only the number of steps sent. Without a [board]
    table, the kind of the axis drives is unknown.
    """
    board, hal = machine.hardware.find_driver_table(BoardTable), machine.hardware.find_driver_table(HalTable)
    if board is not None and board.kind == SIM:
        return
    if board is not None and board.kind in {MESA_SERVO, ETHERCAT} and hal is not None:
        yield from hal.axes
    if machine.spindle.encoder_ppr:
        yield "spindle"
    yield from list_input_row_names(machine)


BACKEND = Backend(
    "HAL",
    create_drivers=create_hal_drivers,
    survey_nodes=_survey_rows,
    list_measured_row_names=_measured_rows,
)

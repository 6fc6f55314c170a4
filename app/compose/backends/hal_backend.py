"""Backend for LinuxCNC HAL."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import resources
from app.compose.backends.backend_entry import Backend, axis_figures, has_station, wired_inputs
from core.machine.hardware_model import HomeModel
from core.machine.machine_model import Axis, Machine
from core.ports import Clock, DriverError
from drivers.driver_host.host_server import Driven
from drivers.hal.boards.board_table import ETHERCAT, MESA_SERVO, SIM, BoardTable
from drivers.hal.hal_config import HalAxis, HalConfig, HalInput, HalOutput, HalPot, HalSpindle
from drivers.hal.hal_machine import HalMachine
from drivers.hal.hal_session import HalSession
from drivers.hal.hal_table import HalTable
from drivers.operator_station import PanelStation
from drivers.waiting import RealClock


def hal_config(machine: Machine) -> HalConfig:
    """Return the configuration of HAL. Raises DriverError if the machine file has no [hal] table."""
    hal = machine.hardware.table(HalTable)
    if hal is None:
        raise DriverError("{source}: the [hal] table is missing", source=machine.source)
    spindle = machine.spindle
    return HalConfig(
        table=hal,
        file=_file(machine, hal.file),
        commit=machine.timing.commit,
        axes=tuple(_axis(axis, machine, hal) for axis in machine.axes),
        spindle=HalSpindle(
            hal.spindle,
            spindle.rpm_max,
            spindle.accel,
            spindle.decel,
            encoder=bool(spindle.encoder_ppr),
            turned=machine.hardware.spindle_driver == "hal",
        ),
        outputs={
            name: HalOutput(out.terminal, out.safe, name in machine.lamps)
            for name, out in machine.outputs.items()
        },
        inputs={name: HalInput(wired.terminal, wired.active_low) for name, wired in machine.inputs.items()},
        pots={
            name: HalPot(pot.terminal, pot.low, pot.high, pot.switch)
            for name, pot in machine.hardware.analog.items()
        },
    )


def _file(machine: Machine, name: str) -> Path:
    """Return the path of the HAL file: next to the machine file, or among the shipped files."""
    beside = Path(machine.source).parent / name
    return resources.hal_file(name) if not Path(machine.source).exists() else beside.resolve()


def _axis(axis: Axis, machine: Machine, hal: HalTable) -> HalAxis:
    home = machine.hardware.homes.get(axis.name) or HomeModel()
    return HalAxis(
        **axis_figures(axis, machine),
        pins=hal.axes.get(axis.name),
        home_method=home.method,
        home_latch=home.latch,
        home_offset=home.offset,
        is_spindle=_is_spindle(axis, machine, hal),
    )


def _is_spindle(axis: Axis, machine: Machine, hal: HalTable) -> bool:
    spindle_is_c = machine.spindle_is_c and machine.hardware.spindle_driver == "hal"
    return axis.name == "C" and spindle_is_c and axis.name in hal.axes


def hal_driven(machine: Machine, clock: Clock) -> Driven:
    """Return the machine on HAL for the driver host. Raises DriverError."""
    config = hal_config(machine)
    zero = clock.zero if isinstance(clock, RealClock) else 0.0
    owned = HalMachine(config, clock, lambda: HalSession(config, zero))
    ports = owned.ports
    if has_station(machine):
        return Driven(ports, owned.tick, owned.close)
    wired = ports.station if {"handwheel", "spindle_load"} & machine.hardware.analog.keys() else None
    panel = PanelStation(clock, ports.io.inputs, wired)
    return Driven(replace(ports, station=panel), owned.tick, owned.close, panel)


def _survey(machine: Machine, _clock: Clock) -> Iterator[tuple[str, str, str, str]]:
    """Yield every pin that the machine file names, with the fault that HAL reports."""
    session = HalSession(hal_config(machine), 0.0, only_check=True)
    session.close()
    for each in session.verdicts:
        yield each.path, each.pin, each.trouble, each.trouble


def _measured(machine: Machine) -> Iterator[str]:
    """Yield the axes and the spindle with encoders, and all inputs; nothing for a simulated board.

    The position of a step drive is only the number of steps sent. Without [board], the driver does not know
    the kind of the axes' drives.
    """
    board, hal = machine.hardware.table(BoardTable), machine.hardware.table(HalTable)
    if board is not None and board.kind == SIM:
        return
    if board is not None and board.kind in {MESA_SERVO, ETHERCAT} and hal is not None:
        yield from hal.axes
    if machine.spindle.encoder_ppr:
        yield "spindle"
    yield from wired_inputs(machine)


BACKEND = Backend("HAL", driven=hal_driven, survey=_survey, measured=_measured)

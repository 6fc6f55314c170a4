"""Generator of the LinuxCNC HAL file and the wiring table for a machine file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace

from app.desk.command_errors import CommandError
from core.machine.machine_model import Machine
from core.message import Message
from core.table_schema import MachineFileError
from drivers.hal.boards import board_table
from drivers.hal.boards.board_table import BoardTable
from drivers.hal.boards.ethercat_lathe import build_ethercat_file
from drivers.hal.boards.hal_file_builder import (
    HalFile,
    LatheAxis,
    LatheData,
    WiringRow,
    format_wiring_table,
    render_hal_file,
)
from drivers.hal.boards.mesa_servo_lathe import build_mesa_servo_file
from drivers.hal.boards.mesa_step_lathe import build_mesa_step_file
from drivers.hal.boards.parallel_port import build_parallel_port_file
from drivers.hal.boards.simulated_lathe import build_simulated_file
from drivers.hal.hal_table import HalTable

_BOARD_BUILDERS: Mapping[str, Callable[[LatheData], HalFile]] = {
    board_table.SIM: build_simulated_file,
    board_table.PARPORT: build_parallel_port_file,
    board_table.MESA_STEP: build_mesa_step_file,
    board_table.MESA_SERVO: build_mesa_servo_file,
    board_table.ETHERCAT: build_ethercat_file,
}


@dataclass(frozen=True, slots=True)
class GeneratedHalFiles:
    """HAL files and tables that are generated for a machine.

    - ``name`` is the file name in [hal], and ``hal_text`` is the text of the HAL file.
    - ``extra_files`` are the additional files by name.
    - ``wiring_rows`` are the rows of the wiring table, and ``wiring_table`` is the same table as text.
    - ``measurement_lines`` describe the measurements that the machine builder must make.
    """

    file_name: str
    board_kind: str
    hal_text: str
    extra_files: Mapping[str, str]
    wiring_rows: tuple[WiringRow, ...]
    wiring_table: tuple[str, ...]
    measurement_lines: tuple[str, ...]


def generate_hal_files(machine: Machine) -> GeneratedHalFiles:
    """Return the generated HAL file and wiring table of a machine.

    Raises the same exceptions as ``build_hal_file``.
    """
    file, hal = build_hal_file(machine), machine.hardware.find_driver_table(HalTable)
    return GeneratedHalFiles(
        file_name=hal.file if hal is not None else "",
        board_kind=file.lathe.board_table.kind,
        hal_text=render_hal_file(file),
        extra_files=file.extra_files,
        wiring_rows=tuple(file.wiring_rows),
        wiring_table=tuple(format_wiring_table(file.wiring_rows)),
        measurement_lines=tuple(file.pre_motion_checks),
    )


def build_hal_file(machine: Machine) -> HalFile:
    """Return the HAL file of a machine that uses LinuxCNC HAL.

    Raises CommandError if the backend is not hal or the machine file has no [hal] or [board] table. Raises
    MachineFileError for names that the board does not have, for terminals that are used twice, and for
    required names that are missing.
    """
    hal, board = machine.hardware.find_driver_table(HalTable), machine.hardware.find_driver_table(BoardTable)
    if hal is None or machine.backend != "hal":
        raise CommandError(
            Message(
                '{source}: machine.backend is {backend}, but a HAL file can be written only for "hal"',
                source=machine.source,
                backend=machine.backend,
            ),
            "not-hal",
        )
    if board is None:
        kinds = ", ".join(f'"{kind}"' for kind in board_table.BOARD_KINDS)
        raise CommandError(
            Message(
                "{source}: the [board] table is missing; add it with kind = one of {kinds}",
                source=machine.source,
                kinds=kinds,
            ),
            "no-board",
        )
    if machine.hardware.spindle_driver != "hal":  # an inverter on a separate serial line
        board = replace(board, spindle=replace(board.spindle, full_speed=0.0, pwm="", channel=-1))
    axes = [
        LatheAxis(axis.name, axis.count_size, axis.max_speed, axis.max_acceleration)
        for axis in machine.axes
        if axis.name in hal.axes
    ]
    lathe = LatheData(
        machine_name=machine.name,
        machine_file_path=machine.source,
        board_table=board,
        servo_thread=hal.thread,
        servo_period_s=hal.period,
        axes=tuple(axes),
        max_rpm=machine.spindle.max_rpm,
        acceleration_rpm_per_s=machine.spindle.acceleration_rpm_s,
        encoder_pulses_per_rev=machine.spindle.encoder_ppr,
        is_spindle_c_axis=machine.is_spindle_c_axis and machine.hardware.spindle_driver == "hal",
        terminal_names={path: name for path, name in _terminal_names(machine, hal) if name},
    )
    file = _BOARD_BUILDERS[board.kind](lathe)
    if file.findings:
        raise MachineFileError(file.findings, machine.source)
    return file


def _terminal_names(machine: Machine, hal: HalTable) -> Iterator[tuple[str, str]]:
    """Yield the key and the name of every HAL pin or signal in the machine file."""
    yield from ((f"hal.{key}", getattr(hal, key)) for key in ("machine_on", "charge_pump", "link_fault"))
    for axis, pins in hal.axes.items():
        yield from ((f"hal.axes.{axis}.{key}", name) for key, name in asdict(pins).items())
    yield from ((f"hal.spindle.{key}", name) for key, name in asdict(hal.spindle).items())
    yield from ((f"io.out.{name}", out.terminal) for name, out in machine.outputs.items())
    yield from ((f"io.in.{name}", wired.terminal) for name, wired in machine.inputs.items())
    yield from ((f"io.analog.{name}", pot.terminal) for name, pot in machine.hardware.analog_inputs.items())

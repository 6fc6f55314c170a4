"""The LinuxCNC HAL file for a machine file, with its wiring table."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace

from app.desk.command_errors import CommandError
from core.machine.machine_model import Machine
from core.message import Message
from core.table_schema import MachineFileError
from drivers.hal.boards import board_table
from drivers.hal.boards.board_table import BoardTable
from drivers.hal.boards.ethercat_lathe import ethercat_lathe
from drivers.hal.boards.hal_lines import HalFile, Lathe, LatheAxis, Wire, table_lines, text_of
from drivers.hal.boards.mesa_servo_lathe import mesa_servo_lathe
from drivers.hal.boards.mesa_step_lathe import mesa_step_lathe
from drivers.hal.boards.parallel_port import parallel_port
from drivers.hal.boards.simulated_lathe import simulated_lathe
from drivers.hal.hal_table import HalTable

_BOARDS: Mapping[str, Callable[[Lathe], HalFile]] = {
    board_table.SIM: simulated_lathe,
    board_table.PARPORT: parallel_port,
    board_table.MESA_STEP: mesa_step_lathe,
    board_table.MESA_SERVO: mesa_servo_lathe,
    board_table.ETHERCAT: ethercat_lathe,
}


@dataclass(frozen=True, slots=True)
class WrittenHal:
    """The generated files and tables for a machine.

    ``name`` is the file name in [hal], and ``wires`` are the rows of the wiring table. Other attributes are
    the additional files, the wiring table as text lines, and the required measurements.
    """

    name: str
    board: str
    text: str
    beside: Mapping[str, str]
    wires: tuple[Wire, ...]
    table: tuple[str, ...]
    measure: tuple[str, ...]


def written_hal(machine: Machine) -> WrittenHal:
    """Return the HAL file of a machine as text. Raises the errors of ``hal_file``."""
    file, hal = hal_file(machine), machine.hardware.table(HalTable)
    return WrittenHal(
        name=hal.file if hal is not None else "",
        board=file.lathe.board.kind,
        text=text_of(file),
        beside=file.beside,
        wires=tuple(file.wires),
        table=tuple(table_lines(file.wires)),
        measure=tuple(file.notes),
    )


def hal_file(machine: Machine) -> HalFile:
    """Return the HAL file of a machine that uses LinuxCNC HAL.

    Raises CommandError if the machine file has no [hal] or [board], and MachineFileError for names that the
    board does not have.
    """
    hal, board = machine.hardware.table(HalTable), machine.hardware.table(BoardTable)
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
        kinds = ", ".join(f'"{kind}"' for kind in board_table.KINDS)
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
        LatheAxis(axis.name, axis.count, axis.vmax, axis.amax)
        for axis in machine.axes
        if axis.name in hal.axes
    ]
    lathe = Lathe(
        name=machine.name,
        source=machine.source,
        board=board,
        thread=hal.thread,
        period=hal.period,
        axes=tuple(axes),
        rpm_max=machine.spindle.rpm_max,
        rpm_accel=machine.spindle.accel,
        encoder_lines=machine.spindle.encoder_ppr,
        spindle_is_c=machine.spindle_is_c and machine.hardware.spindle_driver == "hal",
        names={path: name for path, name in _names(machine, hal) if name},
    )
    file = _BOARDS[board.kind](lathe)
    if file.findings:
        raise MachineFileError(file.findings, machine.source)
    return file


def _names(machine: Machine, hal: HalTable) -> Iterator[tuple[str, str]]:
    """Yield every pin or signal in the machine file, with its key."""
    yield from ((f"hal.{key}", getattr(hal, key)) for key in ("machine_on", "charge_pump", "link_fault"))
    for axis, pins in hal.axes.items():
        yield from ((f"hal.axes.{axis}.{key}", name) for key, name in asdict(pins).items())
    yield from ((f"hal.spindle.{key}", name) for key, name in asdict(hal.spindle).items())
    yield from ((f"io.out.{name}", out.terminal) for name, out in machine.outputs.items())
    yield from ((f"io.in.{name}", wired.terminal) for name, wired in machine.inputs.items())
    yield from ((f"io.analog.{name}", pot.terminal) for name, pot in machine.hardware.analog.items())

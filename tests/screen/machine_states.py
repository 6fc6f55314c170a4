"""Each state of a simulated machine, reached as in the shop; with a program where a cycle needs one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from core.executor.commands import CycleStart, EnableDrives, FeedHold, HomeAxes, Jog, SetSwitch
from core.executor.snapshot import MachineState
from drivers.simulators.plant_controls import PlantControls
from tests.screen.day import Day


@dataclass(frozen=True, slots=True)
class Programs:
    """A machine with programs that move for a long time, wait, and stop."""

    machine: str | None
    ending: str
    slow: str
    waits: str
    stops: str

    @property
    def texts(self) -> dict[str, str]:
        """The programs by name."""
        return {"slow": self.slow, "waits": self.waits, "stops": self.stops}


OMNITURN = Programs(
    None,
    "nc",
    "G90G94F1\nX1Z1\nX0Z0\nM30\n",
    "G90G94F9\nG04F900\nM30\n",
    "G90G94F9\nX.1\nM00(LOOK)\nX1\nM30\n",
)
_PLATE = "BEGIN PGM TEST MM\nTOOL CALL 0 Z\n{}\nM30\nEND PGM TEST MM\n"
KLARTEXT = Programs(
    "ac-table-mill",
    "h",
    _PLATE.format("L X+10 R0 F10\nL X+90 F10"),
    _PLATE.format("L X+10 R0 F1000\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 900"),
    _PLATE.format("L X+10 R0 F1000\nM0\nL X+20 F1000"),
)
SINUMERIK = Programs(
    "sinumerik-linear",
    "mpf",
    "G90 G94 G71\nG1 X10 Z10 F5\nX0 Z0\nM30\n",
    "G90 G94 G71\nG4 F900\nM30\n",
    "G90 G94 G71\nG1 X1 F100\nM0\nG1 X2\nM30\n",
)
MACHINES = {"omniturn": OMNITURN, "klartext": KLARTEXT, "sinumerik": SINUMERIK}


def choose(day: Day, program: str) -> None:
    """Load a program; it may be started then."""
    assert day.desk.program_choice.load_by_name(program)
    day.sees(
        lambda: (
            not day.desk.program_loader.loaded_program.is_busy
            and bool(day.shot.program)
            and not day.shot.needs_proof
        )
    )
    assert not day.desk.program_loader.loaded_program.blocking_errors, (
        day.desk.program_loader.loaded_program.blocking_errors
    )


def drives_on(day: Day) -> None:
    """The drives have power."""
    day.reaches(MachineState.DISABLED)
    day.desk.post(EnableDrives())
    day.reaches(MachineState.IDLE)


def _started(day: Day, program: str, *states: MachineState) -> None:
    drives_on(day)
    choose(day, program)
    day.checks_start()
    day.desk.post(CycleStart())
    day.reaches(*states)


def _running(day: Day) -> None:
    _started(day, "slow", MachineState.RUN)


def _holding(day: Day) -> None:
    _running(day)
    day.run(0.5)
    day.desk.post(FeedHold())
    day.reaches(MachineState.STOPPING, MachineState.HOLD)


def _held(day: Day) -> None:
    _holding(day)
    day.reaches(MachineState.HOLD)


def _block_end(day: Day) -> None:
    day.desk.post(SetSwitch("single_block", True))
    _started(day, "stops", MachineState.SINGLE_BLOCK_STOP)


def _jogging(day: Day) -> None:
    drives_on(day)
    day.desk.post(Jog("X", 1.0, 0.25))
    day.reaches(MachineState.JOG)


def _homing(day: Day) -> None:
    drives_on(day)
    day.desk.post(HomeAxes(""))
    day.reaches(MachineState.HOMING)


def _stopped(day: Day) -> None:
    _running(day)
    day.desk.station_keys.press_estop()
    day.reaches(MachineState.ESTOP)


def _alarm(day: Day) -> None:
    _running(day)
    hands(day).drive_fault("X")
    day.reaches(MachineState.FAULT)


def _rest(day: Day) -> None:
    drives_on(day)
    choose(day, "slow")


def _empty(day: Day) -> None:
    drives_on(day)


def hands(day: Day) -> PlantControls:
    """What an operator does at the simulated machine, and what breaks in it."""
    assert isinstance(day.desk.desk_control.station_panel, PlantControls)
    return day.desk.desk_control.station_panel


STATES: dict[MachineState, Callable[[Day], None]] = {
    MachineState.DISABLED: lambda day: day.reaches(MachineState.DISABLED),
    MachineState.IDLE: _rest,
    MachineState.RUN: _running,
    MachineState.STOPPING: _holding,
    MachineState.HOLD: _held,
    MachineState.SINGLE_BLOCK_STOP: _block_end,
    MachineState.PROGRAM_STOP: lambda day: _started(day, "stops", MachineState.PROGRAM_STOP),
    MachineState.WAIT: lambda day: _started(day, "waits", MachineState.WAIT),
    MachineState.JOG: _jogging,
    MachineState.HOMING: _homing,
    MachineState.ESTOP: _stopped,
    MachineState.FAULT: _alarm,
}

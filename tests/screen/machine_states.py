"""Each state of a simulated machine, reached as in the shop; with a program where a cycle needs one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from core.executor.commands import CycleStart, EnableDrives, FeedHold, Home, Jog, SetSwitch
from core.executor.snapshot import State
from drivers.simulators.plant_hands import PlantHands
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
    assert day.desk.programs.choose(program)
    day.sees(lambda: not day.desk.session.now.busy and bool(day.shot.program) and not day.shot.proof_wanted)
    assert not day.desk.session.now.errors, day.desk.session.now.errors


def drives_on(day: Day) -> None:
    """The drives have power."""
    day.reaches(State.DISABLED)
    day.desk.post(EnableDrives())
    day.reaches(State.IDLE)


def _started(day: Day, program: str, *states: State) -> None:
    drives_on(day)
    choose(day, program)
    day.checks_start()
    day.desk.post(CycleStart())
    day.reaches(*states)


def _running(day: Day) -> None:
    _started(day, "slow", State.RUN)


def _holding(day: Day) -> None:
    _running(day)
    day.run(0.5)
    day.desk.post(FeedHold())
    day.reaches(State.HOLDING, State.HOLD)


def _held(day: Day) -> None:
    _holding(day)
    day.reaches(State.HOLD)


def _block_end(day: Day) -> None:
    day.desk.post(SetSwitch("single_block", True))
    _started(day, "stops", State.BLOCK_END)


def _jogging(day: Day) -> None:
    drives_on(day)
    day.desk.post(Jog("X", 1.0, 0.25))
    day.reaches(State.JOG)


def _homing(day: Day) -> None:
    drives_on(day)
    day.desk.post(Home(""))
    day.reaches(State.HOME)


def _stopped(day: Day) -> None:
    _running(day)
    day.desk.station.press_estop()
    day.reaches(State.ESTOP)


def _alarm(day: Day) -> None:
    _running(day)
    hands(day).drive_fault("X")
    day.reaches(State.FAULT)


def _rest(day: Day) -> None:
    drives_on(day)
    choose(day, "slow")


def _empty(day: Day) -> None:
    drives_on(day)


def hands(day: Day) -> PlantHands:
    """What an operator does at the simulated machine, and what breaks in it."""
    assert isinstance(day.desk.control.panel, PlantHands)
    return day.desk.control.panel


STATES: dict[State, Callable[[Day], None]] = {
    State.DISABLED: lambda day: day.reaches(State.DISABLED),
    State.IDLE: _rest,
    State.RUN: _running,
    State.HOLDING: _holding,
    State.HOLD: _held,
    State.BLOCK_END: _block_end,
    State.PROGRAM_STOP: lambda day: _started(day, "stops", State.PROGRAM_STOP),
    State.WAIT: lambda day: _started(day, "waits", State.WAIT),
    State.JOG: _jogging,
    State.HOME: _homing,
    State.ESTOP: _stopped,
    State.FAULT: _alarm,
}

"""What the composition asks of a backend: one ``BACKEND`` in the module that puts it together.

And the rows of ``turndesk machine check``: what answered, and how it is.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Container, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypedDict

from core.machine.machine_model import Axis, Machine
from core.ports import Clock, DriverError, MachinePorts

if TYPE_CHECKING:
    from app.compose.control.rights import Right
    from app.desk.station_hands import StationPanel
    from drivers.driver_host.host_server import Driven

BACKENDS = {
    "sim": "simulated_backend",
    "canopen": "canopen_backend",
    "grblhal": "grblhal_backend",
    "hal": "hal_backend",
}
"""By the word in machine.backend the module of this room with its ``BACKEND``."""

NO_PRIORITY = "without real-time priority"  # begins what drives lose that want each setpoint at its time
STATION = ("start", "hold")  # a machine whose file has neither has no operator station of its own
Play = Callable[
    [Machine, Callable[[], bool], Callable[[str], None], Callable[[], Iterable[str]]], None
]  # machine, while going, what to say, lines that were typed


@dataclass(frozen=True, slots=True)
class Connected:
    """The ports of a machine. ``panel``: the station on the screen, None where the machine has its own.

    ``more_rows`` are rows of ``turndesk machine check`` that follow the station. ``measured`` lists those of
    them, and the inputs beside the backend's own, whose values hardware reports.
    """

    ports: MachinePorts
    panel: StationPanel | None
    set_input: Callable[[str, bool], None] | None  # of a simulated machine
    close: Callable[[], None]
    more_rows: Callable[[], Iterable[Row]] = tuple
    measured: Callable[[], Iterable[str]] = tuple


@dataclass(frozen=True, slots=True)
class Backend:
    """How a machine of this backend is driven.

    ``word`` is what could not be reached where nothing answers. ``driven`` makes what the driver host owns,
    and ``connect`` what lives in the control's own process, with its inverter; a backend that has both is
    asked for the driver host by its machine file. ``played``: machine and other end are simulated here.
    ``play`` is the other end alone, for trying a machine file without hardware. ``survey`` asks every node by
    itself, or looks at every pin: its name, where it is, what is wrong with it and what it says. ``measured``
    lists the rows of ``turndesk machine check`` whose values hardware reports; without it no row counts as
    checked.
    """

    word: str
    driven: Callable[[Machine, Clock], Driven] | None = None
    connect: Callable[[Machine, Clock], Connected] | None = None
    played: Callable[[Machine], bool] = lambda _machine: False
    play: Play | None = None
    survey: Callable[[Machine, Clock], Iterable[tuple[str, str, str, str]]] | None = None
    measured: Callable[[Machine], Iterable[str]] = lambda _machine: ()


def backend_of(machine: Machine) -> Backend:
    """The backend of a machine; its libraries are loaded when it connects. Raises DriverError for no such."""
    if machine.backend not in BACKENDS:
        raise DriverError(
            "{source}: backend {backend} does not have a driver yet",
            source=machine.source,
            backend=machine.backend,
        )
    return _backend(machine.backend)


def _backend(word: str) -> Backend:
    found = importlib.import_module(f"app.compose.backends.{BACKENDS[word]}").BACKEND
    assert isinstance(found, Backend)
    return found


def playable() -> list[str]:
    """Backends whose other end can be played alone."""
    return [word for word in BACKENDS if _backend(word).play is not None]


class AxisFields(TypedDict):
    """The fields of ``drivers.setpoint_queue.AxisFigures``."""

    name: str
    vmax: float
    amax: float
    count: float
    following_window: float
    following_time: float
    travel: tuple[float, float] | None
    absolute: bool
    home_speed: float
    corner: float


def axis_figures(axis: Axis, machine: Machine) -> AxisFields:
    """Return the values of an axis that every driver of setpoints needs."""
    return {
        "name": axis.name,
        "vmax": axis.vmax,
        "amax": axis.amax,
        "count": axis.count,
        "following_window": axis.following_window,
        "following_time": axis.following_time,
        "travel": axis.travel,
        "absolute": axis.absolute,
        "home_speed": axis.home_speed or 10.0,
        "corner": axis.amax * machine.timing.setpoint,
    }


def has_station(machine: Machine) -> bool:
    """Whether the machine has buttons of its own, or is operated by those on the screen."""
    return any(name in machine.inputs for name in STATION)


def wired_inputs(machine: Machine) -> list[str]:
    """Return the rows of ``turndesk machine check`` for inputs, and for a station that is wired to them."""
    inputs = [f"input {name}" for name in machine.inputs]
    return [*inputs, "station"] if has_station(machine) else inputs


def has_inverter(machine: Machine) -> bool:
    """Whether an inverter of its own turns the spindle."""
    return machine.hardware.spindle_driver == "vfd"


def played(machine: Machine) -> bool:
    """Whether the machine is simulated, on a virtual bus or on none."""
    return backend_of(machine).played(machine)


MISSING, NOT_CHECKED = "missing", "not checked"
FAILED = (
    "fault",
    "no answer",
    "wrong",
    MISSING,
)  # states that are trouble; an E-stop that is pressed is none


class Row(NamedTuple):
    """One thing of the machine: where it hangs, how it is, and what it says."""

    name: str
    at: str
    state: str
    detail: str

    @property
    def verdict(self) -> str:
        """Return ``ok``, ``FAIL`` where it is not as the machine file has it, or ``not checked``."""
        if self.state in FAILED:
            return "FAIL"
        return NOT_CHECKED if self.state == NOT_CHECKED else "ok"

    def checked(self, measured: Container[str]) -> Row:
        """Return the row as ``not checked`` if it is not one of the ``measured`` rows and does not fail."""
        if self.name in measured or self.state in FAILED:
            return self
        return self._replace(state=NOT_CHECKED, detail=self.detail or self.state)


@dataclass(slots=True)
class Answers:
    """What answered; ``warnings``: worth knowing although nothing is broken; ``trouble``: what is.

    ``rights`` are those that the computer grants the process of the control.
    """

    rows: list[Row] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    trouble: list[str] = field(default_factory=list)
    rights: tuple[Right, ...] = ()

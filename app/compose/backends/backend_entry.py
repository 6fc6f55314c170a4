"""Table of the backends, and the rows of ``turndesk machine check``.

The module of each backend defines one ``BACKEND``.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Container, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypedDict

from core.machine.machine_model import Axis, Machine
from core.ports import Clock, DriverError, MachinePorts

if TYPE_CHECKING:
    from app.compose.control.process_rights_check import ProcessRight
    from app.desk.station_controls import StationPanel
    from drivers.driver_host.host_server import DriverBundle

BACKENDS = {
    "sim": "simulated_backend",
    "canopen": "canopen_backend",
    "grblhal": "grblhal_backend",
    "hal": "hal_backend",
}
"""Module in this package that defines BACKEND, by the value of machine.backend."""

NO_PRIORITY_TEXT = (
    "without real-time priority"  # start of the warning for drives that need each setpoint on time
)
STATION_INPUTS = ("start", "hold")  # a machine without these inputs has no operator station
DeviceSimulation = Callable[
    [Machine, Callable[[], bool], Callable[[str], None], Callable[[], Iterable[str]]], None
]  # machine, whether to continue, output of messages, typed lines


@dataclass(frozen=True, slots=True)
class ConnectedMachine:
    """Ports of a connected machine.

    - ``on_screen_station`` is the operator station on the screen, or None if the machine has its own.
    - ``list_extra_check_rows`` returns the rows of ``turndesk machine check`` that follow the station's row.
    - ``list_measured_row_names`` returns the names of those extra rows, and of the inputs outside the
      backend, whose values hardware measures.
    """

    ports: MachinePorts
    on_screen_station: StationPanel | None
    set_input: Callable[[str, bool], None] | None  # only for a simulated machine
    close: Callable[[], None]
    list_extra_check_rows: Callable[[], Iterable[MachineCheckRow]] = tuple
    list_measured_row_names: Callable[[], Iterable[str]] = tuple


@dataclass(frozen=True, slots=True)
class Backend:
    """Functions of a backend. ``device_name`` names the device in messages about no response.

    - ``create_drivers`` creates the drivers that the driver host runs.
    - ``connect`` connects the machine in the control's process, including an inverter. A backend with
      both functions uses the driver host if the machine file specifies one.
    - ``is_simulated`` returns whether the machine and its devices are simulated on this computer.
    - ``simulate_devices`` simulates only the devices, to try a machine file without hardware.
    - ``survey_nodes`` queries every node or pin, and yields its name, address, fault and details.
    - ``list_measured_row_names`` returns the rows of ``turndesk machine check`` whose values hardware
      reports. By default, no row counts as checked.
    """

    device_name: str
    create_drivers: Callable[[Machine, Clock], DriverBundle] | None = None
    connect: Callable[[Machine, Clock], ConnectedMachine] | None = None
    is_simulated: Callable[[Machine], bool] = lambda _machine: False
    simulate_devices: DeviceSimulation | None = None
    survey_nodes: Callable[[Machine, Clock], Iterable[tuple[str, str, str, str]]] | None = None
    list_measured_row_names: Callable[[Machine], Iterable[str]] = lambda _machine: ()


def find_backend(machine: Machine) -> Backend:
    """Return the backend of a machine. Its libraries are loaded only when the machine is connected.

    Raises DriverError if no driver exists for the backend.
    """
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


def list_simulatable_backend_names() -> list[str]:
    """Return the names of the backends that can simulate only the devices of a machine."""
    return [word for word in BACKENDS if _backend(word).simulate_devices is not None]


class AxisArguments(TypedDict):
    """Keyword arguments for ``drivers.setpoint_queue.AxisProperties``."""

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


def get_axis_arguments(axis: Axis, machine: Machine) -> AxisArguments:
    """Return the axis data that every driver with a setpoint queue needs."""
    return {
        "name": axis.name,
        "vmax": axis.max_speed,
        "amax": axis.max_acceleration,
        "count": axis.count_size,
        "following_window": axis.following_error_window,
        "following_time": axis.following_error_time_s,
        "travel": axis.travel,
        "absolute": axis.is_position_absolute,
        "home_speed": axis.home_speed or 10.0,
        "corner": axis.max_acceleration * machine.timing.setpoint_duration_s,
    }


def has_own_station(machine: Machine) -> bool:
    """Return whether the machine has its own operator station instead of the station on the screen."""
    return any(name in machine.inputs for name in STATION_INPUTS)


def list_input_row_names(machine: Machine) -> list[str]:
    """Return the names of the rows of ``turndesk machine check`` for the inputs.

    The result includes the operator station if it is wired to inputs.
    """
    inputs = [f"input {name}" for name in machine.inputs]
    return [*inputs, "station"] if has_own_station(machine) else inputs


def has_inverter(machine: Machine) -> bool:
    """Return whether a separate inverter drives the spindle."""
    return machine.hardware.spindle_driver == "vfd"


def is_simulated(machine: Machine) -> bool:
    """Return whether the machine is simulated. A virtual bus also counts as simulated."""
    return find_backend(machine).is_simulated(machine)


MISSING, NOT_CHECKED = "missing", "not checked"
FAILED_STATES = (
    "fault",
    "no answer",
    "wrong",
    MISSING,
)  # states that are faults; a pressed E-stop is not a fault


class MachineCheckRow(NamedTuple):
    """One row of the machine check: name, address, state and details."""

    name: str
    at: str
    state: str
    detail: str

    @property
    def result_text(self) -> str:
        """Return the result of the check.

        The result is ``ok``, ``FAIL`` if the state contradicts the machine file, or ``NOT_CHECKED``.
        """
        if self.state in FAILED_STATES:
            return "FAIL"
        return NOT_CHECKED if self.state == NOT_CHECKED else "ok"

    def mark_unchecked(self, measured_names: Container[str]) -> MachineCheckRow:
        """Return the row with the state ``NOT_CHECKED`` if no hardware reported its value.

        A failed row does not change. ``measured_names`` are the names of the rows with values that hardware
        reported.
        """
        if self.name in measured_names or self.state in FAILED_STATES:
            return self
        return self._replace(state=NOT_CHECKED, detail=self.detail or self.state)


@dataclass(slots=True)
class MachineCheckResults:
    """Results of a machine check: rows, warnings, faults and process rights.

    ``warnings`` are notes about conditions that are not faults. ``process_rights`` are the rights that the
    operating system grants to the control process.
    """

    rows: list[MachineCheckRow] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    process_rights: tuple[ProcessRight, ...] = ()

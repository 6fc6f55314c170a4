"""What the driver host rejects after a trip, until the control has acknowledged the trip."""

from __future__ import annotations

import dataclasses

import pytest

from core.faults import DriverHostTrip, Fault, TrippedError
from core.ports import DriverError
from drivers.driver_host.host_messages import NO_NUMBERS, Message
from drivers.driver_host.host_server import DriverHost
from drivers.driver_host.trip_guard import TripGuard
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.contract.simulated import simulation_driven
from tests.drivers.machines import CONFIG


@dataclasses.dataclass
class LoggedC:
    """A spindle drive as C which turns for its index until it is released or ready."""

    ready: bool = False
    has_fault: bool = False
    orders: list[tuple[bool, bool]] = dataclasses.field(default_factory=list)

    def set_c_mode(self, is_enabled: bool, should_orient: bool = False) -> None:
        if is_enabled and self.has_fault:
            raise DriverError("C has a fault", "c-coupling")
        self.orders.append((is_enabled, should_orient))

    def is_c_ready(self) -> bool:
        return self.ready


@dataclasses.dataclass
class SilentBench:
    """A driver host whose spindle drive can be C, and whose control sends nothing unless told to."""

    sim: Simulation
    clock: ManualClock
    c: LoggedC
    host: DriverHost

    def ask(self, **command: object) -> Message:
        return self.host.handle_message(Message({"do": "do", **command}, NO_NUMBERS))

    def be_silent(self) -> None:
        """Let 1 s pass without a message, which is longer than the 0.2 s that the driver host permits."""
        for _ in range(100):
            self.clock.advance(0.01)
            self.host.run_cycle()

    @property
    def trip(self) -> DriverHostTrip | None:
        return self.host._guard.active_trip


@pytest.fixture
def silent() -> SilentBench:
    clock, c = ManualClock(), LoggedC()
    sim = build_simulation(CONFIG, clock)
    ports = dataclasses.replace(sim.ports, lock=c)
    bench = SilentBench(sim, clock, c, DriverHost(simulation_driven(ports, sim.machine)))
    bench.ask(what="enable", on=True)
    return bench


def test_trip_is_acknowledged_only_by_its_number_and_stops_always_pass() -> None:
    guard = TripGuard()
    guard.record_trip(0.4, [], is_spindle_stopped=True)
    assert guard.active_trip is None  # nothing was on
    guard.record_trip(0.4, ["coolant"], is_spindle_stopped=True)
    assert guard.active_trip is not None
    for head in ({"what": "run", "rpm": 100.0}, {"what": "home"}, {"do": "splice"}, {"what": "orient"}):
        with raises_code(DriverError, "late", "0.40 s"):
            guard.require_request_allowed(Message(head, ()))
    for head in ({"what": "run", "rpm": 0.0}, {"what": "stop"}, {"what": "write", "on": False}):
        guard.require_request_allowed(Message(head, ()))
    guard.acknowledge_trip(guard.active_trip.trip_number + 1)
    assert guard.active_trip is not None
    guard.acknowledge_trip(guard.active_trip.trip_number)
    assert guard.active_trip is None
    guard.acknowledge_trip(1)
    guard.require_request_allowed(Message({"what": "home"}, ()))


# --- the spindle drive as C: its index search turns the spindle -------------------------------------------


@pytest.mark.parametrize("orient", [True, False])
def test_c_is_not_engaged_before_the_trip_is_acknowledged(silent: SilentBench, orient: bool) -> None:
    silent.ask(what="write", name="coolant", on=True)
    silent.be_silent()
    assert silent.trip is not None
    assert "tripped" in silent.ask(what="hold", on=True, orient=orient).header
    assert silent.c.orders == []
    silent.ask(what="acknowledge", number=silent.trip.trip_number)
    assert "tripped" not in silent.ask(what="hold", on=True, orient=orient).header
    assert silent.c.orders == [(True, orient)]


@pytest.mark.parametrize(
    "command",
    [
        {"what": "hold", "on": False},
        {"what": "release"},
        {"what": "coast"},
        {"what": "safe"},
        {"what": "stop", "how": "off"},
        {"what": "enable", "on": False},
        {"what": "enable", "on": True},
        {"what": "arm"},
        {"what": "clear_fault"},
    ],
)
def test_commands_that_move_nothing_pass_during_a_trip(command: dict[str, object]) -> None:
    guard = TripGuard()
    guard.record_trip(0.4, ["coolant"], is_spindle_stopped=True)
    guard.require_request_allowed(Message({"do": "do", **command}, NO_NUMBERS))


@pytest.mark.parametrize(
    "head",
    [
        {"do": "do", "what": "hold", "on": True, "orient": True},
        {"do": "do", "what": "hold", "on": True},
        {"do": "do", "what": "run", "rpm": -0.5},
        {"do": "do", "what": "orient", "angle": 0.0, "sense": 0},
        {"do": "do", "what": "home", "name": "X"},
        {"do": "do", "what": "write", "name": "coolant", "on": True},
        {"do": "splice"},
        {"do": "mesh"},
    ],
)
def test_commands_that_move_something_are_rejected_during_a_trip(head: dict[str, object]) -> None:
    guard = TripGuard()
    guard.require_request_allowed(Message(head, NO_NUMBERS))
    guard.record_trip(0.4, ["coolant"], is_spindle_stopped=True)
    with pytest.raises(TrippedError):
        guard.require_request_allowed(Message(head, NO_NUMBERS))


def test_silence_during_the_index_search_of_c_releases_the_drive_and_is_a_trip(silent: SilentBench) -> None:
    silent.ask(what="hold", on=True, orient=True)
    silent.be_silent()
    assert silent.c.orders == [(True, True), (False, False)]
    assert silent.trip is not None
    assert silent.trip.spindle
    assert "tripped" in silent.ask(what="hold", on=True, orient=True).header
    silent.be_silent()
    assert silent.c.orders == [(True, True), (False, False)]  # nothing is released twice


def test_engaged_c_remains_engaged_during_a_silence_and_is_no_trip(silent: SilentBench) -> None:
    silent.ask(what="hold", on=True, orient=True)
    silent.c.ready = True
    silent.be_silent()
    assert silent.c.orders == [(True, True)]
    assert silent.trip is None


def test_c_that_was_released_before_the_silence_is_no_trip(silent: SilentBench) -> None:
    silent.ask(what="hold", on=True, orient=True)
    silent.ask(what="hold", on=False)
    silent.be_silent()
    assert silent.c.orders == [(True, True), (False, False)]
    assert silent.trip is None


@pytest.mark.parametrize("orient", [True, False])
def test_c_command_that_the_driver_rejects_is_no_trip(silent: SilentBench, orient: bool) -> None:
    silent.c.has_fault = True
    assert "error" in silent.ask(what="hold", on=True, orient=orient).header
    silent.be_silent()
    assert silent.c.orders == []
    assert silent.trip is None


def test_rejected_second_c_command_leaves_the_first_one_active(silent: SilentBench) -> None:
    silent.ask(what="hold", on=True, orient=True)
    silent.c.has_fault = True
    assert "error" in silent.ask(what="hold", on=True, orient=True).header
    silent.be_silent()
    assert silent.c.orders == [(True, True), (False, False)]
    assert silent.trip is not None


def test_c_that_ends_without_power_is_no_trip(silent: SilentBench) -> None:
    """The drivers release C when the drives are off; switching them on again does not engage it."""
    silent.ask(what="hold", on=True, orient=True)
    silent.ask(what="enable", on=False)
    silent.host.run_cycle()
    silent.ask(what="enable", on=True)
    silent.be_silent()
    assert silent.c.orders == [(True, True)]
    assert silent.trip is None


def test_only_a_fault_of_c_ends_its_request() -> None:
    guard = TripGuard()
    guard.record_accepted_command(Message({"do": "do", "what": "hold", "on": True}, NO_NUMBERS))
    guard.record_c_state(is_enabled=True, fault=Fault("X: following error", "axis"))
    assert guard.is_c_requested
    guard.record_c_state(is_enabled=True, fault=Fault("C: no index", "c-coupling"))
    assert not guard.is_c_requested

"""The driver host in one thread: what it does if its control is silent, and its answers to bad requests."""

from __future__ import annotations

import dataclasses
import re
import socket
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from core.ports import DriverError, MachinePorts
from drivers.driver_host.host_connection import HostConnection, InProcessLink
from drivers.driver_host.host_messages import NO_NUMBERS, Message, convert_messages, encode_message
from drivers.driver_host.host_ports import HostStationControls, create_host_ports
from drivers.driver_host.host_server import (
    CYCLE_PERIOD_S,
    MAX_SLEEP_CYCLE_S,
    DriverBundle,
    DriverHost,
    execute_command,
)
from drivers.process_messages import MAX_MESSAGE_BYTES, MessageSocket
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.wakeups import ManualClock, ProcessWakeup
from tests.coded import raises_code
from tests.drivers.contract.simulated import simulation_driven
from tests.drivers.machines import CONFIG, ramp
from tests.drivers.test_gear import cam

ZERO = (0.0, 0.0, 0.0)


@dataclasses.dataclass
class Bench:
    sim: Simulation
    clock: ManualClock
    host: DriverHost
    line: HostConnection
    ports: MachinePorts

    def alone(self, seconds: float) -> None:
        """Time passes for the driver host; the control says nothing."""
        for _ in range(round(seconds / 0.01)):
            self.clock.advance(0.01)
            self.host.run_cycle()


@pytest.fixture
def bench() -> Bench:
    clock = ManualClock()
    sim = build_simulation(CONFIG, clock)
    host = DriverHost(simulation_driven(sim.ports, sim.machine), ["without real-time priority"])
    line = HostConnection(InProcessLink(host), clock)
    return Bench(sim, clock, host, line, create_host_ports(line))


def test_slow_spindle_connection_is_reported_to_the_control() -> None:
    clock = ManualClock()
    sim = build_simulation(CONFIG, clock)
    slow = dataclasses.replace(sim.ports, spindle_lag=lambda: 0.75)
    line = HostConnection(InProcessLink(DriverHost(simulation_driven(slow, sim.machine))), clock)
    assert create_host_ports(line).spindle_lag() == 0.75


def working(bench: Bench) -> None:
    bench.ports.axes.enable(True)
    bench.ports.spindle.set_speed(600.0)
    bench.ports.io.write("coolant", True)
    bench.ports.axes.splice(ramp(bench.clock.now() + 0.03, ZERO, 50.0, 1.0))


def test_silent_control_lets_the_queue_play_to_its_end_then_all_stops(bench: Bench) -> None:
    working(bench)
    bench.alone(0.9)
    assert bench.sim.machine.get_spindle_rpm() > 500.0  # the tool is still in the cut
    assert bench.sim.ports.io.get_outputs()["coolant"]
    bench.alone(2.0)
    sample = bench.sim.ports.axes.sample()
    assert sample.actual[0] == pytest.approx(50.0 * 1.0167, abs=0.01)
    assert sample.fault == ""
    assert sample.enabled  # it may come back; the slides are held
    assert not bench.sim.ports.io.get_outputs()["coolant"]
    assert bench.sim.ports.io.get_outputs()["collet"]
    bench.alone(2.0)
    assert bench.sim.machine.get_spindle_rpm() == 0.0


def test_samples_recorded_while_the_control_was_late_are_delivered_later(bench: Bench) -> None:
    source = bench.ports.samples
    assert source is not None
    assert source.sample_rate_hz == 1000.0
    working(bench)
    bench.ports.axes.sample()
    bench.alone(0.95)  # the driver host alone: the spindle was ordered to 600, and the slides go on
    rows = []
    for _ in range(5):
        bench.clock.advance(0.01)
        bench.ports.axes.sample()
        rows.append(source.take_samples())
    assert [len(each) for each in rows[:2]] == [400, 400]  # no answer is longer than a late control can bear
    found = np.concatenate(rows)
    assert np.diff(found[:, 0]) == pytest.approx(0.001, abs=1e-9)
    assert found[0, 0] <= 0.011
    assert found[-1, 0] == pytest.approx(bench.clock.now(), abs=0.002)
    for row in found[::50]:
        assert tuple(row[1:4]) == bench.sim.ports.axes.demand_at(row[0])[0]
    assert source.take_samples().shape == (0, 14)


def test_damaged_sample_batch_is_dropped(bench: Bench) -> None:
    assert bench.ports.samples is not None
    bench.line.sample_batches.append(np.zeros(15))
    bench.line.sample_batches.append(np.zeros(28))
    assert bench.ports.samples.take_samples().shape == (2, 14)


def test_driver_without_samples_has_no_sample_port_in_driver_host() -> None:
    clock = ManualClock()
    sim = build_simulation(CONFIG, clock)
    plain = dataclasses.replace(sim.ports, samples=None)
    ports = create_host_ports(
        HostConnection(InProcessLink(DriverHost(simulation_driven(plain, sim.machine))), clock)
    )
    ports.axes.sample()
    assert ports.samples is None


def test_control_that_returns_in_time_continues(bench: Bench) -> None:
    working(bench)
    bench.alone(0.5)
    assert bench.ports.axes.sample().moving
    bench.alone(0.1)
    assert bench.ports.io.get_outputs()["coolant"]
    assert bench.sim.machine.get_spindle_rpm() > 500.0


def test_actions_of_the_driver_host_alone_are_logged(bench: Bench, caplog: pytest.LogCaptureFixture) -> None:
    working(bench)
    bench.alone(3.0)
    bench.ports.axes.sample()
    assert re.search("spindle .*outputs ", caplog.text)
    assert "3.00 s" in caplog.text


def test_orphaned_driver_host_removes_power_at_rest_and_ends(bench: Bench) -> None:
    working(bench)
    bench.line.close()
    bench.alone(0.5)
    assert bench.sim.ports.axes.sample().enabled
    assert [bench.host.is_done] == [False]
    bench.alone(1.0)
    assert bench.host.is_done
    bench.alone(0.1)
    assert not bench.sim.ports.axes.sample().enabled


def test_orphaned_driver_host_brakes_the_spindle_before_it_ends(bench: Bench) -> None:
    bench.ports.spindle.set_speed(3000.0)
    bench.alone(0.19)
    for _ in range(20):
        bench.ports.axes.sample()
        bench.alone(0.19)
    assert bench.sim.machine.get_spindle_rpm() == pytest.approx(3000.0, abs=30.0)
    bench.line.close()
    bench.alone(1.0)  # 3000 rpm at 2500 rpm/s take 1.2 s
    assert not bench.host.is_done
    assert bench.sim.machine.get_spindle_rpm() > 5.0
    bench.alone(0.5)
    assert bench.host.is_done
    assert abs(bench.sim.machine.get_spindle_rpm()) < 5.0


def test_orphaned_driver_host_does_not_wait_forever_for_the_spindle(bench: Bench) -> None:
    bench.ports.spindle.set_speed(600.0)
    bench.alone(0.1)
    bench.sim.machine.spindle_ignores_stop()
    bench.ports.axes.sample()
    bench.line.close()
    bench.alone(7.9)
    assert not bench.host.is_done
    bench.alone(0.3)
    assert bench.host.is_done


def test_startup_warnings_reach_the_control(bench: Bench) -> None:
    assert bench.ports.warnings == ("without real-time priority",)


def test_station_actions_apply_with_the_next_poll_without_waiting(bench: Bench) -> None:
    hands = HostStationControls(bench.line)
    hands.press_estop()
    assert not bench.sim.ports.station.read_state().estop
    bench.ports.axes.sample()
    assert bench.sim.ports.station.read_state().estop
    hands.set_input("TB2-5", True)
    assert bench.sim.ports.io.inputs()["TB2-5"]
    with raises_code(DriverError, "driver", "'77'"):
        hands.set_input("77", True)


@pytest.mark.parametrize(
    ("head", "reason"),
    [
        ({"do": "fly"}, "unknown-request"),
        ({}, "unknown-request"),
        ({"do": "do", "what": "explode"}, "unknown-order"),
        ({"do": "do", "what": "run"}, "no-number"),
        ({"do": "do", "what": "run", "rpm": "fast"}, "no-number"),
        ({"do": "do", "what": "run", "rpm": float("nan")}, "no-number"),
        ({"do": "do", "what": "run", "rpm": float("inf")}, "no-number"),
        ({"do": "do", "what": "run", "rpm": 10**400}, "no-number"),
        ({"do": "do", "what": "stop", "how": "gently"}, "unknown-stop"),
        ({"do": "do", "what": "stop"}, "unknown-stop"),
        ({"do": "hand", "name": "press_estop", "values": [1, 2]}, "wrong-values"),
        ({"do": "splice"}, "damaged"),
        ({"do": "demand"}, "no-number"),
        ({"do": "hand", "name": "__class__", "values": []}, "no-station"),
        ({"do": "hand", "name": "press_estop", "values": 3}, "no-station"),
    ],
)
def test_invalid_request_is_rejected_and_changes_nothing(
    bench: Bench, head: dict[str, object], reason: str
) -> None:
    answer = bench.host.handle_message(Message(head, NO_NUMBERS))
    assert answer.header["error"]
    assert answer.header["reason"] == reason
    assert not bench.sim.ports.axes.sample().enabled
    assert not bench.sim.ports.station.read_state().estop


@pytest.mark.parametrize("damage", [float("nan"), float("inf")])
def test_setpoints_that_are_not_finite_never_reach_a_drive(bench: Bench, damage: float) -> None:
    bench.ports.axes.enable(True)
    way = ramp(bench.clock.now() + 0.03, ZERO, 50.0, 1.0)
    way.positions[1, 1] = damage
    with raises_code(DriverError, "feeder-silent") as told:
        bench.ports.axes.splice(way)
    assert told.value.reason == "damaged"
    bench.alone(0.5)
    assert bench.sim.ports.axes.sample().actual[0] == pytest.approx(0.0, abs=0.002)


def test_driver_host_of_another_version_is_rejected(bench: Bench) -> None:
    class Older(InProcessLink):
        def send_request(self, message: Message) -> Message:
            answer = super().send_request(message)
            return Message({k: v for k, v in answer.header.items() if k != "version"}, answer.numbers)

    with raises_code(DriverError, "driver", "None", "5"):
        create_host_ports(HostConnection(Older(bench.host), bench.clock))


def receive_once(data: bytes) -> list[Message]:
    """The messages of a stream that contains this data."""
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.sendall(data)
        return list(convert_messages(MessageSocket(ours).receive()))


def test_messages_are_decoded_from_pieces_and_from_one_block() -> None:
    one = Message({"do": "look", "t": 0.1}, np.array([1.5, -2.0]))
    two = Message({"do": "hello"}, NO_NUMBERS)
    data = encode_message(one) + encode_message(two)
    ours, theirs = socket.socketpair()
    with ours, theirs:
        inbox, found = MessageSocket(ours), list[Message]()
        for piece in (*(bytes([byte]) for byte in data), data):
            theirs.sendall(piece)
            found += convert_messages(inbox.receive())
    assert [message.header for message in found] == [one.header, two.header] * 2
    assert found[0].numbers.tolist() == [1.5, -2.0]


@pytest.mark.parametrize(
    "data",
    [
        b"\x04\x00\x00\x00\x00\x00\x00\x00nope",
        b"\x02\x00\x00\x00\x00\x00\x00\x00[]",
        (100_000).to_bytes(4, "little") + bytes(4) + b"[" * 100_000,
        b"\x02\x00\x00\x00\x00\x00\x00\x00\xff\xfe",
        b"\x02\x00\x00\x00\x07\x00\x00\x00{}1234567",
        (MAX_MESSAGE_BYTES + 1).to_bytes(4, "little") + b"\x00\x00\x00\x00",
    ],
)
def test_invalid_data_on_the_socket_is_an_error(data: bytes) -> None:
    with raises_code(DriverError, "feeder-silent") as told:
        receive_once(data)
    assert told.value.reason == "no-message"


def test_slow_command_is_not_counted_as_silence_of_the_control(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    enable = bench.sim.ports.axes.enable

    def slowly(on: bool) -> None:
        bench.clock.advance(1.0)  # a drive that takes its time
        enable(on)

    bench.ports.io.write("coolant", True)
    monkeypatch.setattr(bench.sim.ports.axes, "enable", slowly)
    bench.ports.axes.enable(True)
    bench.host.run_cycle()
    assert bench.ports.io.get_outputs()["coolant"]


def test_output_that_is_not_renewed_turns_off_while_axes_still_move(bench: Bench) -> None:
    host = DriverHost(simulation_driven(bench.sim.ports, bench.sim.machine), refresh_periods={"coolant": 0.3})
    bench.host = host
    working(bench)
    host.handle_message(Message({"do": "look"}, NO_NUMBERS))
    bench.alone(0.29)
    assert bench.sim.ports.io.get_outputs()["coolant"]
    bench.alone(0.05)
    assert not bench.sim.ports.io.get_outputs()["coolant"]
    assert bench.sim.ports.axes.sample().moving


def test_loop_delay_is_logged_once_for_each_new_maximum(
    bench: Bench, caplog: pytest.LogCaptureFixture
) -> None:
    for seconds in (0.01, 0.06, 0.055, 0.08):
        bench.host.record_wakeup_delay(seconds)
    bench.ports.axes.sample()
    assert [re.findall(r"\d+ ms", line)[0] for line in caplog.messages] == ["60 ms", "80 ms"]


def test_stopped_spindle_in_a_thread_does_not_block_an_orphaned_host(bench: Bench) -> None:
    """The slides follow the spindle: one that stands in the pass never lets their queue end."""
    bench.ports.axes.enable(True)
    bench.ports.spindle.set_speed(600.0)
    bench.ports.io.write("coolant", True)
    for _ in range(20):
        bench.alone(0.1)
        bench.ports.axes.sample()
    assert bench.ports.gear is not None
    bench.ports.gear.mesh(cam(bench.sim, turns=30.0))
    bench.alone(0.15)
    bench.line.close()
    bench.sim.machine.spindle_bog(0.0)
    bench.alone(4.0)
    assert not bench.sim.ports.io.get_outputs()["coolant"]
    assert not bench.sim.ports.axes.sample().moving
    bench.alone(9.0)
    assert bench.host.is_done


# --- a control that sleeps ----------------------------------------------------------------------------------


class Sleeper:
    """A control whose machine rests, and what rings it."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.sim = build_simulation(CONFIG, self.clock)
        self.rung = 0
        axes = self.sim.ports.axes
        self.asked = False
        driven = DriverBundle(
            self.sim.ports, axes.sample, lambda: None, self.sim.machine, has_sent_requests=lambda: self.asked
        )
        self.host = DriverHost(driven, ring_bell=self._ring)
        self.bell = ProcessWakeup()
        self.line = HostConnection(InProcessLink(self.host), self.clock, wakeup_bell=self.bell)
        self.ports = create_host_ports(self.line)
        self.ports.axes.enable(True)
        self.look()

    def _ring(self) -> None:
        self.rung += 1
        self.bell.send_wakeup()

    def look(self) -> None:
        """As a tick of the control does."""
        self.clock.advance(0.1)
        self.ports.axes.sample()

    def pause(self) -> float:
        """Seconds to the driver host's next round."""
        now = self.clock.now()
        return self.host.get_next_cycle_time(now) - now

    def sleeps(self) -> bool:
        """Whether something has rung by the time the driver host has gone round once more."""
        assert self.ports.wakeup is not None
        assert self.ports.wakeup.can_rely_on_wakeups()
        self.ports.wakeup.wait_for_wakeup(0.0)
        self.clock.advance(0.005)
        self.host.run_cycle()
        return self.rung > 0


@pytest.fixture
def sleeper() -> Iterator[Sleeper]:
    made = Sleeper()
    yield made
    made.bell.close()


def test_control_does_not_sleep_while_a_poll_is_requested(sleeper: Sleeper) -> None:
    sleeper.asked = True
    sleeper.sim.machine.press_estop()
    assert not sleeper.sleeps()
    sleeper.asked = False
    assert sleeper.sleeps()


def test_one_poll_serves_a_whole_cycle_of_a_sleeping_control(sleeper: Sleeper) -> None:
    assert not sleeper.sleeps()
    sleeper.look()
    sleeper.sim.machine.press_estop()
    sleeper.clock.advance(0.01)
    assert not sleeper.ports.station.read_state().estop, "of this tick; what is new rings"
    assert sleeper.sleeps()
    assert sleeper.ports.wakeup is not None
    assert sleeper.ports.wakeup.wait_for_wakeup(0.0)
    assert sleeper.ports.station.read_state().estop


def test_sleeping_control_is_not_woken_without_a_change(sleeper: Sleeper) -> None:
    for _ in range(5):
        assert not sleeper.sleeps()
        sleeper.look()
        assert sleeper.host.is_asleep
    assert not sleeper.bell.wait_for_wakeup(0.0)


@pytest.mark.parametrize(
    "happens",
    [
        lambda sim: sim.machine.press_estop(),
        lambda sim: sim.machine.press_hold(),
        lambda sim: sim.machine.set_input("TB2-5", True),
        lambda sim: sim.machine.set_feed_pot(0.5),
        lambda sim: sim.machine.turn_handwheel(1),
        lambda sim: sim.machine.push("X", 0.1),
        lambda sim: sim.machine.drive_fault("Z"),
        lambda sim: sim.machine.spindle_fault("tripped"),
        lambda sim: sim.machine.switch_output("coolant", True),
        lambda sim: sim.machine.station_silent(),
    ],
)
def test_change_wakes_the_control_once_per_poll(
    sleeper: Sleeper, happens: Callable[[Simulation], None]
) -> None:
    assert not sleeper.sleeps()
    happens(sleeper.sim)
    for _ in range(50):  # a silent station is one after .2 s
        sleeper.clock.advance(0.005)
        sleeper.host.run_cycle()
    assert sleeper.rung == 1
    assert sleeper.bell.wait_for_wakeup(0.0)
    sleeper.host.run_cycle()
    assert sleeper.rung == 1


def test_change_between_last_poll_and_sleep_wakes_the_control(sleeper: Sleeper) -> None:
    sleeper.sim.machine.set_input("TB2-5", True)
    assert sleeper.sleeps()


def test_control_that_polls_normally_is_not_woken(sleeper: Sleeper) -> None:
    sleeper.sleeps()
    assert sleeper.ports.wakeup is not None
    sleeper.bell.send_wakeup()
    assert sleeper.ports.wakeup.wait_for_wakeup(0.0)  # something was asked for: it is awake
    sleeper.look()
    assert not sleeper.host.is_asleep
    sleeper.sim.machine.set_input("TB2-5", True)
    sleeper.host.run_cycle()
    assert sleeper.rung == 0


def test_command_ends_the_sleep(sleeper: Sleeper) -> None:
    sleeper.sleeps()
    assert sleeper.host.is_asleep
    sleeper.ports.io.write("coolant", True)
    assert not sleeper.host.is_asleep
    assert sleeper.pause() == pytest.approx(CYCLE_PERIOD_S)


def test_station_action_on_screen_wakes_its_own_control(sleeper: Sleeper) -> None:
    HostStationControls(sleeper.line).press_hold()
    assert sleeper.bell.wait_for_wakeup(0.0)


def test_sleeping_control_is_missed_after_half_a_second(sleeper: Sleeper) -> None:
    sleeper.sleeps()
    for _ in range(9):
        sleeper.clock.advance(0.05)
        sleeper.host.run_cycle()
    assert sleeper.host._notes == []
    for _ in range(3):
        sleeper.clock.advance(0.05)
        sleeper.host.run_cycle()
    (note,) = sleeper.host._notes
    assert re.search("spindle .*outputs ", note)


def test_drivers_without_an_idle_time_run_at_the_normal_cycle(sleeper: Sleeper) -> None:
    sleeper.sleeps()
    assert sleeper.pause() == pytest.approx(CYCLE_PERIOD_S)


def test_drivers_are_notified_when_the_control_sleeps_and_wakes(sleeper: Sleeper) -> None:
    told: list[bool] = []

    def idle(asleep: bool) -> float:
        told.append(asleep)
        return 9.0

    sleeper.host._driven = dataclasses.replace(sleeper.host._driven, get_idle_time=idle)
    assert sleeper.pause() == pytest.approx(CYCLE_PERIOD_S)
    sleeper.sleeps()
    assert sleeper.pause() == pytest.approx(MAX_SLEEP_CYCLE_S)
    sleeper.ports.io.write("coolant", True)
    assert sleeper.pause() == pytest.approx(CYCLE_PERIOD_S)
    assert sleeper.pause() == pytest.approx(CYCLE_PERIOD_S)
    assert told == [True, False]


def test_orphaned_driver_host_does_not_continue_sleeping(sleeper: Sleeper) -> None:
    sleeper.host._driven = dataclasses.replace(sleeper.host._driven, get_idle_time=lambda _: 9.0)
    sleeper.sleeps()
    assert sleeper.pause() == pytest.approx(MAX_SLEEP_CYCLE_S)
    sleeper.host.is_orphaned = True
    assert sleeper.pause() == pytest.approx(CYCLE_PERIOD_S)


def test_full_or_closed_wakeup_is_not_an_error() -> None:
    bell = ProcessWakeup()
    for _ in range(3000):
        bell.send_wakeup()
    assert bell.wait_for_wakeup(0.0)
    assert not bell.wait_for_wakeup(0.0)
    bell.close()
    bell.send_wakeup()


@pytest.mark.parametrize(
    ("what", "reason"),
    [
        ("hold", "no-c"),
        ("orient", "no-orientation"),
        ("release", "no-orientation"),
        ("arm", "no-touch"),
        ("dance", "unknown-order"),
    ],
)
def test_command_for_a_missing_port_is_rejected_with_the_reason(what: str, reason: str) -> None:
    sim = build_simulation(CONFIG, ManualClock())
    with raises_code(DriverError, "driver") as told:
        execute_command(sim.ports, {"what": what, "angle": 90.0, "sense": 0})
    assert told.value.reason == reason

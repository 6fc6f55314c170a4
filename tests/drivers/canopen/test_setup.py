"""Before anything moves: what is written and read back, and every way in which a node is refused."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from canopen.sdo.exceptions import SdoAbortedError

from app.compose.backends.canopen_backend import connect_canopen_machine, create_simulated_devices
from core.faults import get_fault_code
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.canopen import canopen_objects as od
from drivers.simulators.canopen_axis_drive import AxisDrive
from drivers.simulators.canopen_devices import CanopenDevices
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine, cyclic, says
from tests.drivers.machines import ramp


def test_every_drive_gets_its_stop_options_and_monitoring_settings(bench: CanBench) -> None:
    for name in ("X", "Z"):
        values = bench.peers.plant.axis_drives[name].values
        assert values[od.ABORT_OPTION, 0] == 3
        assert values[od.FAULT_OPTION, 0] == 2
        assert values[od.WINDOW, 0] == round(2.032 / 0.00127)  # .08 in
        assert values[od.QUICK_DECEL, 0] == 36000  # 120 in/s² and .2 in a turn are 600 turns/s²
        assert values[od.LIMITS, 2] == round((101.6 if name == "X" else 152.4) / 0.00127)
        assert values[od.IP_SUBMODE, 0] == -1
        assert values[od.HEARTBEAT, 0] == 100
        assert values[od.WATCHED, 1] == 127 << 16 | 300
        assert (od.QUICK_OPTION, 0) not in values  # an EPOS2 has none


def test_cyclic_drives_monitor_setpoints_and_get_the_sync_interval() -> None:
    bench = CanBench(cyclic())
    values = bench.peers.plant.axis_drives["X"].values
    assert values[od.QUICK_OPTION, 0] == 2
    assert values[od.WINDOW_TIME, 0] == 20
    assert (values[od.IP_TIME, 1], values[od.IP_TIME, 2]) == (4, -3)
    assert values[od.SYNC_PERIOD, 0] == 4000
    assert values[od.COMMANDED, 5] == 20
    assert values[od.QUICK_DECEL, 0] == 2400000  # 3048 mm/s², .00127 mm
    assert bench.machine.ports.warnings == ()
    bench.close()


def test_sdo_value_of_the_machine_file_overrides_the_default() -> None:
    bench = CanBench(can_machine(('"6007:0" = 3', '"6007:0" = 2')))
    assert bench.peers.plant.axis_drives["X"].values[od.ABORT_OPTION, 0] == 2
    bench.close()


def test_safe_output_states_are_written_to_the_module(bench: CanBench) -> None:
    board = bench.peers.nodes["io"].device
    values = board.values  # type: ignore[attr-defined]
    # the collet, bit 1 of the first byte, keeps its state; the others fall
    assert values[od.ERROR_MODE, 1] == 0xFD
    assert values.get((od.ERROR_VALUE, 1), 0) == 0  # as it is anyway: not written
    assert values[od.ANALOG_EVENTS, 0] == 1


READ_ONLY = 0x06010002  # abort code of SDO


class Recorded:
    """A device that refuses to have some objects written, and remembers what was written by SDO."""

    def __init__(self, peers: CanopenDevices, name: str, locked: frozenset[int]) -> None:
        self.written: list[int] = []
        self._locked = locked
        local = peers.nodes[name].local_node
        local.add_write_callback(self.on_write)
        local._write_callbacks.insert(0, local._write_callbacks.pop())  # before it is stored

    def on_write(self, index: int, **_: object) -> None:
        if index in self._locked:
            raise SdoAbortedError(READ_ONLY)
        self.written.append(index)


def test_a_read_only_object_with_the_wanted_value_is_not_written() -> None:
    """Interpolation time and following window are fixed in many drives."""
    machine, clock = cyclic(), ManualClock()
    peers = create_simulated_devices(machine, clock)
    window, period = round(2.032 / 0.00127), 4
    values = {(od.WINDOW, 0): window, (od.IP_TIME, 1): period, (od.IP_TIME, 2): -3}
    says(peers, "X", values)
    record = Recorded(peers, "X", frozenset((od.WINDOW, od.IP_TIME)))
    connected = connect_canopen_machine(machine, clock, peers.process_frames)
    connected.bus.close()
    peers.close()
    assert not {od.WINDOW, od.IP_TIME} & set(record.written)
    assert od.QUICK_DECEL in record.written


def test_read_only_object_with_a_different_value_is_reported_with_both() -> None:
    def spoil(peers: CanopenDevices) -> None:
        says(peers, "X", {(od.WINDOW, 0): 77})
        Recorded(peers, "X", frozenset((od.WINDOW,)))

    refused(spoil, "drive-setup", "node 1", "6065:0", "77", "1600", machine=cyclic())


def test_pdo_already_mapped_as_required_is_not_written() -> None:
    """Mapping and communication of many modules are fixed; the second connection finds all as it wants it."""
    machine, clock = cyclic(), ManualClock()
    peers = create_simulated_devices(machine, clock)
    connect_canopen_machine(machine, clock, peers.process_frames).bus.close()
    record = Recorded(peers, "X", frozenset())
    connect_canopen_machine(machine, clock, peers.process_frames).bus.close()
    peers.close()
    assert not [f"{index:04X}" for index in record.written if 0x1400 <= index < 0x1C00 and index != 0x1400]


def connected_without(machine: Machine, *lacking: int) -> tuple[str, ...]:
    """What is told of X, whose firmware has not these objects."""
    clock = ManualClock()
    peers = create_simulated_devices(machine, clock)
    for index in lacking:
        del peers.nodes["X"].local_node.object_dictionary[index]
    connected = connect_canopen_machine(machine, clock, peers.process_frames)
    connected.bus.close()
    peers.close()
    return tuple(connected.ports.warnings)


def test_all_objects_missing_in_a_drive_are_reported_in_one_warning() -> None:
    (told,) = connected_without(cyclic(), od.WINDOW, od.WINDOW_TIME, od.ABORT_OPTION, od.QUICK_DECEL)
    assert told.startswith("X: ")
    assert re.findall("([0-9A-F]{4})h", told) == ["6007", "6065", "6066", "6085"]


def test_missing_setpoint_timeout_is_reported_for_each_drive() -> None:
    told = connected_without(cyclic(drive="epos4"))
    assert [each.split(":")[0] for each in told] == ["X", "Z"]
    assert all("1400h" in each for each in told)


def test_spindle_drive_that_would_run_without_the_host_is_rejected() -> None:
    def spoil(peers: CanopenDevices) -> None:
        del peers.nodes["spindle"].local_node.object_dictionary[od.ABORT_OPTION]

    refused(spoil, "drive-setup", "spindle: node 3 ", "6007h")


def refused(
    spoil: Callable[[CanopenDevices], None], code: str, *values: str, machine: Machine | None = None
) -> None:
    """Expect that a machine with a spoilt node is not connected to, by code and named values."""
    model, clock = machine or can_machine(), ManualClock()
    peers = create_simulated_devices(model, clock)
    spoil(peers)
    try:
        with raises_code(DriverError, code, *values):
            connect_canopen_machine(model, clock, peers.process_frames)
    finally:
        peers.close()


def drive(peers: CanopenDevices, name: str = "Z") -> AxisDrive:
    return peers.plant.axis_drives[name]


def test_missing_node_is_reported_by_name() -> None:
    def spoil(peers: CanopenDevices) -> None:
        peers.nodes["Z"].is_silent = True

    refused(spoil, "drive-silent", "Z: node 2, object 1000:0: ")


def test_terminal_block_in_place_of_a_drive_is_rejected() -> None:
    def spoil(peers: CanopenDevices) -> None:
        says(peers, "Z", {(od.DEVICE_TYPE, 0): 0x000F0191})

    refused(spoil, "drive-setup", "node 2 ", "401", "402")


def test_drive_without_the_required_mode_is_rejected() -> None:
    def spoil(peers: CanopenDevices) -> None:
        says(peers, "Z", {(od.SUPPORTED, 0): 0x21})

    refused(spoil, "drive-setup", "Z: ", "interpolated position")


def test_drive_that_retains_another_value_is_rejected() -> None:
    def spoil(peers: CanopenDevices) -> None:
        says(peers, "Z", {(od.WINDOW, 0): 0xFFFFFFFF})

    refused(spoil, "drive-setup", "6065:0", "4294967295", "1600")


def test_configured_object_that_the_drive_does_not_have_is_rejected() -> None:
    machine = can_machine(('"6007:0" = 3', '"5FFF:0" = 3'))
    refused(lambda _: None, "drive-setup", "X: node 1 ", "5FFF:0", "[canopen.sdo]", machine=machine)


def test_drive_that_does_not_enable_is_reported_by_name(bench: CanBench) -> None:
    bench.peers.plant.axis_drives["Z"].power_states.refuses_power = True
    with raises_code(DriverError, "no-power", "Z", "switch on disabled"):
        bench.machine.axes.enable(True)
    bench.run(0.1)
    assert not bench.peers.plant.axis_drives["X"].power_states.is_powered  # none without the others


def test_mode_that_the_drive_does_not_accept_bars_power(bench: CanBench) -> None:
    says(bench.peers, "X", {(od.MODE_SHOWN, 0): 1})
    with raises_code(DriverError, "no-power", "X", "operation enabled"):
        bench.machine.axes.enable(True)
    assert not bench.machine.axes.sample().enabled


def test_drive_fault_is_reported_in_words_and_cleared_without_power(bench: CanBench) -> None:
    axes, plant = bench.machine.axes, bench.peers.plant

    def state(name: str) -> str:
        return plant.axis_drives[name].power_states.state.value

    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.15, (0.0, 0.0, 0.0), 60.0, 0.5))
    bench.run(0.3)
    bench.peers.machine.jam("X")
    bench.until(lambda: axes.sample().fault != "", 0.5)
    fault = axes.sample().fault
    assert get_fault_code(fault, "driver") == "following"
    assert fault.startswith("X: ")
    assert "EMCY 8611" in fault
    bench.run(0.5)
    assert state("X") == "fault"
    bench.peers.machine.jam("X", jammed=False)
    axes.clear_fault()
    assert state("X") == "switch on disabled"
    bench.run(0.5)
    assert not plant.axis_drives["X"].power_states.is_powered
    axes.enable(True)
    assert axes.sample().enabled


def test_persistent_drive_fault_is_reported_again(bench: CanBench, monkeypatch: pytest.MonkeyPatch) -> None:
    axes, power = bench.machine.axes, bench.peers.plant.axis_drives["Z"].power_states
    bench.peers.machine.drive_fault("Z")
    bench.run(0.1)
    assert get_fault_code(axes.sample().fault, "driver") == "axis"
    assert axes.sample().fault.startswith("Z: ")
    control = power.apply_control_word
    monkeypatch.setattr(power, "apply_control_word", lambda word: control(word & ~0x80))
    with raises_code(DriverError, "drive-keeps-fault", "Z: "):
        axes.clear_fault()


def test_late_driver_host_starves_the_drives_and_all_stop(bench: CanBench) -> None:
    axes = bench.machine.axes
    axes.enable(True)
    axes.splice(ramp(bench.clock.now() + 0.15, (0.0, 0.0, 0.0), 60.0, 1.0))
    bench.run(0.4)
    for _ in range(30):  # nobody feeds for 150 ms
        bench.clock.advance(0.005)
        bench.peers.process_frames()
    bench.run(0.5)
    assert "EMCY FF0C" in axes.sample().fault
    assert not any(drive.power_states.is_powered for drive in bench.peers.plant.axis_drives.values())


def test_fault_of_one_drive_stops_the_other_within_one_bus_cycle(bench: CanBench) -> None:
    axes, plant = bench.machine.axes, bench.peers.plant
    axes.enable(True)
    both = ramp(bench.clock.now() + 0.15, (0.0, 0.0, 0.0), 100.0, 0.5)
    for part in (both.positions, both.velocities, both.accelerations):
        part[:, 1] = part[:, 0]
    axes.splice(both)
    bench.run(0.4)
    plant.axis_drives["X"].power_states.enter_fault()  # silently: the status word alone tells
    took = bench.until(lambda: plant.axis_drives["Z"].power_states.is_braking, 0.1)
    assert took <= 0.01 + 0.005 + 1e-9  # until the next answer, and a tick
    bench.run(0.3)
    assert get_fault_code(axes.sample().fault, "driver") == "axis"
    assert axes.sample().fault.startswith("X: ")
    assert plant.servos[1].v == 0.0


def refused_by(machine: Machine, says_of_x: dict[tuple[int, int], int], *values: str) -> None:
    """Expect that a machine is refused whose X reports these objects."""

    def spoil(peers: CanopenDevices) -> None:
        says(peers, "X", says_of_x)

    refused(spoil, "drive-setup", *values, machine=machine)


def test_counts_per_rev_must_match_gear_and_feed_objects() -> None:
    geared = {(od.GEAR, 1): 3, (od.GEAR, 2): 1, (od.FEED, 1): 30000, (od.FEED, 2): 1}
    machine = cyclic("csp", ("X = { id = 1 }", "X = { id = 1, counts_per_rev = 4000 }"))
    refused_by(machine, geared, "X: ", "10000 counts", "6091h", "6092h", "4000")


def test_homing_method_that_the_drive_does_not_list_is_rejected() -> None:
    listed = {(od.HOME_METHODS, 0): 2, (od.HOME_METHODS, 1): 37, (od.HOME_METHODS, 2): 18}
    refused_by(cyclic("csp", absolute=False), listed, "method 1 ", "60E3h: 18, 37", "axis.X.home")

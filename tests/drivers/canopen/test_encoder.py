"""The spindle's encoder on the bus: what it measures, what it is refused for, what becomes of its loss."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import pytest

from app.compose.backends.canopen_backend import (
    create_canopen_config,
    create_simulated_devices,
    list_startup_objects,
)
from core.faults import get_fault_code
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.canopen.canopen_encoder import CanEncoder
from drivers.canopen.canopen_survey import identify_nodes
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine

OWN = (
    (
        'driver = "cia402"',
        'driver = "vfd"\n'
        'vfd = { family = "delta-vfdb", port = "/dev/ttyUSB1", stop = 2, hz_per_rpm = 0.01667 }\n'
        'encoder = { node = "turns", counts_per_rev = 4096 }',
    ),
    ("io = { id = 10,", "turns = { id = 20, profile = 406 }\nio = { id = 10,"),
    ("spindle = { id = 3 }\n", ""),
)
AT_Z = (
    *OWN,
    ('node = "turns", counts_per_rev = 4096', 'node = "Z", object = "60E4:1", counts_per_rev = -2000'),
    ("turns = { id = 20, profile = 406 }\n", ""),
)


class EncoderBench(CanBench):
    """The spindle is turned by hand: nothing on this bus does."""

    @property
    def encoder(self) -> CanEncoder:
        assert self.machine.encoder is not None
        return self.machine.encoder

    def turn(self, rpm: float) -> None:
        self.peers.plant.spindle.command_speed(self.clock.now(), rpm)

    @property
    def turns(self) -> float:
        return self.peers.plant.spindle.revolutions


@pytest.fixture(params=["own node", "at a drive"])
def stand(request: pytest.FixtureRequest) -> Iterator[EncoderBench]:
    made = EncoderBench(can_machine(*(OWN if request.param == "own node" else AT_Z)))
    yield made
    made.close()


@pytest.fixture
def own() -> Iterator[EncoderBench]:
    made = EncoderBench(can_machine(*OWN))
    yield made
    made.close()


# --- what it measures -------------------------------------------------------------------------------------


@pytest.mark.parametrize("rpm", [3500.0, 60.0, -1800.0])
def test_encoder_speed_and_angle_match_the_spindle(stand: EncoderBench, rpm: float) -> None:
    stand.turn(rpm)
    stand.run(3.0)
    spindle = stand.machine.ports.spindle
    assert spindle.speed() == pytest.approx(rpm, abs=2.0)
    read = spindle.read_angle()
    assert read is not None
    t, turns = read
    assert turns == pytest.approx(stand.turns - rpm / 60.0 * (stand.clock.now() - t), abs=0.01)
    assert spindle.read_fault() == ""


def test_stopped_spindle_has_zero_measured_speed(stand: EncoderBench) -> None:
    stand.turn(500.0)
    stand.run(1.0)
    stand.turn(0.0)
    stand.run(1.0)
    assert stand.encoder.measure_rpm() == 0.0


def test_encoder_continues_when_its_counter_wraps() -> None:
    stand = EncoderBench(can_machine(*OWN))
    assert stand.peers.encoder is not None
    stand.peers.encoder.turns = 16
    stand.encoder.connect()
    stand.encoder.start_node()
    stand.turn(3000.0)
    stand.run(4.0)
    read = stand.encoder.read_angle()
    assert read is not None
    assert read[1] == pytest.approx(stand.turns, abs=0.8)
    assert stand.turns > 100.0
    assert stand.encoder.read_fault() == ""
    stand.close()


def test_encoder_node_alone_cannot_turn_the_spindle(own: EncoderBench) -> None:
    own.machine.ports.spindle.set_speed(0.0)
    with raises_code(DriverError, "spindle-off") as told:
        own.machine.ports.spindle.set_speed(100.0)
    assert told.value.reason == "no-drive"


# --- what it is refused for -------------------------------------------------------------------------------


def refused(machine: Machine, *values: str, **says: int) -> None:
    """Expect that connecting refuses an encoder that reports ``says`` and names ``values``."""
    stand = EncoderBench(machine)
    for name, value in says.items():
        setattr(stand.peers.encoder, name, value)
    try:
        with raises_code(DriverError, "driver", "turns: ", *values):
            stand.encoder.connect()
    finally:
        stand.close()


def test_count_other_than_in_the_machine_file_is_rejected() -> None:
    refused(can_machine(*OWN), "5000", "6501:0", "4096", steps=5000)


def test_a_single_turn_encoder_is_refused_for_a_fast_spindle() -> None:
    refused(can_machine(*OWN), "after 1 rev,", "2.3", "4.67", turns=1)


def test_node_that_is_not_an_encoder_is_rejected() -> None:
    stand = EncoderBench(can_machine(*OWN))
    module = stand.machine.io.modules["io"]
    assert stand.machine.config.encoder is not None
    other = dataclasses.replace(stand.machine.config.encoder, node=module.config)
    wrong = CanEncoder(other, stand.machine.bus, None)
    with raises_code(DriverError, "drive-setup", "401", "406"):
        wrong.connect()
    stand.close()


# --- its loss ---------------------------------------------------------------------------------------------


def test_silent_encoder_is_reported_and_does_not_disable_the_axes(own: EncoderBench) -> None:
    own.machine.axes.enable(True)
    own.peers.nodes["turns"].is_silent = True
    own.run(0.5)
    fault = own.machine.ports.spindle.read_fault()
    assert get_fault_code(fault, "driver") == "spindle-encoder"
    assert "turns: " in fault
    assert "SYNC" in fault
    assert own.machine.axes.sample().fault == ""
    own.peers.nodes["turns"].is_silent = False
    own.run(0.2)
    assert own.machine.ports.spindle.read_fault() != ""  # only a reset clears it
    own.machine.axes.clear_fault()
    own.run(0.3)
    assert own.machine.ports.spindle.read_fault() == ""


def test_encoder_restart_is_reported(own: EncoderBench) -> None:
    own.run(0.1)
    own.peers.nodes["turns"].boot_up()
    own.run(0.05)
    fault = own.machine.ports.spindle.read_fault()
    assert get_fault_code(fault, "driver") == "spindle-encoder"
    assert "turns: " in fault
    assert "SYNC" not in fault
    own.machine.axes.clear_fault()
    own.turn(600.0)
    own.run(1.5)
    assert own.encoder.measure_rpm() == pytest.approx(600.0, abs=2.0)


def test_jump_in_the_count_is_reported_as_an_encoder_fault(own: EncoderBench) -> None:
    assert own.peers.encoder is not None
    own.run(0.1)
    own.peers.encoder.stuck = 40960
    own.run(0.05)
    fault = own.machine.ports.spindle.read_fault()
    assert get_fault_code(fault, "driver") == "spindle-encoder"
    assert "turns: " in fault


def test_emergency_message_of_the_encoder_is_reported(own: EncoderBench) -> None:
    own.peers.nodes["turns"].send_emergency(0x5000)
    own.run(0.05)
    assert "EMCY 5000" in own.machine.ports.spindle.read_fault()


def test_bus_survey_includes_the_encoder() -> None:
    clock, machine = ManualClock(), can_machine(*OWN)
    peers = create_simulated_devices(machine, clock)
    found = {
        one.name: one for one in identify_nodes(create_canopen_config(machine), clock, peers.process_frames)
    }
    peers.close()
    assert (found["turns"].node_id, found["turns"].error_text) == (20, "")
    assert "CiA 406" in found["turns"].detail_text


# --- the values that are written to it at startup ---------------------------------------------------------


def test_startup_objects_include_an_encoder_with_its_own_node() -> None:
    plain = list_startup_objects(can_machine(*OWN))
    sdo = ("[canopen]\n", '[canopen.sdo.turns]\n"6000:0" = 4\n[canopen]\n')
    changed = list_startup_objects(can_machine(*OWN, sdo))
    assert changed["turns"] == (*plain["turns"], (0x6000, 0, 4))
    assert {name for name in plain if plain[name] != changed[name]} == {"turns"}


def test_startup_objects_of_an_encoder_at_a_drive_are_those_of_the_drive() -> None:
    assert "turns" not in list_startup_objects(can_machine(*AT_Z))
    assert list_startup_objects(can_machine(*AT_Z))["Z"] == list_startup_objects(can_machine())["Z"]

"""An inverter that only a file next to the machine file knows."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path

import pytest

from app.cli.main import main
from app.compose.machine.machine_files import parse_machine
from core.faults import get_fault_code
from core.ports import DriverError
from core.table_schema import MachineFileError
from drivers.inverter.inverter_control import InverterControl
from drivers.inverter.inverter_spindle import create_inverter_control
from drivers.inverter.inverter_table import InverterTable
from drivers.inverter.modbus_rtu import MAX_TRIES
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.inverter.benches import OWN, bench, config
from tests.drivers.inverter.inverter_simulators import (
    Inverter,
    MyDriveMemory,
    NoCoils,
    RefusedByDeviceError,
    RtuSlave,
)
from tests.drivers.inverter.lines import ModbusServer, Pair, inverter
from tests.drivers.inverter.test_lines import machine_file
from tests.drivers.inverter.wires import BenchWire
from tests.late_computer import stalls_told

DECIHERTZ = """
name = "Tenths and signs"
manual = "none"
protocol = "modbus"
line = { baud = [9600, 19200], parity = ["E"] }
frequency = { register = 2, counts_per_hz = 10, signed = true }
highest = { name = "P-01", register = 129, counts_per_hz = 10 }
parameter = [{ name = "P-36", register = 164, counts_per_s = 1000, write = true }]
[command]
stop = [{ register = 1, value = 0 }]
forward = [{ register = 1, value = 1 }]
reverse = [{ register = 1, value = 1 }]
reset = [{ register = 1, value = 4 }]
[[read]]
register = 6
count = 4
[report]
setpoint = { register = 9, counts_per_hz = 10, signed = true }
output = { register = 7, counts_per_hz = 10, signed = true }
current = { register = 8, counts_per_a = 10 }
run = { register = 6, mask = 1, values = [1] }
reverse = { register = 7, mask = 0x8000, values = [0x8000] }
asked_reverse = { register = 9, mask = 0x8000, values = [0x8000] }
fault = { register = 6, mask = 2, values = [2] }
fault_code = { register = 6, mask = 0xFF00 }
"""


class DecihertzMemory(NoCoils):
    """Frequencies in tenths of a hertz, negative in reverse."""

    def __init__(self, inverter: Inverter) -> None:
        self.inverter = inverter
        self.timeout = 0

    def word(self, address: int) -> int:
        inverter = self.inverter
        back = -1 if inverter.turns_back else 1
        asked = -1 if inverter.back else 1
        shown = {
            6: inverter.running | bool(inverter.trip) << 1 | inverter.trip << 8,
            7: round(inverter.output / 10) * back & 0xFFFF,
            8: 31,
            9: round(inverter.hz * 10) * asked & 0xFFFF,
            129: 600,
            164: self.timeout,
        }
        if address not in shown:
            raise RefusedByDeviceError(2)
        return shown[address]

    def set_word(self, address: int, value: int) -> None:
        inverter = self.inverter
        if address == 164:
            self.timeout = value
        elif address == 2:
            signed = value - 0x10000 if value & 0x8000 else value
            inverter.hz, inverter.back = abs(signed) / 10, signed < 0
            if inverter.running:
                inverter.obey(run=True)
        elif value == 4:
            inverter.resets, inverter.trip = inverter.resets + 1, 0
        else:
            inverter.obey(run=value == 1)


def tenths(folder: Path) -> tuple[InverterControl, DecihertzMemory, Callable[[float], None]]:
    """Attended on a bench, connected; and what lets the line be attended for some seconds."""
    (folder / "tenths.toml").write_text(DECIHERTZ)
    clock = ManualClock()
    memory = DecihertzMemory(Inverter(clock))
    wire = BenchWire(RtuSlave(memory), clock)
    one = create_inverter_control(own(parity="E"), wire.opened, clock, folder)
    one.open_and_check_line()

    def run(seconds: float) -> None:
        end = clock.now() + seconds
        while clock.now() < end:
            one.run_exchange()

    return one, memory, run


def own(**more: object) -> InverterTable:
    return dataclasses.replace(config("tenths.toml"), **more)  # type: ignore[arg-type]


def test_own_family_file_turns_the_spindle_in_both_directions(tmp_path: Path) -> None:
    one, memory, run = tenths(tmp_path)
    assert (one.warnings, memory.timeout) == ((), 1500)
    for hz in (20.04, -33.36, 0.0):  # tenths that no register can hold
        one.commanded_hz = hz
        run(4.0)
        assert one.failure == ""
        assert memory.inverter.rpm / 60 == pytest.approx(hz, abs=0.06)
        assert one.last_poll is not None
        assert one.last_poll.inverter_state.signed_output_hz == pytest.approx(hz, abs=0.06)


def test_a_setpoint_that_is_off_by_two_steps_is_still_a_fault(tmp_path: Path) -> None:
    one, memory, run = tenths(tmp_path)
    one.commanded_hz = 20.0
    run(2.0)
    memory.inverter.hz = 20.2
    run(3.0)
    assert get_fault_code(one.failure, "driver") == "ignores-stop"


def test_fault_code_without_a_text_is_reported_by_number(tmp_path: Path) -> None:
    one, memory, run = tenths(tmp_path)
    memory.inverter.trip_with(0x12)
    run(1.0)
    assert get_fault_code(one.failure, "driver") == "spindle"
    assert str(0x1200) in one.failure
    one.clear_fault()
    run(1.0)
    assert (memory.inverter.resets, one.failure) == (1, "")


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"baud": 4800}, "baud"),
        ({"baud": 38400}, "baud"),
        ({"parity": "N"}, "parity"),
        ({"rpm_max": 200_000.0}, "max-hz"),  # 3333 Hz, of 3276.7
    ],
)
def test_function_not_supported_by_the_inverter_is_rejected(
    tmp_path: Path, wrong: dict[str, object], reason: str
) -> None:
    (tmp_path / "tenths.toml").write_text(DECIHERTZ)
    clock = ManualClock()
    wire = BenchWire(RtuSlave(DecihertzMemory(Inverter(clock))), clock)
    with raises_code(DriverError, "driver", "Tenths and signs") as told:
        create_inverter_control(own(**{"parity": "E", **wrong}), wire.opened, clock, tmp_path)
    assert told.value.reason == reason
    assert wire.sent == []


@pytest.mark.parametrize("family", ["", "delta", "Delta-VFDB", "my-drive.tml", "../my-drive"])
def test_family_neither_shipped_nor_a_file_is_rejected(tmp_path: Path, family: str) -> None:
    text = machine_file(tmp_path, family, "/dev/ttyUSB1").read_text()
    with pytest.raises(MachineFileError) as told:
        parse_machine(text, "own.toml")
    assert [(each.path, each.code) for each in told.value.findings] == [("spindle.vfd.family", "wrong-value")]


# --- Replies that must not be believed.


class Rejects(RtuSlave):
    """Rejects reads that begin at one address."""

    def __init__(self, memory: MyDriveMemory, address: int) -> None:
        super().__init__(memory)
        self._address = address

    def _body(self, function: int, data: bytes) -> bytes:
        if function == 3 and int.from_bytes(data[:2], "big") == self._address:
            raise RefusedByDeviceError(2)
        return super()._body(function, data)


def test_rejected_reads_are_reported_as_a_silent_inverter() -> None:
    one = bench(OWN)
    assert isinstance(one.memory, MyDriveMemory)
    one.wire.slave = Rejects(one.memory, 0x0020)
    assert one.until_fault(4.0) <= 2.5
    assert get_fault_code(one.spindle.read_fault(), "driver") == "inverter-silent"


@pytest.mark.parametrize("count", [0, 6, 8])
def test_response_with_wrong_register_count_is_not_a_valid_poll(count: int) -> None:
    one = bench(OWN)
    assert isinstance(one.memory, MyDriveMemory)
    one.wire.slave = Shortened(one.memory, count)
    assert one.until_fault(4.0) <= 2.5
    assert get_fault_code(one.spindle.read_fault(), "driver") == "inverter-silent"


class Shortened(RtuSlave):
    """Answers a read of seven registers with another number of them."""

    def __init__(self, memory: MyDriveMemory, count: int) -> None:
        super().__init__(memory)
        self._count = count

    def _body(self, function: int, data: bytes) -> bytes:
        if function == 3 and data[2:4] == b"\x00\x07":
            return bytes((3, 2 * self._count)) + bytes(2 * self._count)
        return super()._body(function, data)


def test_write_confirmed_for_another_register_is_sent_again() -> None:
    one = bench(OWN)
    assert isinstance(one.memory, MyDriveMemory)
    one.wire.slave = Elsewhere(one.memory)
    one.wire.sent.clear()
    one.spindle.set_speed(600.0)
    one.attendant.run_exchange()
    assert [frame[1:4] for frame in one.wire.sent] == [b"\x10\x00\x02"] * MAX_TRIES
    assert one.until_fault(6.0) <= 5.0
    assert one.attendant.commanded_hz == 0.0


class Elsewhere(RtuSlave):
    """Confirms each write for the next register."""

    def _body(self, function: int, data: bytes) -> bytes:
        body = super()._body(function, data)
        return body[:2] + bytes((body[2] + 1,)) + body[3:] if function == 16 else body


def test_trip_with_an_unreadable_code_is_still_a_fault() -> None:
    one = bench(OWN)
    one.spindle.set_speed(600.0)
    one.run(1.5)
    one.inverter.trip_with(7)
    assert isinstance(one.memory, MyDriveMemory)
    one.wire.slave = Rejects(one.memory, 0x0080)
    assert one.until_fault(4.0) <= 2.5
    one.run(3.0)
    assert one.attendant.commanded_hz == 0.0


# --- The whole way, against a Modbus server of others.


@pytest.mark.real_time
def test_machine_check_reads_a_family_next_to_the_machine_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir("/")
    with stalls_told(), Pair() as cable, ModbusServer(cable.far, MyDriveMemory(inverter())):
        path = machine_file(tmp_path, OWN, cable.near)
        assert main(["machine", "check", str(path), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert {port["name"]: port["verdict"] for port in report["ports"]}["spindle"] == "ok"


@pytest.mark.parametrize("text", [None, "count = 0"])
def test_machine_check_names_the_family_file_that_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str | None
) -> None:
    if text is not None:
        (tmp_path / "other.toml").write_text(text)
    path = machine_file(tmp_path, "other.toml", "/dev/ttyNONE7")
    assert main(["machine", "check", str(path), "--json"]) != 0
    assert f"{tmp_path}/other.toml" in capsys.readouterr().out

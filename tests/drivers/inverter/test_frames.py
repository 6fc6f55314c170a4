"""Frames by known examples of manuals, and what must not pass for an answer."""

from __future__ import annotations

import pytest

from drivers.inverter import modbus_rtu
from drivers.inverter.family_files import load_inverter_family
from drivers.inverter.modbus_rtu import ModbusMaster, NoResponseError, RequestRejectedError
from drivers.inverter.register_family import RegisterInverter
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.inverter.benches import FOLDER, OWN, far_end
from tests.drivers.inverter.inverter_simulators import DeltaMemory, HitachiMemory, Inverter, RtuSlave
from tests.drivers.inverter.wires import BenchWire


@pytest.mark.parametrize(
    ("body", "crc"),
    [
        # Huanyang, stop: list of Bouni
        ("01 03 01 08", "F1 8E"),
        # Huanyang at unit 4, read PD001, and its answer: a log of an HY01D523B
        ("04 01 03 01 00 00", "6D DB"),
        ("04 01 02 01 02", "F5 AD"),
        # INVT's manual, 9.4.1: read two words from 0004
        ("01 03 00 04 00 02", "85 CA"),
        # Hitachi WJ200's manual, Ver.3-29: read 4001h, and its answer
        ("01 03 40 00 00 01", "91 CA"),
        ("01 03 02 00 10", "B9 88"),
        # the same, Ver.3-34: write FFFF to 4003h
        ("01 06 40 02 FF FF", "3C 7A"),
        # Yaskawa's V1000 and J1000 manuals: read four words from 0020h at unit 2, its refusal, loopback
        ("02 03 00 20 00 04", "45 F0"),
        ("02 83 03", "F1 31"),
        ("01 08 00 00 A5 37", "DA 8D"),
    ],
)
def test_crc_matches_frames_in_manuals(body: str, crc: str) -> None:
    assert modbus_rtu.append_crc(bytes.fromhex(body)) == bytes.fromhex(body + crc)
    assert modbus_rtu.has_valid_crc(bytes.fromhex(body + crc))


@pytest.mark.parametrize(
    ("pdu", "expected"),
    [
        (modbus_rtu.encode_read_request(3, 0x2103, 1), "03 21 03 00 01"),
        (modbus_rtu.encode_write_coil(0, True), "05 00 00 FF 00"),
        (modbus_rtu.encode_write_coil(1, False), "05 00 01 00 00"),
        (modbus_rtu.encode_write_register(0x2001, 6000), "06 20 01 17 70"),
        (modbus_rtu.encode_write_registers(0, (0, 5000)), "10 00 00 00 02 04 00 00 13 88"),
        (modbus_rtu.encode_echo_request(0xA537), "08 00 00 A5 37"),
    ],
)  # fmt: skip
def test_modbus_requests_are_encoded(pdu: bytes, expected: str) -> None:
    assert pdu == bytes.fromhex(expected)


def test_response_is_found_between_noise_bytes() -> None:
    frame = modbus_rtu.append_crc(bytes.fromhex("01 03 02 00 10"))
    assert modbus_rtu.find_response(b"\x01\x03" + frame + b"\xff", 1, 3) == frame
    assert modbus_rtu.find_response(frame[:-1], 1, 3) is None
    assert modbus_rtu.find_response(frame, 2, 3) is None  # another unit's
    assert modbus_rtu.find_response(frame, 1, 4) is None  # to another question


def line_to(slave: RtuSlave) -> tuple[ModbusMaster, BenchWire, ManualClock]:
    clock = ManualClock()
    wire = BenchWire(slave, clock)
    return ModbusMaster(wire, clock, 1, 10 / 9600), wire, clock


def delta() -> RtuSlave:
    return RtuSlave(DeltaMemory(Inverter(ManualClock())))


def test_every_function_reads_and_writes() -> None:
    inverter = Inverter(ManualClock())
    modbus, _, _ = line_to(RtuSlave(HitachiMemory(inverter)))
    modbus.write_registers(0, (0, 4250))
    assert modbus.read_registers(0, 2) == [0, 4250]
    modbus.write_register(1, 1234)
    assert modbus.read_registers(1) == [1234]
    modbus.write_coil(1, True)
    assert modbus.read_coils(0, 2) == [False, True]


def test_modbus_exception_is_reported_by_number_and_not_retried() -> None:
    modbus, wire, _ = line_to(delta())
    with raises_code(RequestRejectedError, "driver", "03") as told:
        modbus.read_registers(0x7777)
    assert told.value.reason == "exception-2"
    with raises_code(RequestRejectedError, "driver", "01") as told:
        modbus.read_coils(0)
    assert told.value.reason == "exception-1"
    assert len(wire.sent) == 2


def test_silent_device_is_tried_three_times() -> None:
    modbus, wire, clock = line_to(delta())
    wire.silent = True
    with raises_code(NoResponseError, "driver") as told:
        modbus.read_registers(0x2103)
    assert told.value.reason == "silent"
    assert len(wire.sent) == 3
    assert clock.now() == pytest.approx(0.6, abs=0.05)  # three answers of .2 s at most


def test_noise_is_distinguished_from_silence() -> None:
    modbus, wire, _ = line_to(delta())
    wire.noise, wire.spoils = b"\x55\x55", True
    with raises_code(NoResponseError, "driver", "10 bytes") as told:
        modbus.read_registers(0x2103)
    assert told.value.reason == "garbled"


def test_pending_stop_ends_the_retries() -> None:
    modbus, wire, _ = line_to(delta())
    wire.silent, modbus.is_stop_pending = True, lambda: True
    with pytest.raises(NoResponseError):
        modbus.read_registers(0x2103)
    assert len(wire.sent) == 1


def test_late_response_is_not_used_for_the_next_request() -> None:
    """The answer to the first question comes after the second has been sent."""
    slave = delta()
    modbus, wire, _ = line_to(slave)
    slave.memory.inverter.hz = 33.33
    wire.delay = 0.25
    with pytest.raises(NoResponseError):
        modbus.read_registers(0x0100)  # 6000, asked for in vain
    wire.delay = 0.02
    assert modbus.read_registers(0x2102) == [3333]


def test_requests_are_spaced_by_the_minimum_interval() -> None:
    modbus, _, clock = line_to(delta())
    for _ in range(10):
        modbus.read_registers(0x2103)
    assert clock.now() >= 9 * 0.03


def test_reset_is_sent_once_even_without_a_response() -> None:
    modbus, wire, _ = line_to(delta())
    wire.silent = True
    with pytest.raises(NoResponseError):
        modbus.write_register(0x2000, 0x2000, max_tries=1)
    assert len(wire.sent) == 1


def on_bench(name: str) -> tuple[RegisterInverter, BenchWire, ManualClock]:
    """A family on its line, without anybody who attends it."""
    clock = ManualClock()
    _, slave = far_end(name, Inverter(clock))
    wire = BenchWire(slave, clock)
    table = load_inverter_family(name, FOLDER)
    assert table.register_table is not None
    line = ModbusMaster(wire, clock, 1, 10 / 9600)
    return RegisterInverter(table, table.register_table, line, clock), wire, clock


@pytest.mark.parametrize(
    ("name", "first", "next_speed", "other_way"),
    [("delta-vfdb", 2, 1, 2), ("hitachi-wj200", 3, 3, 3), (OWN, 2, 2, 2)],
)
def test_run_command_is_repeated_as_the_family_requires(
    name: str, first: int, next_speed: int, other_way: int
) -> None:
    family, wire, _ = on_bench(name)
    counts = []
    for hz in (20.0, 30.0, -30.0):
        wire.sent.clear()
        family.command_frequency_hz(hz)
        counts.append(len(wire.sent))
    assert counts == [first, next_speed, other_way]


@pytest.mark.parametrize(("name", "tries"), [("delta-vfdb", 1), ("hitachi-wj200", 3), (OWN, 3)])
def test_reset_is_retried_as_often_as_the_family_specifies(name: str, tries: int) -> None:
    family, wire, _ = on_bench(name)
    wire.silent = True
    with pytest.raises(NoResponseError):
        family.reset_trip()
    assert len(wire.sent) == tries


def test_family_specifies_the_delay_after_a_reset() -> None:
    waits = {}
    for name in ("delta-vfdb", "hitachi-wj200"):
        family, _, clock = on_bench(name)
        family.reset_trip()
        waits[name] = clock.now() >= 1.0
    assert waits == {"delta-vfdb": False, "hitachi-wj200": True}

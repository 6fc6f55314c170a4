"""What an inverter's settings are looked at for when the line is opened."""

from __future__ import annotations

import re

import pytest

from core.ports import DriverError
from drivers.inverter.modbus_rtu import NoResponseError
from drivers.serial_line import SerialLineError
from tests.coded import raises_code
from tests.drivers.inverter.benches import FAMILIES, OWN, bench
from tests.drivers.inverter.inverter_simulators import (
    DeltaMemory,
    HitachiMemory,
    HuanyangSlave,
    MyDriveMemory,
)
from tests.texts import begins


def test_delta_timeout_is_written_once() -> None:
    one = bench("delta-vfdb")
    assert isinstance(one.memory, DeltaMemory)
    assert (one.memory.settings[0x0902], one.memory.settings[0x0903]) == (1, 15)  # ramp, 1.5 s in tenths
    assert one.attendant.warnings == ()
    one.memory.written.clear()
    one.attendant.close()
    one.attendant.open_and_check_line()
    assert [address for address, _ in one.memory.written if address < 0x2000] == []


def test_hitachi_timeout_is_written() -> None:
    one = bench("hitachi-wj200")
    assert isinstance(one.memory, HitachiMemory)
    assert (one.memory.settings[0x113C], one.memory.settings[0x113D]) == (4, 150)  # ramp, hundredths
    assert one.attendant.warnings == ()


def test_huanyang_has_no_timeout_and_reports_it() -> None:
    warnings = bench("huanyang").attendant.warnings
    assert len(warnings) == 1
    assert begins(warnings[0], "drivers.inverter-no-timeout", name="Huanyang HY")


@pytest.mark.parametrize(
    ("family", "register", "value", "named"),
    [
        ("delta-vfdb", 0x0201, 0, ["Pr.02-01", "0", "3"]),
        ("delta-vfdb", 0x0100, 5000, ["Pr.01-00", "50 Hz", "58.33"]),
        ("hitachi-wj200", 0x1201, 2, ["A002", "2", "3"]),
        ("hitachi-wj200", 0x1203, 500, ["A004", "50 Hz"]),
        (OWN, 0x0181, 1, ["P1-02", "1", "2"]),
        (OWN, 0x0435, 20, ["P5-09", "20", "15", "1.5 s"]),
        (OWN, 0x0303, 500, ["P2-04", "50 Hz"]),
    ],
)
def test_differing_user_settings_are_reported_and_not_changed(
    family: str, register: int, value: int, named: list[str]
) -> None:
    one = bench(family, connect=False)
    assert not isinstance(one.memory, HuanyangSlave)
    one.memory.settings[register] = value
    one.attendant.open_and_check_line()
    (warning,) = one.attendant.warnings
    assert all(each in warning for each in named)
    assert one.memory.settings[register] == value


def test_settings_unknown_to_the_inverter_are_reported() -> None:
    one = bench("delta-vfdb", connect=False)
    assert isinstance(one.memory, DeltaMemory)
    del one.memory.settings[0x0903]
    one.attendant.open_and_check_line()
    assert len(one.attendant.warnings) == 1
    assert "Pr.09-03" in one.attendant.warnings[0]


def test_unreadable_maximum_frequency_is_reported() -> None:
    one = bench(OWN, connect=False)
    assert isinstance(one.memory, MyDriveMemory)
    del one.memory.settings[0x0303]
    one.attendant.open_and_check_line()
    (warning,) = one.attendant.warnings
    assert warning.startswith("P2-04 ")


def test_huanyang_controlled_by_its_keypad_is_reported() -> None:
    one = bench("huanyang", connect=False)
    assert isinstance(one.memory, HuanyangSlave)
    one.memory.parameters[1] = 0
    one.attendant.open_and_check_line()
    assert any(re.search(r"PD001 .*\b0\b.*\b2\b", warning) for warning in one.attendant.warnings)


def test_huanyang_start_after_a_lost_response_needs_ten_valid_ones() -> None:
    one = bench("huanyang")
    assert one.attendant.is_inverter_trusted
    one.wire.loses = 1
    one.attendant.run_exchange()
    assert not one.attendant.is_inverter_trusted
    with raises_code(DriverError, "spindle-off") as told:
        one.spindle.set_speed(100.0)
    assert told.value.reason == "not-ready"
    one.run(1.0)
    one.spindle.set_speed(100.0)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize(("fault", "kind"), [("silent", NoResponseError), ("out", SerialLineError)])
def test_missing_inverter_is_reported_in_one_line(family: str, fault: str, kind: type[DriverError]) -> None:
    one = bench(family, connect=False)
    setattr(one.wire, fault, True)
    with pytest.raises(kind):
        one.attendant.open_and_check_line()


@pytest.mark.parametrize("family", FAMILIES)
def test_spindle_turning_at_connection_is_stopped(family: str) -> None:
    one = bench(family, connect=False)
    one.inverter.hz, one.inverter.running = 30.0, True
    one.inverter.obey(run=True)
    one.clock.advance(2.0)
    assert one.rpm == pytest.approx(1800.0)
    one.attendant.open_and_check_line()
    one.run(2.0)
    assert one.rpm == 0.0
    assert one.spindle.read_fault() == ""

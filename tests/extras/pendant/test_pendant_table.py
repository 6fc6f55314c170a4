"""[pendant] of a machine file: what may be at a pendant, and that nothing is started by it."""

from __future__ import annotations

from dataclasses import replace

import pytest

import resources
from app.compose.backends.connection import connect_machine
from app.compose.backends.machine_check import check_machine
from app.compose.machine.machine_files import parse_machine
from app.extras.pendant.driver.input_devices import AxisRange
from app.extras.pendant.driver.pendant_table import PendantModel
from app.extras.pendant.pendant_setup import add_pendant, remove_pendant
from core.machine.machine_model import Machine
from core.table_schema import MachineFileError
from drivers.wakeups import ManualClock
from tests.extras.pendant.made import ABS_HAT0X, Peer
from tests.texts import text as wording

PENDANT = """
[pendant]
device = "0b33:0030"
counts = "place"

[io.analog]
handwheel = { at = "pendant.REL_DIAL" }
"""
BUTTONS = """[io.in]
wheel_x = { at = "pendant.BTN_0" }
wheel_step = { at = "pendant.BTN_2" }
jog_z_minus = { at = "pendant.ABS_HAT0X-" }
start_inhibit = { at = "pendant.BTN_1" }
"""


def text(*changes: tuple[str, str]) -> str:
    found = resources.read_machine_file("gt75.toml").replace("[io.in]\n", BUTTONS) + PENDANT
    for old, new in changes:
        assert old in found
        found = found.replace(old, new)
    return found


def refused(*changes: tuple[str, str]) -> str:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text(*changes), "test")
    return str(caught.value)


def test_pendant_table_is_read_and_removed_from_the_backend_machine() -> None:
    machine = parse_machine(text(), "test")
    assert machine.hardware.find_driver_table(PendantModel) == PendantModel("0b33:0030", "", "place")
    backend = remove_pendant(machine)
    assert not {"wheel_x", "start_inhibit"} & set(backend.inputs)
    assert "handwheel" not in backend.hardware.analog_inputs
    assert "guard" in backend.inputs


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            'start = { at = "IN-2" }',
            'start = { at = "pendant.BTN_START" }',
            "a pendant cannot start anything",
        ),
        ("wheel_x =", "cycle_start =", "a pendant cannot start anything"),
        ("wheel_x =", "palm_left =", "a pendant cannot start anything"),
        ("wheel_x =", "spindle_auto =", "a pendant cannot start anything"),
        (
            'estop = { at = "IN-1", active = "low" }',
            'estop = { at = "pendant.BTN_A" }',
            "USB is not suitable for this signal",
        ),
        (
            'guard = { at = "IN-4" }',
            'guard = { at = "pendant.BTN_A" }',
            "USB is not suitable for this signal",
        ),
        ('coolant = { at = "OUT-1"', 'coolant = { at = "pendant.BTN_A"', "a pendant cannot switch an output"),
        ("pendant.BTN_2", "pendant.BTN_0", "io.in.wheel_x already uses"),
        ("pendant.BTN_2", "pendant.BTN_NOPE", "expected the Linux name of a button"),
        ("pendant.REL_DIAL", "pendant.BTN_A", "expected the Linux name of a handwheel"),
        ("wheel_step", "wheel_axis", "already makes this selection"),
        ("jog_z_minus", "jog_y_minus", "is not a jog button; use one of jog_rapid, jog_x_plus"),
        (
            '[pendant]\ndevice = "0b33:0030"\ncounts = "place"\n',
            "",
            f"[pendant]: {wording('machine.pendant-missing', used='io.in.wheel_x')}",
        ),
        ('counts = "place"', 'counts = "clicks"', "pendant.counts"),
        ("handwheel = {", "feed_pot = {", "the handwheel is the only analog input that can be on a pendant"),
    ],
)
def test_invalid_pendant_table_is_rejected(old: str, new: str, expected: str) -> None:
    assert expected in refused((old, new))


def test_pendant_table_without_button_assignments_is_rejected() -> None:
    found = resources.read_machine_file("gt75.toml") + '\n[pendant]\ndevice = "Knob"\n'
    with pytest.raises(MachineFileError) as caught:
        parse_machine(found, "test")
    (finding,) = caught.value.findings
    assert finding.path == "[pendant]"
    assert "pendant.BTN_B" in finding.expected_value


def test_missing_pendant_fails_its_row_in_machine_check(monkeypatch: pytest.MonkeyPatch) -> None:
    """``machine check`` names it, and what to do; the machine answers all the same."""
    monkeypatch.setattr("app.extras.pendant.pendant_setup.list_input_devices", list)
    answers = check_machine(parse_machine(text(), "test"))
    rows = {each.name: each for each in answers.rows}
    assert (rows["pendant"].at, rows["pendant"].state) == ("0b33:0030", "no answer")
    assert "not plugged in" in rows["pendant"].detail
    assert any("pendant" in each for each in answers.faults)
    assert {rows[name].result_text for name in ("X", "Z", "spindle", "input wheel_x")} == {"not checked"}


def test_connected_pendant_is_read_alongside_the_machine() -> None:
    peer = Peer({ABS_HAT0X: AxisRange(-1, 1, 0)})
    machine = parse_machine(text(), "test")
    connected = add_pendant(
        machine, connect_machine(remove_pendant(replace_pendant(machine)), ManualClock()), lambda *_: [peer]
    )
    try:
        assert connected.ports.warnings == ()
        assert not connected.ports.io.inputs()["wheel_x"]
        assert "guard" in connected.ports.io.inputs()
        assert connected.ports.station.read_state().trouble == ""
    finally:
        connected.close()
    assert peer.closed


def replace_pendant(machine: Machine) -> Machine:
    """The same without its table: what is behind the pendant."""
    tables = {path: each for path, each in machine.hardware.tables.items() if path != "pendant"}
    return replace(machine, hardware=replace(machine.hardware, tables=tables))

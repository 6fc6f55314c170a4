"""A board whose cable is out: its inputs are frozen, so nothing that they report may let the machine run."""

from __future__ import annotations

import math

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from core.faults import get_fault_code
from core.ports import ALL_UNKNOWN_PARTS, DriverError
from core.table_schema import MachineFileError
from drivers.hal.boards.hal_file_builder import render_hal_file
from tests.coded import raises_code
from tests.drivers.hal.played import powered
from tests.drivers.hal.test_hal_files import written

ERRORS = 0.02  # s, more than hm2_eth's packet errors and one report take


def test_lost_board_opens_the_chain_at_rest_despite_frozen_estop_input() -> None:
    with powered() as bench:
        bench.far.is_cable_disconnected = True
        bench.far.plant_controls.press_estop()  # what the board sees reaches nobody
        bench.run(ERRORS)
        assert not bench.driver.io.inputs()["estop"]
        assert bench.pin("chain-ok") == 0.0
        assert bench.pin("powered") == 0.0
        assert bench.bridge[1] == "hal-board"
        assert get_fault_code(bench.driver.axes.fault, "driver") == "hal-board"


def test_lost_board_with_drives_off_is_also_a_fault() -> None:
    with powered() as bench:
        bench.axes.enable(False)
        bench.run(0.3)
        assert not bench.driver.axes.fault
        bench.far.is_cable_disconnected = True
        bench.run(ERRORS)
        assert get_fault_code(bench.driver.axes.fault, "driver") == "hal-board"


def test_frozen_inputs_have_infinite_age_and_are_unknown() -> None:
    with powered() as bench:
        assert bench.driver.io.read_state().age < 0.1
        assert not bench.driver.find_unknown_parts()
        bench.far.is_cable_disconnected = True
        bench.run(ERRORS)
        assert bench.driver.io.read_state().age == math.inf
        assert bench.driver.find_unknown_parts() == ALL_UNKNOWN_PARTS


def test_lost_board_removes_power_in_motion_and_stops_the_spindle() -> None:
    with powered() as bench:
        bench.driver.spindle.set_speed(500.0)
        bench.x_goes(5.0)
        bench.run(0.3)
        bench.far.is_cable_disconnected = True
        bench.run(0.5)
        place = bench.x
        bench.run(0.5)
        assert bench.x == place
        assert bench.driver.spindle.commanded_rpm == 0.0
        with raises_code(DriverError, "spindle-off"):
            bench.driver.spindle.set_speed(500.0)


def test_reset_reloads_hal_only_after_the_board_is_reconnected() -> None:
    with powered() as bench:
        bench.far.is_cable_disconnected = True
        bench.run(0.1)
        for _ in range(2):  # hm2_eth does not load without its card
            with raises_code(DriverError, "hal-setup"):
                bench.axes.clear_fault()
            bench.run(0.1)
            assert get_fault_code(bench.driver.axes.fault, "driver") == "hal-board"
            assert bench.driver.find_unknown_parts() == ALL_UNKNOWN_PARTS
        thread = bench.far.servo_thread
        bench.far.is_cable_disconnected = False
        bench.run(0.5)
        assert bench.driver.axes.fault  # hm2_eth does not read again before HAL is loaded again
        bench.axes.clear_fault()
        bench.run(0.1)
        assert not bench.driver.axes.fault
        assert bench.far.servo_thread is not thread
        assert not bench.driver.find_unknown_parts()
        assert not bench.axes.sample().enabled


@pytest.mark.parametrize("name", ["gt75-mesa-7i76e", "gt75-mesa-7i97", "gt75-ethercat"])
def test_machine_file_without_the_link_fault_of_its_board_is_rejected(name: str) -> None:
    text = resources.read_machine_file(f"{name}.toml")
    line = next(each for each in text.splitlines() if each.startswith("link_fault"))
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text.replace(f"{line}\n", ""), f"{name}.toml")
    assert [each.path for each in caught.value.findings] == ["hal.link_fault"]


def test_board_input_requires_the_link_fault_without_a_board_table_too() -> None:
    text = (
        resources.read_machine_file("gt75-hal.toml")
        .replace('link_fault = "link-fault"', "")
        .split("[board]")[0]
    )
    parse_machine(text, "gt75-hal.toml")
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text.replace('"in-estop-ok"', '"hm2_5i25.0.gpio.003.in"'), "gt75-hal.toml")
    assert [each.path for each in caught.value.findings] == ["hal.link_fault"]


@pytest.mark.parametrize(
    ("name", "pins"),
    [
        ("gt75-mesa-7i76e", {"hm2_7i76e.0.packet-error-exceeded", "hm2_7i76e.0.watchdog.has_bit"}),
        ("gt75-mesa-7i97", {"hm2_7i97.0.packet-error-exceeded", "hm2_7i97.0.watchdog.has_bit"}),
        (
            "gt75-ethercat",
            {"lcec.0.link-up", "lcec.0.all-op"}
            | {f"lcec.0.{slave}.slave-oper" for slave in ("x", "z", "spindle", "DI", "DO")},
        ),
    ],
)
def test_communication_pins_of_every_board_are_in_the_board_link(name: str, pins: set[str]) -> None:
    nets = [
        line.split()
        for line in render_hal_file(written(name)).splitlines()
        if line.startswith("net board-link-")
    ]
    assert pins <= {words[2] for words in nets}
    assert all(words[3].startswith("board-link.in-") for words in nets)

"""A guard that stops the machine needs its switch among the inputs."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine_files import parse_machine
from tests.machine.test_hardware import assert_refused, changed

LINE = "guard_stops = true"
STOPPED = (
    "gt75",
    "gt75-canopen",
    "gt75-epos4",
    "gt75-vfd",
    "gt75-mesa-7i76e",
    "gt75-mesa-7i97",
    "gt75-ethercat",
)


@pytest.mark.parametrize("name", STOPPED)
def test_the_shipped_lathe_and_the_boards_stop_at_the_guard_and_start_with_two_hands(name: str) -> None:
    machine = parse_machine(resources.machine_file(f"{name}.toml"), f"{name}.toml")
    assert machine.interlocks.guard_stops
    assert machine.interlocks.two_hand_start
    assert {"guard", "start", "hold"} <= set(machine.inputs)


def test_left_out_it_is_shown_and_stops_nothing() -> None:
    assert not parse_machine(changed(LINE, ""), "can").interlocks.guard_stops


def test_without_its_switch_it_is_refused() -> None:
    text = changed(LINE, LINE).replace("\nguard ", "\nlid ")
    assert "\nlid " in text
    assert_refused(text, "interlocks.guard_stops", "input guard")

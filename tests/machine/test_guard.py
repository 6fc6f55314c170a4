"""A guard that stops the machine needs its switch among the inputs."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from tests.machine.test_hardware import assert_refused, changed
from tests.texts import text as wording

LINE = "guard_stops = true"
STOPPED = (
    "gt75",
    "gt75-canopen",
    "gt75-epos4",
    "gt75-vfd",
    "gt75-mesa-7i76e",
    "gt75-mesa-7i97",
    "gt75-ethercat",
    "gt75-grblhal",
)
BENCHES = ("gt75-bench", "gt75-hal")  # without hardware, and so without palm buttons


@pytest.mark.parametrize("name", STOPPED)
def test_the_shipped_lathe_and_the_boards_stop_at_the_guard_and_start_with_two_hands(name: str) -> None:
    machine = parse_machine(resources.read_machine_file(f"{name}.toml"), f"{name}.toml")
    assert machine.interlocks.guard_stops
    assert machine.interlocks.two_hand_start
    assert {"guard", "start", "hold"} <= set(machine.inputs)


@pytest.mark.parametrize("name", BENCHES)
def test_a_bench_stops_at_the_guard_with_start_and_hold_wired(name: str) -> None:
    machine = parse_machine(resources.read_machine_file(f"{name}.toml"), f"{name}.toml")
    assert machine.interlocks.guard_stops
    assert {"guard", "start", "hold"} <= set(machine.inputs)


def test_left_out_it_is_shown_and_stops_nothing() -> None:
    assert not parse_machine(changed(LINE, ""), "can").interlocks.guard_stops


def test_without_its_switch_it_is_refused() -> None:
    text = changed(LINE, LINE).replace("\nguard ", "\nlid ")
    assert "\nlid " in text
    assert_refused(text, "interlocks.guard_stops", wording("machine.needs-guard"))


def test_a_parallel_port_has_no_input_left_for_a_guard_and_promises_none() -> None:
    text = resources.read_machine_file("gt75-parport.toml")
    machine = parse_machine(text, "gt75-parport.toml")
    assert not machine.interlocks.guard_stops
    assert not machine.interlocks.two_hand_start
    assert machine.inputs["estop"].is_active_low  # the guard opens this circuit
    assert_refused(
        text.replace("two_hand_start = false", "guard_stops = true\ntwo_hand_start = false"),
        "interlocks.guard_stops",
        wording("machine.needs-guard"),
    )


def test_a_guard_at_an_input_that_grblhal_reads_at_rest_only_stops_nothing_and_is_refused() -> None:
    text = resources.read_machine_file("gt75-grblhal.toml")
    assert 'guard = { at = "pn.D", active = "low" }' in text
    assert_refused(text.replace('"pn.D", active = "low"', '"in.1"'), "io.in.guard.at", "pn.D")

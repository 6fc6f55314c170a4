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
def test_shipped_lathes_stop_at_guard_and_need_two_hand_start(name: str) -> None:
    machine = parse_machine(resources.read_machine_file(f"{name}.toml"), f"{name}.toml")
    assert machine.interlocks.guard_stops
    assert machine.interlocks.two_hand_start
    assert {"guard", "start", "hold"} <= set(machine.inputs)


@pytest.mark.parametrize("name", BENCHES)
def test_bench_machines_stop_at_guard_with_start_and_hold_inputs(name: str) -> None:
    machine = parse_machine(resources.read_machine_file(f"{name}.toml"), f"{name}.toml")
    assert machine.interlocks.guard_stops
    assert {"guard", "start", "hold"} <= set(machine.inputs)


def test_guard_does_not_stop_machine_without_guard_stops() -> None:
    assert not parse_machine(changed(LINE, ""), "can").interlocks.guard_stops


def test_guard_stops_without_guard_input_is_rejected() -> None:
    text = changed(LINE, LINE).replace("\nguard ", "\nlid ")
    assert "\nlid " in text
    assert_refused(text, "interlocks.guard_stops", wording("machine.needs-guard"))


def test_parallel_port_machine_rejects_guard_stops() -> None:
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


def test_grblhal_guard_must_be_at_realtime_input() -> None:
    text = resources.read_machine_file("gt75-grblhal.toml")
    assert 'guard = { at = "pn.D", active = "low" }' in text
    assert_refused(text.replace('"pn.D", active = "low"', '"in.1"'), "io.in.guard.at", "pn.D")

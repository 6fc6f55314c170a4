"""A handwheel in the machine file: its counts and the switches beside it."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from tests.machine.test_hardware import assert_refused, changed
from tests.texts import text as wording

PADS = "[io.analog]"
WHEEL = '\nhandwheel = { at = "401.6401.3", counts_per_click = -4 }'
SWITCHES = '[io.in]\nwheel_x = { at = "401.6000.5.0" }\nwheel_x10 = { at = "401.6000.5.1" }'


def with_wheel(switches: str = "[io.in]") -> str:
    return changed("[io.in]", switches, changed(PADS, PADS + WHEEL))


def test_handwheel_with_switches_is_read() -> None:
    machine = parse_machine(with_wheel(SWITCHES), "can")
    assert machine.hardware.analog_inputs["handwheel"].counts_per_click == -4
    assert {"wheel_x", "wheel_x10"} <= set(machine.inputs)
    assert machine.hardware.analog_inputs["feed_pot"].counts_per_click == 1


@pytest.mark.parametrize(
    ("old", "new", "path", "expected"),
    [
        ("= -4", "= 0", "io.analog.handwheel.counts_per_click", "negative if"),
        ("= -4", "= 2000", "io.analog.handwheel.counts_per_click", "1000"),
        ("= -4", "= 1.5", "io.analog.handwheel.counts_per_click", "whole"),
        (
            "range = [0, 1.5]",
            "counts_per_click = 2",
            "io.analog.feed_pot.counts_per_click",
            wording("machine.pot-without-clicks"),
        ),
    ],
)
def test_invalid_handwheel_counts_are_rejected(old: str, new: str, path: str, expected: str) -> None:
    assert_refused(changed(old, new, with_wheel()), path, expected)


def test_handwheel_switches_without_handwheel_are_rejected() -> None:
    text = changed("[io.in]", SWITCHES)
    assert_refused(text, "io.in.wheel_x", "add the handwheel under [io.analog]")


def test_switch_for_missing_axis_is_rejected() -> None:
    assert_refused(
        with_wheel('[io.in]\nwheel_y = { at = "401.6000.5.0" }'), "io.in.wheel_y", "one of wheel_enable"
    )


def test_handwheel_is_rejected_without_counter_input() -> None:
    text = resources.read_machine_file("gt75-grblhal.toml") + '\n[io.analog]\nhandwheel = { at = "in.0" }\n'
    assert_refused(text, "io.analog.handwheel", "does not have a counter input")

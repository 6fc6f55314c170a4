"""A guard that stops the machine needs its switch among the inputs."""

from __future__ import annotations

from app.compose.machine_files import parse_machine
from tests.machine.test_hardware import assert_refused, changed

STOPS = ("[interlocks]", "[interlocks]\nguard_stops = true")


def test_it_stops_where_its_switch_is_wired() -> None:
    assert parse_machine(changed(*STOPS), "can").interlocks.guard_stops


def test_left_out_it_is_shown_and_stops_nothing() -> None:
    assert not parse_machine(changed("[interlocks]", "[interlocks]"), "can").interlocks.guard_stops


def test_without_its_switch_it_is_refused() -> None:
    text = changed(*STOPS).replace("\nguard ", "\nlid ")
    assert "\nlid " in text
    assert_refused(text, "interlocks.guard_stops", "input guard")

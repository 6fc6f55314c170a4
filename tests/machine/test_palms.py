"""Two palm buttons are one input, that of a relay; buttons wired one by one are refused with the reason."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import parse_machine
from tests.machine.test_hardware import CAN, assert_refused, changed


@pytest.mark.parametrize(
    "name", ["palm_left", "palm_right", "left_palm", "palm1", "start_1", "start2", "Palm_2"]
)
def test_a_single_palm_button_is_refused(name: str) -> None:
    text = changed("[io.in]", f'[io.in]\n{name} = {{ at = "401.6000.5.0" }}')
    assert_refused(text, f"io.in.{name}", "two-hand relay")


def test_two_hand_relay_output_and_other_inputs_are_accepted() -> None:
    more = '[io.in]\npalm_rest = { at = "401.6000.5.0" }\nstarted = { at = "401.6000.5.1" }'
    assert "start" in parse_machine(CAN.replace("\n[io.in]", "\n" + more), "can").inputs

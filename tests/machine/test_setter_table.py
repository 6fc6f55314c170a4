"""[setter] of a machine file."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from core.machine.setter_table import ToolSetterModel
from core.table_schema import MachineFileError
from tests.texts import text as wording

PROBE = '[io.in]\nprobe = { at = "IN-7" }\n'
SETTER = """
[setter]
x = 0.5
z = 1.0
width = 0.25
overtravel = 0.15
speed = 20
slow = 0.5
"""


def text(*changes: tuple[str, str]) -> str:
    found = resources.read_machine_file("gt75.toml").replace("[io.in]\n", PROBE) + SETTER
    for old, new in changes:
        assert old in found
        found = found.replace(old, new)
    return found


def test_tool_setter_gives_touch_position() -> None:
    setter = parse_machine(text(), "test").hardware.find_driver_table(ToolSetterModel)
    assert setter is not None
    assert setter.compute_touch_position("X", -1) == pytest.approx(25.4 * (0.5 + 0.125))
    assert setter.compute_touch_position("Z", 1) == pytest.approx(25.4 * (1.0 - 0.125))


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('probe = { at = "IN-7" }\n', "", f"io.in.probe: {wording('machine.setter-needs-input')}"),
        ("speed = 20\nslow", "speed = 100\nslow", "exceeds setter.overtravel; reduce the speed"),
        ("slow = 0.5", "slow = 15", "setter.slow"),
        ("speed = 20\nslow = 0.5", "speed = 0.3\nslow = 0.5", wording("machine.setter-too-fast")),
        ("width = 0.25", "width = 0", "setter.width"),
    ],
)
def test_invalid_setter_is_rejected(old: str, new: str, expected: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text((old, new)), "test")
    assert expected in str(caught.value)

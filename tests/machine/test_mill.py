"""Machine files of mills: slides first, then the rotary axes that are there."""

from __future__ import annotations

import math

import pytest

from app.compose.machine.machine_files import load_named_machine, parse_machine
from core.table_schema import MachineFileError
from tests.machine.mill import MILL


def test_linear_axes_are_listed_before_rotary_axes() -> None:
    machine = parse_machine(MILL, "mill")
    assert [axis.name for axis in machine.axes] == ["X", "Y", "Z", "A", "C"]
    assert [axis.is_rotary for axis in machine.axes] == [False, False, False, True, True]
    assert not machine.is_c_enabled  # its C is an axis of its own, not the spindle


def test_rotary_axis_values_are_in_degrees_and_seconds() -> None:
    machine = parse_machine(MILL, "mill")
    a, c = machine.find_axis("A"), machine.find_axis("C")
    assert a.travel == (-120.0, 120.0)
    assert c.travel is None
    assert math.isclose(a.max_speed, 60.0)  # 3600 degrees a minute
    assert a.max_acceleration == 720.0


@pytest.mark.parametrize(
    ("change", "path"),
    [
        (("[axis.Y]", "[axis.U]"), "axis.U"),
        (("[axis.Y]", "[axis.U]"), "[axis.Y]"),
        (("[io.out]", "[collet]\nopen_s = 1\nclose_s = 1\n[io.out]"), "[collet]"),
        (('kind = "mill"', 'kind = "router"'), "machine.kind"),
        (('kind = "mill"', 'kind = "mill"\nlanguage = "sinumerik"'), "machine.language"),
        (('kind = "mill"', 'kind = "mill"\nlanguage = "klarttext"'), "machine.language"),
        (
            ("travel = [-120.0, 120.0]\nabsolute = true", "travel = [10.0, 120.0]\nabsolute = true"),
            "axis.A.travel",
        ),
        (("travel = [-120.0, 120.0]\nabsolute = true", "travel = [-120.0, 120.0]"), "axis.A.absolute"),
    ],
)
def test_invalid_mill_file_is_rejected(change: tuple[str, str], path: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(MILL.replace(*change, 1), "mill")
    assert path in str(caught.value)


def test_machine_kind_sets_mdi_language() -> None:
    assert parse_machine(MILL, "mill").mdi_language == "klartext"
    assert load_named_machine("gt75").mdi_language == "omniturn"
    assert load_named_machine("sinumerik-linear").mdi_language == "sinumerik"


def test_y_axis_is_rejected_on_lathe() -> None:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(MILL.replace('kind = "mill"', 'kind = "lathe"'), "lathe")
    assert ("axis.Y", "unknown-key") in {(each.path, each.code) for each in caught.value.findings}

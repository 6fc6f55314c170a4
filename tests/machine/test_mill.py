"""Machine files of mills: slides first, then the rotary axes that are there."""

from __future__ import annotations

import math

import pytest

from core.machine.load import MachineFileError, parse_machine

SLIDE = """
travel = [-500.0, 500.0]
vmax = 15000
amax = 3000
count = 0.001
fe_window = 2.0
in_pos = 0.005
absolute = true
"""
ROTARY = """
vmax = 3600
amax = 720
count = 0.001
fe_window = 2.0
in_pos = 0.01
"""
MILL = f"""
[machine]
name = "M"
units = "mm"
kind = "mill"
commit_ms = 30
lookahead_ms = 1000
low_water_ms = 80
lease_ms = 60
setpoint_ms = 1
[limits]
max_feed = 15000
manual_rapid = 5000
resolution = 0.001
clearance = 40.0
[axis.X]{SLIDE}[axis.Y]{SLIDE}[axis.Z]{SLIDE}
[axis.A]{ROTARY}
travel = [-120.0, 120.0]
absolute = true
[axis.C]{ROTARY}
absolute = true
[spindle]
rpm = [50, 8000]
accel_rpm_s = 4000
decel_rpm_s = 4000
at_speed_pct = 5
at_speed_s = 0.3
timeout_s = 5
stop_below = 5
encoder_ppr = 0
[io.out]
coolant = {{ at = "OUT-1", safe = false }}
[io.in]
estop = {{ at = "IN-1", active = "low" }}
start = {{ at = "IN-2" }}
[interlocks]
spindle_with_collet_open = true
"""


def test_the_axes_come_slides_first() -> None:
    machine = parse_machine(MILL, "mill")
    assert [axis.name for axis in machine.axes] == ["X", "Y", "Z", "A", "C"]
    assert [axis.rotary for axis in machine.axes] == [False, False, False, True, True]
    assert not machine.c_enabled  # its C is an axis of its own, not the spindle


def test_rotary_figures_are_degrees_and_seconds() -> None:
    machine = parse_machine(MILL, "mill")
    a, c = machine.axis("A"), machine.axis("C")
    assert a.travel == (-120.0, 120.0)
    assert c.travel is None
    assert math.isclose(a.vmax, 60.0)  # 3600 degrees a minute
    assert a.amax == 720.0


@pytest.mark.parametrize(
    ("change", "path"),
    [
        (("[axis.Y]", "[axis.U]"), "axis.U"),
        (("[axis.Y]", "[axis.U]"), "[axis.Y]"),
        (("[io.out]", "[collet]\nopen_s = 1\nclose_s = 1\n[io.out]"), "[collet]"),
        (('kind = "mill"', 'kind = "router"'), "machine.kind"),
        (
            ("travel = [-120.0, 120.0]\nabsolute = true", "travel = [10.0, 120.0]\nabsolute = true"),
            "axis.A.travel",
        ),
        (("travel = [-120.0, 120.0]\nabsolute = true", "travel = [-120.0, 120.0]"), "axis.A.absolute"),
    ],
)
def test_what_a_mill_cannot_be(change: tuple[str, str], path: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(MILL.replace(*change, 1), "mill")
    assert path in str(caught.value)


def test_a_lathe_has_no_y() -> None:
    with pytest.raises(MachineFileError, match=r"axis\.Y"):
        parse_machine(MILL.replace('kind = "mill"', 'kind = "lathe"'), "lathe")

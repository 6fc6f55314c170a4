"""The example of the specification as it stands, and what stands in for each value that it leaves out."""

from __future__ import annotations

import pytest

import resources
from app.compose.machine.machine_files import load_machine, parse_machine
from core.table_schema import FileFinding, MachineFileError
from tests.machine.spoil import spec_text
from tests.texts import text as wording


def findings(text: str) -> list[FileFinding]:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text, "test.toml")
    return list(caught.value.findings)


def without(*lines: str) -> str:
    """The shipped file less these lines, which must be there."""
    text = resources.read_machine_file("gt75.toml")
    for line in lines:
        assert line in text, line
        text = text.replace(line, "", 1)
    return text


def test_the_example_of_the_specification_loads() -> None:
    machine = parse_machine(spec_text(), "spec")
    x, z, c = machine.axes
    assert x.travel == pytest.approx((-2.54, 152.4))
    assert (x.max_acceleration, z.max_acceleration) == pytest.approx((4064.0, 4064.0))  # 160 in/s²
    assert machine.timing.setpoint_duration_s == 0.001
    assert z.following_error_window == x.following_error_window == pytest.approx(0.04 * 25.4)
    assert z.in_position_tolerance == x.in_position_tolerance == pytest.approx(0.0002 * 25.4)
    assert not machine.is_c_enabled
    assert (c.max_acceleration, c.following_error_window, c.in_position_tolerance) == pytest.approx(
        (3600.0, 5.0, 0.1)
    )  # 600 rpm/s
    assert machine.spindle.deceleration_rpm_s == 1500
    assert (machine.limits.max_feed, machine.limits.manual_rapid) == pytest.approx((127.0, 100 * 25.4 / 60))
    assert (machine.limits.resolution, machine.limits.clearance) == pytest.approx((0.00127, 31.75))
    assert (machine.collet.open_time_s, machine.collet.close_time_s) == (0.5, 0.5)
    assert machine.hardware.analog_inputs["spindle_pot"].switch == "spindle_auto"


def test_example_on_bus_needs_spindle_driver_and_wired_switch() -> None:
    text = spec_text().replace('backend = "sim"', 'backend = "canopen"', 1)
    told = {finding.path: finding.expected_value for finding in findings(text)}
    # bits 0 to 5 of the module's first byte are taken by estop … end_of_bar
    assert told["io.analog.spindle_pot.switch"].endswith('spindle_auto = { at = "401.6000.1.6" }')
    assert "at least 100" in told["machine.commit_ms"]  # three records of 20 ms and a restart of 40 ms
    spindle = wording("machine.no-spindle-driver", allowed="cia402 or vfd", backend='"canopen"')
    assert told["spindle.driver"] == spindle


def test_pot_switch_with_other_name_must_be_wired() -> None:
    text = without().replace("[sim]\n", '[io.analog]\nspindle_pot = { at = "A", switch = "auto" }\n[sim]\n')
    (found,) = findings(text)
    assert found.path == "io.analog.spindle_pot.switch"
    assert 'auto = { at = "IN-…" }' in found.expected_value
    assert parse_machine(text.replace('"auto"', '"spindle_auto"'), "t").hardware.analog_inputs["spindle_pot"]


def test_missing_axis_values_are_derived_from_speed_and_count() -> None:
    text = without("fe_window = 0.08", "in_pos = 0.0002", "[limits]", "max_feed = 300", "manual_rapid = 100")
    text = (
        text.replace("resolution = 0.00005\n", "").replace("fe_window = 0.08", "").replace("clearance =", "#")
    )
    machine = parse_machine(text.replace("in_pos = 0.0002", ""), "t")
    for slide in machine.axes[:2]:
        # Position loop of 40 Hz, damping 1: lag 2 / (2 · 3.1416 · 40) s = 7.958 ms, at 127 mm/s, twice
        assert slide.following_error_window == pytest.approx(2.0213, abs=1e-4)
        assert slide.in_position_tolerance == pytest.approx(4 * 0.00127)
    assert machine.limits.max_feed == pytest.approx(127.0)


def test_slow_axis_limits_feed_and_manual_rapid() -> None:
    text = without("[limits]", "max_feed = 300", "manual_rapid = 100", "resolution = 0.00005").replace(
        "vmax = 300", "vmax = 60", 1
    )
    machine = parse_machine(text.replace("clearance =", "#"), "t")
    assert machine.limits.max_feed == machine.limits.manual_rapid == pytest.approx(25.4)  # 60 in/min


def test_a_lathe_without_a_c_axis_needs_no_table_for_it() -> None:
    text = without()
    start, end = text.index("[axis.C]"), text.index("[c_axis]")
    machine = parse_machine(text[:start] + text[end:], "t")
    assert not machine.is_c_enabled
    assert [axis.name for axis in machine.axes] == ["X", "Z", "C"]


def test_enabled_c_axis_needs_speed_and_count() -> None:
    found = findings(without("vmax = 200", "count = 0.02"))
    assert [finding.path for finding in found] == ["axis.C.vmax", "axis.C.count"]


def test_collet_without_switch_needs_its_times() -> None:
    text = without("close_s = 0.30", 'collet_closed = { at = "IN-5" }')
    text = text.replace("spindle_with_collet_open = false", "spindle_with_collet_open = true")
    assert [finding.path for finding in findings(text)] == ["collet.close_s"]


@pytest.mark.parametrize(
    ("line", "path"),
    [
        ("vmax = 300", "axis.X.vmax"),
        ("amax = 120", "axis.X.amax"),
        ("count = 0.00005", "axis.X.count"),
        ("travel = [-4.0, 4.0]", "axis.X.travel"),
        ("commit_ms = 30", "machine.commit_ms"),
        ("lease_ms = 200", "machine.lease_ms"),
        ("rpm = [50, 3500]", "spindle.rpm"),
        ("accel_rpm_s = 1500", "spindle.accel_rpm_s"),
        ("encoder_ppr = 1024", "spindle.encoder_ppr"),
        ('estop = { at = "IN-1", active = "low" }', "io.in.estop"),
    ],
)
def test_missing_value_without_safe_default_is_rejected(line: str, path: str) -> None:
    assert [finding.path for finding in findings(without(line))] == [path]


def test_shipped_lathe_uses_no_defaults() -> None:
    machine = load_machine(None)
    assert (machine.collet.open_time_s, machine.spindle.deceleration_rpm_s) == (0.25, 2500)


@pytest.mark.parametrize(("stated", "power"), [("", 0.0), ("power_kw = 2.2\n", 2200.0)])
def test_the_power_of_the_spindle_is_stated_in_kilowatts(stated: str, power: float) -> None:
    text = without().replace("[spindle]\n", f"[spindle]\n{stated}", 1)
    assert parse_machine(text, "t").spindle.power_w == pytest.approx(power)


@pytest.mark.parametrize("wrong", ["0", "-1.5", "1500", '"1.5"', "true", "nan"])
def test_spindle_power_out_of_range_is_rejected(wrong: str) -> None:
    """0.05 kW to 100 kW; 1500 are watts."""
    text = without().replace("[spindle]\n", f"[spindle]\npower_kw = {wrong}\n", 1)
    (found,) = findings(text)
    assert found.path == "spindle.power_kw"

"""The machine file: what it becomes, and everything that is refused, by path."""

from __future__ import annotations

from pathlib import Path

import pytest

import resources
from app.compose.machine.machine_files import load_machine, parse_machine
from core.table_schema import FileFinding, MachineFileError
from tests.coded import raises_code
from tests.texts import text as wording

SHIPPED = resources.read_machine_file("gt75.toml")


def changed(old: str, new: str) -> str:
    """The shipped file with one text replaced, which must be there."""
    assert old in SHIPPED
    return SHIPPED.replace(old, new, 1)


def findings(text: str) -> tuple[FileFinding, ...]:
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text, "test.toml")
    return caught.value.findings


def only(text: str) -> FileFinding:
    found = findings(text)
    assert len(found) == 1, found
    return found[0]


def test_shipped_lathe_is_read_in_model_units() -> None:
    machine = load_machine(None)
    x, z, c = machine.axes
    assert (x.name, z.name, c.name) == ("X", "Z", "C")
    assert x.travel == pytest.approx((-101.6, 101.6))
    assert z.travel == pytest.approx((-152.4, 152.4))
    assert (x.max_speed, x.max_acceleration) == pytest.approx((127.0, 3048.0))  # 300 in/min, 120 in/s²
    assert (x.count_size, machine.limits.resolution) == pytest.approx((0.00127, 0.00127))
    assert c.travel is None
    assert c.max_speed == pytest.approx(1200.0)  # 200 rpm in degrees/s
    assert machine.limits.max_feed == 300 * 25.4 / 60  # the very number an F300 word gives
    assert machine.limits.manual_rapid == 100 * 25.4 / 60


def test_shipped_lathe_has_its_times_spindle_and_interlocks() -> None:
    machine = load_machine(None)
    timing, spindle = machine.timing, machine.spindle
    assert (
        timing.commit_time_s,
        timing.lookahead_time_s,
        timing.low_water_time_s,
        timing.motion_lease_s,
    ) == (0.03, 1.0, 0.08, 0.2)
    assert timing.setpoint_duration_s == 0.001
    assert (machine.collet.open_time_s, machine.collet.close_time_s) == (0.25, 0.3)
    assert (spindle.min_rpm, spindle.max_rpm, spindle.acceleration_rpm_s, spindle.deceleration_rpm_s) == (
        50,
        3500,
        1500,
        2500,
    )
    assert (spindle.at_speed_tolerance, spindle.at_speed_time_s, spindle.timeout_s) == (0.05, 0.3, 5)
    assert not machine.interlocks.spindle_with_collet_open
    assert machine.interlocks.unclamp_while_turning
    assert machine.interlocks.two_hand_start
    assert all(axis.is_position_absolute for axis in machine.axes)


def test_shipped_io_signals_and_m_codes() -> None:
    machine = load_machine(None)
    assert machine.outputs["collet"].safe_state is None
    assert machine.outputs["coolant"].safe_state is False
    assert machine.inputs["estop"].is_active_low
    assert {"TB2-5", "TB2-7", "TB2-9", *(str(n) for n in range(1, 17))} <= set(machine.inputs)
    assert machine.m_code_outputs[25] == ("catcher", True)
    assert machine.m_code_outputs[16] == ("live1", False)
    assert 11 not in machine.m_code_outputs  # the loader option is off until its owner enables it


def test_metric_file_is_read_in_millimeters(tmp_path: Path) -> None:
    text = changed('units = "inch"', 'units = "mm"').replace("travel = [-4.0, 4.0]", "travel = [-100, 100]")
    text = text.replace("clearance = 1.25", "clearance = 30")
    path = tmp_path / "metric.toml"
    path.write_text(
        text.replace("fe_window = 0.08", "fe_window = 2")
        .replace("0.00005", "0.001")
        .replace("0.0002", "0.005")
    )
    machine = load_machine(path)
    assert machine.axes[0].travel == (-100, 100)
    assert machine.axes[0].max_speed == 5.0  # 300 mm/min
    assert machine.source == str(path)


def test_enabled_loader_code_is_available() -> None:
    text = SHIPPED.replace("on = false, enabled = false", "on = false, enabled = true")
    text = text.replace('11 = { output = "loader_feed", on = true, enabled = false }', "")
    assert parse_machine(text, "t").m_code_outputs[10] == ("loader_feed", False)


def test_unknown_key_names_the_nearest() -> None:
    found = only(changed("vmax = 300\n", "vmax = 300\nvmaxx = 3\n"))
    assert found.path == "axis.X.vmaxx"
    assert "did you mean vmax?" in found.expected_value


def test_file_without_units_still_has_other_values_checked() -> None:
    text = "[spindle]\nrpm = [20, 3500]\naccel_rpm_s = 0\nat_speed_s = 0.3\ntimeout_s = 5\n"
    assert "spindle.accel_rpm_s = 0: expected a number, 10…50000 rpm/s" in map(str, findings(text))


def test_unknown_table_lists_known_tables() -> None:
    found = only(SHIPPED + "\n[profibus]\nbaud = 1000000\n")
    assert found.path == "[profibus]"
    assert "[machine], [limits], [axis]" in found.expected_value


@pytest.mark.parametrize(
    ("old", "new", "path", "expected"),
    [
        ('units = "inch"', 'units = "furlong"', "machine.units", '"inch", "mm"'),
        ('backend = "sim"', 'backend = "canbus"', "machine.backend", '"sim", "canopen", "grblhal"'),
        ('name = "GT-75"', 'name = ""', "machine.name", wording("machine.nonblank-text")),
        ("commit_ms = 30", 'commit_ms = "30"', "machine.commit_ms", "1…200 ms"),
        ("commit_ms = 30", "commit_ms = true", "machine.commit_ms", "1…200 ms"),
        ("amax = 120", "amax = nan", "axis.X.amax", "in/s²"),
        ("amax = 120", "amax = " + "9" * 400, "axis.X.amax", "in/s²"),
        ("vmax = 300", "vmax = 30000", "axis.X.vmax", "in/min"),
        ("fe_window = 0.08", "fe_window = 4294967295", "axis.X.fe_window", "in"),
        ("travel = [-4.0, 4.0]", "travel = [4.0, -4.0]", "axis.X.travel", "[low, high]"),
        ("travel = [-4.0, 4.0]", "travel = [-4.0]", "axis.X.travel", "two numbers"),
        ("encoder_ppr = 1024", "encoder_ppr = 1024.5", "spindle.encoder_ppr", "a whole number"),
        ("two_hand_start = true", "two_hand_start = 1", "interlocks.two_hand_start", "true or false"),
        ('active = "low"', 'active = "down"', "io.in.estop.active", '"high", "low"'),
        ('safe = "keep"', "safe = 0", "io.out.collet.safe", 'true, false, "keep"'),
        ("seed = 1", "seed = -1", "sim.seed", "a whole number, 0…"),
        ("[c_axis]\nfeedback = false", "c_axis = 3", "axis.C.c_axis", "unknown key"),
    ],
)
def test_invalid_value_is_reported_with_expected_value(old: str, new: str, path: str, expected: str) -> None:
    found = only(changed(old, new))
    assert found.path == path
    assert expected in str(found)


@pytest.mark.parametrize(
    ("old", "new", "path", "expected"),
    [
        ("count = 0.00005", "count = 0.000001", "axis.X.vmax", "counts/s"),
        ("lease_ms = 200", "lease_ms = 260", "machine.lease_ms", "limits.clearance"),
        ("travel = [-4.0, 4.0]", "travel = [1.0, 4.0]", "axis.X.travel", "so 0 must be within the travel"),
        ("max_feed = 300", "max_feed = 301", "limits.max_feed", "axis.X.vmax = 300 in/min"),
        (
            "low_water_ms = 80",
            "low_water_ms = 20",
            "machine.commit_ms",
            ("the setpoint queue would run empty"),
        ),
        ("timeout_s = 5", "timeout_s = 2.6", "spindle.timeout_s", "2.63 s"),  # 3500 / 1500 + .3
        ("rpm = [50, 3500]", "rpm = [4, 3500]", "spindle.stop_below", "counts as stopped"),
        ('{ at = "IN-3" }', '{ at = "OUT-1" }', "io.in.hold.at", "io.out.coolant already uses"),
        ('coolant = { at = "OUT-1", safe = false }', "", "io.out.coolant", "M08"),
        ('start = { at = "IN-2" }', "", "io.in.start", "two-hand relay"),
        ('collet_closed = { at = "IN-5" }', "", "io.in.collet_closed", "collet open"),
        ('16 = { output = "live1"', '16 = { output = "mill"', "m_codes.16.output", "live1"),
        ('25 = { output = "catcher"', '8 = { output = "catcher"', "m_codes.8", "M08 has a fixed meaning"),
        ('25 = { output = "catcher"', '2500 = { output = "catcher"', "m_codes.2500", "0…999"),
    ],
)
def test_conflicting_values_are_rejected(old: str, new: str, path: str, expected: str) -> None:
    found = [finding for finding in findings(changed(old, new)) if finding.path == path]
    assert found
    assert expected in str(found[0])


def test_ignored_m_codes_are_read_and_checked() -> None:
    machine = parse_machine(
        changed("[m_codes]", "[m_codes]\n80 = { ignored = true }\n81 = { ignored = true, enabled = false }"),
        "t",
    )
    assert machine.ignored_m_codes == {80}
    assert machine.disabled_m_codes >= {81}
    assert 80 not in machine.m_code_outputs
    for wrong in ("{ ignored = false }", '{ ignored = true, output = "catcher" }', "{ ignored = 1 }"):
        assert findings(changed("[m_codes]", f"[m_codes]\n80 = {wrong}"))[0].path.startswith("m_codes.80.")
    assert only(changed("[m_codes]", "[m_codes]\n8 = { ignored = true }")).path == "m_codes.8"


def test_axis_that_is_not_absolute_needs_homing() -> None:
    found = only(changed("absolute = true", "absolute = false"))
    assert found.path == "axis.X.absolute"
    homing = "absolute = false\nhome = { order = 2, speed = 60 }"
    machine = parse_machine(changed("absolute = true ", homing), "t")
    assert (machine.axes[0].home_order, machine.axes[0].home_speed) == (2, pytest.approx(25.4))


def test_two_axes_with_same_homing_order_are_rejected() -> None:
    text = SHIPPED.replace("in_pos = 0.0002\n", "in_pos = 0.0002\nhome = { order = 1, speed = 60 }\n")
    assert only(text).path == "axis.Z.home.order"


def test_output_without_safe_state_is_refused() -> None:
    found = only(changed('catcher = { at = "OUT-3", safe = false }', 'catcher = { at = "OUT-3" }'))
    assert found.path == "io.out.catcher.safe"
    assert "missing" in found.expected_value


def test_output_without_off_code_is_rejected() -> None:
    found = only(changed('26 = { output = "catcher", on = false }', ""))
    assert found.path == "m_codes.25"
    assert found.expected_value == wording("machine.output-stays-on", output="catcher")


def test_all_errors_are_reported_in_one_pass() -> None:
    text = changed("amax = 120", "amax = 0").replace("lease_ms = 200", "lease_ms = 9")
    text = text.replace("seed = 1", "sed = 1").replace("accel_rpm_s = 1500", "", 1)
    assert {finding.path for finding in findings(text)} == {
        "axis.X.amax",
        "machine.lease_ms",
        "sim.sed",
        "spindle.accel_rpm_s",
    }


def test_empty_file_names_every_missing_table() -> None:
    paths = {finding.path for finding in findings("")}
    assert {"[machine]", "[axis.X]", "[spindle]", "[io.out]"} <= paths


def test_invalid_toml_reports_its_line() -> None:
    assert "line 2" in only("[machine]\nname = \n").expected_value


@pytest.mark.parametrize("value", ["[" * 50_000, "{a=" * 5000, "9" * 5000])
def test_unparsable_value_is_one_finding(value: str) -> None:
    found = only(f"[machine]\nname = {value}")
    assert found.code == "not-toml"
    assert len(found.expected_value) < 100


def test_missing_file_and_wrong_encoding_are_rejected(tmp_path: Path) -> None:
    with raises_code(MachineFileError, "unreadable", "none.toml"):
        load_machine(tmp_path / "none.toml")
    (tmp_path / "latin.toml").write_bytes(b'name = "\xff"')
    with raises_code(MachineFileError, "not-utf8", "latin.toml"):
        load_machine(tmp_path / "latin.toml")


def test_key_with_line_break_is_reported_on_one_line() -> None:
    with pytest.raises(MachineFileError) as told:
        parse_machine('["a\\nb"]\nx = 1\n', "x.toml")
    assert "[a b]: unknown table" in str(told.value)
    assert "\n" not in str(told.value)


def test_turret_is_rejected_without_indexing_driver() -> None:
    text = resources.read_machine_file("gt75.toml").replace('kind = "gang" ', 'kind = "turret" ')
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text, "gt75.toml")
    assert [(each.path, each.code) for each in caught.value.findings] == [("tooling.kind", "broken-rule")]

"""What a lathe's C is: modulo or not, its own drive or the spindle; kept by proof and run."""

from __future__ import annotations

from dataclasses import replace

import pytest

import resources
from app.compose.machine.machine_files import load_machine, parse_machine
from app.compose.machine.machine_setup import get_control_limits
from core.executor.job import check_block
from core.executor.raised_alarm import AlarmError
from core.machine.machine_model import Machine
from core.proving.prove_program import prove
from core.table_schema import MachineFileError
from tests.coded import raises_code
from tests.sinumerik.lathe import LINEAR, MODULO, good, run, setup, source

GT75 = load_machine(None)
HOME = (0.0, 0.0, 0.0)


def changed(old: str, new: str) -> Machine:
    """The modulo lathe with another line in its file."""
    text = resources.read_machine_file("sinumerik-modulo.toml")
    assert text.count(old) == 1
    return parse_machine(text.replace(old, new), "changed.toml")


def codes(text: str, machine: Machine) -> list[str]:
    report = prove(source(text), setup(machine, HOME), machine)
    return [each.code for each in report.errors]


def test_the_shipped_lathes_have_the_limits_of_the_specification() -> None:
    for machine in (MODULO, LINEAR):
        x, z, c = machine.axes
        assert [x.max_speed * 60, z.max_speed * 60, c.max_speed * 60] == pytest.approx([8000, 10000, 7200])
        assert get_control_limits(machine).max_axis_speeds == (x.max_speed, z.max_speed, c.max_speed)
        assert machine.has_separate_c_drive
        assert not machine.is_spindle_c_axis
    assert (MODULO.is_c_axis_modulo, MODULO.axes[2].travel) == (True, None)
    assert (LINEAR.is_c_axis_modulo, LINEAR.axes[2].travel) == (False, (-360.0, 360.0))


def test_shipped_gang_lathe_uses_spindle_as_c_axis() -> None:
    assert GT75.is_c_axis_modulo
    assert GT75.is_spindle_c_axis


@pytest.mark.parametrize(
    ("line", "new"),
    [
        ("modulo = true ", 'modulo = "yes" '),
        ("own_drive = true ", "own_drive = 1 "),
        ("controlled = true ", "controlled = 0 "),
        ("own_drive = true ", "own_drives = true "),
    ],
)
def test_machine_file_keys_are_read_strictly(line: str, new: str) -> None:
    with pytest.raises(MachineFileError):
        changed(line, new)


def test_c_is_not_moved_by_a_spindle_that_turns() -> None:
    text = "S500 M3\nG0 X20 C90\nM5\nC=IC(5)\nG1 Z-3 F100"
    assert codes(text, GT75) == ["c-is-spindle"]
    assert codes(text, MODULO) == []
    assert codes("S500 M3\nG0 X20\nG1 Z-3 F100", GT75) == []


def test_executor_checks_block_again() -> None:
    (moved,) = good("S500 M3\nG0 C90", setup(GT75, HOME))
    with pytest.raises(AlarmError) as told:
        check_block(moved, GT75)
    assert told.value.code == "c-is-spindle"
    check_block(moved, MODULO)


def test_same_program_is_limited_by_each_lathe() -> None:
    (block,) = good("G0 C90", setup(GT75, HOME))
    assert block.feed == pytest.approx(200 * 6)  # 200 rpm of C
    (block,) = good("G0 C90", setup(MODULO, HOME))
    assert block.feed == pytest.approx(120)


def test_offset_cannot_move_axes_beyond_travel() -> None:
    assert codes("G0 Z790", MODULO) == []
    assert codes("TRANS Z20\nG0 Z790", MODULO) == ["soft-limit"]


def test_program_is_rejected_on_a_mill() -> None:
    around = replace(setup(), start=(0.0,) * 5)
    passed = run("G0 X1", around)
    assert [each.code for each in passed.errors] == ["machine-kind"]
    assert passed.blocks == []


def test_machine_file_makes_c_linear_or_removes_it() -> None:
    linear = changed("modulo = true ", "modulo = false ")
    assert linear.axes[2].travel == (-360.0, 360.0)
    assert codes("G0 C=DC(5)", linear) == ["16800"]
    without = changed("enabled = true", "enabled = false")
    assert codes("G0 C5", without) == ["unknown-axis"]
    assert codes("G0 X5", without) == []


def test_fixed_points_of_shipped_lathes_are_away_from_the_part() -> None:
    """The part is cut towards -Z and the axis of the spindle; the ends of the travel are X300 and Z800."""
    for machine in (MODULO, LINEAR):
        x, z, c = machine.axes
        assert (x.fixed_points, z.fixed_points, c.fixed_points) == ((299.0,), (799.0,), ())
        assert codes("TRANS Z20\nG0 X20 Z5\nG75 X1=0 Z1=0", machine) == []


def test_fixed_point_beyond_soft_limit_stops_proof() -> None:
    """As where the travel has been made smaller: the machine file would not have been read."""
    x, *others = MODULO.axes
    shorter = replace(MODULO, axes=(replace(x, travel=(-20.0, 298.0)), *others))
    assert codes("G75 X1=0", shorter) == ["soft-limit"]


@pytest.mark.parametrize(
    ("new", "code", "value"),
    [
        ("[300.5]", "broken-rule", "300.5 mm"),
        ("[299.0, -21.0]", "broken-rule", "-21 mm"),
        ("[]", "wrong-value", "[first, second]"),
        ("[1.0, 2.0, 3.0, 4.0, 5.0]", "wrong-value", "[first, second]"),
        ('["far"]', "wrong-value", "[first, second]"),
        ("299.0", "wrong-value", "[first, second]"),
        ("[nan]", "wrong-value", "[first, second]"),
    ],
)
def test_invalid_fixed_points_are_rejected(new: str, code: str, value: str) -> None:
    with raises_code(MachineFileError, code, "axis.X.fixed_points", value):
        changed("fixed_points = [299.0] ", f"fixed_points = {new} ")


def test_fixed_points_need_no_order_and_mill_accepts_only_one() -> None:
    machine = changed("fixed_points = [299.0] ", "fixed_points = [100.0, 20.0, -20.0, 300.0] ")
    assert machine.axes[0].fixed_points == (100.0, 20.0, -20.0, 300.0)
    mill = resources.read_machine_file("ac-table-mill.toml")
    with raises_code(MachineFileError, "broken-rule", "axis.X.fixed_points", "M92"):
        parse_machine(mill.replace("fixed_points = [-100.0]", "fixed_points = [0.0, 1.0]"), "mill.toml")


MILL = """G17 G90 G54 G94 F200
S3000 M3
G0 X10 Y10 Z5
G1 Z-5
Y20 A10
G2 X60 I10 J0
G3 X60 Y40 I10 J0
X50 Y30 A20 B5
G0 Z50
M30
"""


def test_mill_program_on_lathe_is_reported_once_per_axis() -> None:
    """Y first on line 3, A on line 5."""
    assert [(each.line, each.column, each.code) for each in run(MILL).errors] == [
        (3, 8, "not-in-subset"),
        (5, 5, "not-in-subset"),
    ]


def test_each_missing_axis_has_its_own_finding() -> None:
    errors = run("G0 X10 Y1\nG0 B2\nG0 Y3\nG0 B4\nG0 A5").errors
    assert [each.line for each in errors] == [1, 2, 5]


def test_another_error_in_same_program_is_still_reported() -> None:
    assert [each.line for each in run("G0 X10 Y1\nG0 Y3\nG999\nG0 Y4").errors] == [1, 3]

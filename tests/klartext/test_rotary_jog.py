"""Moves by hand on a mill: every axis has its keys and its cell, no axis is asked for more than it can."""

from __future__ import annotations

from app.compose.machine.machine_files import load_machine, load_shipped_machine
from app.jog.held_jog import JogSpeeds, make_jog_directions
from app.offsets.offset_values import UnitMode

MILL, LATHE = load_shipped_machine("ac-table-mill"), load_machine()


def test_every_axis_has_both_jog_directions() -> None:
    for machine, names in ((MILL, "XYZAC"), (LATHE, "XZC")):
        ways = make_jog_directions(machine)
        assert sorted((way.axis_name, way.direction_sign) for way in ways) == sorted(
            (n, s) for n in names for s in (-1, 1)
        )


def test_no_two_jog_directions_share_a_key_or_cell() -> None:
    for machine in (MILL, LATHE):
        ways = make_jog_directions(machine)
        assert len({way.key_name for way in ways}) == len(ways)
        cells = {(way.cell_column, way.cell_row) for way in ways}
        assert len(cells) == len(ways)
        assert (1, 1) not in cells  # the figures stand there


def test_down_key_is_x_plus_on_lathe_and_up_key_is_y_plus_on_mill() -> None:
    down = next(way for way in make_jog_directions(LATHE) if way.key_name == "Down")
    up = next(way for way in make_jog_directions(MILL) if way.key_name == "Up")
    assert (down.axis_name, down.direction_sign) == ("X", 1)
    assert (up.axis_name, up.direction_sign) == ("Y", 1)


def test_jog_speed_of_slow_table_is_within_its_limit() -> None:
    speeds, mode = JogSpeeds(MILL, speed_index=3), UnitMode(is_metric=True)
    assert speeds.find_continuous_speed("A", mode, is_rapid=True) == 60.0  # degrees/s: 3600 a minute
    assert speeds.find_continuous_speed("A", mode, is_rapid=False) == 60.0
    assert speeds.find_continuous_speed("C", mode, is_rapid=True) == 120.0
    assert speeds.find_step_speed("A") == 60.0
    speeds.step_index = 0
    assert speeds.find_step_length("A", mode) == 1.0  # degrees
    assert speeds.find_step_length("Y", mode) == 1.0  # mm

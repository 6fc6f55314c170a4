"""What is asked of an elementary block by itself: its length, its reach, and what it needs of a machine."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.machine_requirements import (
    SURFACE_SPEED,
    SURFACE_SPEED_THREAD,
    THREAD_CHAIN,
    THREADING,
    MachineRequirement,
    list_requirements,
    remove_repeated_requirements,
)
from core.interpreter.sinumerik.setup.programmed_frame import ProgrammedFrame
from tests.interpreter.programs import lines, passed, setup
from tests.motion.moves import arc, line


@pytest.mark.parametrize(
    ("block", "length"),
    [
        (line((1.0, 1.0), (4.0, 5.0)), 5.0),
        (arc((0.0, 3.0), (3.0, 0.0), (0.0, 0.0)), 1.5 * math.pi),
        (arc((0.0, 3.0), (3.0, 0.0), (0.0, 0.0), clockwise=False), 4.5 * math.pi),
        (replace(line((2.0, 2.0), (2.0, 2.0)), c0=30.0, c=-60.0), 90.0),
        (replace(line((0.0, 0.0), (0.0, 8.0)), c0=30.0, c=-60.0), 8.0),
        (line((2.0, 2.0), (2.0, 2.0)), 0.0),
    ],
)
def test_feed_length_is_path_length_or_degrees_for_c_alone(block: Block, length: float) -> None:
    assert block.length == pytest.approx(length)


def test_extent_of_a_line_is_its_end_and_of_an_arc_its_bounds() -> None:
    assert line((1.0, 2.0), (3.0, -4.0)).reach() == (3.0, 3.0, -4.0, -4.0)
    half = arc((0.0, 3.0), (0.0, -3.0), (0.0, 0.0))
    assert half.reach() == pytest.approx((0.0, 3.0, -3.0, 3.0))
    moved = replace(half, offset_x=10.0, offset_z=-1.0)
    assert moved.compute_machine_bounds()[:2] == (pytest.approx((10.0, 13.0)), pytest.approx((-4.0, 2.0)))


def test_secondary_offset_shifts_the_extent_of_a_milled_path() -> None:
    text = lines("G90G94F300", "M19", "X-.5Z-.1F5", "(~PLXC)", "(X0Y.4)", "(END)", "M30")
    (way,) = (block for block in passed(text).moves if block.kind is BlockKind.PLANE_LINE)
    low_x, high_x, low_z, high_z = way.reach()
    assert low_x < high_x
    moved = replace(way, modal=way.modal._replace(secondary_offset_x=1.5, secondary_offset_z=-2.0))
    assert moved.reach() == pytest.approx((low_x + 1.5, high_x + 1.5, low_z - 2.0, high_z - 2.0))


def test_css_is_required_only_with_a_turning_spindle_and_listed_once() -> None:
    still = replace(line((0, 0), (0, 1)), line=1, css=2000.0)
    turns = replace(still, line=2, rpm=500.0)
    thread = replace(turns, line=3, kind=BlockKind.THREAD, per_rev=True)
    chain = replace(turns, line=4, kind=BlockKind.THREAD, continues=True, css=None)
    assert list(list_requirements([still])) == []
    assert remove_repeated_requirements(list_requirements([still, turns, turns, thread, chain])) == (
        MachineRequirement(SURFACE_SPEED, 2),
        MachineRequirement(THREADING, 3),
        MachineRequirement(SURFACE_SPEED_THREAD, 3),
        MachineRequirement(THREAD_CHAIN, 4),
    )


# --- a program's frame --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "frame",
    [
        ProgrammedFrame(),
        ProgrammedFrame().add_rotation(30.0),
        ProgrammedFrame().add_scaling(2.0, 0.5),
        ProgrammedFrame().add_rotation(-75.0).add_scaling(1.0, -1.0).add_rotation(20.0),
        ProgrammedFrame().add_scaling(3.0, 1.5).add_rotation(40.0),
    ],
)
def test_frame_transform_is_invertible(frame: ProgrammedFrame) -> None:
    for x, z in ((1.0, 0.0), (0.0, 1.0), (-3.5, 7.25)):
        assert frame.convert_to_program_distance(*frame.convert_to_machine_distance(x, z)) == pytest.approx(
            (x, z), abs=1e-12
        )


def test_frame_rotation_is_from_z_toward_x() -> None:
    """By 90 degrees Z of the program is X of the machine, and X its -Z."""
    frame = ProgrammedFrame().add_rotation(90.0)
    assert frame.convert_to_machine_distance(0.0, 1.0) == pytest.approx((1.0, 0.0), abs=1e-12)
    assert frame.convert_to_program_distance(1.0, 0.0) == pytest.approx((0.0, 1.0), abs=1e-12)
    assert frame.convert_to_program_distance(0.0, 1.0) == pytest.approx((-1.0, 0.0), abs=1e-12)
    assert not frame.is_shift_only
    assert frame.has_uniform_scale
    assert not frame.is_mirrored
    assert ProgrammedFrame().add_scaling(-1.0, 1.0).is_mirrored
    assert not ProgrammedFrame().add_scaling(2.0, 1.0).has_uniform_scale


# --- a program without a line to execute --------------------------------------------------------------------


@pytest.mark.parametrize("text", ["", "(NOTHING)\n", "\n\n(A)\n", "/G90X1\n"])
def test_program_without_executed_lines_needs_no_unit(text: str) -> None:
    """The control counts in mm, and the program names no unit: there is nothing that would run in it."""
    given = setup(metric=True, block_delete=True)
    assert "units-unnamed" not in [code for _, _, code in passed(text, given).warnings]
    assert (1, 0, "units-unnamed") in passed("G90G94F300\nX1\nM30\n", given).warnings

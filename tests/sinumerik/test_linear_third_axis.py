"""A third axis that is a slide, named Y: mm where C has degrees."""

from __future__ import annotations

import re

import pytest

from app.compose.machine.machine_files import load_shipped_machine, parse_machine
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ZeroOffset
from core.machine.machine_model import Machine
from core.proving.prove_program import prove
from tests.sinumerik.lathe import refused, run, setup, source, times

SLIDE = """[axis.C]
enabled = true
linear = true
name = "Y"
travel = [-60.0, 60.0]
vmax = 5000
amax = 2000
count = 0.001
absolute = true

"""


@pytest.fixture(scope="module")
def lathe() -> Machine:
    """The linear lathe that ships, with a slide Y in the place of C."""
    text = load_shipped_machine("sinumerik-linear").text
    return parse_machine(re.sub(r"\[axis\.C\].*?(?=\[spindle\])", SLIDE, text, flags=re.DOTALL), "t")


def timed(text: str, lathe: Machine) -> list[tuple[Block, float]]:
    return times(text, lathe)


def test_machine_has_an_additional_linear_axis(lathe: Machine) -> None:
    axis = lathe.find_axis("C")
    assert (axis.is_rotary, axis.travel, lathe.third_axis_name) == (False, (-60.0, 60.0), "Y")
    assert axis.max_speed == pytest.approx(5000 / 60)
    assert not lathe.is_spindle_c_axis


def test_single_linear_axis_moves_at_programmed_feed(lathe: Machine) -> None:
    """50 mm at 100 mm/min: 30 s. 20 mm at 0.5 mm a turn, 400 rpm: 6 s. At its limit of 5000: 0.6 s."""
    (_, rapid), (_, feed), *_ = timed("G0 X20 Z0 Y0\nG94 G1 Y50 F100", lathe)
    assert feed == pytest.approx(30.0)
    assert rapid > 0.0
    assert timed("G95 S400 M3\nG1 Y20 F0.5", lathe)[-1][1] == pytest.approx(6.0)
    assert timed("G94 G1 Y50 F9000", lathe)[-1][1] == pytest.approx(0.6)


def test_linear_axis_moving_with_x_and_z_has_no_share_of_f(lathe: Machine) -> None:
    """30 mm of Z at 600 mm/min are 3 s; 50 mm of Y need 0.6 s at its limit, more than 1 mm of Z."""
    assert timed("G94 G1 Z=IC(-30) Y12 F600", lathe)[-1][1] == pytest.approx(3.0)
    assert timed("G94 G1 Z=IC(-1) Y50 F600", lathe)[-1][1] == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("text", "end"),
    [
        ("G0 Y2", 2.0),
        ("G70 G0 Y2", 50.8),
        ("G700 G0 Y-1", -25.4),
        ("G0 Y10\nG91 Y-4", 6.0),
        ("G0 Y10\nG0 Y=IC(5)", 15.0),
        ("G91 G0 Y=AC(7)", 7.0),
        ("TRANS Y5\nG0 Y10", 15.0),
        ("TRANS Y5\nATRANS Y-2\nG0 Y10", 13.0),
        ("G70\nTRANS Y1\nG0 Y0.5", 38.1),
        ("G54 G0 Y10", 13.0),
        ("G54 G0 Y10\nG53 G0 Y10", 10.0),
    ],
)
def test_linear_axis_positions_are_in_length_units(text: str, end: float, lathe: Machine) -> None:
    passed = run(text, setup(lathe, zero={54: ZeroOffset(0.0, 0.0, 3.0)}))
    assert passed.errors == []
    assert passed.moves[-1].mc == pytest.approx(end)


def test_linear_axis_feed_is_in_inches_under_g700(lathe: Machine) -> None:
    """1 in at 10 in/min: 6 s; under G70 F stays in mm: 25.4 mm at 10 mm/min are 152.4 s."""
    assert timed("G700 G94 G1 Y1 F10", lathe)[-1][1] == pytest.approx(6.0)
    assert timed("G70 G94 G1 Y1 F10", lathe)[-1][1] == pytest.approx(152.4)


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("G0 Y=DC(10)", "16800"),
        ("G0 Y=ACP(10)", "16810"),
        ("G0 Y=ACN(10)", "16820"),
        ("G0 Y60.01", "10720"),
        ("G0 Y=IC(-61)", "10720"),
        ("G70 G0 Y2.4", "10720"),
        ("G0 C10", "not-in-subset"),
        ("G1 Y10", "10860"),
        ("TRANS Y=IC(3)", "offset-form"),
    ],
)
def test_rotary_words_are_rejected_for_linear_axis(line: str, code: str, lathe: Machine) -> None:
    assert refused(line, setup(lathe)).code == code


def test_transmit_is_rejected_with_linear_third_axis(lathe: Machine) -> None:
    assert refused("T1 D1\nG17\nTRANSMIT", setup(lathe)).code == "14401"


def test_program_with_linear_axis_is_proved(lathe: Machine) -> None:
    report = prove(source("G94\nG0 X20 Z0 Y0\nG1 Y50 F100\nG0 Y60\nM30\n"), setup(lathe), lathe)
    assert report.errors == ()
    assert report.program_ranges.c_range == pytest.approx((0.0, 60.0))
    assert report.machine_final_position[2] == pytest.approx(60.0)

"""How long blocks take by feeds and limits alone: the table of the specification, worked out by hand."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, pi

import pytest

from core.machine.machine_model import Machine
from core.proving.program_timeline import Timeline, iter_timed_blocks
from tests.sinumerik.lathe import LINEAR, MODULO, refused, run, setup, source, times

BEFORE = "N5 G94\nN10 G0 X10 Z30 C45\n"


def slow_c(limit: float) -> Machine:
    """The same lathe with another limit of C, degrees/min."""
    x, z, c = MODULO.axes
    return replace(MODULO, axes=(x, z, replace(c, max_speed=limit / 60)))


def last(text: str, machine: Machine = MODULO) -> tuple[float, float]:
    """Seconds of the last block, and the speed of C in it in degrees/min."""
    block, seconds = times(text, machine)[-1]
    return seconds, abs(block.c - block.c0) / seconds * 60


def path(text: str) -> float:
    """Length of the straight way of the last block, mm."""
    block = times(text)[-1][0]
    return hypot(block.x - block.x0, block.z - block.z0)


ROWS = [  # program, X/Z path, seconds, degrees/min
    (BEFORE, 20.615528, 0.375000, 7200),
    (BEFORE + "N20 G1 X12 Z33 C60 F400", 3.162278, 0.474342, 1897.367),
    (BEFORE + "N20 G1 X12 Z33 C60 F400\nN30 G1 C90 F3000", 0, 0.600000, 3000),
    ("DIAMOF\nG0 X10 Z30 C45\nG1 X12 Z33 C60 F400", 3.605551, 0.540833, 1664.101),
    ("S500 M3\nDIAMOF\nG0 X10 Z30 C45\nG95 G1 X40 Z50 C135 F0.2", 36.055513, 21.633308, 249.615),
    ("S500 M3\nG95 G1 C=IC(90) F2", 0, 5.400000, 1000),
    ("G0 X40 Z0 C0\nG1 Z=IC(-0.001) C=IC(360) F100", 0.001, 3.000000, 7200),
    ("G1 C=IC(360) F100", 0, 216.000000, 100),
    ("G0 C179", 0, 1.491667, 7200),
    ("G0 Z0 C30\nG1 Z-30 C30 F400", 30, 4.500000, 0),
]


@pytest.mark.parametrize("row", ROWS, ids=[f"row{n}" for n in range(len(ROWS))])
def test_block_durations_match_reference_table(row: tuple[str, float, float, float]) -> None:
    text, length, seconds, speed = row
    assert path(text) == pytest.approx(length, abs=1e-6)
    took, turned = last(text)
    assert took == pytest.approx(seconds, abs=1e-6)
    assert turned == pytest.approx(speed, abs=1e-3)


def test_lower_c_limit_extends_its_own_move() -> None:
    took, turned = last(BEFORE + "N30 G1 C90 F3000", slow_c(1000))
    assert took == pytest.approx(45 / 1000 * 60, abs=1e-6)
    assert turned == pytest.approx(1000)
    assert last("G0 C60\nG1 C90 F3000", slow_c(1000))[0] == pytest.approx(1.8, abs=1e-6)


def test_quarter_arc_with_c_has_expected_duration() -> None:
    """15.708 mm at 200 mm/min, 90 degrees meanwhile."""
    for code, end in (("G3", "X40 Z40"), ("G2", "X40 Z40")):
        text = f"G0 X20 Z50 C0\n{code} {end} CR=10 C=IC(90) F200"
        took, turned = last(text)
        assert took == pytest.approx(10 * pi / 2 / 200 * 60, abs=1e-6)
        assert took == pytest.approx(4.712389, abs=1e-6)
        assert turned == pytest.approx(1145.916, abs=1e-3)


def test_c_at_its_limit_extends_an_arc() -> None:
    """720 degrees at 7200 a minute take 6 s, longer than the arc alone."""
    assert last("G3 X40 Z40 CR=10 C=IC(720) F200")[0] == pytest.approx(6.0, abs=1e-6)


def test_c_has_no_share_of_f() -> None:
    """The maker's rule: path axis 100 mm at 1000, so whatever goes along takes 6 s."""
    text = "G0 Z100 C0\nG1 Z0 C50 F1000"
    took, turned = last(text)
    assert took == pytest.approx(6.0, abs=1e-6)
    assert turned == pytest.approx(500, abs=1e-3)


def test_speed_limit_of_linear_axis_extends_a_block() -> None:
    """X 40 mm of radius at 8000 mm/min: .3 s, though F20000 asks for less."""
    took, turned = last("G0 X20 Z0 C0\nG1 X100 C10 F20000")
    assert took == pytest.approx(40 / 8000 * 60, abs=1e-6)
    assert turned == pytest.approx(10 / 0.3 * 60, abs=1e-3)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("S300 M3\nG4 S30", 6.0),
        ("S270 M3\nG4 S30", 6.666667),
        ("G4 F2.5", 2.5),
        ("S270.0 M4\nG4 S=30", 6.666667),
    ],
)
def test_dwell_durations_are_calculated(text: str, seconds: float) -> None:
    assert times(text)[-1][1] == pytest.approx(seconds, abs=1e-6)


def test_dwell_does_not_change_feed_and_speed() -> None:
    blocks = run("S300 M3 F100\nG4 S30\nG4 F9\nG1 Z0").blocks
    assert blocks[-1].feed == pytest.approx(100 / 60)
    assert blocks[-1].rpm == pytest.approx(300)


@pytest.mark.parametrize(("x", "rpm"), [(50, 763.944), (10, 2500.0)])
def test_constant_surface_speed_is_limited_by_lims(x: float, rpm: float) -> None:
    """n = 1000 · 120 / (pi · D), held by LIMS."""
    block = run(f"G96 S120 LIMS=2500 M3\nG0 X{x}").blocks[-1]
    assert block.rpm == pytest.approx(rpm, abs=1e-3)
    assert 1000 * 120 / (pi * x) >= block.rpm - 1e-9


def test_lims_also_limits_g97() -> None:
    assert run("LIMS=800 S1200 M4\nG0 X1").blocks[-1].rpm == pytest.approx(-800)


def test_g97_continues_at_current_spindle_speed() -> None:
    blocks = run("G0 X50\nG96 S120 LIMS=2500 M3\nG97\nG0 X10").blocks
    assert blocks[-1].rpm == pytest.approx(763.944, abs=1e-3)


def test_f_is_interpreted_by_kind_of_block() -> None:
    text = "G0 X20 Z0 C0\nG1 Z-10 F600\nC=IC(90)\nZ-20"
    _, path_block, turn, again = times(text)
    assert path_block[1] == pytest.approx(1.0, abs=1e-6)  # 10 mm at 600 mm/min
    assert turn[1] == pytest.approx(9.0, abs=1e-6)  # 90 degrees at 600 degrees/min
    assert again[1] == pytest.approx(1.0, abs=1e-6)


def test_path_under_a_millionth_of_a_millimeter_is_ignored() -> None:
    """Then F is the feed of C: 360 degrees at 100 a minute."""
    assert last("G0 X40 Z0 C0\nG1 Z=IC(0.0000005) C=IC(360) F100")[0] == pytest.approx(216.0, abs=1e-6)
    assert last("G0 X40 Z0 C0\nG1 Z=IC(0.000002) C=IC(360) F100")[0] == pytest.approx(3.0, abs=1e-6)


def test_linear_and_modulo_c_need_the_same_time() -> None:
    text = BEFORE + "N20 G1 X12 Z33 C60 F400"
    assert last(text, LINEAR) == pytest.approx(last(text, MODULO))


def test_real_machine_needs_more_time_than_ideal() -> None:
    text = BEFORE + "N20 G1 X12 Z33 C60 F400"
    real = list(iter_timed_blocks(Timeline.from_program(source(text), setup(), MODULO)))
    for (_, t0, t1), (_, ideal) in zip(real, times(text), strict=True):
        assert t1 - t0 > ideal


@pytest.mark.parametrize("change", ["G95", "G95\nG94"])
def test_change_between_g94_and_g95_clears_f(change: str) -> None:
    error = refused(f"S500 M3\nG1 Z0 F100\n{change}\nZ-1")
    assert error.code == "10860"
    assert error.line == 4 + change.count("\n")


def test_repeated_g94_retains_f() -> None:
    assert times("G1 Z0 F600\nG94\nZ-10")[-1][1] == pytest.approx(1.0, abs=1e-6)


def test_g96_interprets_f_per_revolution() -> None:
    """22 mm at 0.2 mm a revolution and 763.944 rpm, which is 120 m/min on Ø 50: 8.639 s, and not 6 600 s."""
    found = times("G0 X50 Z2\nG96 S120 LIMS=2500 M3\nG1 Z-20 F0.2")
    assert found[-1][1] == pytest.approx(22.0 / (0.2 * 763.9437268 / 60.0), rel=1e-6)


@pytest.mark.parametrize(
    ("text", "per_rev", "css"),
    [
        ("G96 S120 M3", True, True),
        ("G961 S120 M3", False, True),
        ("G962 S120 M3", False, True),
        ("G95\nG962 S120 M3", True, True),
        ("G97 S500 M3", True, False),
        ("G971 S500 M3", False, False),
        ("G95\nG972 S500 M3", True, False),
        ("G973 S500 M3", True, False),
        ("G96 S120 M3\nG94", False, False),
        ("G961 S120 M3\nG95", True, False),
        ("G96 S120 M3\nG97", True, False),
    ],
)
def test_g94_to_g97_codes_set_feed_and_speed_modes(text: str, per_rev: bool, css: bool) -> None:
    modal = run(text + "\nG0 X30").blocks[-1].modal
    assert (modal.per_rev, modal.css) == (per_rev, css)


def test_g97_retains_speed_reached_under_g96() -> None:
    """120 m/min on Ø 50: 120 000 / (50 pi)."""
    assert run("G0 X50\nG96 S120 M3\nG97\nG0 X20").blocks[-1].rpm == pytest.approx(763.9437268)


def test_g94_after_g96_restores_previous_s() -> None:
    assert run("S900 M3\nG0 X50\nG96 S120\nG94\nG0 X20").blocks[-1].rpm == pytest.approx(900.0)


def test_g96_requires_a_new_f() -> None:
    assert refused("G1 X40 F200\nG96 S120 M3\nN30 Z0").code == "10860"


@pytest.mark.parametrize("two", ["G96 G95", "G94 G97", "G961 G971", "G95 G94"])
def test_two_codes_of_the_feed_group_are_rejected(two: str) -> None:
    assert refused(f"S100 {two}").code == "12060"

"""M03 M04 M05, S, G96 G97 G76 G77. rpm = S·12/(2·pi·r), S in ft/min and r in inches."""

from __future__ import annotations

from math import pi

import pytest

from core.interpreter.shared.actions import SpindleRun, SpindleStop
from core.interpreter.shared.job_setup import ControlLimits
from tests.interpreter.programs import body, lines, passed, setup

HEAD = "G90G94F300"


def rpms(*program: str) -> list[float]:
    """Commanded speed at the end of each move."""
    result = passed(lines(HEAD, *program, "M30"))
    assert result.errors == []
    return [round(block.rpm, 2) for block in result.moves]


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        (("X1",), [0]),
        (("M03S500", "X1", "M05", "X2", "M03", "X3"), [500, 0, 500]),
        (("M04S500", "X1"), [-500]),
        (("M03S500", "M04", "X1"), [-500]),
        (("M03S500", "S700", "X1"), [700]),
        (("S700", "X1", "M03", "X2"), [0, 700]),
        (("M03S500", "M05", "S900", "M03", "X1"), [900]),
        (("M03S3500", "X1"), [3500]),
    ],
)
def test_spindle_speed_in_force(program: tuple[str, ...], expected: list[float]) -> None:
    assert rpms(*program) == expected


def test_speed_and_m_codes_that_produce_spindle_blocks() -> None:
    result = passed(lines(HEAD, "S400", "M03", "S800", "M03S900", "M05S950", "S100", "M04", "M30"))
    assert result.actions[:-1] == [
        SpindleRun(400),
        SpindleRun(800),
        SpindleRun(900),
        SpindleStop(),
        SpindleRun(-100),
    ]


CSS_250 = 250 * 12 / (2 * pi)  # rpm at a radius of 1 in


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        (("M03S1000", "X1", "G96S250", "X.5", "X1"), [1000, 2 * CSS_250, CSS_250]),
        (("M04S1000", "G96S250", "X1"), [-CSS_250]),
        (("M03S1000", "G96S250", "X-.5"), [2 * CSS_250]),
        (("M03S1000", "G72G96S250", "X1"), [2 * CSS_250]),
        (("M03S1000", "G96S250", "X0"), [3500]),
        (("M03S1000", "G96S250", "G77S2500", "X.1", "X0"), [2500, 2500]),
        (("M03S1000", "G96S250", "G76S600", "X9", "X.5"), [600, 2 * CSS_250]),
        (("M03S1000", "G96S250", "X.5", "G97", "X1"), [2 * CSS_250, 2 * CSS_250]),
        (("M03S1000", "G96S250", "X.5", "G97S700", "X1"), [2 * CSS_250, 700]),
        (("G96S250", "X.5", "M03", "X1"), [0, CSS_250]),
        (("M03S1000", "G71G96S76.2", "X25.4"), [CSS_250]),  # 250 ft/min in m/min
    ],
)
def test_surface_speed_sets_rpm_from_diameter(program: tuple[str, ...], expected: list[float]) -> None:
    assert rpms(*program) == [pytest.approx(rpm, abs=0.01) for rpm in expected]


def test_surface_speed_is_marked_in_blocks() -> None:
    result = passed(body("X1", "G96S250", "Z1"))
    run = result.actions[1]
    assert isinstance(run, SpindleRun)
    assert run.surface_speed == pytest.approx(250 * 12 * 25.4 / 60)
    assert run.rpm == pytest.approx(CSS_250)
    assert [block.css is None for block in result.moves] == [True, False]


def test_machine_speed_limit_applies_to_surface_speed() -> None:
    result = passed(body("G96S250", "X0"), setup(limits=ControlLimits(max_rpm=2000)))
    assert result.moves[-1].rpm == 2000


def test_stopped_spindle_is_accepted_for_feed_per_minute() -> None:
    assert passed(lines(HEAD, "F5X1", "M30")).errors == []


def test_spindle_stops_after_move_of_its_line() -> None:
    result = passed(body("X1M05"))
    assert [block.rpm for block in result.blocks[1:3]] == [1000, 0]
    assert isinstance(result.blocks[2].action, SpindleStop)

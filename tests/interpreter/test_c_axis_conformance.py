"""The worked examples of spindle positioning and plane switching: the figures of their table."""

from __future__ import annotations

from math import atan2, degrees, hypot, pi
from pathlib import Path

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ControlLimits
from core.language.source import load_source
from tests.interpreter.programs import INCH, OUTPUTS, Pass, passed, setup

FOLDER = Path(__file__).parents[2].parent / "shared" / "conformance" / "omniturn"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the worked examples are not at hand")
LIMITS = ControlLimits(m_code_outputs={**OUTPUTS, 27: ("mill", True), 28: ("mill", False)})


def example(name: str) -> Pass:
    return passed(load_source(FOLDER / f"{name}.nc").text, setup(limits=LIMITS))


def good(name: str) -> Pass:
    result = example(name)
    assert result.errors == []
    return result


def milled(result: Pass) -> list[Block]:
    return [b for b in result.moves if b.plane is not None]


def test_cross_drill_example_runs_as_documented() -> None:
    result = good("caxis-cross-drill")
    holes = [b.c for b in result.moves if b.kind is BlockKind.FEED and b.x < b.x0]
    assert holes == pytest.approx([27.5, 117.5, 207.5, 297.5])
    # the first turn is followed by the drill without a dwell, the others have a second
    assert result.warnings == [(7, 1, "dwell-too-short")]


def test_slot_lead_example_runs_as_documented() -> None:
    (slot,) = [b for b in good("caxis-slot-lead").moves if b.per_rev]
    assert (slot.z - slot.z0) / INCH == pytest.approx(-0.1)
    assert slot.feed / INCH == pytest.approx(0.8)
    assert (slot.c0, slot.c, slot.rpm) == pytest.approx((0.0, -45.1, -3.5))
    assert abs(slot.z - slot.z0) / slot.feed * 360 == pytest.approx(45.0)


def test_too_little_c_rotation_is_rejected() -> None:
    result = example("caxis-too-little-turn")
    assert result.errors == [(9, 1, "c-too-little")]
    assert any("432" in d.message for d in result.interpreter.diagnostics)


def test_rectangle_example_runs_as_documented() -> None:
    result = good("plane-xc-rectangle")
    corners = milled(result)[1:]
    programmed = [(0.313, -0.25), (0.313, 0.25), (-0.313, 0.25), (-0.313, -0.25), (0.313, -0.25)]
    at = [degrees(-atan2(y, x)) for x, y in programmed]
    assert [b.c for b in corners] == pytest.approx([at[0], at[1], at[2], at[3] - 360, at[4] - 360])
    assert [b.x / INCH for b in corners] == pytest.approx([-hypot(0.313, 0.25)] * 5)
    assert corners[-1].c - corners[0].c == pytest.approx(-360.0)


def test_oval_is_milled_at_a_constant_distance() -> None:
    """Everywhere .1875 in from the middle line of the oval, which runs from X -.1875 to .1875."""
    way = milled(good("plane-xc-oval"))
    assert way[-1].c - way[0].c == pytest.approx(-360.0)
    for block in way[1:-1]:
        assert block.plane is not None
        x, y, _ = (block.plane.compute_mill_points(np.linspace(0.0, 1.0, 50)) / INCH).T
        off = np.hypot(x - np.clip(x, -0.1875, 0.1875), y)
        assert off == pytest.approx(np.full(50, 0.1875))


def test_six_flats_turn_c_in_60_degree_steps() -> None:
    ends = [b.c for b in milled(good("plane-xc-six-flats")) if b.line == 14]
    assert np.diff(ends) == pytest.approx([-60.0] * 5, abs=1e-3)
    assert ends[-1] == pytest.approx(-360.0, abs=6e-3)  # as near as the five decimals of the program


def test_square_and_circle_example_runs_as_documented() -> None:
    way = milled(good("plane-zc-square-circle"))
    (up,) = [b for b in way if b.line == 12]
    assert up.c == pytest.approx(-360 * 0.5625 / (pi * 0.875))
    assert up.c == pytest.approx(-73.666, abs=5e-4)
    for block in way:
        assert block.plane is not None
        assert block.z / INCH == pytest.approx(-0.1187 - block.plane.end[0] / INCH)


def test_figure_eight_example_ends_at_its_start() -> None:
    way = milled(good("plane-zc-figure-eight"))
    start, end = way[1], way[-2]
    assert (end.x, end.z, end.c) == pytest.approx((start.x, start.z, start.c))
    assert start.x / INCH == pytest.approx(-0.775 / 2)


def test_j_slot_example_runs_as_documented() -> None:
    (up,) = [b for b in milled(good("plane-zc-j-slot")) if b.line == 12]
    assert up.c == pytest.approx(39.289, abs=5e-4)

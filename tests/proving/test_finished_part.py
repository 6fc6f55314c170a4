"""The finished part for a thumbnail: before it is parted off, before the collet opens, or at the end."""

from __future__ import annotations

import numpy as np
import pytest

from core.proving.finished_part import FinishedPart, make_finished_part
from tests.path.test_part_player import HEAD, SHAFT, picture

INCH = 25.4
PINS = (
    "G90G94F300(BAR)\nM03S1500\nT1(TURNING TOOL)\nX.6Z.05\nX.3\nG95F.004Z-.5\nX.55\nG94F300Z.05\n"
    "T2(PARTING TOOL)\nX.6Z-.6\nG95F.002X-.02\nG94F300X.6\nM30\n"
)


def made(text: str) -> FinishedPart | None:
    moves = picture(text).part
    assert moves is not None
    return make_finished_part(moves, lambda _count: None)


def radius_at(part: FinishedPart, z: float) -> float:
    """The outermost metal at this Z (inches), in inches."""
    solid = part.solid
    column = int(np.searchsorted(solid.column_edges, z * INCH)) - 1
    return float(solid.outer_radii[:, column].max()) / INCH


def test_turned_shaft_has_its_radii_at_program_end() -> None:
    part = made(SHAFT)
    assert part is not None
    assert radius_at(part, -0.1) == pytest.approx(0.3, abs=1e-3)
    assert radius_at(part, -0.4) == pytest.approx(0.4, abs=1e-3)


def test_finished_part_is_that_before_parting_off() -> None:
    part = made(PINS)
    assert part is not None
    assert radius_at(part, -0.25) == pytest.approx(0.3, abs=1e-3)  # it is still on the bar
    assert radius_at(part, -0.58) > 0.3


def test_finished_part_is_that_before_collet_opens() -> None:
    part = made(SHAFT.replace("M30", "M05\nM13\nM12\nM30"))
    assert part is not None
    assert radius_at(part, -0.1) == pytest.approx(0.3, abs=1e-3)


def test_program_without_cut_has_no_finished_part() -> None:
    assert made(HEAD + "X2Z2\nX2.5\nM30\n") is None


def test_canceled_request_stops_finished_part() -> None:
    class NoLongerError(Exception):
        pass

    def watch(_count: float) -> None:
        raise NoLongerError

    moves = picture(SHAFT).part
    assert moves is not None
    with pytest.raises(NoLongerError):
        make_finished_part(moves, watch)

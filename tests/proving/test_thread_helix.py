"""Helices of threads: where the groove is at each polar angle, and which moves are one thread."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.part.picture.surface_points import Solid
from core.proving.thread_helix import ThreadZone, find_thread_zones, make_threaded_solid
from core.proving.tip_moves import TipMove

LEAD, LENGTH = 2.0, 20.0


def pass_(z: float, end: float, radius: float = 9.0, lead: float = LEAD, rpm: float = 500.0) -> TipMove:
    points = ((z, radius), (end, radius))
    return TipMove(1, 1, BlockKind.THREAD, points, 10.0, False, lead, rpm, ModalState())


def threaded(lead: float, *, inside: bool = False) -> Solid:
    """A tube of 8 to 20 mm with a groove of 0.5 mm width at each whole multiple of the lead."""
    count = 2000
    edges = np.linspace(-LENGTH, 0.0, count + 1)
    z = 0.5 * (edges[1:] + edges[:-1])
    groove = np.abs((z / LEAD + 0.5) % 1.0 - 0.5) * LEAD < 0.25
    outer = np.where(groove & (not inside), 9.0, 10.0)
    inner = np.where(groove & inside, 5.0, 4.0)
    zone = ThreadZone(-LENGTH, 0.0, 5.0 if inside else 9.0, lead)
    return make_threaded_solid(edges, inner[None], outer[None], [zone])


def groove_place(solid: Solid, ray: int, *, inside: bool = False) -> float:
    """The middle of the grooves on a ray, as a share of the lead from 0 to 1."""
    z = 0.5 * (solid.column_edges[1:] + solid.column_edges[:-1])
    radii = solid.inner_radii[0, :, ray] if inside else solid.outer_radii[0, :, ray]
    deep = radii > 4.5 if inside else radii < 9.5
    turns = np.exp(2j * math.pi * z[deep & (z > -18.0) & (z < -2.0)] / LEAD)
    return float(np.angle(turns.mean())) / (2.0 * math.pi) % 1.0


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("hand", [1.0, -1.0])
def test_groove_moves_by_lead_for_each_revolution(hand: float, inside: bool) -> None:
    """A quarter of a revolution counterclockwise moves a right-hand groove by a quarter of the lead to Z+."""
    solid = threaded(hand * LEAD, inside=inside)
    rays = solid.outer_radii.shape[2]
    for quarter in range(4):
        expected = (hand * quarter / 4.0) % 1.0
        found = groove_place(solid, rays * quarter // 4, inside=inside)
        assert min(abs(found - expected), 1.0 - abs(found - expected)) < 0.02


def test_other_side_of_tube_has_no_helix() -> None:
    assert np.ptp(threaded(LEAD).inner_radii[0]) == 0.0
    assert np.ptp(threaded(LEAD, inside=True).outer_radii[0]) == 0.0


def test_helix_does_not_change_volume_much() -> None:
    solid = threaded(LEAD)
    width = np.diff(solid.column_edges)[None, :, None]
    volume = (
        ((solid.outer_radii**2 - solid.inner_radii**2) * width).sum() * math.pi / solid.outer_radii.shape[2]
    )
    exact = math.pi * ((100.0 - 16.0) * LENGTH - (100.0 - 81.0) * 0.5 * LENGTH / LEAD)
    assert volume == pytest.approx(exact, rel=0.01)


def test_passes_of_one_thread_are_one_zone() -> None:
    found = find_thread_zones([pass_(2.0, -15.0, 9.8), pass_(1.5, -15.0, 9.4)])
    assert found == [ThreadZone(-15.0, 2.0, 9.4, LEAD)]


def test_other_lead_or_place_is_another_zone() -> None:
    assert len(find_thread_zones([pass_(2.0, -15.0), pass_(2.0, -15.0, lead=1.5)])) == 2
    assert len(find_thread_zones([pass_(2.0, -5.0), pass_(-10.0, -15.0)])) == 2


@pytest.mark.parametrize(
    ("start", "end", "rpm", "hand"),
    [(0.0, -9.0, 500.0, 1.0), (-9.0, 0.0, 500.0, -1.0), (0.0, -9.0, -500.0, -1.0), (-9.0, 0.0, -500.0, 1.0)],
)
def test_hand_follows_direction_and_spindle(start: float, end: float, rpm: float, hand: float) -> None:
    assert find_thread_zones([pass_(start, end, rpm=rpm)])[0].lead_mm == hand * LEAD


@pytest.mark.parametrize(
    "move",
    [
        pass_(0.0, -9.0)._replace(block_kind=BlockKind.FEED),
        pass_(0.0, -9.0, lead=0.0),
        pass_(-5.0, -5.0),
    ],
)
def test_other_moves_are_no_thread(move: TipMove) -> None:
    assert find_thread_zones([move]) == []

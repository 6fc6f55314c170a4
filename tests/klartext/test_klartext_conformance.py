"""The worked programs of the specification, read where they are; absent, the tests skip."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from tests.klartext.running import Ran, run_file

SPECIFICATION = Path(__file__).parents[2].parent / "shared" / "spec" / "klartext-planes.md"


@pytest.fixture(scope="module")
def programs() -> tuple[str, str]:
    """By axis angles, and the same with its planes by points."""
    if not SPECIFICATION.exists():
        pytest.skip(f"the worked programs are not here: {SPECIFICATION}")
    text = SPECIFICATION.read_text(encoding="utf-8")
    found = re.search(r"^0 BEGIN PGM.*?^\d+ END PGM[^\n]*\n", text, re.DOTALL | re.MULTILINE)
    assert found is not None
    axial = found.group()
    planes = dict(re.findall(r"^(\d+) (PLANE POINTS .* TABLE ROT)$", text, re.MULTILINE))
    points = re.sub(
        r"^(\d+) PLANE AXIAL.*$",
        lambda each: f"{each[1]} {planes[each[1]]}",
        axial,
        flags=re.MULTILINE,
    )
    assert points.count("PLANE POINTS") == 4
    return axial, points


def ends(ran: Ran) -> np.ndarray:
    return np.array([block.travel.end for block in ran.blocks if block.travel is not None])


def test_plane_axial_and_plane_points_give_same_machine_path(programs: tuple[str, str]) -> None:
    axial, points = (run_file(text) for text in programs)
    assert not axial.diagnostics
    assert not points.diagnostics
    assert np.allclose(ends(axial), ends(points), atol=1e-9)


def test_cuts_of_first_chamfer_have_expected_positions(programs: tuple[str, str]) -> None:
    feeds = [block for block in run_file(programs[0]).blocks if block.kind is BlockKind.FEED]
    down, along = (block.swivel for block in feeds[:2])
    assert down is not None
    assert along is not None
    assert down.machine_position == pytest.approx((218.0, 278.2843, -352.2183), abs=6e-5)
    assert along.machine_position == pytest.approx((342.0, 278.2843, -352.2183), abs=6e-5)


def test_rotary_angles_match_comments_of_program(programs: tuple[str, str]) -> None:
    """``; A45 C90`` behind a PLANE block is where the table stands then."""
    text = programs[0]
    said = {
        number: (float(a), float(c))
        for number, line in enumerate(text.splitlines(), start=1)
        for a, c in re.findall(r"; A(\d+) C(\d+)", line)
    }
    assert len(said) == 5
    for block in run_file(text).planes:
        if block.line in said:
            assert block.swivel is not None
            a, _, c = block.swivel.rotary_angles
            assert (a, c) == pytest.approx(said[block.line], abs=1e-9)

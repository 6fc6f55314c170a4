"""``expand``, ``prove`` and ``trace`` of the C axis and of plane switching: their keys and figures."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk

FACE = "G90G94F300\nT1M27\nM19\nX-.5Z0\nCI10S20\nG04F1\n(~PLXC)\n(X.3Y-.3F20)\n(Y.3)\n(END)\nX-.6\nM30\n"
SIDE = "G90G94F300\nT1\nM19\nX-.5Z0\n(~PLZC)\n(D.8F20)\n(END)\nM30\n"
ROUND = "G90G94F300\nT1\nM19\nX-.5Z0\n(~PLZC)\n(Z.8F20)\n(G02X.1Y.1I.1J0)\n(END)\nM30\n"


def part(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "part.nc"
    path.write_text(text)
    return path


def test_expand_of_face_milling_gives_polar_and_cartesian_positions(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    told = turndesk("expand", part(tmp_path, FACE), "--offsets", offsets, "--json")
    assert told.status == 0
    by_line = {b["line"]: b for b in told.lines}
    turn, flat = by_line[5], by_line[9]
    assert (turn["kind"], turn["c"], turn["rpm"]) == ("rotate", 10.0, 20.0)
    assert turn["feed"] is None
    assert turn["feed_mode"] is None
    # 10 degrees at 120 degrees/s and 3600 degrees/s²; it begins in the corner of the move before
    assert turn["t1"] - turn["t0"] == pytest.approx(10 / 120 + 120 / 3600, abs=1e-3)
    assert (flat["kind"], flat["px"], flat["py"], flat["pz"]) == ("plane-line", 0.3, 0.3, 0.0)
    assert (flat["pcx"], flat["pcy"], flat["dir"]) == (None, None, None)
    assert (flat["feed"], flat["feed_mode"]) == (20.0, "ipm")
    assert flat["x"] == pytest.approx(-0.3 * math.sqrt(2), abs=1e-8)
    assert flat["c"] == pytest.approx(10.0 - 45.0)
    assert by_line[11]["px"] is None


def test_expand_of_arc_on_cylinder_gives_its_positions(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    told = turndesk("expand", part(tmp_path, ROUND), "--offsets", offsets, "--json")
    arc = told.lines[-2]
    assert (arc["kind"], arc["dir"], arc["pcx"], arc["pcy"]) == ("plane-arc", "cw", 0.1, 0.0)
    assert (arc["px"], arc["py"], arc["pz"]) == (0.1, 0.1, 0.8)  # Z as a diameter
    assert (arc["z"], arc["x"]) == (-0.1, -0.4)


def test_conflicting_plane_words_are_reported_on_their_line(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    told = turndesk("prove", part(tmp_path, SIDE), "--offsets", offsets, "--json")
    assert told.status == 1
    (report,) = told.lines
    assert (6, "not-alone") in [(d["line"], d["code"]) for d in report["diagnostics"]]


def test_proof_limits_and_cutting_length_include_c_motion(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    (report,) = turndesk("prove", part(tmp_path, FACE), "--offsets", offsets, "--json").lines
    assert report["diagnostics"] == []
    limits = report["limits"]
    assert limits["c"] == [pytest.approx(-35.0), pytest.approx(55.0)]
    assert limits["rpm"] == [0.0, 0.0]
    assert limits["feed_ipm"] == [20.0, 300.0]
    assert limits["x"] == [-0.6, pytest.approx(-0.3, abs=1e-9)]  # the flat's middle
    # in: hypot(.2, .3), the flat .6, out from rho .3·sqrt(2) to .6 at the same feed
    out = 0.6 - 0.3 * math.sqrt(2)
    assert report["cutting_length"] == pytest.approx(math.hypot(0.2, 0.3) + 0.6 + out)


@pytest.mark.parametrize("dt", ["0.001", "0.0317"])
def test_setpoints_of_milled_flat_are_on_the_flat(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, dt: str
) -> None:
    out = tmp_path / "out.csv"
    assert turndesk("trace", part(tmp_path, FACE), "--offsets", offsets, "--dt", dt, "--out", out).status == 0
    with out.open() as file:
        rows = [row for row in csv.DictReader(file) if row["line"] == "9"]
    assert len(rows) > 50
    for row in rows:
        angle = math.radians(10.0 - float(row["c"]))
        assert -float(row["x"]) * math.cos(angle) == pytest.approx(0.3, abs=0.00001)

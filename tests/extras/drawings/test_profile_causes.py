"""``turndesk profile`` names one cause: a drawing in the wrong unit, a nose without a tip quadrant."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk
from tests.extras.drawings.hand import chain, dxf

CASES = Path(__file__).parents[3].parent / "shared" / "cases" / "drawings"
INCH = 1  # $INSUNITS
SHAFT = chain((0.0, 0.0), (0.0, 6.0), (-10.0, 6.0), (-14.0, 9.0), (-20.0, 9.0), (-20.0, 0.0))
LARGE = chain((0.0, 0.0), (0.0, 10.0), (-40.0, 10.0), (-40.0, 0.0))


def test_wrong_unit_is_reported_once_and_its_remedy_works(turndesk: Turndesk, tmp_path: Path) -> None:
    path = dxf(tmp_path / "x.dxf", LARGE, INCH)
    told = turndesk("profile", path)
    assert (told.status, told.code, told.err.count("\n")) == (2, "wrong-unit", 1)
    assert "is 40 in long" in told.err
    assert "use --unit mm" in told.err
    assert turndesk("profile", path, "--unit", "mm").status == 0


def test_millimeter_sample_saved_as_inch_is_reported(turndesk: Turndesk) -> None:
    path = CASES / "mm-saved-as-inch.dxf"
    if not path.is_file():
        pytest.skip(f"no {path}")
    told = turndesk("profile", path)
    assert told.code == "wrong-unit"
    assert "is 40 in long" in told.err
    assert "use --unit mm" in told.err


def test_command_reports_only_the_cause(turndesk: Turndesk, tmp_path: Path) -> None:
    sheet = tmp_path / "tools.toml"
    sheet.write_text('[tool.1]\nx = 0.5\nz = -3.0\nkind = "turning"\nnose_radius = 0.0157\n')
    told = turndesk("profile", dxf(tmp_path / "x.dxf", SHAFT), "--tools", sheet)
    assert (told.status, told.code, told.err.count("\n")) == (2, "no-tip-quadrant", 1)
    sheet.write_text(sheet.read_text() + "tip = 3\n")
    assert turndesk("profile", tmp_path / "x.dxf", "--tools", sheet).status == 0

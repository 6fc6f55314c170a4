"""Small Klartext and SINUMERIK programs that once were judged wrongly, from ``../shared/cases/dialects``.

The folder is not part of the repository; without it the tests are skipped.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from tests.cli.conftest import Turndesk
from tests.sinumerik.test_linear_third_axis import SLIDE

FOLDER = Path(__file__).parents[2].parent / "shared" / "cases" / "dialects"

ERRORS = {
    "block_delete_m30.h": [], "cycle93_flank.mpf": [], "r_parameter_of_the_operator.mpf": [],
    "s_head.mpf": [], "s_not.mpf": [], "spatial_behind_mirror.h": [], "tool_call_s_under_m128.h": [],
    "fl_acc.mpf": [(1, "not-in-subset"), (2, "not-in-subset")],
    "s_iso.mpf": [(6, "other-control"), (8, "other-control")],
    "s_thread.mpf": [(5, "cycle-parameter")], "setint.mpf": [(1, "not-in-subset")],
}  # fmt: skip
WARNINGS = {
    "block_delete_m30.h": {"Q parameter not defined"},
    "r_parameter_of_the_operator.mpf": {"r-unset"},
    "s_not.mpf": {"no-tool"},
    "spatial_behind_mirror.h": {"plane-figure"},
}
CAUSES = {
    "fl_acc.mpf": ("FL: ", "ACC: "),
    "s_iso.mpf": ("CR=2 is the radius", "F1"),
    "s_thread.mpf": ("a whole number",),
    "setint.mpf": ("SETINT: ",),
}


def proved(turndesk: Turndesk, name: str, *more: object) -> dict[str, Any]:
    """What prove says of a case, on the machine of its language."""
    if not FOLDER.is_dir():
        pytest.skip(f"no {FOLDER}")
    machine = ("--machine", "ac-table-mill" if name.endswith(".h") else "sinumerik-modulo")
    told = turndesk("prove", FOLDER / name, "--json", *(more or machine))
    found: dict[str, Any] = json.loads(told.out.splitlines()[0])
    return found


@pytest.mark.parametrize("name", list(ERRORS))
def test_case_reports_exactly_its_expected_errors_and_causes(turndesk: Turndesk, name: str) -> None:
    found = proved(turndesk, name)["diagnostics"]
    errors = [each for each in found if each["severity"] == "error"]
    assert [(each["line"], each["code"]) for each in errors] == ERRORS[name]
    assert WARNINGS.get(name, set()) <= {each["code"] for each in found if each["severity"] == "warning"}
    told = " ".join(f"{each['message']} {each['hint']}" for each in errors)
    assert all(cause in told for cause in CAUSES.get(name, ()))


def test_skipped_fault_is_an_error_with_block_delete_on(turndesk: Turndesk) -> None:
    found = proved(turndesk, "block_delete_m30.h", "--machine", "ac-table-mill", "--block-delete")
    errors = [(each["line"], each["code"]) for each in found["diagnostics"] if each["severity"] == "error"]
    assert errors == [(11, "Q parameter not defined")]


def test_tool_called_by_name_is_reported_by_name(turndesk: Turndesk) -> None:
    assert proved(turndesk, "s_head.mpf")["tools"] == ["ROUGH"]


def test_cycle93_groove_limits_include_its_flanks(turndesk: Turndesk) -> None:
    """From X40 down by 6: radius 14; roughly from Z-20 to -27.1, less the width of the tool."""
    limits = proved(turndesk, "cycle93_flank.mpf")["limits"]
    assert limits["x"][0] == pytest.approx(14.0)
    assert limits["z"][0] == pytest.approx(-27.116 + 3.0, abs=1e-3)


def test_linear_third_axis_is_measured_in_mm(turndesk: Turndesk, tmp_path: Path) -> None:
    """50 mm at 100 mm/min: 30 s."""
    text = load_shipped_machine("sinumerik-linear").text
    file = tmp_path / "y.toml"
    file.write_text(re.sub(r"\[axis\.C\].*?(?=\[spindle\])", SLIDE, text, flags=re.DOTALL), encoding="utf-8")
    found = proved(turndesk, "third_axis_linear.mpf", "--machine", file)
    assert [each for each in found["diagnostics"] if each["severity"] == "error"] == []
    assert found["cutting_time_s"] == pytest.approx(30.0, abs=0.05)
    assert found["limits"]["c"] == [0.0, 50.0]

"""Small programs that once were judged wrongly, from ``../shared/cases/proof``: the codes of their findings.

The folder is not part of the repository; without it the tests are skipped.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk

FOLDER = Path(__file__).parents[2].parent / "shared" / "cases" / "proof"
SHORT = {"thread-retract-through-bar": "bar:0.494:3.0"}
STOCK = "bar:1.0:3.0"

ERRORS = {
    "bore-without-drill": [(5, "drill-off-axis"), (6, "drill-off-axis")],
    "arc-wrong-way": [(7, "arc-loop")], "behind-the-bar": [(7, "past-stock")], "dwell-4000": [],
    "fanuc-g71": [(5, "other-control")], "fanuc-g92-thread": [], "flat-drill": [], "fresa": [],
    "g04-fanuc": [(4, "other-control"), (5, "other-control"), (6, "other-control")],
    "g33-from-x0-slow": [(5, "thread-passes")], "g33-i9999": [(5, "thread-depth")],
    "g33-k00001": [(5, "thread-lead-range")], "g72-forgotten": [(7, "arc-radius")], "g9o": [(1, "letter-o")],
    "lf-with-word": [(6, "not-alone")], "m04-front-tool": [(7, "wrong-spindle-direction")],
    "mo3": [(2, "letter-o")], "nested-comment": [(2, "comment-nested")], "no-m03": [],
    "partoff-hides-holder": [(6, "feed-into-holder")], "partoff-x04-seen": [(6, "feed-into-holder")],
    "plunge-behind-head": [], "rf-lost": [(4, "contour-open")],
    "remedies": [(3, "other-control"), (4, "letter-l"), (5, "other-control")],
    "tap-comment": [], "thread-retract-through-bar": [(6, "through-part")], "two-tools-one-place": [],
}  # fmt: skip
WARNINGS = {
    "fanuc-g92-thread": {"preset-thread"}, "no-m03": {"spindle-off"},
    "plunge-behind-head": {"wrong-side"},
}  # fmt: skip


@pytest.mark.parametrize("name", list(ERRORS))
def test_case_reports_exactly_its_expected_errors(turndesk: Turndesk, name: str) -> None:
    if not FOLDER.is_dir():
        pytest.skip(f"no {FOLDER}")
    tools, stock = FOLDER / "tools.toml", SHORT.get(name, STOCK)
    told = turndesk(
        "prove", FOLDER / f"{name}.nc", "--offsets", tools, "--tools", tools, "--stock", stock, "--json"
    )
    found = json.loads(told.out.splitlines()[0])["diagnostics"]
    assert [(each["line"], each["code"]) for each in found if each["severity"] == "error"] == ERRORS[name]
    assert WARNINGS.get(name, set()) <= {each["code"] for each in found if each["severity"] == "warning"}


def test_a_profile_is_in_the_unit_of_the_program(turndesk: Turndesk) -> None:
    """A blank of 24 mm and 50 mm: pi x 12² x 50 = 22 619.5 mm³ = 1.38031 in³."""
    if not FOLDER.is_dir():
        pytest.skip(f"no {FOLDER}")
    tools, profile = FOLDER / "tools.toml", FOLDER / "metric-profile.csv"
    given = ("--offsets", tools, "--tools", tools, "--stock", f"profile:{profile}", "--json")
    told = turndesk("prove", FOLDER / "metric.nc", *given)
    report = json.loads(told.out.splitlines()[0])
    assert report["stock"]["volume"] == pytest.approx(1.38031, abs=1e-3)
    assert [each["code"] for each in report["diagnostics"] if each["severity"] == "error"] == []

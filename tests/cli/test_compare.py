"""``prove --compare``: what other offsets make of a part, feature by feature; and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.cli.conftest import Turndesk
from tests.cli.test_prove import written

# Faced at Z0; .8 in diameter to Z-.5, 1 in diameter to Z-.9; a 1/4 in drill .5 in deep. X is a radius.
PART = (
    "G90G94F300\nM03S1500\nT1(TURN)\nX.7Z.05\nG95F.006Z0\nX-.02\nG94F300Z.05\nX.5\nG95F.006Z-.9\nX.65\n"
    "G94F300Z.05\nX.4\nG95F.006Z-.5\nX.65\nG94F300Z1\nT2(1/4 DRILL)\nX0Z.1\nG95F.004Z-.5\nG94F300Z1\nM30\n"
)
STOCK = ("--stock", "bar:1.2:2+.02")
GOOD = 0.0001  # in; what a figure is good to


def offsets_file(tmp_path: Path, name: str, **tools: tuple[float, float]) -> Path:
    rows = (f"[tool.{n[1:]}]\nx = {x:.6f}\nz = {z:.6f}\n" for n, (x, z) in tools.items())
    return Path(written(tmp_path, "".join(rows), name))


def compared(turndesk: Turndesk, path: Path, here: Path, there: Path, *more: object) -> dict[str, Any]:
    told = turndesk("prove", path, "--offsets", here, "--compare", there, *STOCK, "--json", *more)
    found: dict[str, Any] = told.lines[0]["compare"]
    return found


def differences(found: dict[str, Any], kind: str) -> list[float]:
    return [each["difference"] for each in found["features"] if each["kind"] == kind]


@pytest.fixture
def here(tmp_path: Path) -> Path:
    return offsets_file(tmp_path, "here.toml", T1=(1.25, -2.0), T2=(0.5, -3.0))


@pytest.fixture
def part(tmp_path: Path) -> Path:
    return written(tmp_path, PART)


@pytest.mark.parametrize("wear", [0.0005, -0.0005, 0.02])
def test_radial_wear_offset_changes_diameters_by_twice_its_value(
    turndesk: Turndesk, tmp_path: Path, part: Path, here: Path, wear: float
) -> None:
    there = offsets_file(tmp_path, "there.toml", T1=(1.25 + wear, -2.0), T2=(0.5, -3.0))
    found = compared(turndesk, part, here, there)
    turned = [each for each in found["features"] if each["kind"] == "diameter"][:2]
    assert [each["here"] for each in turned] == [pytest.approx(0.8, abs=GOOD), pytest.approx(1.0, abs=GOOD)]
    assert [each["difference"] for each in turned] == [pytest.approx(2 * wear, abs=GOOD)] * 2
    assert differences(found, "bore") == [pytest.approx(0.0, abs=GOOD)]
    assert differences(found, "shoulder") == [pytest.approx(0.0, abs=GOOD)] * 4


def test_z_offset_moves_only_shoulders_cut_by_that_tool(
    turndesk: Turndesk, tmp_path: Path, part: Path, here: Path
) -> None:
    there = offsets_file(tmp_path, "there.toml", T1=(1.25, -2.0), T2=(0.5, -3.003))
    found = compared(turndesk, part, here, there)
    assert differences(found, "shoulder") == [pytest.approx(0.0, abs=GOOD)] * 4
    there = offsets_file(tmp_path, "there.toml", T1=(1.25, -2.003), T2=(0.5, -3.0))
    moved = differences(compared(turndesk, part, here, there), "shoulder")
    assert moved[:3] == [pytest.approx(-0.003, abs=GOOD)] * 3  # face and both shoulders
    assert moved[3] == pytest.approx(0.0, abs=GOOD)  # the saw has cut the back


def test_same_offsets_produce_the_same_part(turndesk: Turndesk, part: Path, here: Path) -> None:
    found = compared(turndesk, part, here, here)
    assert (found["differing"], found["largest"], found["added"], found["gone"]) == (0, 0.0, [], [])
    assert found["cycle_time_s"][0] == found["cycle_time_s"][1]
    assert found["removed_volume"][0] == found["removed_volume"][1]


def test_compare_lists_new_and_removed_findings(
    turndesk: Turndesk, tmp_path: Path, part: Path, here: Path
) -> None:
    far = offsets_file(tmp_path, "far.toml", T1=(1.25, -9.0), T2=(0.5, -3.0))  # Z travels 6 in
    found = compared(turndesk, part, here, far)
    assert found["gone"] == []
    assert {each["severity"] for each in found["added"]} >= {"error"}
    beyond = [each["line"] for each in found["added"] if each["code"] == "soft-limit"]
    assert beyond  # it is there alone
    back = compared(turndesk, part, far, here)
    assert [each["line"] for each in back["gone"] if each["code"] == "soft-limit"] == beyond


def test_comparison_table_uses_the_unit_of_the_program(
    turndesk: Turndesk, tmp_path: Path, part: Path, here: Path
) -> None:
    there = offsets_file(tmp_path, "there.toml", T1=(1.2505, -2.0), T2=(0.5, -3.0))
    told = turndesk("prove", part, "--offsets", here, "--compare", there, *STOCK).out
    row = next(line for line in told.splitlines() if line.strip().startswith("diameter"))
    assert row.split()[-3:] == ["0.8000", "0.8010", "+0.0010"]
    assert "feature, in" in told
    metric = written(
        tmp_path, "G90G94F7620G71\nM03S1500\nT1(TURN)\nX15Z1\nG95F.1Z0\nX10\nZ-10\nX16\nG94F7620Z5\nM30\n"
    )
    told = turndesk("prove", metric, "--offsets", here, "--compare", there, *STOCK).out
    row = next(line for line in told.splitlines() if line.strip().startswith("diameter"))
    assert row.split()[-3:] == ["20.0000", "20.0254", "+0.0254"]
    assert "feature, mm" in told


def test_folder_comparison_has_one_line_per_program_and_full_report(
    turndesk: Turndesk, tmp_path: Path, here: Path
) -> None:
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "a.nc").write_text(PART)
    there = offsets_file(tmp_path, "there.toml", T1=(1.2505, -2.0), T2=(0.5, -3.0))
    report = tmp_path / "report.html"
    given = ("--offsets", here, "--compare", there, *STOCK, "--report", report)
    told = turndesk("prove", folder, *given).out
    assert f"with {there}: 2 of 8 diameters and shoulders differ, by 0.0010 in at most" in told
    assert "With different offsets" in report.read_text(encoding="utf-8")
    assert turndesk("prove", folder, *given, "--json").lines[0]["compare"] == compared(
        turndesk, folder / "a.nc", here, there
    )


@pytest.mark.parametrize(
    ("text", "code"),
    [(None, "unreadable"), ("[tool.1]\nx = true\n", "wrong-type"), ("x =", "not-toml"),
     ("[tool.99]\nx = 1.0\n", "unknown-number")],
)  # fmt: skip
def test_invalid_comparison_offsets_stop_prove_before_it_starts(
    turndesk: Turndesk, tmp_path: Path, part: Path, here: Path, text: str | None, code: str
) -> None:
    there = tmp_path / "there.toml"
    if text is not None:
        there.write_text(text)
    told = turndesk("prove", part, "--offsets", here, "--compare", there)
    assert (told.status, told.out, told.err.count("\n")) == (2, "", 1)
    assert told.code == code
    assert "there.toml" in told.err

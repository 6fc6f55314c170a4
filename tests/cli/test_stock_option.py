"""``prove --stock``: what the part is made of, what became of it, and what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import resources
from app.desk.stored_part import StoredPart
from core.store.store import Store
from tests.cli.conftest import Turndesk
from tests.cli.test_prove import written
from tests.texts import shows
from tests.texts import text as wording

# Tool offset 1 of the fixture; faced at Z0, .8 in diameter turned .5 in long.
PART = (
    "G90G94F300\nM03S1500\nT1\nX.6Z.05\nG95F.006Z0\nX-.02\nG94F300Z.05\n"
    "X.4\nG95F.004Z-.5\nX.55\nG94F300Z1\nM30\n"
)
KEYS = {
    "given", "volume", "removed_volume", "left_volume", "profile", "bore", "min_wall", "milled", "pieces",
}  # fmt: skip


def test_stock_json_has_its_keys_in_cubic_inches(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = written(tmp_path, PART)
    told = turndesk("prove", path, "--offsets", offsets, "--stock", "bar:1.0:2+.02", "--json")
    assert told.status == 0
    stock = told.lines[0]["stock"]
    assert set(stock) >= KEYS
    assert stock["given"] == "bar:1.0:2+.02"
    assert stock["volume"] == pytest.approx(math.pi * 0.25 * 2.0, rel=1e-4)
    removed = math.pi * 0.25 * 0.02 + math.pi * (0.25 - 0.16) * 0.5
    assert stock["removed_volume"] == pytest.approx(removed, rel=3e-3)  # but for the fillet of the nose
    assert stock["left_volume"] == pytest.approx(stock["volume"] - stock["removed_volume"], abs=2e-6)
    assert stock["profile"][0] == [pytest.approx(0.0, abs=4e-4), pytest.approx(0.4, abs=1e-3)]
    assert (stock["bore"], stock["min_wall"], stock["milled"], stock["pieces"]) == (None, None, False, [])


def test_bar_stock_is_assumed_and_reported_without_stock_option(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    path = written(tmp_path, PART)
    stock = turndesk("prove", path, "--offsets", offsets, "--json").lines[0]["stock"]
    assert stock["given"] is None
    assert any("T1" in words for words in stock["assumed"])
    assert shows(turndesk("prove", path, "--offsets", offsets).out, "cli.bar-assumed", unit="in")


def test_part_finding_makes_the_program_fail(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = written(tmp_path, PART.replace("G95F.004Z-.5", "G00Z-.5"))
    told = turndesk("prove", path, "--offsets", offsets, "--json")
    assert told.status == 0
    (found,) = [each for each in told.lines[0]["diagnostics"] if each["check"] == "rapid-into-stock"]
    assert (found["line"], found["severity"], found["assumed"]) == (9, "warning", ["stock"])
    told = turndesk("prove", path, "--offsets", offsets, "--stock", "bar:1.0:2+.02", "--json")
    assert told.status == 1
    (found,) = [each for each in told.lines[0]["diagnostics"] if each["check"] == "rapid-into-stock"]
    assert (found["line"], found["severity"], found["n"] > 0, found["assumed"]) == (9, "error", True, [])


def test_stock_of_second_program_is_the_part_left_by_the_first(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    first = written(tmp_path, PART, "first.nc")
    again = ("prove", first, "--offsets", offsets, "--json", "--stock", f"after:{first}")
    assert turndesk(*again).lines[0]["stock"]["removed_volume"] == pytest.approx(0.0, abs=1e-5)


def test_bore_left_by_first_program_remains_if_second_cuts_nothing(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    first = written(
        tmp_path, "G90G94F300\nM03S900\nT2(.25 DRILL)\nX0Z.1\nG95F.004Z-.5\nG94F300Z1\nM30\n", "first.nc"
    )
    second = written(tmp_path, "G90G94F300\nM03S900\nT1\nX1.1Z.1\nG94F5Z-.5\nF300Z1\nM30\n", "second.nc")
    told = turndesk("prove", second, "--offsets", offsets, "--json", "--stock", f"after:{first}")
    bore = told.lines[0]["stock"]["bore"]
    assert bore[0] == pytest.approx([0.0, 0.125], abs=1e-3)


def test_offsets_file_without_shapes_uses_shapes_of_the_store(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, home: Path
) -> None:
    """The store says that T1 is a drill; on the axis it takes off pi/4 x .5² x .5 = .0982 in³."""
    path = written(tmp_path, "G90G94F300\nM03S900\nT1\nX0Z.1\nG95F.004Z-.5\nG94F300Z1\nM30\n")
    assert turndesk("offsets", "set", "T1", "kind=drill", "diameter=.5", "point=180").status == 0
    told = turndesk("prove", path, "--offsets", offsets, "--stock", "bar:1:2", "--json")
    assert told.lines[0]["stock"]["removed_volume"] == pytest.approx(0.0982, abs=2e-3)
    assert told.lines[0]["stock"]["assumed"] == []


def test_stock_profile_is_read_from_a_file_of_points(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    blank = written(tmp_path, "z,r\n-2,.5\n-.5,.5\n-.5,.42\n0,.42\n", "blank.csv")
    told = turndesk(
        "prove", written(tmp_path, PART), "--offsets", offsets, "--json", "--stock", f"profile:{blank}"
    )
    removed = math.pi * (0.42**2 - 0.16) * 0.5
    assert told.lines[0]["stock"]["removed_volume"] == pytest.approx(removed, rel=0.02)


@pytest.mark.parametrize(
    ("spec", "code", "value"),
    [
        ("bar", "not-a-length", "bar"),
        ("rod:1", "unknown-form", "rod:1"),
        ("tube:1:2", "bore", "tube:1:2"),
        ("profile:nowhere.csv", "unreadable", "nowhere.csv"),
        ("after:nowhere.nc", "file-unreadable", "nowhere.nc"),
    ],
)
def test_invalid_stock_is_rejected_in_one_line(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, spec: str, code: str, value: str
) -> None:
    told = turndesk("prove", written(tmp_path, PART), "--offsets", offsets, "--stock", spec)
    assert (told.status, told.code) == (2, code)
    assert value in told.err
    assert told.err.count("\n") == 1


def test_first_program_with_errors_leaves_no_stock_for_the_second(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    bad = written(tmp_path, "G90G94F300\nQ3\nM30\n", "bad.nc")
    told = turndesk("prove", written(tmp_path, PART), "--offsets", offsets, "--stock", f"after:{bad}")
    assert (told.status, told.code) == (2, "no-part-left")


def chuck(tmp_path: Path, *lines: str) -> Path:
    """A machine file of the shipped lathe with another chuck, or without one."""
    text = Path("resources/machines/gt75.toml").read_text(encoding="utf-8")
    before, _, rest = text.partition("[clamping]")
    table = "\n".join(("[clamping]", *lines)) if lines else ""
    return written(tmp_path, f"{before}{table}\n[{rest.partition('[')[2]}", "chuck.toml")


def test_stick_out_option_adds_the_chuck_to_the_proof(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    path, machine = written(tmp_path, PART), chuck(tmp_path, "diameter = 4.0", "max_rpm = 4000")
    given = ("prove", path, "--offsets", offsets, "--machine", machine, "--stock", "bar:1", "--json")
    assert turndesk(*given).status == 0
    assert turndesk(*given, "--stick-out", ".7").status == 0
    told = turndesk(*given, "--stick-out", ".4")
    assert told.status == 1
    assert {each["check"] for each in told.lines[0]["diagnostics"]} == {"into-chuck"}


def test_stick_out_of_the_machine_file_is_used_by_default(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    machine = chuck(tmp_path, "diameter = 4.0", "stick_out = 0.4")
    told = turndesk("prove", written(tmp_path, PART), "--offsets", offsets, "--machine", machine)
    assert "into-chuck" in told.out + told.err


@pytest.mark.parametrize(("value", "code"), [(".5", "no-clamping"), ("x", "")])
def test_a_stick_out_without_a_chuck_is_refused(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, value: str, code: str
) -> None:
    given = ("prove", written(tmp_path, PART), "--offsets", offsets, "--machine", chuck(tmp_path))
    told = turndesk(*given, "--stick-out", value)
    assert (told.status, told.code) == (2, code)
    assert "--stick-out" in told.err


@pytest.mark.parametrize("value", ["0", "-1", "50"])
def test_stick_out_that_is_not_a_length_is_rejected(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, value: str
) -> None:
    given = (
        "prove",
        written(tmp_path, PART),
        "--offsets",
        offsets,
        "--machine",
        chuck(tmp_path, "diameter = 4.0"),
    )
    told = turndesk(*given, f"--stick-out={value}")
    assert (told.status, told.code) == (2, "stick-out")


SHAPES = """[tool.1]
kind = "turning"
insert = "DCMT21.51"
nose_radius = 0.0156
tip = 3
"""


def test_tools_given_in_a_file_are_not_reported_as_assumed(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    path, tools = written(tmp_path, PART), written(tmp_path, SHAPES, "tools.toml")
    told = turndesk("prove", path, "--offsets", offsets, "--tools", tools, "--json")
    assert told.status == 0
    assert told.lines[0]["stock"]["assumed"] == []


def test_a_tool_file_with_a_mistake_is_refused(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    tools = written(tmp_path, SHAPES.replace("DCMT21.51", "QXMT21.51"), "tools.toml")
    told = turndesk("prove", written(tmp_path, PART), "--offsets", offsets, "--tools", tools)
    assert (told.status, told.code) == (2, "invalid-shape")
    assert "tool.1.insert" in told.err


def test_shapes_of_the_store_are_used(turndesk: Turndesk, tmp_path: Path) -> None:
    path = written(tmp_path, PART)
    assert turndesk("offsets", "set", "T1", "x=0", "z=0", "nose_radius=.0156", "quadrant=3").status == 0
    told = turndesk("prove", path, "--json")
    assert told.lines[0]["stock"]["assumed"] != []
    assert turndesk("offsets", "set", "T1", "kind=turning", "insert=DCMT21.51").status == 0
    assert turndesk("prove", path, "--json").lines[0]["stock"]["assumed"] == []


def test_stock_of_a_program_is_saved_in_the_store(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path, other = written(tmp_path, PART), written(tmp_path, PART, "other.nc")
    given = ("--offsets", offsets, "--json")
    told = turndesk("prove", path, *given, "--stock", "bar:1.1+.02", "--keep-stock")
    assert told.lines[0]["stock"]["given"] == "bar:1.1+.02"
    assert turndesk("prove", path, *given).lines[0]["stock"]["given"] == "bar:1.1+.02"
    assert turndesk("prove", path, *given, "--stock", "bar:1.2").lines[0]["stock"]["given"] == "bar:1.2"
    assert turndesk("prove", path, *given).lines[0]["stock"]["given"] == "bar:1.1+.02"
    assert turndesk("prove", other, *given).lines[0]["stock"]["given"] is None


def test_missing_or_invalid_stock_is_not_saved(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = written(tmp_path, PART)
    told = turndesk("prove", path, "--offsets", offsets, "--keep-stock")
    assert (told.status, told.code) == (2, "nothing-to-keep")
    assert turndesk("prove", path, "--offsets", offsets, "--stock", "rod", "--keep-stock").status == 2
    assert turndesk("prove", path, "--offsets", offsets, "--json").lines[0]["stock"]["given"] is None


def test_saved_stock_file_is_found_from_any_folder_and_reported_if_missing(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, blank = written(tmp_path, PART), written(tmp_path, "-2,.5\n0,.5\n", "blank.csv")
    monkeypatch.chdir(tmp_path)
    given = ("--offsets", offsets, "--json")
    assert turndesk("prove", path, *given, "--stock", "profile:blank.csv", "--keep-stock").status == 0
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert turndesk("prove", path, *given).lines[0]["stock"]["given"].startswith("profile:")
    blank.unlink()
    told = turndesk("prove", path, *given)
    assert (told.status, told.code) == (2, "kept-stock")
    assert "part.nc" in told.err
    assert "--keep-stock" in told.err
    assert turndesk("prove", path, *given, "--stock", "bar:1", "--keep-stock").status == 0
    assert turndesk("prove", path, *given).lines[0]["stock"]["given"] == "bar:1"


SLIP = PART.replace("M30", "X.3\nG00Z-.3\nM30")


def test_disabled_check_is_reported_as_a_note_and_counted(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    path = written(tmp_path, SLIP)
    given = ("prove", path, "--offsets", offsets, "--stock", "bar:1.2")
    told = turndesk(*given, "--json")
    found = [each for each in told.lines[0]["diagnostics"] if each["check"]]
    assert told.status == 1
    assert told.lines[0]["silenced"] == 0
    check = found[0]["check"]
    assert found[0]["assumed"] == []
    machine = written(
        tmp_path,
        resources.read_machine_file("gt75.toml") + f'\n[checks]\nsilenced = ["{check}"]\n',
        "quiet.toml",
    )
    quiet = turndesk(*given, "--machine", machine, "--json")
    (note,) = [each for each in quiet.lines[0]["diagnostics"] if each["check"] == check]
    assert (quiet.status, note["severity"], note["silenced"]) == (0, "note", ("set by the machine file"))
    assert quiet.lines[0]["silenced"] == 1
    assert f"silenced 1 findings of {check}" in turndesk(*given, "--machine", machine).out


def test_check_disabled_for_a_program_applies_to_that_program_only(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, home: Path
) -> None:
    path, other = written(tmp_path, SLIP), written(tmp_path, SLIP, "other.nc")
    given = ("--offsets", offsets, "--stock", "bar:1.2")
    assert turndesk("prove", path, *given).status == 1
    with Store.open(home) as store:
        kept = StoredPart(
            silenced_checks={"rapid-into-stock": "drilled before", "through-part": "drilled before"}
        )
        for key, value in kept.make_stored_settings("part.nc").items():
            store.settings.save_setting(key, value).result()
    told = turndesk("prove", path, *given)
    assert (told.status, wording("findings.check-off", why="drilled before") in told.out) == (0, True)
    assert turndesk("prove", other, *given).status == 1
    assert turndesk("prove", path.parent, *given).status == 1  # of the folder the other one alone
    assert turndesk("prove", path, *given, "--jobs", "1").status == 0


def test_first_program_starts_with_its_saved_stock(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, home: Path
) -> None:
    """A tube of 1 in with a bore of .5, turned: the second program has a bore of .25 in radius."""
    first = written(tmp_path, PART, "first.nc")
    kept = ("prove", first, "--offsets", offsets, "--json", "--keep-stock", "--stock", "tube:1.0:.5:2")
    assert "bore" in turndesk(*kept).lines[0]["stock"]
    second = written(tmp_path, "G90G94F300\nM03S900\nT1\nX1.1Z.1\nG94F5Z-.5\nF300Z1\nM30\n", "second.nc")
    told = turndesk("prove", second, "--offsets", offsets, "--json", "--stock", f"after:{first}")
    bore = told.lines[0]["stock"]["bore"]
    assert bore is not None
    assert bore[0][1] == pytest.approx(0.25, abs=1e-3)


def test_saved_stock_that_depends_on_its_own_program_is_rejected(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, home: Path
) -> None:
    first = written(tmp_path, PART, "first.nc")
    assert turndesk("prove", first, "--offsets", offsets, "--keep-stock", "--stock", "bar:1:2").status == 0
    loop = ("--keep-stock", "--stock", f"after:{first}")
    turndesk("prove", first, "--offsets", offsets, *loop)
    again = turndesk("prove", first, "--offsets", offsets, "--json")
    assert (again.status, again.code) == (2, "kept-stock")

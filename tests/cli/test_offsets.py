"""``turndesk offsets``: inches at the door, the store behind, one line on stderr for what is refused."""

from __future__ import annotations

import io
import json
import sys
from importlib.resources import files
from pathlib import Path

import pytest

from app.cli.main import main
from app.compose.desk_assembly import create_desk_and_executor
from app.compose.machine.machine_setup import save_machine_in_use
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_stored_offsets
from core.message import CodedError
from core.store.store import Store
from core.store.store_rows import SecondaryOffsetRow, ToolOffsetRow
from drivers.wakeups import ManualClock
from tests.coded import recorded_refusals

Captured = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "home"
    monkeypatch.setenv("TURNDESK_HOME", str(folder))
    return folder


def refused(capsys: Captured, *argv: str) -> CodedError:
    """Return the error that a refused command prints on one line."""
    with pytest.MonkeyPatch.context() as patch:
        refusals = recorded_refusals(patch)
        assert main(["offsets", *argv]) == 2
    told = capsys.readouterr()
    assert (told.out, told.err) == ("", f"turndesk: {refusals[-1]}\n")
    assert told.err.count("\n") == 1
    return refusals[-1]


def shown(capsys: Captured) -> dict[str, object]:
    capsys.readouterr()
    assert main(["offsets", "show", "--json"]) == 0
    tables: dict[str, object] = json.loads(capsys.readouterr().out)
    return tables


def tool(**fields: float | str) -> dict[str, object]:
    """A tool as ``show --json`` tells it."""
    zeros = dict.fromkeys(("x", "z", "nose_radius", "wear_x", "wear_z"), 0.0)
    return {**zeros, "quadrant": 0, "remark": "", "master": False, **fields}


def test_showing_offsets_of_a_new_home_creates_no_store(capsys: Captured, home: Path) -> None:
    assert shown(capsys) == {"tool": {}, "secondary": {}}
    assert main(["offsets", "show"]) == 0
    assert capsys.readouterr().out == "no offsets are set\n"
    assert not home.exists()


def test_offsets_are_set_and_shown_in_inches(capsys: Captured, home: Path) -> None:
    assert main(["offsets", "set", "T3", "x=1.25", "z=-.5"]) == 0
    assert main(["offsets", "set", "D4", "x=-.0005"]) == 0
    assert shown(capsys) == {
        "tool": {"3": tool(x=1.25, z=-0.5)},
        "secondary": {"4": {"x": -0.0005, "z": 0.0, "r": 0.0}},
    }
    with Store.open(home, read_only=True) as store:  # millimetres inside; D's x is the radius as given
        assert store.offsets.tool_offsets.read_rows() == {3: ToolOffsetRow(1.25 * 25.4, -0.5 * 25.4, 0.0)}
        assert store.offsets.secondary_offsets.read_rows() == {
            4: SecondaryOffsetRow(-0.0005 * 25.4, 0.0, 0.0)
        }


def test_second_entry_retains_fields_it_does_not_name(capsys: Captured) -> None:
    main(["offsets", "set", "t03", "x=1", "nose_radius=.015"])
    main(["offsets", "set", "T3", "x=.5-.002", "--yes"])
    assert shown(capsys) == {"tool": {"3": tool(x=0.498, nose_radius=0.015)}, "secondary": {}}


def test_offsets_are_shown_with_five_decimals(capsys: Captured) -> None:
    main(["offsets", "set", "D4", "x=-.0005", "r=.015"])
    capsys.readouterr()
    main(["offsets", "show"])
    assert capsys.readouterr().out == "D4  X -0.00050  Z +0.00000  R 0.01500\n"


def test_clear_and_undo_are_in_the_history(capsys: Captured) -> None:
    main(["offsets", "set", "D1", "z=.1", "--yes", "--why", "long part"])
    main(["offsets", "set", "T1", "x=1"])
    assert main(["offsets", "clear", "D"]) == 0
    assert shown(capsys) == {"tool": {"1": tool(x=1.0)}, "secondary": {}}
    assert main(["offsets", "undo"]) == 0
    capsys.readouterr()
    assert main(["offsets", "history", "--json"]) == 0
    history = json.loads(capsys.readouterr().out)
    assert [(row["kind"], row["number"]) for row in history] == [
        ("secondary", 1),
        ("secondary", 1),
        ("tool", 1),
        ("secondary", 1),
    ]
    assert history[0]["undoes"] == history[1]["step"]
    assert history[3]["why"] == "long part"
    assert history[3]["old"] is None
    assert history[3]["new"] == {"x": 0.0, "z": 0.1, "r": 0.0}


def test_history_shows_old_and_new_value(capsys: Captured) -> None:
    main(["offsets", "set", "D1", "z=.1", "--yes"])
    capsys.readouterr()
    main(["offsets", "history"])
    line = capsys.readouterr().out
    assert "D1  not set → X +0.00000  Z +0.10000  R 0.00000  entered (command line)" in line


@pytest.mark.parametrize(
    ("argv", "code", "value"),
    [
        (("set", "T33", "x=1"), "unknown-offset", "T33"),
        (("set", "T0", "x=1"), "unknown-offset", "T0"),
        (("set", "X1", "x=1"), "unknown-offset", "X1"),
        (("set", "T1", "y=1"), "unknown-key", "y "),
        (("set", "T1", "nose_rad=1"), "unknown-key", "nose_radius?"),
        (("set", "D1", "nose_radius=.1"), "unknown-key", "x, z, r"),
        (("set", "T1", "x"), "no-value", "KEY=VALUE"),
        (("set", "T1", "x="), "not-a-number", "x:"),
        (("set", "T1", "x=1", "x=2"), "key-twice", "x "),
        (("set", "T1", "x=1,5"), "not-a-number", "x:"),
        (("set", "T1", "x=__import__('os')"), "not-a-number", "x:"),
        (("set", "T1", "x=1/0"), "not-a-number", "x:"),
        (("set", "T1", "x=50.1"), "out-of-range", "-50…50 in"),
        (("set", "D1", "x=10.1"), "out-of-range", "-10…10 in"),
        (("set", "D1", "r=-.001"), "out-of-range", "0…2 in"),
        (("set", "T1", "quadrant=10"), "out-of-range", "quadrant = 10 "),
        (("set", "T1", "quadrant=two"), "not-a-number", "quadrant:"),
        (("set", "T1", "wear_x=.2"), "out-of-range", "wear_x = 0.2 "),
        (("set", "T1", f"remark={'x' * 41}"), "out-of-range", "40"),
        (("set", "T1", "master=1"), "never-set", "T1"),
        (("set", "T1", "master=perhaps"), "not-a-flag", "perhaps"),
        (("set", "D1", "wear_x=.001"), "unknown-key", "wear_x"),
        (("undo",), "nothing-to-undo", ""),
        (("history", "--limit", "0"), "limit", "0"),
    ],
)
def test_rejected_entry_is_one_line_and_changes_nothing(
    capsys: Captured, argv: tuple[str, ...], code: str, value: str
) -> None:
    error = refused(capsys, *argv)
    assert error.code == code
    assert value in str(error)
    assert shown(capsys) == {"tool": {}, "secondary": {}}


@pytest.mark.parametrize("argv", [(), ("set", "T1"), ("clear",), ("nonsense",)])
def test_wrong_usage_is_reported_in_one_line(capsys: Captured, argv: tuple[str, ...]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["offsets", *argv])
    assert caught.value.code == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_one_invalid_value_of_two_sets_neither(capsys: Captured) -> None:
    refused(capsys, "set", "T1", "x=1", "z=99")
    assert shown(capsys) == {"tool": {}, "secondary": {}}


def test_store_in_use_rejects_changes_and_can_be_shown(capsys: Captured, home: Path) -> None:
    with Store.open(home) as store:
        store.offsets.tool_offsets.change_row(1, "screen", {"x": 25.4}).result()
        assert refused(capsys, "set", "T1", "x=2").code == "in-use"
        assert shown(capsys) == {"tool": {"1": tool(x=1.0)}, "secondary": {}}


def test_damaged_store_is_reported_in_one_line(capsys: Captured, home: Path) -> None:
    home.mkdir()
    (home / "turndesk.db").write_bytes(b"rubbish" * 100)
    assert refused(capsys, "show").code == "not-a-database"


def test_every_tool_field_is_set_shown_and_logged(capsys: Captured) -> None:
    main(["offsets", "set", "T3", "x=1.25", "z=-.5", "master=1"])
    main(["offsets", "set", "T3", "wear_x=-.001/2", "quadrant=3", "remark=rough, DCMT 11"])
    assert shown(capsys) == {
        "tool": {"3": tool(x=1.25, z=-0.5, wear_x=-0.0005, quadrant=3, remark="rough, DCMT 11", master=True)},
        "secondary": {},
    }
    main(["offsets", "show"])
    told = (
        "T3  X +1.25000  Z -0.50000  R 0.00000  wear X -0.00050 Z +0.00000  tip 3  master  rough, DCMT 11\n"
    )
    assert capsys.readouterr().out == told
    main(["offsets", "history", "--json"])
    newest = json.loads(capsys.readouterr().out)[0]
    assert (newest["old"]["wear_x"], newest["new"]["wear_x"]) == (0.0, -0.0005)
    assert newest["who"] == "command line"


def test_undo_and_history_cover_all_tables(capsys: Captured) -> None:
    """The youngest change of any table first: a zero offset is no longer passed by for a tool."""
    main(["offsets", "set", "T1", "x=1", "z=2"])
    main(["offsets", "set", "G54", "z=-120"])
    capsys.readouterr()
    assert main(["offsets", "history", "--json"]) == 0
    kinds = [row["kind"] for row in json.loads(capsys.readouterr().out)]
    assert sorted(kinds) == ["tool", "zero"]
    main(["offsets", "undo"])
    main(["offsets", "undo"])
    capsys.readouterr()
    assert shown(capsys)["tool"] == {}
    refused(capsys, "undo")


def test_cleared_tool_is_restored_by_undo(capsys: Captured) -> None:
    main(["offsets", "set", "T1", "x=1", "z=2"])
    main(["offsets", "set", "T1D2", "x=1", "z=3"])
    capsys.readouterr()
    error = refused(capsys, "clear", "T1")
    assert error.code == "has-further-edges"
    assert "T1 D2" in str(error)
    assert main(["offsets", "clear", "T1D2"]) == 0
    assert main(["offsets", "clear", "T1"]) == 0
    capsys.readouterr()
    assert shown(capsys) == {"tool": {}, "secondary": {}}
    assert main(["offsets", "undo"]) == 0
    capsys.readouterr()
    assert shown(capsys)["tool"] == {"1": tool(x=1.0, z=2.0)}
    assert main(["offsets", "clear", "T9"]) == 0
    assert "nothing to clear" in capsys.readouterr().out
    assert main(["offsets", "clear", "T"]) == 0
    capsys.readouterr()
    assert shown(capsys)["tool"] == {}


def test_a_value_beyond_the_travel_is_refused_even_with_yes(capsys: Captured) -> None:
    for consent in ((), ("--yes",)):
        error = refused(capsys, "set", "T1", "x=-15", "z=0", *consent)
        assert error.code == "beyond-travel"
        assert "T1 x not set → -15.00000 in" in str(error)
    assert shown(capsys) == {"tool": {}, "secondary": {}}


@pytest.mark.parametrize(
    ("entry", "value"),
    [("x=-1.2", "x +1.20000 → -1.20000 in"), ("z=.1", "z +0.00000 → +0.10000 in"), ("wear_x=.02", "wear_x")],
)
def test_a_large_change_needs_consent(capsys: Captured, entry: str, value: str) -> None:
    assert main(["offsets", "set", "T1", "x=1.2", "z=0"]) == 0
    capsys.readouterr()
    before = shown(capsys)
    error = refused(capsys, "set", "T1", entry)
    assert error.code == "not-confirmed"
    assert value in str(error)
    assert shown(capsys) == before
    assert main(["offsets", "set", "T1", entry, "--yes"]) == 0
    assert shown(capsys) != before


@pytest.mark.parametrize(("typed", "status"), [("y", 0), ("n", 2), ("", 2)])
def test_large_change_is_confirmed_at_a_terminal(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch, typed: str, status: int
) -> None:
    assert main(["offsets", "set", "T1", "x=1.2", "z=0"]) == 0
    terminal = io.StringIO(f"{typed}\n")
    monkeypatch.setattr(terminal, "isatty", lambda: True)
    monkeypatch.setattr("sys.stdin", terminal)
    assert main(["offsets", "set", "T1", "x=2"]) == status
    assert shown(capsys)["tool"] == {"1": tool(x=2.0 if typed == "y" else 1.2)}


def test_master_change_that_moves_followers_needs_confirmation(capsys: Captured) -> None:
    for name in ("T1", "T2"):
        assert main(["offsets", "set", name, "x=1", "z=0"]) == 0
    capsys.readouterr()
    error = refused(capsys, "set", "T2", "master=1")
    assert (error.code, "followers: T1" in str(error)) == ("not-confirmed", True)
    assert main(["offsets", "set", "T2", "master=1", "--yes"]) == 0


def exported(folder: Path, offsets: str = "", mill: str = "") -> Path:
    """Return an exported folder with one program, these tools and these tools of a mill."""
    (folder / "programs").mkdir(parents=True)
    (folder / "programs" / "pin.nc").write_bytes(b"M30\n")
    (folder / "offsets.toml").write_text(offsets)
    if mill:
        (folder / "mill_tools.csv").write_text(mill)
    return folder


def imported(monkeypatch: pytest.MonkeyPatch, folder: Path, *options: str) -> str:
    """Import the folder; return the code of the refusal, empty if the import was done."""
    refusals = recorded_refusals(monkeypatch)
    status = main(["store", "import", str(folder), *options])
    return "" if status == 0 else refusals[-1].code


def test_an_import_beyond_the_travel_is_refused_as_a_whole(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, home: Path
) -> None:
    folder = exported(tmp_path / "out", "[tool.1]\nx = 1.0\nz = 0.0\n[tool.2]\nx = -15.0\nz = 0.0\n")
    assert imported(monkeypatch, folder, "--yes") == "beyond-travel"
    assert shown(capsys) == {"tool": {}, "secondary": {}}
    with Store.open(home, read_only=True) as store:
        assert store.programs.list_programs() == ()


def test_an_import_of_a_large_change_needs_consent(
    capsys: Captured, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert main(["offsets", "set", "T1", "x=1.2", "z=0"]) == 0
    folder = exported(tmp_path / "out", "[tool.1]\nx = -1.2\nz = 0.0\n")
    assert imported(monkeypatch, folder) == "not-confirmed"
    assert shown(capsys)["tool"] == {"1": tool(x=1.2)}
    assert imported(monkeypatch, folder, "--yes") == ""
    assert shown(capsys)["tool"] == {"1": tool(x=-1.2)}


def test_an_import_of_a_large_change_of_a_mill_needs_consent(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, home: Path
) -> None:
    assert main(["offsets", "set", "TOOL1", "L=80"]) == 0
    folder = exported(tmp_path / "out", mill="number,length\n1,8.0\n")
    assert imported(monkeypatch, folder) == "not-confirmed"
    with Store.open(home) as store:
        assert store.offsets.mill_tools.read_rows()[1].length == 80.0
    assert imported(monkeypatch, folder, "--yes") == ""


@pytest.mark.parametrize("entry", ["L=8", "DL=.3", "R=6"])
def test_a_large_change_of_a_tool_of_a_mill_needs_consent(capsys: Captured, home: Path, entry: str) -> None:
    assert main(["offsets", "set", "TOOL1", "L=80", "R=5"]) == 0
    capsys.readouterr()
    assert refused(capsys, "set", "TOOL1", entry).code == "not-confirmed"
    with Store.open(home) as store:
        assert store.offsets.mill_tools.read_rows()[1][1:5] == (80.0, 5.0, 0.0, 0.0)


# --- the machine in use -------------------------------------------------------------------------------------


def shorter(folder: Path) -> Path:
    """Return a machine file of a lathe whose X travels 2 in from home."""
    text = files("resources").joinpath("machines", "gt75.toml").read_text("utf-8")
    path = folder / "short.toml"
    path.write_text(text.replace("travel = [-4.0, 4.0]", "travel = [-2.0, 2.0]"))
    return path


def test_travel_limits_are_those_of_the_machine_last_used_by_screen(
    capsys: Captured, tmp_path: Path, home: Path
) -> None:
    machine = shorter(tmp_path)
    assert main(["offsets", "set", "T1", "x=3", "z=0"]) == 0  # the shipped lathe travels 4 in
    journal = Journal(home)
    desk, _executor = create_desk_and_executor(str(machine), read_stored_offsets, ManualClock(), journal)
    desk.close()
    journal.close()
    capsys.readouterr()
    assert refused(capsys, "set", "T1", "x=3.01").code == "beyond-travel"
    assert refused(capsys, "set", "T2", "x=3", "z=0", "--yes").code == "beyond-travel"
    assert main(["offsets", "set", "T1", "x=3.01", "--machine", "gt75"]) == 0


def test_offsets_cannot_be_set_if_machine_file_is_missing(
    capsys: Captured, tmp_path: Path, home: Path
) -> None:
    machine = shorter(tmp_path)
    journal = Journal(home)
    save_machine_in_use(str(machine), journal)
    journal.close()
    machine.unlink()
    assert "--machine" in str(refused(capsys, "set", "T1", "x=1", "z=0"))
    assert shown(capsys) == {"tool": {}, "secondary": {}}
    assert main(["offsets", "set", "T1", "x=1", "z=0", "--machine", "gt75"]) == 0


def test_import_uses_the_travel_limits_of_the_given_machine(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    folder, machine = exported(tmp_path / "out", "[tool.1]\nx = 3.0\nz = 0.0\n"), shorter(tmp_path)
    assert imported(monkeypatch, folder, "--machine", str(machine)) == "beyond-travel"
    assert imported(monkeypatch, folder, "--machine", "gt75") == ""


# --- all or nothing -----------------------------------------------------------------------------------------


def test_rejected_tool_shape_leaves_the_offset_unchanged(capsys: Captured) -> None:
    assert main(["offsets", "set", "T3", "x=1", "z=0", "kind=drill", "diameter=.25"]) == 0
    before = shown(capsys)
    assert refused(capsys, "set", "T3", "x=1.01", "point=999").code == "out-of-range"
    assert shown(capsys) == before


@pytest.mark.skipif(sys.platform == "win32", reason="links of POSIX")
@pytest.mark.parametrize("words", [("show",), ("set", "T3", "x=1", "z=-1"), ("history",), ("undo",)])
def test_link_to_an_unmounted_disk_is_not_an_empty_store(
    words: tuple[str, ...], capsys: Captured, home: Path
) -> None:
    home.mkdir(exist_ok=True)
    (home / "turndesk.db").symlink_to("/nowhere/turndesk.db")
    assert refused(capsys, *words).code == "link-without-target"
    assert (home / "turndesk.db").is_symlink()

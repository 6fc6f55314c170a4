"""``turndesk store``: there and back, and what it refuses."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path

import pytest

from app.cli.main import main
from core.message import CodedError
from core.store import database
from core.store.store import Store
from core.store.store_rows import SecondaryOffsetRow, ToolOffsetRow
from tests.coded import recorded_refusals
from tests.texts import text as wording

Captured = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "home"
    monkeypatch.setenv("TURNDESK_HOME", str(folder))
    return folder


@pytest.fixture
def filled(home: Path) -> Path:
    with Store.open(home) as store:
        store.offsets.tool_offsets.change_row(1, "x", {"x": 31.75, "nose_radius": 0.015 * 25.4})
        store.offsets.secondary_offsets.change_row(4, "x", {"x": -0.0127})
        store.programs.save_version("PIN.nc", b"G90\r\n", "x").result()
    return home


def test_store_of_an_older_version_is_upgraded(
    filled: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured, refusals: list[CodedError]
) -> None:
    newer = (*database.load_migrations(), "CREATE TABLE extra (a);")
    monkeypatch.setattr(database, "load_migrations", lambda: newer)
    assert main(["offsets", "show"]) == 2
    (error,) = refusals
    assert error.code == "older-version"
    assert "turndesk store upgrade" in str(error)
    assert main(["store", "upgrade"]) == 0
    assert main(["offsets", "show"]) == 0
    assert "T1" in capsys.readouterr().out


def test_upgrade_without_a_store_creates_nothing(home: Path, capsys: Captured) -> None:
    assert main(["store", "upgrade"]) == 0
    assert wording("cli.no-stored-data", folder=home) in capsys.readouterr().out
    assert not home.exists()


def test_store_of_a_newer_version_is_not_changed(
    filled: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    older = database.load_migrations()[:-1]
    monkeypatch.setattr(database, "load_migrations", lambda: older)
    assert refused(capsys, "upgrade").code == "newer-version"


def refused(capsys: Captured, *argv: str) -> CodedError:
    """Return the error that a refused command prints on one line."""
    with pytest.MonkeyPatch.context() as patch:
        refusals = recorded_refusals(patch)
        assert main(["store", *argv]) == 2
    told = capsys.readouterr()
    assert (told.out, told.err) == ("", f"turndesk: {refusals[-1]}\n")
    assert told.err.count("\n") == 1
    return refusals[-1]


def test_backup_is_restored_into_the_store(capsys: Captured, filled: Path, tmp_path: Path) -> None:
    target = str(tmp_path / "b.db")
    assert main(["store", "backup", target]) == 0
    with Store.open(filled) as store:
        store.offsets.tool_offsets.change_row(1, "x", {"x": 0.0}).result()
    assert main(["store", "restore", target]) == 0
    told = capsys.readouterr().out
    (replaced,) = filled.glob("turndesk-replaced-*.db")
    saved = wording("cli.previous-data", path=replaced)
    assert told.endswith(wording("cli.restored", folder=filled, path=target, saved=saved) + "\n")
    with Store.open(filled) as store:
        assert store.offsets.tool_offsets.read_rows()[1].x == 31.75


def test_a_restore_without_a_previous_store_names_no_saved_file(
    capsys: Captured, filled: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target, second = str(tmp_path / "b.db"), tmp_path / "second"
    assert main(["store", "backup", target]) == 0
    monkeypatch.setenv("TURNDESK_HOME", str(second))
    capsys.readouterr()
    assert main(["store", "restore", target]) == 0
    said = wording("cli.restored", folder=second, path=target, saved="")
    assert capsys.readouterr().out == f"{said}\n"


def test_export_and_import_into_an_empty_home(
    filled: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = str(tmp_path / "out")
    assert main(["store", "export", folder]) == 0
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "second"))
    assert main(["store", "import", folder]) == 0
    with Store.open(tmp_path / "second") as store:
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(31.75, 0.0, 0.015 * 25.4)}
        assert store.offsets.secondary_offsets.read_rows() == {4: SecondaryOffsetRow(-0.0127, 0.0, 0.0)}
        assert store.programs.load_version("PIN.nc") == b"G90\r\n"
        assert store.offsets.read_history()[0].why == wording("cli.import-from", folder="out")


def test_export_and_import_transfer_every_offset_field(
    capsys: Captured, filled: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    row = ToolOffsetRow(1.0, 2.0, 0.4, -0.01, 0.02, 3, 'a "rough" one, 45°', master=True)
    with Store.open(filled) as store:
        store.offsets.tool_offsets.change_row(2, "x", row._asdict()).result()
    folder = tmp_path / "out"
    main(["store", "export", str(folder)])
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "second"))
    assert main(["store", "import", str(folder)]) == 0
    with Store.open(tmp_path / "second") as store:
        again = store.offsets.tool_offsets.read_rows()[2]
    assert again[:6] == pytest.approx(row[:6])
    assert again[6:] == row[6:]
    text = (folder / "offsets.toml").read_text().replace("master = false", "master = true")
    (folder / "offsets.toml").write_text(text)
    capsys.readouterr()
    error = refused(capsys, "import", str(folder))
    assert error.code == "two-masters"
    assert "tool.1 and tool.2" in str(error)


def test_verify_reports_undamaged_store_or_damaged_rows(capsys: Captured, filled: Path) -> None:
    assert main(["store", "verify", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["problems"] == []
    with sqlite3.connect(filled / "turndesk.db") as connection:
        connection.execute("UPDATE program_versions SET text = X'58'")
    connection.close()
    assert main(["store", "verify"]) == 1
    told = capsys.readouterr()
    assert told.out == ""
    assert wording("log.differs-from-saved", what="'PIN.nc' version 1") in told.err


def test_verify_without_a_store_creates_nothing(capsys: Captured, home: Path) -> None:
    assert main(["store", "verify"]) == 0
    assert wording("cli.no-stored-data", folder=home) in capsys.readouterr().out
    assert not home.exists()


def test_store_commands_reject_invalid_paths_and_files(
    capsys: Captured, filled: Path, tmp_path: Path
) -> None:
    (tmp_path / "part.nc").write_bytes(b"G90")
    assert refused(capsys, "backup", str(tmp_path / "part.nc")).code == "not-a-database"
    error = refused(capsys, "restore", str(tmp_path / "none.db"))
    assert error.code == "not-found"
    assert "none.db" in str(error)
    assert refused(capsys, "restore", str(tmp_path / "part.nc")).code == "not-a-database"
    assert refused(capsys, "export", str(filled)).code == "folder-not-empty"
    assert refused(capsys, "import", str(tmp_path / "none")).code == "not-an-export"
    assert (tmp_path / "part.nc").read_bytes() == b"G90"


def test_restore_into_a_store_in_use_is_refused(capsys: Captured, filled: Path, tmp_path: Path) -> None:
    target = str(tmp_path / "b.db")
    main(["store", "backup", target])
    capsys.readouterr()
    with Store.open(filled):
        assert refused(capsys, "restore", target).code == "in-use"


def test_import_of_an_invalid_offsets_file_changes_nothing(
    capsys: Captured, filled: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    main(["store", "export", str(folder)])
    capsys.readouterr()
    (folder / "offsets.toml").write_text("[tool.1]\nx = 999\n")
    (folder / "programs" / "NEW.nc").write_bytes(b"G91")
    error = refused(capsys, "import", str(folder))
    assert error.code == "out-of-range"
    assert "tool.1.x = 999 " in str(error)
    with Store.open(filled, read_only=True) as store:
        assert [row.name for row in store.programs.list_programs()] == ["PIN.nc"]


def test_backup_without_a_store_is_refused(capsys: Captured, tmp_path: Path) -> None:
    assert refused(capsys, "backup", str(tmp_path / "b.db")).code == "no-store"

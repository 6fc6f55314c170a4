"""Cells that no version of ours wrote, and a schema that SQLite cannot even quote: one sentence each."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from core.store import backup
from core.store.damaged_rows import make_row_label
from core.store.store import Store, StoreError
from core.store.store_export import export_store
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import ToolOffsetRow
from tests.coded import raises_code


@pytest.fixture
def kept(folder: Path) -> Path:
    """T1 with two changes, and a program."""
    with Store.open(folder) as store:
        store.offsets.tool_offsets.change_row(1, "touched", {"x": 1.0}).result()
        store.offsets.tool_offsets.change_row(1, "worn", {"x": 2.0}).result()
        store.programs.save_version("pin.nc", b"G90\nM30\n", "written").result()
        store.runs.add_parts("pin.nc").result()
    return folder


def spoil(folder: Path, statement: str, *values: object) -> None:
    with closing(sqlite3.connect(folder / STORE_FILE_NAME)) as connection:
        connection.execute(statement, values)
        connection.commit()


@pytest.mark.parametrize("value", ["a\nb", b"\xff", "nought"])
def test_history_entry_that_is_not_a_number_is_reported_and_not_undone(kept: Path, value: object) -> None:
    spoil(kept, "UPDATE offset_changes SET old_x = ? WHERE id = 2", value)
    with Store.open(kept) as store:
        with raises_code(StoreError, "damaged-history", "entry 2"):
            store.offsets.tool_offsets.read_history()
        with raises_code(StoreError, "damaged-history", "entry 2"):
            store.offsets.undo_last_step().result()
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(x=2.0)}
        store.offsets.tool_offsets.change_row(1, "worn", {"x": 3.0}).result()  # the table itself is whole
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(x=3.0)}


def test_program_text_that_is_not_bytes_is_damaged(kept: Path) -> None:
    spoil(kept, "UPDATE program_versions SET text = ?", "G90\nM30\n")
    [problem] = backup.find_store_problems(kept / STORE_FILE_NAME)
    assert problem.startswith("'pin.nc' version 1 ")
    with Store.open(kept) as store, raises_code(StoreError, "damaged-version", "version 1"):
        store.programs.load_version("pin.nc")


def test_schema_names_that_are_not_text_are_file_damage(kept: Path) -> None:
    path = kept / STORE_FILE_NAME
    content = path.read_bytes()
    at = content.index(b"CREATE INDEX") if b"CREATE INDEX" in content else -1
    assert at > 0
    name = content.index(b"(", at) + 2
    path.write_bytes(content[:name] + b"\xd7" + content[name + 1 :])
    with raises_code(StoreError, "damaged") as told:
        Store.open(kept)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(("word", "of"), [(b"REAL", 2), (b"who", 0)])
def test_damaged_column_type_or_name_is_reported_with_remedy(kept: Path, word: bytes, of: int) -> None:
    """SQLite has no code for it, so it was some other trouble, without a remedy."""
    content = bytearray((kept / STORE_FILE_NAME).read_bytes())
    content[content.index(word, content.index(b"CREATE TABLE offset_changes")) + of] |= 0x80
    (kept / STORE_FILE_NAME).write_bytes(content)
    with raises_code(StoreError, "damaged", "turndesk store restore FILE"):
        Store.open(kept)


def test_name_with_line_break_stays_on_one_line_of_message(kept: Path) -> None:
    spoil(kept, "UPDATE part_counts SET program = ?", "a\nb")
    with Store.open(kept) as store:
        [first, *_] = store.find_damaged_rows()
        assert first.startswith(make_row_label("part_counts", "a b"))


@pytest.mark.parametrize("name", ["../pin.nc", "/tmp/pin.nc", b"\xff\x00", "pin\0.nc", ""])
def test_program_name_with_a_path_is_not_exported(kept: Path, tmp_path: Path, name: object) -> None:
    spoil(kept, "UPDATE programs SET name = ?", name)
    with Store.open(kept) as store, raises_code(StoreError, "invalid-name"):
        export_store(store, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert list(tmp_path.rglob("pin*")) == []


def test_version_number_with_line_break_stays_on_one_line_of_message(kept: Path) -> None:
    spoil(kept, "UPDATE program_versions SET number = ?, text = ?", "a\nb", b"M30\n")
    assert backup.find_store_problems(kept / STORE_FILE_NAME)[0].startswith("'pin.nc' version a b ")
    with Store.open(kept) as store, raises_code(StoreError, "damaged-version", "version a b"):
        store.programs.load_version("pin.nc")


@pytest.mark.parametrize("step", [float("inf"), 1e308, 2**63 - 1, "x", b"\xff"])
def test_offset_can_be_changed_after_damaged_history_step(kept: Path, step: object) -> None:
    spoil(kept, "UPDATE offset_changes SET step = ? WHERE id = 2", step)
    with Store.open(kept) as store:
        store.offsets.tool_offsets.change_row(1, "worn", {"x": 3.0}).result()
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(x=3.0)}
    with closing(sqlite3.connect(kept / STORE_FILE_NAME)) as connection:
        assert connection.execute("SELECT step FROM offset_changes WHERE id = 3").fetchone() == (2,)


def test_export_stops_at_column_name_that_is_not_text(kept: Path, tmp_path: Path) -> None:
    path = kept / STORE_FILE_NAME
    content = path.read_bytes()
    at = content.index(b"CREATE TABLE tool_lives")
    name = content.index(b"tool", at + 24)
    path.write_bytes(content[:name] + b"\x83" + content[name + 1 :])
    with raises_code(StoreError, "damaged") as told, Store.open(kept) as store:
        export_store(store, tmp_path / "out")
    assert "\n" not in str(told.value)
    assert not (tmp_path / "out").exists()

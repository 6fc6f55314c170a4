"""A store of every released version is opened and upgraded without a loss; a newer one is refused."""

from __future__ import annotations

import re
from hashlib import sha256
from pathlib import Path

import pytest

from app import VERSION
from core.store import database
from core.store.store import Store, StoreError
from tests.coded import raises_code
from tests.documents.changelog import UNRELEASED, releases
from tests.documents.pages import ROOT
from tests.store.released_store import RELEASED, dump, main, restore

FILES = sorted(RELEASED.glob("*.sql"))
each_release = pytest.mark.parametrize("file", FILES, ids=lambda path: path.stem)


@each_release
def test_a_released_store_upgrades_without_a_loss(file: Path, folder: Path) -> None:
    restore(file.read_text(encoding="utf-8"), folder)
    with Store.open(folder) as store:
        row = store.offsets.tool_offsets.read_rows()[1]
        assert (row.x, row.z, row.wear_x) == (1.25, -0.5, -0.004)
        assert [change.why for change in store.offsets.read_history()] == ["wear", "first"]
        assert store.programs.load_version("peg.nc") == b"G90\nX1.25\nM30\n"
        assert store.runs.read_part_count("peg.nc") == 1
        assert [event.text for event in store.events.read_events(kinds=("start",))] == ["peg.nc"]
        assert store.settings.read_setting("theme") == "dark"
        assert [person.name for person in store.people.read_users().rows] == ["ANNA"]
        assert store.find_damaged_rows() == ()
    assert database.check_store_file(folder / "turndesk.db", is_thorough=True) == len(
        database.load_migrations()
    )


@each_release
def test_a_released_store_that_a_newer_version_has_upgraded_is_refused(file: Path, folder: Path) -> None:
    newer = len(database.load_migrations()) + 1
    text = re.sub(
        r"PRAGMA user_version = \d+;", f"PRAGMA user_version = {newer};", file.read_text(encoding="utf-8")
    )
    path = restore(text, folder)
    before = sha256(path.read_bytes()).hexdigest()
    with raises_code(StoreError, "newer-version"):
        Store.open(folder)
    assert sha256(path.read_bytes()).hexdigest() == before


@each_release
def test_a_changed_value_in_a_released_store_is_repaired(file: Path, folder: Path) -> None:
    text = file.read_text(encoding="utf-8")
    spoilt = re.sub(r"(INSERT INTO \"tool_offsets\" VALUES\(1,)1\.25", r"\g<1>1.26", text)
    assert spoilt != text
    restore(spoilt, folder)
    with Store.open(folder) as store:
        assert len(store.repair_messages) == 1
        assert store.offsets.tool_offsets.read_rows()[1].x == 1.25  # from the history


@each_release
def test_a_changed_value_without_a_history_is_not_used(file: Path, folder: Path) -> None:
    text = file.read_text(encoding="utf-8")
    spoilt = text.replace("'peg.nc',3", "'peg.nc',4")
    assert spoilt != text
    restore(spoilt, folder)
    with Store.open(folder) as store:
        assert len(store.find_damaged_rows()) == 1


def test_every_released_version_has_a_sample_store() -> None:
    released = {each.version for each in releases((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))}
    assert (released - {UNRELEASED}) | {VERSION} <= {path.stem for path in FILES}


def test_sample_store_of_this_version_is_what_it_writes(tmp_path: Path, folder: Path) -> None:
    """Until its release, a version may change; the file must follow."""
    assert main([str(tmp_path)]) == 0
    made = (tmp_path / f"{VERSION}.sql").read_text(encoding="utf-8")
    saved = (RELEASED / f"{VERSION}.sql").read_text(encoding="utf-8")
    assert _tables(made) == _tables(saved)
    assert _tables(dump(restore(made, folder))) == _tables(made)


def _tables(text: str) -> dict[str, int]:
    """Return the number of rows of each table, and the version of the store."""
    counts = dict.fromkeys(re.findall(r'^CREATE TABLE "?(\w+)', text, re.MULTILINE), 0)
    for name in re.findall(r'^INSERT INTO "?(\w+)', text, re.MULTILINE):
        counts[name] = counts.get(name, 0) + 1
    return counts | {"version": int(re.findall(r"user_version = (\d+)", text)[0])}

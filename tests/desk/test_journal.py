"""The journal while a backup takes the store's place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.compose.journal import UNDER_WAY, Journal
from app.desk.persistence import Persistence
from core.executor.snapshot import Event
from core.store.store_errors import StoreError
from tests.interrupted import broken_off


@pytest.fixture
def journal(tmp_path: Path) -> Iterator[Journal]:
    journal = Journal(tmp_path / "home")
    yield journal
    journal.close()


def test_the_journal_keeps_all_that_there_is_to_keep() -> None:
    asked = {name for name, what in vars(Persistence).items() if callable(what) and not name.startswith("_")}
    assert len(asked) > 10
    assert asked <= vars(Journal).keys()


def test_a_bad_backup_leaves_everything_as_it_was(journal: Journal, tmp_path: Path) -> None:
    bad = tmp_path / "bad.db"
    bad.write_bytes(b"no database" * 50)
    journal.hear(Event(0.0, "start", "before"))
    with pytest.raises(StoreError, match="is not a database"):
        journal.restore(bad)
    journal.hear(Event(0.0, "start", "after"))
    journal.save_version("a.nc", b"M30", "so that all is written")
    assert [event.text for event in journal.events("", (), 9)] == ["after", "before"]
    assert journal.trouble == ""


def test_a_part_made_meanwhile_is_counted_in_the_restored_store(journal: Journal, tmp_path: Path) -> None:
    journal.hear(Event(0.0, "load", "/programs/pin.nc"))
    journal.save_version("pin.nc", b"M30", "test")
    target = tmp_path / "copy.db"
    journal.backup(target)
    book = journal.book()
    before = book.store
    journal.restore(target)
    journal.hear(Event(0.0, "part", "part 1"))
    journal.save_version("pin.nc", b"M02", "so that all is written")
    assert journal.parts("pin.nc") == 1
    assert book.poll() == ""
    assert book.store is not before
    assert book.changes == 1


def test_a_backup_brings_no_interrupted_job_and_takes_none_away(journal: Journal, tmp_path: Path) -> None:
    """Whose tool stands in a part is of this machine and of now."""
    journal.note(broken_off(line=3))
    journal.save_version("pin.nc", b"M30", "so that all is written")
    target = tmp_path / "copy.db"
    journal.backup(target)
    journal.note(broken_off(line=8))
    journal.restore(target)
    journal.close()
    again = Journal(tmp_path / "home")
    assert again.left == broken_off(line=8)
    again.note(None)
    again.save_version("pin.nc", b"M02", "so that all is written")
    again.restore(target)
    again.close()
    last = Journal(tmp_path / "home")
    assert last.left is None
    last.close()


def test_a_job_that_cannot_be_read_is_none(journal: Journal, tmp_path: Path) -> None:
    journal.save_setting(UNDER_WAY, {"line": "eight"})
    journal.close()
    again = Journal(tmp_path / "home")
    assert (again.left, again.trouble) == (None, "")
    again.close()


def test_without_a_store_nothing_is_backed_up_or_restored(tmp_path: Path) -> None:
    (tmp_path / "home").write_text("a file where the folder should be")
    journal = Journal(tmp_path / "home")
    assert journal.trouble
    for call in (lambda: journal.backup(tmp_path / "x.db"), lambda: journal.restore(tmp_path / "x.db")):
        with pytest.raises(StoreError):
            call()
    journal.save_setting("a", 1)
    assert journal.setting("a") is None
    assert journal.parts("pin.nc") == 0
    journal.close()

"""Programs that were loaded last: their order, their number, and what is stored."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.recent_programs import MAX_RECENT_PROGRAMS, RECENT_PROGRAMS_SETTING, RecentPrograms
from app.programs.program_rows import find_missing_reason, list_recent_programs
from core.store.store_errors import StoreError


def save_now(save: Callable[[], None]) -> None:
    save()


def make_list(persistence: Persistence) -> RecentPrograms:
    return RecentPrograms(persistence, save_now)


@pytest.fixture
def recent(tmp_path: Path) -> RecentPrograms:
    return make_list(Persistence())


def test_the_program_that_was_loaded_last_is_first(recent: RecentPrograms, tmp_path: Path) -> None:
    for name in ("a.nc", "b.nc", "a.nc"):
        recent.add(str(tmp_path / name))
    assert recent.paths == (tmp_path / "a.nc", tmp_path / "b.nc")


def test_the_oldest_program_of_a_full_list_is_dropped(recent: RecentPrograms, tmp_path: Path) -> None:
    for number in range(MAX_RECENT_PROGRAMS + 2):
        recent.add(str(tmp_path / f"{number}.nc"))
    assert len(recent.paths) == MAX_RECENT_PROGRAMS == 10
    assert recent.paths[-1] == tmp_path / "2.nc"  # 12 were added; 0.nc and 1.nc were dropped


def test_the_list_is_read_again_at_the_next_start(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    first = make_list(journal)
    first.add("/shop/part.nc")
    first.add("/shop/other.nc")
    first.remove(Path("/shop/part.nc"))
    journal.close()
    journal = Journal(tmp_path)
    try:
        assert make_list(journal).paths == (Path("/shop/other.nc"),)
    finally:
        journal.close()


@pytest.mark.parametrize(
    ("stored", "paths"),
    [
        (None, ()),
        ("part.nc", ()),
        ({"a": "/a.nc"}, ()),
        ([1, None, ["/b.nc"], "/a.nc"], ("/a.nc",)),
        (["relative.nc", "", "/a\0.nc", "/a.nc", "/a.nc"], ("/a.nc",)),
        ([f"/{number}.nc" for number in range(11)], tuple(f"/{number}.nc" for number in range(10))),
    ],
)
def test_invalid_stored_values_are_ignored(stored: object, paths: tuple[str, ...]) -> None:
    persistence = Persistence(settings={RECENT_PROGRAMS_SETTING: stored})
    assert make_list(persistence).paths == tuple(map(Path, paths))


def test_stored_programs_survive_a_store_that_cannot_be_read_for_a_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(_self: Persistence, _key: str) -> object:
        raise StoreError("busy")

    persistence = Persistence(settings={RECENT_PROGRAMS_SETTING: ["/a.nc", "/b.nc"]})
    recent = make_list(persistence)
    with monkeypatch.context() as patched:
        patched.setattr(Persistence, "read_setting", fail)
        recent.add("/c.nc")
        assert recent.paths == ()
    recent.add("/d.nc")
    assert recent.paths == (Path("/d.nc"), Path("/a.nc"), Path("/b.nc"))


def test_a_store_that_cannot_be_read_gives_an_empty_list(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_self: Persistence, _key: str) -> object:
        raise StoreError("damaged")

    monkeypatch.setattr(Persistence, "read_setting", fail)
    assert make_list(Persistence()).paths == ()


def test_removing_an_unknown_program_changes_nothing(recent: RecentPrograms, tmp_path: Path) -> None:
    recent.add(str(tmp_path / "a.nc"))
    recent.remove(tmp_path / "b.nc")
    assert recent.paths == (tmp_path / "a.nc",)


def test_a_missing_file_and_a_folder_are_listed_with_the_reason(tmp_path: Path) -> None:
    own, folder = tmp_path / "programs", tmp_path / "folder.nc"
    own.mkdir()
    folder.mkdir()
    (own / "good.nc").write_text("G90\nM30\n")
    paths = [own / "good.nc", tmp_path / "gone.nc", folder]
    rows = list_recent_programs(paths, ProgramFolders((own,)), own, Persistence())
    assert [row.missing_reason for row in rows] == ["", "THE FILE NO LONGER EXISTS", "IT IS NOT A FILE"]
    assert [row.is_outside for row in rows] == [False, True, True]


def test_recent_programs_of_another_control_are_marked(tmp_path: Path) -> None:
    (tmp_path / "a.nc").write_text("O1\nM30\n")
    (tmp_path / "b.nc").write_text("G90\nM30\n")

    def recognize(lines: Sequence[str]) -> str:
        return "FANUC" if lines[0].startswith("O") else ""

    paths = [tmp_path / "a.nc", tmp_path / "b.nc", tmp_path / "gone.nc"]
    rows = list_recent_programs(paths, ProgramFolders((tmp_path,)), tmp_path, Persistence(), recognize)
    assert [row.control_name for row in rows] == ["FANUC", "", ""]


def test_a_path_below_a_file_is_not_readable(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    assert find_missing_reason(tmp_path / "a" / "b.nc") == "Not a directory"  # the text of the system

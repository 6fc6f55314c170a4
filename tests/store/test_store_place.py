"""What has the store's name and is no file is refused by name, and nothing takes its place."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from core.store import backup
from core.store.store import Store, StoreError
from core.store.store_file import STORE_FILE_NAME, has_store
from tests.coded import raises_code

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="links and pipes of POSIX")


def _link(path: Path) -> None:
    path.symlink_to("/nowhere/turndesk.db")


def _pipe(path: Path) -> None:
    os.mkfifo(path)


def _folder(path: Path) -> None:
    path.mkdir()


PLACES = [(_link, "link-without-target"), (_pipe, "not-a-file"), (_folder, "not-a-file")]


def look(path: Path) -> tuple[int, int]:
    found = path.lstat()
    return stat.S_IFMT(found.st_mode), found.st_ino


@pytest.fixture
def good(tmp_path: Path) -> Path:
    with Store.open(tmp_path / "other") as store:
        store.offsets.tool_offsets.change_row(3, "touched", {"x": 1.0}).result()
    backup.back_up_store(tmp_path / "other", tmp_path / "b.db")
    return tmp_path / "b.db"


@pytest.mark.parametrize(("put", "code"), PLACES)
def test_invalid_store_file_is_rejected_by_name_and_unchanged(
    put: Callable[[Path], None], code: str, folder: Path, good: Path
) -> None:
    """A link whose disk was not mounted was read as a store with nothing in it, and replaced by one."""
    folder.mkdir()
    path = folder / STORE_FILE_NAME
    put(path)
    before = look(path)
    assert has_store(folder)
    for refused in (
        lambda: Store.open(folder),
        lambda: Store.open(folder, read_only=True),
        lambda: backup.back_up_store(folder, folder / "b.db"),
        lambda: backup.restore_store(folder, good),
        lambda: backup.find_store_problems(path),
        lambda: backup.back_up_store(good.parent / "other", path),
    ):
        with raises_code(StoreError, code, path):
            refused()
    assert look(path) == before


def test_folder_link_without_target_is_not_an_empty_store(folder: Path) -> None:
    folder.symlink_to("/nowhere/home")
    with raises_code(StoreError, "not-found"):
        Store.open(folder, read_only=True)
    with raises_code(StoreError, "cannot-make-folder"):
        Store.open(folder)


def test_linked_store_stays_on_its_disk(folder: Path, tmp_path: Path, good: Path) -> None:
    """A restore put a file in the place of the link, and looked for the log beside it."""
    disk = tmp_path / "disk"
    disk.mkdir()
    folder.mkdir()
    with Store.open(tmp_path / "made") as store:
        store.offsets.tool_offsets.change_row(3, "touched", {"x": 2.0}).result()
    (tmp_path / "made" / STORE_FILE_NAME).rename(disk / "shop.db")
    (folder / STORE_FILE_NAME).symlink_to(disk / "shop.db")
    with Store.open(folder) as store:
        assert store.offsets.tool_offsets.read_rows()[3].x == 2.0
    backup.restore_store(folder, good)
    assert (folder / STORE_FILE_NAME).is_symlink()
    for each in (folder, disk):
        assert not [path for path in each.iterdir() if path.name.endswith(("-wal", ".unfinished"))]
    with Store.open(folder) as store:
        assert store.offsets.tool_offsets.read_rows()[3].x == 1.0


def test_has_store_is_true_only_for_existing_store(folder: Path) -> None:
    assert not has_store(folder)
    with Store.open(folder):
        assert has_store(folder)

"""What a data folder holds is read by its owner alone, whatever the umask was when it was made."""

from __future__ import annotations

import os
import stat
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from core.file_replacement import restrict_access, restrict_folder_access
from core.store import backup
from core.store.store import Store
from core.store.store_file import STORE_FILE_NAME

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows keeps its own rights")


@pytest.fixture(autouse=True)
def _wide_umask() -> Iterator[None]:
    before = os.umask(0)
    yield
    os.umask(before)


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def modes(folder: Path) -> dict[str, int]:
    return {path.name: mode(path) for path in folder.iterdir()}


def test_new_folder_is_private_to_its_owner(folder: Path, tmp_path: Path) -> None:
    with Store.open(folder) as store:
        store.settings.save_setting("a", 1).result()
        assert {f"{STORE_FILE_NAME}-wal", f"{STORE_FILE_NAME}-shm", "turndesk.lock"} < set(modes(folder))
        assert set(modes(folder).values()) == {0o600}
        backup.back_up_store(folder, tmp_path / "b.db")
    assert (mode(folder), mode(tmp_path / "b.db")) == (0o700, 0o600)


def test_access_to_readable_folder_is_restricted_on_opening(folder: Path) -> None:
    with Store.open(folder):
        pass
    for name in ("logs", "backups"):
        (folder / name).mkdir()
        (folder / name / "old").touch()
    (folder / "turndesk-version-3.db").touch()
    folder.chmod(0o755)
    (folder / STORE_FILE_NAME).chmod(0o644)
    with Store.open(folder):
        assert {mode(path) for path in (folder, folder / "logs", folder / "backups")} == {0o700}
        assert {mode(path) for path in folder.rglob("*") if path.is_file()} == {0o600}


def test_files_saved_by_restore_are_private_too(folder: Path, tmp_path: Path) -> None:
    with Store.open(folder):
        pass
    backup.back_up_store(folder, tmp_path / "b.db")
    folder.chmod(0o755)
    (folder / STORE_FILE_NAME).chmod(0o644)
    kept = backup.restore_store(folder, tmp_path / "b.db")
    assert kept is not None
    assert (mode(kept), mode(folder / STORE_FILE_NAME), mode(folder)) == (0o600, 0o600, 0o700)


def test_shared_and_missing_folders_are_unchanged(tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    shared.mkdir()
    shared.chmod(0o1777)
    restrict_access(shared)
    restrict_access(tmp_path / "nowhere")
    restrict_folder_access(tmp_path / "nowhere")
    assert mode(shared) == 0o1777


def test_target_of_symbolic_link_is_unchanged(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").touch(0o644)
    folder = tmp_path / "home"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path / "elsewhere")
    restrict_folder_access(folder)
    assert mode(tmp_path / "elsewhere") == 0o644

"""Folders of sessions of HAL whose control was killed: removed once nothing runs there any more."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

import pytest

from drivers.hal.hal_session import create_session_folder, remove_old_session_folders


@pytest.fixture(autouse=True)
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def nobody_waits() -> bool:
    raise AssertionError("there was nothing to wait for")


def test_used_session_folder_stays_and_abandoned_one_is_removed() -> None:
    used, lock = create_session_folder()
    deserted, its_lock = create_session_folder()
    (deserted / "session.hal").write_text("")
    os.close(its_lock)
    remove_old_session_folders(nobody_waits)
    assert used.exists()
    assert not deserted.exists()
    os.close(lock)


def test_folder_of_a_running_process_is_removed_only_after_it_ends() -> None:
    folder, lock = create_session_folder()
    os.close(lock)
    still_runs = ["sh", "-c", "echo runs; read x; exit", str(folder)]
    with subprocess.Popen(still_runs, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as left:
        assert left.stdout
        # A process that is just being begun has no command line yet.
        assert left.stdout.readline() == b"runs\n"
        remove_old_session_folders(lambda: False)
        assert folder.exists()

        def ends() -> bool:
            left.communicate(b"\n")
            return True

        remove_old_session_folders(ends)
    assert not folder.exists()


def test_folders_of_other_programs_are_not_removed(tmp_path: Path) -> None:
    other, link = tmp_path / "turndesk-hal-other", tmp_path / "turndesk-hal-link"
    other.mkdir()  # without a lock: somebody else's, or just being made
    link.symlink_to(other)
    remove_old_session_folders(nobody_waits)
    assert other.exists()
    assert link.is_symlink()

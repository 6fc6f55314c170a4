"""The log folder: a file for each run without a screen, and none kept for ever."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

import pytest

from app.compose.runs import run_log
from app.compose.runs.error_log import ErrorLog
from app.compose.runs.run_log import EventLog
from core.executor.snapshot import LogEvent

DAY = 86_400.0


def a_file(folder: Path, name: str, days: float, size: int = 10) -> Path:
    """A file of the log folder that was written so many days ago."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_bytes(bytes(size))
    at = time.time() - days * DAY
    os.utime(path, (at, at))
    return path


def begun(home: Path) -> set[str]:
    """The files that are left once another run has begun its own, without that."""
    with EventLog.create("PIN.nc") as log:
        return {path.name for path in (home / "logs").iterdir() if path != log.path}


def test_run_logs_older_than_a_year_are_deleted(home: Path) -> None:
    a_file(home / "logs", "old.jsonl", 367.0)
    a_file(home / "logs", "crash-old.txt", 367.0)
    a_file(home / "logs", "young.jsonl", 365.0)
    assert begun(home) == {"young.jsonl"}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows keeps its own rights")
def test_log_files_are_readable_by_owner_only(home: Path) -> None:
    before = os.umask(0)
    try:
        failures = ErrorLog()
        with EventLog.create("PIN.nc") as log:
            modes = {path.name: path.stat().st_mode & 0o777 for path in (home / "logs").iterdir()}
        failures.close()
    finally:
        os.umask(before)
    assert modes == {log.path.name: 0o600, "turndesk.log": 0o600}


def test_number_of_run_logs_is_limited(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_log, "MAX_FILES", 3)
    for days in (1, 2, 3, 4):
        a_file(home / "logs", f"{days}.jsonl", days)
    assert begun(home) == {"1.jsonl", "2.jsonl"}  # three with the new one


def test_total_size_of_run_logs_is_limited(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_log, "MAX_TOTAL_BYTES", 250)
    for days in (1, 2, 3):
        a_file(home / "logs", f"{days}.jsonl", days, size=100)
    assert begun(home) == {"1.jsonl", "2.jsonl"}


def test_files_that_are_not_run_logs_are_not_deleted(home: Path) -> None:
    for name in ("turndesk.log", "turndesk.log.1", "notes.txt"):
        a_file(home / "logs", name, 1000.0)
    assert begun(home) == {"turndesk.log", "turndesk.log.1", "notes.txt"}


def test_clock_set_back_deletes_no_run_log(home: Path) -> None:
    a_file(home / "logs", "tomorrow.jsonl", -30.0)
    assert begun(home) == {"tomorrow.jsonl"}


def test_run_log_that_cannot_be_deleted_does_not_stop_the_run(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    a_file(home / "logs", "old.jsonl", 400.0)

    def refused(_path: Path) -> None:
        raise PermissionError

    monkeypatch.setattr(Path, "unlink", refused)
    assert begun(home) == {"old.jsonl"}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a disk that is always full")
def test_full_disk_under_run_log_is_reported_and_does_not_stop_the_run(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was told of the output, and whatever came behind it was left undone."""
    opened = Path.open
    full = Path("/dev/full")
    monkeypatch.setattr(Path, "open", lambda _path, *_how, **_named: opened(full, "w", encoding="utf-8"))
    with EventLog.create("PIN.nc") as log:
        log.write_event(LogEvent(0.1, "stop", "M01 optional stop", 7))
        assert log.error_text == ""  # it waits in memory yet
    assert log.error_text == f"{log.path}: the event log cannot be written: No space left on device"
    with EventLog.create("PIN.nc") as log:
        for number in range(2_000):
            log.write_event(LogEvent(0.1 * number, "stop", "M01 optional stop", 7))
        assert "No space left on device" in log.error_text

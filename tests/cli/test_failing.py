"""What TurnDesk says when it fails itself: a crash file in the log folder, no display, no log."""

from __future__ import annotations

import logging
import os
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from app.cli.bug_report.crash_report import report_crash, report_thread_exception
from app.cli.main import main
from app.compose.runs import error_log
from app.compose.runs.error_log import ErrorLog
from core.executor.raised_alarm import AlarmError, log_alarm, make_alarm_and_reaction

CODE = "from app.cli.main import run_console; import sys; sys.argv = ['turndesk']; sys.exit(run_console())"


def crash(text: str) -> None:
    """As the interpreter does with what nobody catches."""
    error = RuntimeError(text)
    report_crash(type(error), error, error.__traceback__)


def test_each_crash_gets_its_own_file_in_log_folder(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    crash("first")
    crash("second")
    files = sorted((home / "logs").glob("crash-*.txt"))
    assert len(files) == 2
    texts = "".join(file.read_text() for file in files)
    assert "RuntimeError: first" in texts
    assert "RuntimeError: second" in texts
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 2
    assert str(home / "logs") in told[0]
    assert "Traceback" not in "".join(told)


def test_crash_file_is_saved_elsewhere_without_a_log_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "file"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    crash("nowhere")
    assert str(tmp_path / "crash-") in capsys.readouterr().err


def test_crash_that_cannot_be_saved_is_still_reported_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "file"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "file"))
    crash("nowhere")
    assert capsys.readouterr().err.count("\n") == 1


def test_failing_thread_leaves_a_crash_file_and_prints_one_line(
    home: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail() -> None:
        raise RuntimeError("in a thread")

    monkeypatch.setattr(threading, "excepthook", report_thread_exception)
    thread = threading.Thread(target=fail, name="preview")
    thread.start()
    thread.join()
    (file,) = (home / "logs").glob("crash-*.txt")
    assert "RuntimeError: in a thread" in file.read_text()
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "Traceback" not in told


@pytest.mark.skipif(sys.platform != "linux", reason="displays of Linux")
@pytest.mark.parametrize(
    ("display", "says"),
    [
        ({"DISPLAY": ":7777"}, "no display found at DISPLAY=:7777"),
        (
            {"WAYLAND_DISPLAY": "/nowhere/wayland-9"},
            "no display found at WAYLAND_DISPLAY=/nowhere/wayland-9",
        ),
        ({"WAYLAND_DISPLAY": "w9", "DISPLAY": ":7777"}, "WAYLAND_DISPLAY=w9 or DISPLAY=:7777"),
        ({"QT_QPA_PLATFORM": "xcb"}, "neither DISPLAY nor WAYLAND_DISPLAY is set"),
        ({"QT_QPA_PLATFORM": "nonsense"}, "QT_QPA_PLATFORM=nonsense"),
        ({"DISPLAY": "rubbish"}, "no display found at DISPLAY=rubbish"),
    ],
)
def test_missing_display_is_reported_in_one_line_without_crash_file(
    tmp_path: Path, display: dict[str, str], says: str
) -> None:
    """And status 2, where Qt alone would abort with a core dump."""
    bare = {
        name: value
        for name, value in os.environ.items()
        if name not in {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}
    }
    around = {**bare, "TURNDESK_HOME": str(tmp_path), **display}
    done = subprocess.run(
        [sys.executable, "-c", CODE], env=around, capture_output=True, text=True, timeout=150, check=False
    )
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert says in done.stderr
    assert "headless" in done.stderr
    assert list(tmp_path.glob("logs/crash*")) == []


def test_missing_system_library_is_reported_without_traceback(
    home: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing() -> str:
        raise ImportError("libGL.so.1: cannot open shared object file: No such file or directory")

    monkeypatch.setenv("QT_QPA_PLATFORM", "offscreen")
    monkeypatch.setattr("app.screen.display.find_display_error", missing)
    assert main([]) == 2
    said = capsys.readouterr().err
    assert said.startswith("turndesk: libGL.so.1: cannot open shared object file")
    assert said.endswith("install the system packages that README.md names\n")


def test_missing_turndesk_module_raises_import_error(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> str:
        raise ImportError("cannot import name 'x' from 'app'")

    monkeypatch.setenv("QT_QPA_PLATFORM", "offscreen")
    monkeypatch.setattr("app.screen.display.find_display_error", missing)
    with pytest.raises(ImportError):
        main([])


def test_log_folder_that_cannot_be_created_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "logs").write_text("a file stands where the folder should be")
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    log = ErrorLog()
    assert log.error_text.startswith(f"the log cannot be written to {tmp_path / 'logs'}: ")
    log.close()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a disk that is always full")
def test_full_disk_under_log_is_reported_without_traceback(
    home: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (home / "logs").mkdir(parents=True)
    (home / "logs" / "turndesk.log").symlink_to("/dev/full")
    log = ErrorLog()
    assert log.error_text == ""
    logging.getLogger("test").warning("lost")
    log.close()
    assert "No space left on device" in log.error_text
    assert "Traceback" not in capfd.readouterr().err


def test_log_rotates_when_it_reaches_its_maximum_size(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(error_log, "_MAX_BYTES", 2_000)
    log = ErrorLog()
    for number in range(200):
        logging.getLogger("test").warning("line %d of the night", number)
    log.close()
    files = sorted((home / "logs").glob("turndesk.log*"))
    assert [file.name for file in files] == ["turndesk.log", "turndesk.log.1", "turndesk.log.2"]
    assert all(file.stat().st_size <= 2_000 for file in files)
    lines = [line for file in reversed(files) for line in file.read_text().splitlines()]
    assert lines[-1].endswith("line 199 of the night")
    assert [int(line.split()[-4]) for line in lines] == list(range(200 - len(lines), 200))


def test_removed_log_folder_is_reported_without_traceback(
    home: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """The file is open yet; that the folder has gone is found when the next one is begun."""
    monkeypatch.setattr(error_log, "_MAX_BYTES", 300)
    log = ErrorLog()
    logging.getLogger("test").warning("the first line")
    log._listener.stop()
    log._listener.start()
    shutil.rmtree(home / "logs")
    for number in range(20):
        logging.getLogger("test").warning("line %d of the night", number)
    log._listener.stop()
    log._listener.start()
    assert "the log cannot be written" in log.error_text
    log.close()
    assert "Traceback" not in capfd.readouterr().err


def test_a_record_of_the_log_has_time_thread_and_alarm(home: Path) -> None:
    log = ErrorLog()
    log_alarm(make_alarm_and_reaction(AlarmError("driver", "setpoints of a wrong shape", 7), 0, 1.0)[0])
    log.close()
    (line,) = (home / "logs" / "turndesk.log").read_text().splitlines()
    assert "MainThread" in line
    assert line.endswith("alarm 104 driver line 7: setpoints of a wrong shape")

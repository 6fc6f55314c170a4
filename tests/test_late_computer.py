"""Which failures a late computer leaves without a verdict, and which not."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.late_computer import command_was_late, forget, stalls_told, tell, told_late, without_verdict


def told_by(home: Path, *events: tuple[str, str]) -> bool:
    log = home / "logs" / "run.jsonl"
    log.parent.mkdir(parents=True, exist_ok=True)
    log.write_text("".join(json.dumps({"kind": kind, "text": text}) + "\n" for kind, text in events))
    return command_was_late(home)


@pytest.mark.parametrize(
    ("first", "late"),
    [("late", True), ("hal-silent", True), ("following", False), ("estop", False)],
)
def test_late_computer_counts_if_it_is_reported_first(first: str, late: bool) -> None:
    tell(first)
    tell("late")
    assert told_late() is late


@pytest.mark.parametrize(
    ("code", "marked", "verdict"),
    [("late", True, "skipped"), ("following", True, "failed"), ("late", False, "failed")],
)
def test_only_a_real_time_test_on_a_late_computer_has_no_verdict(
    code: str, marked: bool, verdict: str
) -> None:
    mark = pytest.mark.real_time.mark if marked else None
    item: Any = SimpleNamespace(location=("a.py", 1, "test"), get_closest_marker=lambda _name: mark)
    report: Any = SimpleNamespace(outcome="failed", failed=True, longrepr="why")
    tell(code)
    without_verdict(item, report)
    forget()
    assert report.outcome == verdict


def test_other_cause_before_lateness_counts(tmp_path: Path) -> None:
    wrong = ("alarm", "102 FOLLOWING ERROR: X"), ("stop", "903 THE COMPUTER WAS TOO LATE")
    assert not told_by(tmp_path, *wrong)


def test_spindle_stop_is_not_lateness_without_a_preceding_stall(tmp_path: Path) -> None:
    stop = "stop", "225 SPINDLE HAS STOPPED: something"
    assert not told_by(tmp_path, stop)


def test_spindle_stop_is_lateness_after_a_stall(tmp_path: Path) -> None:
    assert told_by(
        tmp_path, ("starved", "the control was away"), ("stop", "225 SPINDLE HAS STOPPED: something")
    )


def test_stalled_process_is_reported_and_running_process_is_not() -> None:
    forget()
    tick = threading.Event()
    with stalls_told(-1.0):  # whatever it took, it was longer
        while not told_late():
            tick.wait(0.001)
    forget()
    with stalls_told(1e9):
        tick.wait(0.1)
    assert not told_late()


def test_drives_off_is_lateness_only_with_stalled_hal_thread(tmp_path: Path) -> None:
    off = "alarm", "106 DRIVES STAY OFF: something"
    assert not told_by(tmp_path, off)
    forget()
    assert told_by(tmp_path, off, ("alarm", "533 HAL'S REAL-TIME THREAD STANDS: something"))
    forget()

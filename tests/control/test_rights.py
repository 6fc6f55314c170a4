"""What the system grants the process of the control, and what the operator reads where it refuses."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

import pytest

from app.compose.control import process_rights_check
from app.compose.control.process_rights_check import (
    NICE_VALUE,
    READING_PRIORITY,
    REAL_TIME_PRIORITY,
    acquire_rights,
    check_rights,
)
from drivers.process_rights import lower_thread_priority

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="rights of Linux")
REFUSED = PermissionError(errno.EPERM, os.strerror(errno.EPERM))


class System:
    """The system's answers, and what was asked of it."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *, grants: bool) -> None:
        self.asked = list[object]()
        self.grants = grants
        monkeypatch.setattr(os, "sched_getscheduler", lambda _: os.SCHED_OTHER)
        monkeypatch.setattr(os, "sched_getparam", lambda _: os.sched_param(0))
        monkeypatch.setattr(os, "getpriority", lambda *_: 0)
        monkeypatch.setattr(os, "sched_setscheduler", self.schedule)
        monkeypatch.setattr(os, "setpriority", self.be_nice)
        self.memory = ("", 0) if grants else ("not allowed", 1 << 23)
        monkeypatch.setattr(process_rights_check, "lock_process_memory", lambda **_: self.memory)

    def schedule(self, _who: int, policy: int, param: os.sched_param) -> None:
        """Another policy; back to the usual one is always granted."""
        self.asked.append((policy, param.sched_priority))
        if not self.grants and policy != os.SCHED_OTHER:
            raise REFUSED

    def be_nice(self, _which: int, _who: int, value: int) -> None:
        """Another nice value."""
        self.asked.append(value)
        if not self.grants and value < 0:
            raise REFUSED


def test_granted_rights_are_not_reported_as_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System(monkeypatch, grants=True)
    granted = acquire_rights()
    assert [right.missing for right in granted] == ["", ""]
    assert system.asked == [(os.SCHED_RR, REAL_TIME_PRIORITY)]  # no nice value beside it


def test_each_missing_right_is_reported_with_its_remedy(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    grouped = tmp_path / "autogroup"
    grouped.write_text("1\n")
    monkeypatch.setattr(process_rights_check, "_AUTOGROUP", grouped)
    system = System(monkeypatch, grants=False)
    refused = acquire_rights()
    assert [bool(right.missing) for right in refused] == [True, True, True, False]
    assert NICE_VALUE in system.asked
    grouped.write_text("0\n")
    assert len(acquire_rights()) == 3
    grouped.unlink()
    assert len(acquire_rights()) == 3


def test_nice_value_is_used_if_real_time_priority_is_denied(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System(monkeypatch, grants=False)
    monkeypatch.setattr(os, "setpriority", lambda *_: None)
    real_time, _, nice, *_ = acquire_rights()
    assert real_time.missing
    assert (nice.granted, nice.missing) == (str(NICE_VALUE), "")
    assert system.asked == [(os.SCHED_RR, REAL_TIME_PRIORITY)]


def test_limited_locked_memory_is_reported_with_its_size(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System(monkeypatch, grants=True)
    system.memory = ("", 64 << 20)
    _, memory = acquire_rights()
    assert memory.missing == ""
    assert "64" in memory.granted


@pytest.mark.parametrize("grants", [True, False])
def test_checking_rights_restores_the_previous_priority(
    monkeypatch: pytest.MonkeyPatch, grants: bool
) -> None:
    system = System(monkeypatch, grants=grants)
    found = check_rights()
    assert bool(found[0].missing) is not grants
    assert system.asked[-2:] == [(os.SCHED_OTHER, 0), 0]


@pytest.mark.parametrize("policy", [os.SCHED_RR, os.SCHED_FIFO])
def test_a_thread_of_a_real_time_process_has_a_lower_priority(
    monkeypatch: pytest.MonkeyPatch, policy: int
) -> None:
    system = System(monkeypatch, grants=True)
    monkeypatch.setattr(os, "sched_getscheduler", lambda _: policy)
    lower_thread_priority(READING_PRIORITY)
    assert system.asked == [(policy, 1)]
    assert READING_PRIORITY < REAL_TIME_PRIORITY


def test_thread_without_real_time_priority_is_unchanged(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System(monkeypatch, grants=True)
    lower_thread_priority(READING_PRIORITY)
    assert system.asked == []
    monkeypatch.delattr(os, "sched_getscheduler")
    lower_thread_priority(READING_PRIORITY)
    assert system.asked == []


def test_denied_lower_priority_is_not_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System(monkeypatch, grants=False)
    monkeypatch.setattr(os, "sched_getscheduler", lambda _: os.SCHED_RR)
    lower_thread_priority(READING_PRIORITY)
    assert system.asked == [(os.SCHED_RR, 1)]


def test_system_without_priority_calls_reports_missing_rights(monkeypatch: pytest.MonkeyPatch) -> None:
    System(monkeypatch, grants=True)
    monkeypatch.delattr(os, "sched_setscheduler")
    monkeypatch.delattr(os, "setpriority")
    real_time, _, nice, *_ = acquire_rights()
    assert real_time.missing
    assert nice.missing

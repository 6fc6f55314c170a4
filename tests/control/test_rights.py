"""What the system grants the process of the control, and what the operator reads where it refuses."""

from __future__ import annotations

import ctypes
import errno
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import pytest

from app.compose.backends.backend_entry import NO_PRIORITY_TEXT
from app.compose.control import process_rights_check
from app.compose.control.control_client import ControlEventHandlers
from app.compose.control.live_control import LiveControl
from app.compose.control.process_rights_check import (
    NICE_VALUE,
    READING_PRIORITY,
    REAL_TIME_PRIORITY,
    ProcessRight,
    acquire_rights,
    check_rights,
)
from app.compose.machine.machine_files import load_shipped_machine
from app.desk.status.alarm_log import AlarmLog
from core.executor.snapshot import LogEvent
from core.store.store_rows import EventRow
from drivers.process_rights import lower_thread_priority, unlock_process_memory
from drivers.wakeups import ManualClock
from tests.named import ROOT
from tests.texts import text as wording

if TYPE_CHECKING:
    from app.compose.control.control_client import ControlClient

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
        monkeypatch.setattr(process_rights_check, "lock_process_memory", self.lock)
        monkeypatch.setattr(process_rights_check, "unlock_process_memory", self.unlock)
        self.locked = False

    def schedule(self, _who: int, policy: int, param: os.sched_param) -> None:
        """Another policy; back to the usual one is always granted."""
        self.asked.append((policy, param.sched_priority))
        if not self.grants and policy != os.SCHED_OTHER:
            raise REFUSED

    def refuse_nice(self, _which: int, _who: int, value: int) -> None:
        """A system that grants no nice value below zero."""
        self.asked.append(value)
        if value < 0:
            raise REFUSED

    def lock(self, *, only_used: bool) -> tuple[str, int]:
        """Locked memory, of which only what is used counts."""
        assert only_used
        self.locked = not self.memory[0]
        return self.memory

    def unlock(self) -> None:
        """Memory as before."""
        self.locked = False

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
    assert [bool(right.missing) for right in refused] == [True, True, True, True]
    assert "sched_autogroup_enabled = 0" in refused[-1].missing
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
def test_checking_rights_restores_the_previous_priority_and_memory(
    monkeypatch: pytest.MonkeyPatch, grants: bool
) -> None:
    system = System(monkeypatch, grants=grants)
    found = check_rights()
    assert bool(found[0].missing) is not grants
    assert system.asked[-2:] == [(os.SCHED_OTHER, 0), 0]
    assert not system.locked


def test_check_with_the_shipped_limits_reports_nothing_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    system = System(monkeypatch, grants=True)
    monkeypatch.setattr(os, "setpriority", system.refuse_nice)
    found = check_rights()
    assert [(right.name, right.missing) for right in found] == [
        ("real-time priority", ""),
        ("locked memory", ""),
    ]
    assert [right.granted for right in found] == ["SCHED_RR 40", "all"]


@pytest.mark.parametrize("limits", ["resources/setup/debian/limits.conf", "docs/integrator/computer.md"])
def test_each_advised_limit_is_in_the_shipped_file_and_on_the_page(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, limits: str
) -> None:
    System(monkeypatch, grants=False)
    monkeypatch.setattr(process_rights_check, "_AUTOGROUP", tmp_path / "missing")
    missing = [right.missing for right in check_rights()]
    advised = [found[1] for text in missing if (found := re.search("'@machine - (.*?)'", text))]
    assert len(advised) == len(missing) == 3
    lines = (ROOT / limits).read_text(encoding="utf-8").splitlines()
    shipped = [" ".join(line.split()[2:]) for line in lines if line.strip().startswith("@machine")]
    assert sorted(shipped) == sorted(advised)


@pytest.mark.parametrize("kind", ["scheduling", "memory", "nice", "autogroup"])
@pytest.mark.parametrize("grants", [True, False])
def test_check_reports_each_right_as_granted_or_with_its_remedy(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, kind: str, grants: bool
) -> None:
    grouped = tmp_path / "autogroup"
    grouped.write_text("0" if grants else "1")
    monkeypatch.setattr(process_rights_check, "_AUTOGROUP", grouped)
    system = System(monkeypatch, grants=False)
    if grants and kind == "scheduling":
        system.grants = True
    if grants and kind == "memory":
        system.memory = ("", 0)
    if grants and kind == "nice":
        monkeypatch.setattr(os, "setpriority", lambda *_: None)
    name, granted, refused, remedy = {
        "scheduling": ("real-time priority", "SCHED_RR 40", "no", "@machine - rtprio 60"),
        "memory": ("locked memory", "all", "no", "@machine - memlock unlimited"),
        "nice": ("nice value", "-10", "0", "@machine - nice -10"),
        "autogroup": ("process groups by session", None, "on", "kernel.sched_autogroup_enabled = 0"),
    }[kind]
    found = {right.name: right for right in check_rights()}
    if grants and granted is None:
        assert name not in found
    elif grants:
        assert (found[name].granted, found[name].missing) == (granted, "")
    else:
        assert found[name].granted == refused
        assert remedy in found[name].missing


@pytest.mark.parametrize("failed", ["lock_process_memory", "_check_autogroup"])
def test_rights_are_released_although_the_check_fails(monkeypatch: pytest.MonkeyPatch, failed: str) -> None:
    system = System(monkeypatch, grants=False)

    def fail(**_values: object) -> None:
        raise RuntimeError(failed)

    monkeypatch.setattr(process_rights_check, failed, fail)
    with pytest.raises(RuntimeError, match=failed):
        check_rights()
    assert system.asked[-2:] == [(os.SCHED_OTHER, 0), 0]
    assert not system.locked


def test_memory_can_be_unlocked_repeatedly_and_without_the_system_call(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    unlock_process_memory()
    unlock_process_memory()
    locked = next(line for line in Path("/proc/self/status").read_text().splitlines() if "VmLck" in line)
    assert locked.split()[1] == "0"
    monkeypatch.setattr(ctypes, "CDLL", lambda *_: object())
    unlock_process_memory()


# --- what the operator reads ------------------------------------------------------------------------------

REFUSED_RIGHTS = (
    ProcessRight("real-time priority", "no", "other programs can delay the control"),
    ProcessRight("locked memory", "all"),
)
GRANTED_RIGHTS = (ProcessRight("real-time priority", "SCHED_RR 40"), REFUSED_RIGHTS[1])


@dataclass
class FakeClient:
    """A connection to a control that has these rights and these warnings."""

    process_rights: tuple[ProcessRight, ...]
    warnings: tuple[str, ...] = ()
    interrupted_job: None = None
    has_on_screen_station: bool = False

    @property
    def hello_message(self) -> FakeClient:
        return self

    @property
    def clock(self) -> ManualClock:
        return ManualClock()

    def start_threads(self, _handlers: ControlEventHandlers) -> None:
        """Nothing is received."""


def start_screen(machine: str, client: FakeClient) -> tuple[list[LogEvent], list[str]]:
    """The events and the messages of a screen that is connected to this control."""
    events, shown = list[LogEvent](), list[str]()
    live = LiveControl(cast("ControlClient", client), load_shipped_machine(machine), Path("unused"))
    live.start_threads(
        ControlEventHandlers(lambda event, _: events.append(event), lambda _: None, lambda _: None),
        shown.append,
    )
    return events, shown


def test_missing_real_time_priority_of_a_real_machine_is_shown_and_listed() -> None:
    events, shown = start_screen("gt75-hal", FakeClient(REFUSED_RIGHTS))
    assert [event.kind for event in events] == ["rights", "rights", "notice"]
    assert shown == [wording("machine.no-real-time-priority")]
    log = AlarmLog(lambda: "09:41:07")
    log.hear(events[-1])
    (listed,) = log.entries
    assert listed.alarm.number == 909
    assert "rtprio 60" in listed.alarm.remedy
    log.add_stored_entries([EventRow("2020-02-03T04:05:06Z", event.kind, event.text, 0) for event in events])
    assert [entry.alarm.code for entry in log.entries] == ["no-real-time"] * 2


@pytest.mark.parametrize(
    ("machine", "rights", "number"),
    [("gt75", REFUSED_RIGHTS, 2), ("gt75-hal", GRANTED_RIGHTS, 2), ("gt75-hal", (), 0)],
)
def test_nothing_is_shown_with_priority_or_for_a_simulated_machine(
    machine: str, rights: tuple[ProcessRight, ...], number: int
) -> None:
    events, shown = start_screen(machine, FakeClient(rights))
    assert [event.kind for event in events] == ["rights"] * number
    assert shown == []


def test_message_about_drives_without_priority_is_not_replaced() -> None:
    warning = f"{NO_PRIORITY_TEXT}, the axes stop"
    events, shown = start_screen("gt75-hal", FakeClient(REFUSED_RIGHTS, (warning,)))
    assert "notice" in [event.kind for event in events]
    assert shown == []


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

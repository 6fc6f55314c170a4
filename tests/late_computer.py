"""Detection of a computer that is too slow for a machine in real time.

A busy computer may stop all processes for some tenths of a second. The machine then stops too, as it must,
and a test of real processes cannot judge it. Such a test is skipped, with this reason, if its machine reports
first that the computer was late. Any other cause is a failure. No test is retried.
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from core.alarms import CATALOG

NO_VERDICT = "no verdict, this computer was late"
LOOK, STALL = 0.02, 0.15  # s
# Codes of alarms and of holds that a late computer alone causes on a machine that is whole.
LATE = frozenset(
    {"late", "low-queue", "queue-dry", "hal-silent", "hal-thread", "feeder-tripped", "feeder-silent"}
)
# What a machine behind HAL makes of a control that it has not heard for a quarter of a second, or of a servo
# thread that stood still.
OF_SILENCE = frozenset({"spindle-has-stopped"})
OF_A_STILL_THREAD = frozenset({"no-power"})
_CODES = {str(entry.number): code for code, entry in CATALOG.items()}
_told: list[str] = []  # by the machines of the test that runs


def tell(code: str) -> None:
    """A machine of this test has stopped, by this code."""
    _told.append(code)


def forget() -> None:
    """Another test begins."""
    _told.clear()


def told_late() -> bool:
    """Whether the first that a machine of this test has told is a computer that was late."""
    return bool(_told) and _told[0] in LATE


def command_was_late(home: Path) -> bool:
    """Whether a command that has this folder has told that first; it is told to the test too."""
    for log in sorted((home / "logs").glob("*.jsonl")):
        away = False
        events = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
        codes = [_CODES.get(event["text"].partition(" ")[0], "") for event in events]
        for event, code in zip(events, codes, strict=True):
            away = away or event["kind"] == "starved"
            still = code in OF_A_STILL_THREAD and "hal-thread" in codes
            if event["kind"] == "alarm" or (event["kind"] == "stop" and code in LATE | OF_SILENCE):
                tell("late" if still or (away and code in OF_SILENCE) else code)
    return told_late()


@contextmanager
def stalls_told(longest: float = STALL) -> Iterator[None]:
    """Tell when this process has stood still for longer: what it plays has answered nobody meanwhile."""
    ended = threading.Event()

    def look() -> None:
        looked = time.monotonic()
        while not ended.wait(LOOK):
            before, looked = looked, time.monotonic()
            if looked - before > longest:
                tell("late")

    looking = threading.Thread(target=look, name="stalls")
    looking.start()
    try:
        yield
    finally:
        ended.set()
        looking.join()


def without_verdict(item: pytest.Item, report: pytest.TestReport) -> None:
    """Turn a failure of a ``real_time`` test into a skip where the computer was late."""
    if report.failed and told_late() and item.get_closest_marker("real_time") is not None:
        path, line, _ = item.location
        report.outcome = "skipped"
        report.longrepr = (path, (line or 0) + 1, f"Skipped: {NO_VERDICT} ({_told[0]})")

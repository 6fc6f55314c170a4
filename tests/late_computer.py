"""A computer that comes too late for a machine in real time: how that is told, and what is played again then.

A computer that stands still for some tenths of a second, as a busy one does, stops a machine, and rightly. A
test whose subject that is not plays its piece again when it is what the machine has told first: any other
cause fails at once, and so does a computer that is late every time.
"""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import pytest
from _pytest.runner import runtestprotocol

from core.alarms import CATALOGUE

TRIES = 8
LOOK, STALL = 0.02, 0.15  # s
# Codes of alarms and of holds that a late computer alone causes on a machine that is whole.
LATE = frozenset(
    {"late", "low-queue", "queue-dry", "hal-silent", "hal-thread", "feeder-tripped", "feeder-silent"}
)
# What a machine behind HAL makes of a control that it has not heard for a quarter of a second.
OF_SILENCE = frozenset({"spindle-has-stopped"})
_CODES = {str(entry.number): code for code, entry in CATALOGUE.items()}
_told: list[str] = []  # by the machines of the test that runs
Played = TypeVar("Played")


def tell(code: str) -> None:
    """A machine of this test has stopped, by this code."""
    _told.append(code)


def forget() -> None:
    """Another test, or another try."""
    _told.clear()


def told_late() -> bool:
    """Whether the first that a machine of this test has told is a computer that was late."""
    return bool(_told) and _told[0] in LATE


def played_again(play: Callable[[], Played], late: Callable[[], bool]) -> Played:
    """What comes of ``play``, played again while it was ``late``; the last time as it is."""
    for _ in range(TRIES - 1):
        played = play()
        if not late():
            return played
        forget()
    return play()


def command_was_late(home: Path) -> bool:
    """Whether a command that has this folder has told that first; it is told to the test too."""
    for log in sorted((home / "logs").glob("*.jsonl")):
        away = False
        for event in map(json.loads, log.read_text(encoding="utf-8").splitlines()):
            code = _CODES.get(event["text"].partition(" ")[0], "")
            away = away or event["kind"] == "starved"
            if event["kind"] == "alarm" or (event["kind"] == "stop" and code in LATE | OF_SILENCE):
                tell("late" if away and code in OF_SILENCE else code)
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


def run_again(
    item: pytest.Item,
    nextitem: pytest.Item | None,
    again: Callable[[int, list[pytest.TestReport]], bool],
) -> bool:
    """The whole of a test, fixtures too, anew while it fails and ``again`` says so of its tries and reports.

    For ``pytest_runtest_protocol``: what counts is the last.
    """
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for tries in range(1, TRIES + 1):
        forget()
        reports = runtestprotocol(item, nextitem=nextitem, log=False)
        if not any(report.failed for report in reports) or not again(tries, reports):
            break
        item._initrequest()  # type: ignore[attr-defined]
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True

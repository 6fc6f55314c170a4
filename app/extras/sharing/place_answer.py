"""The wait of a command for a place of shared programs: a dead network drive may never answer."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future, wait
from typing import TypeVar

from core.extras.sharing.shared_folder import SharedFolder
from core.extras.sharing.shared_place import Cause, SharedPlace
from core.message import Message

T = TypeVar("T")
_TOLD_AFTER = 30.0  # s, as on the desk; a slow place may take longer and answer yet
_DEAD_AFTER = 300.0  # s in which not one byte of a folder came: a script would wait for it for ever
_OPEN = (  # a pipe in its place is told by who reads it
    "import os, sys; os.read(os.open(sys.argv[1], os.O_RDONLY | getattr(os, 'O_NONBLOCK', 0)), 1)"
)


def answered(place: SharedPlace, work: Callable[[], T], told_after: float = _TOLD_AFTER) -> T:
    """What ``work`` gives, or raises; a place that keeps it waiting is named on stderr.

    The work has a thread of its own: a call that hangs in the system sees no Ctrl+C, this wait does. What
    hangs then is left behind, and ends with the process.
    """
    if isinstance(place, SharedFolder):
        _wait_for_folder(place, told_after)
    answer: Future[T] = Future()
    threading.Thread(target=_work, args=(work, answer), name="shared-place", daemon=True).start()
    if not wait([answer], told_after).done:
        _tell(place, told_after)
    return answer.result()


def _wait_for_folder(place: SharedFolder, told_after: float) -> None:
    """Until its mark was opened, or refused, by a process of its own. Raises SharingError.

    What hangs in a dead FUSE drive outlives SIGKILL, and as a thread it would keep the whole command: a
    process is left behind instead. Opened, because what a look at names finds may be kept on this side.
    """
    opening = subprocess.Popen(
        [sys.executable, "-I", "-S", "-c", _OPEN, str(place.mark)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # no Ctrl+C there: it has nothing to say
    )
    try:
        opening.wait(told_after)
    except subprocess.TimeoutExpired:
        until = Message("; TurnDesk stops waiting after {dead_after} s", dead_after=f"{_DEAD_AFTER:g}")
        _tell(place, told_after, until)
        try:
            opening.wait(_DEAD_AFTER - told_after)
        except subprocess.TimeoutExpired:
            raise Cause.AWAY.error(
                place.name, Message("no data received in {dead_after} s", dead_after=f"{_DEAD_AFTER:g}")
            ) from None


def _tell(place: SharedPlace, seconds: float, until: str = "") -> None:
    said = Message(
        "{place} has not responded for {seconds} s{until}; press Ctrl+C to stop waiting",
        place=place.name,
        seconds=f"{seconds:g}",
        until=until,
    )
    sys.stderr.write(f"turndesk: {said}\n")


def _work(work: Callable[[], T], answer: Future[T]) -> None:
    try:
        answer.set_result(work())
    except BaseException as error:  # noqa: BLE001 - whatever it is, it is raised again where it is waited for
        answer.set_exception(error)

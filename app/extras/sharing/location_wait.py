"""Waiting of a command for the shared location, which the user can interrupt with Ctrl+C.

A location on a failed network drive may never respond.
"""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future, wait
from typing import TypeVar

from core.extras.sharing.shared_folder import SharedFolder
from core.extras.sharing.shared_location import SharedLocation, SharingErrorCause
from core.message import Message

T = TypeVar("T")
_TOLD_AFTER = 30.0  # seconds, as on the operator screen; a slow location can still respond later
_DEAD_AFTER = 300.0  # seconds without data from a folder after which a script stops waiting
_OPEN = (  # a pipe in its place is reported by its reader
    "import os, sys; os.read(os.open(sys.argv[1], os.O_RDONLY | getattr(os, 'O_NONBLOCK', 0)), 1)"
)


def run_location_work(
    location: SharedLocation, run_work: Callable[[], T], report_after_s: float = _TOLD_AFTER
) -> T:
    """Run ``run_work`` in a thread and return its result, or raise its exception.

    If the location responds slowly, this is reported on stderr after ``report_after_s`` seconds. A separate
    thread is necessary because Ctrl+C cannot interrupt a blocked system call. A blocked thread ends with
    the process.
    """
    if isinstance(location, SharedFolder):
        _wait_for_folder(location, report_after_s)
    answer: Future[T] = Future()
    threading.Thread(target=_work, args=(run_work, answer), name="shared-place", daemon=True).start()
    if not wait([answer], report_after_s).done:
        _tell(location, report_after_s)
    return answer.result()


def _wait_for_folder(location: SharedFolder, told_after: float) -> None:
    """Wait until a separate process has opened the marker file of the shared folder.

    A system call that blocks on a failed FUSE drive survives SIGKILL. In a thread, it would block the whole
    command, but a separate process can be left running. The process opens the file, because a list of file
    names could come from a cache. Raises SharingError if the folder does not respond.
    """
    opening = subprocess.Popen(
        [sys.executable, "-I", "-S", "-c", _OPEN, str(location.marker_path)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # without Ctrl+C, because the process has nothing to report
    )
    try:
        opening.wait(told_after)
    except subprocess.TimeoutExpired:
        until = Message("; TurnDesk stops waiting after {dead_after} s", dead_after=f"{_DEAD_AFTER:g}")
        _tell(location, told_after, until)
        try:
            opening.wait(_DEAD_AFTER - told_after)
        except subprocess.TimeoutExpired:
            raise SharingErrorCause.AWAY.make_error(
                location.name, Message("no data received in {dead_after} s", dead_after=f"{_DEAD_AFTER:g}")
            ) from None


def _tell(place: SharedLocation, seconds: float, until: str = "") -> None:
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

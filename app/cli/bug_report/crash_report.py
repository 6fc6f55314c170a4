"""Reports of internal errors: one line on the terminal and the traceback in a crash file.

The module also restores Ctrl+C interrupts that Python drops. If an interrupt is raised in a finalizer,
Python only prints it, and the command would continue.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path
    from sys import UnraisableHookArgs

_dropped: list[type[BaseException]] = []
_NAMES = 100  # file names tried, the largest number of crashes in one second


def report_crash(
    error_type: type[BaseException], error: BaseException, error_traceback: TracebackType | None
) -> None:
    """Print one line about an uncaught exception, and write its traceback to a crash file.

    The function is installed as ``sys.excepthook``.
    """
    where = write_crash_file(error_type, error, error_traceback)
    what = str(error).splitlines()[0] if str(error) else error_type.__name__
    sys.stderr.write(f"turndesk: a fault in TurnDesk itself ({what}); please report it with {where}\n")


def report_thread_exception(thread_error: threading.ExceptHookArgs) -> None:
    """Report an uncaught exception that ended a software thread. The other threads continue."""
    if thread_error.exc_value is not None and not isinstance(thread_error.exc_value, SystemExit):
        report_crash(thread_error.exc_type, thread_error.exc_value, thread_error.exc_traceback)


def write_crash_file(
    error_type: type[BaseException], error: BaseException, error_traceback: TracebackType | None
) -> str:
    """Write a crash file to the log folder, or to the system's temporary folder, and return its path."""
    import tempfile
    import traceback
    from pathlib import Path

    text = "".join(traceback.format_exception(error_type, error, error_traceback))
    head = (
        f"{time.strftime('%Y-%m-%d %H:%M:%S%z')}  {' '.join(sys.argv)}  {threading.current_thread().name}\n"
    )
    for folder in (_log_folder(), Path(tempfile.gettempdir())):
        path = _try_write(folder, head + text) if folder is not None else None
        if path is not None:
            return str(path)
    return "a description of what you were doing"


def _log_folder() -> Path | None:
    """Return the log folder, or None if the data folder cannot be used."""
    try:
        from app.desk.data_folder import DataFolderError, find_data_folder
    except (OSError, ImportError):
        return None
    try:
        return find_data_folder() / "logs"
    except (OSError, DataFolderError):
        return None


def _try_write(folder: Path, text: str) -> Path | None:
    """Write a new crash file and return its path, or None if the file cannot be written."""
    stem = f"crash-{time.strftime('%Y%m%d-%H%M%S')}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for count in range(_NAMES):
            path = folder / f"{stem}{f'-{count}' if count else ''}.txt"
            try:
                number = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
            except FileExistsError:
                continue
            with open(number, "w", encoding="utf-8", errors="replace") as file:
                file.write(text)
            return path
    except OSError:
        return None
    return None


@contextmanager
def catch_interrupts() -> Iterator[None]:
    """Record each Ctrl+C interrupt that Python drops in the ``with`` block.

    ``raise_dropped_interrupt`` then raises it.
    """
    before = sys.unraisablehook

    def record_interrupt(hook_args: UnraisableHookArgs) -> None:
        if issubclass(hook_args.exc_type, KeyboardInterrupt):
            _dropped.append(hook_args.exc_type)
        else:
            before(hook_args)

    _dropped.clear()
    sys.unraisablehook = record_interrupt
    try:
        yield
    finally:
        sys.unraisablehook = before


def raise_dropped_interrupt() -> None:
    """Raise KeyboardInterrupt once if Python dropped a Ctrl+C interrupt in ``catch_interrupts``."""
    if _dropped:
        _dropped.clear()
        raise KeyboardInterrupt

"""What happens when TurnDesk itself is at fault: one line for the person, the traceback into a crash file.

And Ctrl+C where Python drops it: raised in a finalizer it is printed, and the command goes on to its end.
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
_NAMES = 100  # tried before giving up: so many crashes in one second


def report_crash(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """An excepthook: nobody at a machine can act on a traceback, but whoever mends it needs it."""
    where = keep_crash(kind, error, trace)
    what = str(error).splitlines()[0] if str(error) else kind.__name__
    sys.stderr.write(f"turndesk: a fault in TurnDesk itself ({what}); please report it with {where}\n")


def report_thread(found: threading.ExceptHookArgs) -> None:
    """The same for a thread that ends by a mistake; the others go on."""
    if found.exc_value is not None and not isinstance(found.exc_value, SystemExit):
        report_crash(found.exc_type, found.exc_value, found.exc_traceback)


def keep_crash(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> str:
    """A crash file of its own in the log folder, else in the system's folder for such; where it lies."""
    import tempfile
    import traceback
    from pathlib import Path

    text = "".join(traceback.format_exception(kind, error, trace))
    head = (
        f"{time.strftime('%Y-%m-%d %H:%M:%S%z')}  {' '.join(sys.argv)}  {threading.current_thread().name}\n"
    )
    for folder in (_logs(), Path(tempfile.gettempdir())):
        path = _written(folder, head + text) if folder is not None else None
        if path is not None:
            return str(path)
    return "a description of what you were doing"


def _logs() -> Path | None:
    """Where the log lies; it may be the folder itself that has failed."""
    try:
        from app.desk.data_folder import DataFolderError, data_folder
    except (OSError, ImportError):
        return None
    try:
        return data_folder() / "logs"
    except (OSError, DataFolderError):
        return None


def _written(folder: Path, text: str) -> Path | None:
    """The file, never one that is already there; None where it cannot be written."""
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
def keep_interrupts() -> Iterator[None]:
    """Whatever is dropped in here is raised by the next ``raise_interrupt``."""
    before = sys.unraisablehook

    def keep(told: UnraisableHookArgs) -> None:
        if issubclass(told.exc_type, KeyboardInterrupt):
            _dropped.append(told.exc_type)
        else:
            before(told)

    _dropped.clear()
    sys.unraisablehook = keep
    try:
        yield
    finally:
        sys.unraisablehook = before


def raise_interrupt() -> None:
    """Raise the KeyboardInterrupt that was dropped, once."""
    if _dropped:
        _dropped.clear()
        raise KeyboardInterrupt

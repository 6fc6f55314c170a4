"""What a session of HAL has left behind whose control was killed: waited for until HAL is down, then removed.

A folder of a session is locked by whoever runs it, so one without a lock has nobody any more. Its bridge has
seen the end of the control and takes the machine down in good order; before that no other session can begin.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

PREFIX = "turndesk-hal-"
_LOCK = "session.lock"


def new_folder() -> tuple[Path, int]:
    """A folder for one session, and its lock: the folder counts as used until that is closed."""
    folder = Path(tempfile.mkdtemp(prefix=PREFIX))
    lock = os.open(folder / _LOCK, os.O_CREAT | os.O_RDWR | os.O_CLOEXEC, 0o600)
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    return folder, lock


def clear_away(goes_on: Callable[[], bool]) -> None:
    """Remove the folders of sessions whose control has gone, each once its processes have ended.

    ``goes_on`` is asked between two looks, and waits: what still runs when it says no is left as it is.
    """
    for folder in _deserted():
        while _runs(folder) and goes_on():
            pass
        if not _runs(folder):
            shutil.rmtree(folder, ignore_errors=True)


def _deserted() -> Iterator[Path]:
    for folder in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        with suppress(OSError):  # somebody else's, or just removed
            found = folder.lstat()
            if stat.S_ISDIR(found.st_mode) and os.geteuid() in {0, found.st_uid} and not _locked(folder):
                yield folder


def _locked(folder: Path) -> bool:
    """Raises OSError for a folder without a lock: it is being made, or none of ours."""
    lock = os.open(folder / _LOCK, os.O_RDWR | os.O_NOFOLLOW | os.O_CLOEXEC)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(lock)
    return False


def _runs(folder: Path) -> bool:
    """Whether halrun, the bridge or anything else that was started with this folder is still there."""
    name = os.fsencode(str(folder))
    for told in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):
            if name in told.read_bytes():
                return True
    return False

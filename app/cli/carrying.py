"""A transfer on the command line: progress on stderr, Ctrl-C gives it up."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYetError
from typing import TypeVar

from app.cli.progress import Progress
from app.programs.file_changes import FileError
from app.transfer.serial_line import Carrying
from core.ports import DriverError

T = TypeVar("T")
_LOOK = 0.1  # s


def carry(transfer: Carrying[T], what: str) -> T | None:
    """What it answers; None when it came to nothing, which has then been said in one sentence."""
    with ThreadPoolExecutor(1, thread_name_prefix="serial") as pool, Progress(what) as progress:
        future = pool.submit(transfer.run)
        try:
            while True:
                try:
                    return future.result(_LOOK)
                except NotYetError:
                    if future.done():
                        raise
                    progress.total = transfer.reach.total
                    progress.reach(transfer.reach.done)
        except (DriverError, FileError) as error:
            sys.stderr.write(f"turndesk: {error}\n")
            return None
        except KeyboardInterrupt:
            transfer.cancel()
            raise

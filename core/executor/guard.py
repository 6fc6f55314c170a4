"""Lets no failure of the control pass in silence, and none kill the thread that watches the machine."""

from __future__ import annotations

import logging
from collections.abc import Callable
from types import TracebackType

_log = logging.getLogger(__name__)


class Guard:
    """A ``with`` block whose failure is written to the log, told to ``failed`` and then over."""

    def __init__(self, failed: Callable[[Exception], None]) -> None:
        self._failed = failed

    def __enter__(self) -> None:
        return None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        if not isinstance(error, Exception):
            return False
        _log.error("the control has failed", exc_info=(type(error), error, trace))
        self._failed(error)
        return True

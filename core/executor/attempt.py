"""Attempts that may fail: no failure of the control is silent, and none ends the thread that runs it."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable
from types import TracebackType
from typing import ClassVar

from core.message import Message

_log = logging.getLogger(__name__)


class Attempt:
    """A ``with`` block that is over when it fails: ``error`` is what it raised, SystemExit of a library too.

    Only Ctrl-C goes on: it is meant for the program, and comes to its main thread alone.
    """

    def __init__(self) -> None:
        self.error: BaseException | None = None

    def __enter__(self) -> Attempt:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        self.error = error
        return not isinstance(error, KeyboardInterrupt)


class ReportedAttempt(Attempt):
    """A ``with`` block whose failure is written to the log, given to ``failed`` and then over.

    Should ``failed`` fail as well, that is written too. What comes in every tick is written the first, the
    tenth, the hundredth time, so that it does not drown what was before.
    """

    _written: ClassVar[Counter[str]] = Counter()

    def __init__(self, failed: Callable[[BaseException], None]) -> None:
        super().__init__()
        self._failed = failed

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        swallowed = super().__exit__(kind, error, trace)
        if error is None or not swallowed:
            return swallowed
        self._write(error)
        with Attempt() as telling:
            self._failed(error)
        if telling.error is not None:
            _log.error("and could not say so", exc_info=telling.error)
        return True

    def _write(self, error: BaseException) -> None:
        what = Message("{name}: {error}", name=type(error).__name__, error=error)
        self._written[what] += 1
        times = self._written[what]
        if str(times).strip("0") == "1":
            _log.error("the control has failed, %d", times, exc_info=error)

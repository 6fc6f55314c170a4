"""The limit of the work on a drawing that was read: its contours, its profile and the program."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from core.extras.drawings.drawing import DrawingError

MOST_SECONDS = 30.0  # of the processor, for one program out of a drawing


@dataclass(frozen=True, slots=True)
class _Limit:
    begun: float
    seconds: float
    watch: Callable[[float], None]


_limit: ContextVar[_Limit | None] = ContextVar("drawing_work", default=None)


@contextmanager
def limited_work(watch: Callable[[float], None], seconds: float = MOST_SECONDS) -> Iterator[None]:
    """Limit the processor time that this thread spends in the block; ``watch`` gets the seconds spent."""
    token = _limit.set(_Limit(time.thread_time(), seconds, watch))
    try:
        yield
    finally:
        _limit.reset(token)


def check_work() -> None:
    """Raise DrawingError at the limit, or what the watch raises; called in each loop over lines."""
    limit = _limit.get()
    if limit is None:
        return
    spent = time.thread_time() - limit.begun
    limit.watch(spent)
    if spent > limit.seconds:
        words = "the drawing has too many parallel lines. Save only the contour of the part."
        raise DrawingError(words, "too-slow")

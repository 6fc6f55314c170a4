"""Ctrl+C where Python drops it: raised in a finalizer it is printed, and the command goes on to its end."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

_dropped: list[type[BaseException]] = []


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

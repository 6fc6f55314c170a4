"""Receipt of an event: its origin in a control process, and the confirmation that it is stored."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from core.store.store_rows import EventOrigin


class Receipt(NamedTuple):
    """``confirm`` is called, from any thread, when the event is on the disk or need not be stored."""

    origin: EventOrigin
    confirm: Callable[[], None]

"""Receipt of an event, which identifies the event and confirms that it is stored."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from core.store.production.part_cycles import ProductionRow
from core.store.store_rows import EventOrigin


class EventReceipt(NamedTuple):
    """Origin of an event, the function that confirms its storage, and its rows of cycles and stops.

    ``confirm_storage`` may be called from any thread. It is called when the event is on the disk, or when
    the event does not need to be stored.
    """

    origin: EventOrigin
    confirm_storage: Callable[[], None]
    production_rows: tuple[ProductionRow, ...] = ()

"""A store of offsets under a desk that a test has built without one."""

from __future__ import annotations

from app.desk.desk import Desk
from core.store.store import Store


def use_store(desk: Desk, store: Store) -> None:
    """Have the desk's book read this store and save to it, as a desk that opens on it does."""
    book = desk.offset_book
    book.store, book.lock_reason, book.has_read_failed = store, "", False
    book.read_store()

"""What is attached to a desk, in tests that know that it is there."""

from __future__ import annotations

from typing import TypeVar

from app.desk.desk import Desk
from app.desk.pages.attached_parts import AttachedModel

A = TypeVar("A", bound=AttachedModel)


def attached(desk: Desk, kind: type[A]) -> A:
    """Fails where the desk was put together without."""
    found = desk.page_registry.find_model(kind)
    assert found is not None, kind
    return found

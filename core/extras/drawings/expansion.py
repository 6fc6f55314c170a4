"""How many entities blocks and reused groups come to: counted before any of them is made."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import NamedTuple, TypeVar

from core.extras.drawings.drawing import MOST_ELEMENTS, DrawingError
from core.message import Message

Key = TypeVar("Key", bound=Hashable)


class Content(NamedTuple):
    """A block or group: ``own`` entities, and ``inserted`` others, each so many times."""

    own: int
    inserted: Sequence[tuple[int, Hashable]]


def check_expansion(name: str, root: Key, content: Callable[[Key], Content], spare: int = 0) -> None:
    """Refuse a file whose blocks would come to more than ``MOST_ELEMENTS`` entities, or contain themselves.

    ``spare`` entities are allowed besides: those that the file itself has. Raises DrawingError.
    """
    if _count(name, root, content) > MOST_ELEMENTS + spare:
        raise DrawingError(
            Message(
                "The repeated groups in {name} add up to more than {most_elements} entities: "
                "save only the contour of the part.",
                name=name,
                most_elements=MOST_ELEMENTS,
            ),
            "too-many-lines",
        )


def _count(name: str, root: Key, content: Callable[[Key], Content]) -> int:
    """Count depth first without recursion: a file may nest deeper than Python calls."""
    known: dict[Hashable, int] = {}
    waiting: dict[Hashable, Content] = {}
    stack: list[Hashable] = [root]
    while stack:
        here = stack[-1]
        if here in known:
            stack.pop()
        elif here in waiting:
            own, inserted = waiting.pop(here)
            known[here] = own + sum(times * known[each] for times, each in inserted)
            stack.pop()
        else:
            waiting[here] = content(here)  # type: ignore[arg-type]
            below = [each for _, each in waiting[here].inserted if each not in known]
            if any(each in waiting for each in below):
                words = Message(
                    "A repeated group in {name} contains itself: save only the contour of the part.",
                    name=name,
                )
                raise DrawingError(words, "nested-blocks")
            stack += below
    return known[root]

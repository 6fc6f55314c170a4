"""Blocks on their way through the planner: those that have gone in and have not been timed yet."""

from __future__ import annotations

from collections import deque

from core.interpreter.elementary_blocks import Block, Series

Part = list[Block] | Series
"""Blocks one after the other that have come one by one, or as a series."""


class Passing:
    """A queue of blocks that keeps series whole as far as it can."""

    def __init__(self) -> None:
        self._parts: deque[Part] = deque()

    @property
    def first(self) -> Block | None:
        """The block that has waited longest."""
        return self._parts[0][0] if self._parts else None

    def append(self, each: Block | Series) -> None:
        """Put in behind the others."""
        if isinstance(each, Series):
            self._parts.append(each)
        elif self._parts and isinstance(self._parts[-1], list):
            self._parts[-1].append(each)
        else:
            self._parts.append([each])

    def take(self, count: int) -> tuple[Part, ...]:
        """Take so many out, those that have waited longest."""
        taken: list[Part] = []
        while count:
            part = self._parts.popleft()
            if len(part) > count:
                self._parts.appendleft(part[count:])
                part = part[:count]
            taken.append(part)
            count -= len(part)
        return tuple(taken)

"""Program text as it was read: a name and lines, counted from 1."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True)
class Source:
    """Program text. ``name`` is what messages and the screen call it."""

    name: str
    text: str

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """The lines without their ends; a last empty line after the final newline does not count."""
        return tuple(self.text.splitlines())

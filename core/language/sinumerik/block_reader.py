"""A place in a SINUMERIK block, from which formulas and what stands beside them are read."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TypeVar

from core.language.formulas import FormulaError, FormulaReader
from core.language.sinumerik.sinumerik_formulas import GRAMMAR

NEXT = re.compile(r"\s*([,)])")
"""A comma or the closing parenthesis behind an item."""

_Item = TypeVar("_Item")


class BlockReader(FormulaReader):
    """Reads a block from ``at`` on. ``upper`` is the block in capitals, ``written`` is as it was written."""

    def __init__(self, upper: str, written: str, at: int) -> None:
        super().__init__(GRAMMAR, upper, at)
        self.written = written

    @property
    def rest(self) -> str:
        """What is left, without the blanks before it."""
        return self.upper[self.at :].lstrip()

    def take(self, pattern: re.Pattern[str], *, written: bool = False) -> re.Match[str] | None:
        """What the pattern matches here, and go behind it."""
        match = pattern.match(self.written if written else self.upper, self.at)
        if match is not None:
            self.at = match.end()
        return match

    def demand(self, pattern: re.Pattern[str], why: str, hint: str) -> re.Match[str]:
        """The same. Raises FormulaError where it matches nothing."""
        match = self.take(pattern)
        if match is None:
            raise FormulaError(self.at, why, hint)
        return match

    def items(self, read: Callable[[], _Item], why: str, hint: str) -> list[_Item]:
        """Return what ``read`` finds up to the closing parenthesis. Raises FormulaError without one."""
        found: list[_Item] = []
        while True:
            found.append(read())
            if self.demand(NEXT, why, hint)[1] == ")":
                return found

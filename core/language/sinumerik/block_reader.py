"""A place in a SINUMERIK block, from which formulas and what stands beside them are read."""

from __future__ import annotations

import re

from core.language.formulas import FormulaError, FormulaReader
from core.language.sinumerik.sinumerik_formulas import GRAMMAR


class BlockReader(FormulaReader):
    """Reads ``text``, a block in capitals, from ``at`` on; ``written`` is the same in its own case."""

    def __init__(self, text: str, written: str, at: int) -> None:
        super().__init__(GRAMMAR, text, at)
        self.written = written

    @property
    def rest(self) -> str:
        """What is left, without the blanks before it."""
        return self.text[self.at :].lstrip()

    def take(self, pattern: re.Pattern[str], *, written: bool = False) -> re.Match[str] | None:
        """What the pattern matches here, and go behind it."""
        match = pattern.match(self.written if written else self.text, self.at)
        if match is not None:
            self.at = match.end()
        return match

    def demand(self, pattern: re.Pattern[str], why: str, hint: str) -> re.Match[str]:
        """The same. Raises FormulaError where it matches nothing."""
        match = self.take(pattern)
        if match is None:
            raise FormulaError(self.at, why, hint)
        return match

"""The rows of ``turndesk machine check``: what answered, and how it is."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, field
from typing import NamedTuple

MISSING, NOT_CHECKED = "missing", "not checked"
FAILED = (
    "fault",
    "no answer",
    "wrong",
    MISSING,
)  # states that are trouble; an E-stop that is pressed is none


class Row(NamedTuple):
    """One thing of the machine: where it hangs, how it is, and what it says."""

    name: str
    at: str
    state: str
    detail: str

    @property
    def verdict(self) -> str:
        """Return ``ok``, ``FAIL`` where it is not as the machine file has it, or ``not checked``."""
        if self.state in FAILED:
            return "FAIL"
        return NOT_CHECKED if self.state == NOT_CHECKED else "ok"

    def checked(self, measured: Container[str]) -> Row:
        """Return the row as ``not checked`` if it is not one of the ``measured`` rows and does not fail."""
        if self.name in measured or self.state in FAILED:
            return self
        return self._replace(state=NOT_CHECKED, detail=self.detail or self.state)


@dataclass(slots=True)
class Answers:
    """What answered; ``warnings``: worth knowing although nothing is broken; ``trouble``: what is."""

    rows: list[Row] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    trouble: list[str] = field(default_factory=list)

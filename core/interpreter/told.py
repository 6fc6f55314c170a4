"""What every interpreter tells of its pass, whatever language it reads."""

from __future__ import annotations

from typing import Protocol

from core.interpreter.log import Log, refusal
from core.interpreter.modal import Modal
from core.language.diagnostics import Diagnostic

MOST_BLOCKS = 5_000_000
MOST_LINES = 10_000_000
"""More of either is made by no program that anybody means to run."""

DEEPEST_CALL = 16
"""Subroutines that may call each other in a chain."""


class Standing(Protocol):
    """The state that the blocks of a pass leave behind."""

    modal: Modal


class Tools(Protocol):
    """Tool numbers of a pass."""

    used: list[int]
    missing: list[int]


class Told:
    """All of it grows while blocks are taken; an interpreter gives its own ``_state`` and ``_tools``."""

    _state: Standing
    _tools: Tools | None = None

    def __init__(self, log: Log) -> None:
        self._log = log
        self._stopped = False  # an error has been met: no more blocks

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings so far, those of reading the program first."""
        return self._log.found

    @property
    def failed(self) -> bool:
        """Whether there is an error among the findings so far."""
        return bool(self._log.errors)

    @property
    def modal(self) -> Modal:
        """The state after the last block that was taken."""
        return self._state.modal

    @property
    def used_tools(self) -> list[int]:
        """Tool numbers asked for so far, in the order of first use."""
        return self._tools.used if self._tools is not None else []

    @property
    def missing_tools(self) -> list[int]:
        """Those of them whose offset has never been set."""
        return self._tools.missing if self._tools is not None else []

    def _too_much(self, line: int, hint: str) -> None:
        """A program that makes more than anybody runs ends at this line."""
        self._stopped = True
        text = f"The program makes more than {MOST_BLOCKS:,} blocks or {MOST_LINES:,} executed lines."
        self._log.add(refusal(line, 0, "too-many-blocks", text, hint))

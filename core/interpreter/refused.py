"""A program that this machine cannot run at all: one finding, and no block."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.blocks import Block
from core.interpreter.modal import Modal
from core.language.diagnostics import Diagnostic, Severity


class Refused:
    """``core.interpreter.dialects.Interpretation`` of nothing."""

    source_blocks = 0
    used_tools: Sequence[int] = ()
    missing_tools: Sequence[int] = ()

    def __init__(self, why: str, hint: str) -> None:
        self.modal = Modal()
        self.diagnostics: Sequence[Diagnostic] = (
            Diagnostic(0, 0, Severity.ERROR, "machine-kind", why, hint),
        )

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """None."""
        del to_first_error
        return iter(())

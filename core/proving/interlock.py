"""What a machine cannot do at once: its spindle turn, and be the axis C."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.elementary_blocks import Block, Series
from core.language.diagnostics import Diagnostic, Severity
from core.machine.model import Machine


def c_findings(blocks: Sequence[Block], machine: Machine) -> Iterator[Diagnostic]:
    """An error for each block that moves C while the spindle, which is this machine's C, turns."""
    if not machine.spindle_is_c or isinstance(blocks, Series):  # which moves X and Z alone
        return
    for block in blocks:
        if block.c != block.c0 and block.modal.spindle:
            yield Diagnostic(
                line=block.line,
                column=1,
                severity=Severity.ERROR,
                code="c-is-spindle",
                message="C moves while the spindle turns, and on this machine the spindle itself is C",
                hint="stop it with M5 first, or take a lathe whose C has its own drive: sinumerik-modulo",
            )

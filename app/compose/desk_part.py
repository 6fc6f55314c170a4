"""Proof of the part of the loaded program: known data, and the weight of each finding.

It runs after the proof of the program. Decision 0011 states which functions wait for it.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import AbandonedError, Watch, sentence
from app.desk.kept_part import NOTHING_KEPT, KeptPart
from app.desk.programs.program_loading import PartProved
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.proving.checks.part_checks import is_serious
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from core.executor.job import Job
    from core.language.source import Source
    from core.machine.machine_model import Machine
    from core.part.tool_shape import ToolShape
    from core.proving.other_offsets import OtherPart
    from core.proving.part_history import PartMoves
    from core.proving.program_tools import PartSetting
    from core.proving.proof_report import PartReport

Shapes = Callable[[], Mapping[int, "ToolShape"]]
"""The shapes of tools, by T, as they are when it is called; on the worker."""
KeptOfProgram = Callable[[str], KeptPart]
"""What is kept of a program's part, by its name; on the worker."""

_log = logging.getLogger(__name__)

NOT_MADE, NO_STOCK = "part-not-made", "stock-unusable"


def nothing_kept(_program: str) -> KeptPart:
    """Return the empty data of a part, for callers without a store."""
    return NOTHING_KEPT


@dataclass(frozen=True, slots=True)
class PartDesk:
    """Proof of parts on this machine. ``read`` reads the program whose finished part is used as stock."""

    machine: Machine
    shapes: Shapes
    kept: KeptOfProgram
    read: Callable[[Path], Source]

    def setting(self, job: Job, watch: Watch) -> tuple[PartSetting, Diagnostic | None]:
        """Return the specified stock, tools and clamping, and a finding if the stock cannot be used."""
        from app.compose.known_part import known_part, with_kept_clamping
        from app.compose.said_stock import ProgramBefore, said_stock

        setting = known_part(self.machine, job.setup.tools, self.shapes())
        try:
            kept = self.kept(job.source.name)
        except StoreError as error:
            return setting, _unusable(str(error))
        setting = with_kept_clamping(setting, self.machine, kept)
        if not kept.stock:
            return setting, None
        try:
            around = ProgramBefore(self.read, job.setup, self.machine, setting, watch, self.kept)
            return replace(setting, stock=said_stock(kept.stock, around)), None
        except ValueError as error:  # invalid text, or a program that cannot be read
            return setting, _unusable(str(error))

    def compared(self, before: Job, after: Job, watch: Watch) -> OtherPart | None:
        """Return the part of a job with other offsets, compared with its present part.

        The result is None if the job has no part.
        """
        from core.proving.other_offsets import FINE, ThisPart, other_part
        from core.proving.part_proof import prove_with_part

        setting = replace(self.setting(before, watch)[0], step=FINE)
        around = before.setup, self.machine, setting
        report, part = prove_with_part(before.reading, *around, watch, watch=watch)
        if part is None or part.last is None:
            return None
        this = ThisPart(before.setup, setting, report, part)
        return other_part(before.reading, this, after.setup, self.machine, watch)

    def proved(self, moves: PartMoves, trouble: Diagnostic | None, watch: Watch) -> PartProved:
        """Return the proof of the part. An exception of the proof becomes a warning."""
        from core.proving.part_proof import PartProof

        try:
            report = PartProof(moves.setting, moves.parts).report(watch)
        except AbandonedError:
            raise
        except Exception as error:  # noqa: BLE001 - the program itself is proved, and may be run
            _log.exception("proving the part")
            failed = Diagnostic(
                0,
                0,
                Severity.WARNING,
                NOT_MADE,
                Message("The part could not be proved: {error}.", error=sentence(error)),
                "Change the specified stock or the tool shapes.",
            )
            return _weighed([failed], None)
        return _weighed([*([trouble] if trouble else []), *report.findings], report)


def _unusable(why: str) -> Diagnostic:
    return Diagnostic(
        0,
        0,
        Severity.WARNING,
        NO_STOCK,
        Message("The specified stock cannot be used ({why}). An assumed stock is used instead.", why=why),
        "Enter the stock again on the PART page.",
    )


def _weighed(found: Iterable[Diagnostic], report: PartReport | None) -> PartProved:
    """Return the findings with those that are announced before a start."""
    found = tuple(found)
    warned = [each for each in found if _is_announced(each)]
    return PartProved(found, tuple(_in_short(each) for each in warned), report)


def _is_announced(found: Diagnostic) -> bool:
    """Return whether a start announces the finding: a serious warning, or a part that was not proved."""
    if found.code in {NOT_MADE, NO_STOCK}:
        return True
    return is_serious(found) and found.severity is not Severity.ERROR


def _in_short(found: Diagnostic) -> str:
    """Return the short text of an announced finding; the list of findings has the full text and remedy."""
    if not found.line:
        return "PART NOT PROVED WITH THE SPECIFIED STOCK AND TOOLS"
    return Message("LINE {line}: {check}", line=found.line, check=found.check.upper())

"""Proof of the part that the loaded program makes, with a severity for each finding.

TurnDesk proves the program first, and then the part. Decision record 0011 specifies when a start must wait
for the proof of the part.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk.background_work import ProgressCallback, WorkAbandonedError, describe_error
from app.desk.programs.program_loading import PartProof
from app.desk.stored_part import EMPTY_STORED_PART, StoredPart
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.proving.checks.part_checks import is_serious_finding
from core.store.store_errors import StoreError

if TYPE_CHECKING:
    from core.executor.job import Job
    from core.language.source import ProgramSource
    from core.machine.machine_model import Machine
    from core.part.tool_shape import ToolShape
    from core.proving.offset_comparison import OffsetComparisonResult
    from core.proving.part_history import ProgramSteps
    from core.proving.program_tools import PartSettings
    from core.proving.proof_report import PartReport

ReadShapes = Callable[[], Mapping[int, "ToolShape"]]
"""Function that returns the current tool shapes by T number. It is called on the worker thread."""
ReadStoredPart = Callable[[str], StoredPart]
"""Function that returns the stored part settings of a program, by program name.

It is called on the worker thread.
"""

_log = logging.getLogger(__name__)

NOT_MADE, NO_STOCK = "part-not-made", "stock-unusable"


def get_empty_stored_part(_program: str) -> StoredPart:
    """Return empty part data, for callers without a store."""
    return EMPTY_STORED_PART


@dataclass(frozen=True, slots=True)
class PartProver:
    """Prover of the parts that programs make on this machine.

    ``read_source`` reads a program whose finished part is the stock of another program.
    """

    machine: Machine
    read_shapes: ReadShapes
    read_stored_part: ReadStoredPart
    read_source: Callable[[Path], ProgramSource]

    def read_part_settings(
        self, job: Job, report_progress: ProgressCallback
    ) -> tuple[PartSettings, Diagnostic | None]:
        """Return the specified stock, tools and clamping, and a finding if the stock cannot be used.

        The finding is None if the stock can be used or if no stock is specified.
        """
        from app.compose.part_data import apply_stored_clamping, make_part_settings
        from app.compose.specified_stock import StockContext, read_stock

        setting = make_part_settings(self.machine, job.setup.tools, self.read_shapes())
        try:
            kept = self.read_stored_part(job.source.name)
        except StoreError as error:
            return setting, _unusable(str(error))
        setting = apply_stored_clamping(setting, self.machine, kept)
        if not kept.stock_text:
            return setting, None
        try:
            around = StockContext(
                self.read_source, job.setup, self.machine, setting, report_progress, self.read_stored_part
            )
            return replace(setting, stock=read_stock(kept.stock_text, around)), None
        except ValueError as error:  # invalid text, or a program that cannot be read
            return setting, _unusable(str(error))

    def compare_parts(
        self, old_job: Job, new_job: Job, report_progress: ProgressCallback
    ) -> OffsetComparisonResult | None:
        """Return a comparison of the parts that a job makes with old and with new offsets.

        The result is None if the job does not make a part.
        """
        from core.proving.offset_comparison import FINE_COLUMN_WIDTH_MM, ProvedPart, prove_other_offsets
        from core.proving.part_proof import prove_program_and_part

        setting = replace(self.read_part_settings(old_job, report_progress)[0], step=FINE_COLUMN_WIDTH_MM)
        around = old_job.setup, self.machine, setting
        report, part = prove_program_and_part(
            old_job.shared_program, *around, report_progress, check_canceled=report_progress
        )
        if part is None or part.last_piece is None:
            return None
        this = ProvedPart(old_job.setup, setting, report, part)
        return prove_other_offsets(old_job.shared_program, this, new_job.setup, self.machine, report_progress)

    def prove_part(
        self, program_steps: ProgramSteps, stock_finding: Diagnostic | None, report_progress: ProgressCallback
    ) -> PartProof:
        """Return the proof of the part. An exception during the proof is reported as a warning."""
        from core.proving.part_proof import PartProof

        try:
            report = PartProof(program_steps.part_settings, program_steps.block_groups).make_report(
                report_progress
            )
        except WorkAbandonedError:
            raise
        except Exception as error:  # noqa: BLE001 - the program itself is proved, and may be run
            _log.exception("proving the part")
            failed = Diagnostic(
                0,
                0,
                Severity.WARNING,
                NOT_MADE,
                Message("The part could not be proved: {error}.", error=describe_error(error)),
                "Change the specified stock or the tool shapes.",
            )
            return _assign_severity([failed], None)
        return _assign_severity([*([stock_finding] if stock_finding else []), *report.findings], report)


def _unusable(why: str) -> Diagnostic:
    return Diagnostic(
        0,
        0,
        Severity.WARNING,
        NO_STOCK,
        Message("The specified stock cannot be used ({why}). An assumed stock is used instead.", why=why),
        "Enter the stock again on the PART page.",
    )


def _assign_severity(findings: Iterable[Diagnostic], report: PartReport | None) -> PartProof:
    """Return the proof of the part, with a severity for each finding.

    The proof also contains short texts of the findings that the operator sees before the program starts.
    """
    findings = tuple(findings)
    warned = [each for each in findings if _is_announced(each)]
    return PartProof(findings, tuple(_shorten(each) for each in warned), report)


def _is_announced(finding: Diagnostic) -> bool:
    """Return whether a finding is shown to the operator before the program starts.

    This applies to a serious warning, and to a part that was not proved.
    """
    if finding.code in {NOT_MADE, NO_STOCK}:
        return True
    return is_serious_finding(finding) and finding.severity is not Severity.ERROR


def _shorten(finding: Diagnostic) -> str:
    """Return the short text of a finding that is shown before the program starts.

    The list of findings has the full text and the remedy.
    """
    if not finding.line:
        return "PART NOT PROVED WITH THE SPECIFIED STOCK AND TOOLS"
    return Message("LINE {line}: {check}", line=finding.line, check=finding.check_name.upper())

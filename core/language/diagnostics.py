"""Diagnostics of a program, with location, severity, text and remedy."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

from core.message import Message


class Severity(StrEnum):
    """Severity of a diagnostic.

    An error prevents the run. A warning is shown to the operator. A note only gives information.
    """

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding in a program.

    Lines and columns count from 1. Column 0 means the whole line, and line 0 means the whole file.

    - ``check_name`` is the name of the check that made the finding.
    - ``block_number`` is the elementary block, or 0 if the finding does not belong to a block.
    - ``occurrence_count`` is the number of occurrences; a repeated finding has the location of the first.
    - ``assumptions`` are the assumptions on which the finding depends, such as ``stock`` or ``T3``.
    - ``downgrade_reason`` is the reason why the finding is only a note.
    """

    line: int
    column: int
    severity: Severity
    code: str
    message: str
    hint: str = ""
    check_name: str = ""
    block_number: int = 0
    occurrence_count: int = 1
    assumptions: tuple[str, ...] = ()
    downgrade_reason: str = ""

    @property
    def text(self) -> str:
        """Return the message, with the number of occurrences if the finding is repeated."""
        return (
            self.message
            if self.occurrence_count == 1
            else Message("{message} ({count} times)", message=self.message, count=self.occurrence_count)
        )

    def format_one_line(self, name: str) -> str:
        """Return the finding as one line with location, severity, message, code and remedy."""
        place = f"{name}:{self.line}:{max(self.column, 1)}" if self.line else name
        hint = Message(" — {hint}", hint=self.hint) if self.hint else ""
        return Message(
            "{place}: {severity}: {text} [{code}]{hint}",
            place=place,
            severity=self.severity,
            text=self.text,
            code=self.code,
            hint=hint,
        )


class ProgramError(Exception):
    """Error in a program line, with the diagnostic that explains the error."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


PROGRAM_STOP_ASSUMPTION = "axis position after a program stop"
"""Assumption for an axis position that a program reads after a stop.

An operator can jog the axes during the stop.
"""


def add_assumptions(finding: Diagnostic, *assumed: str) -> Diagnostic:
    """Return the finding with additional assumptions on which it depends."""
    return replace(finding, assumptions=(*finding.assumptions, *assumed))


def make_error_diagnostic(line: int, column: int, code: str, message: str, hint: str = "") -> Diagnostic:
    """Return a diagnostic with the severity ``error``."""
    return Diagnostic(line, column, Severity.ERROR, code, message, hint)


def make_program_error(line: int, column: int, code: str, message: str, hint: str = "") -> ProgramError:
    """Return a ProgramError with an error diagnostic."""
    return ProgramError(make_error_diagnostic(line, column, code, message, hint))

"""What the control has to say about a program: one sentence, one place, one thing to do."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

from core.message import Message


class Severity(StrEnum):
    """How much a diagnostic weighs: an error refuses the run, a warning is shown, a note informs."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding. Lines and columns count from 1; column 0 speaks of the whole line, line 0 of the file.

    ``check`` names the check of the part that has found it, ``n`` the elementary block (0: none). One that
    repeats is told once: ``count`` says how often, and its place is the first. ``assumed`` names what it
    rests on that nobody has said (``stock``, ``T3``), ``silenced`` why it is only a note.
    """

    line: int
    column: int
    severity: Severity
    code: str
    message: str
    hint: str = ""
    check: str = ""
    n: int = 0
    count: int = 1
    assumed: tuple[str, ...] = ()
    silenced: str = ""

    @property
    def text(self) -> str:
        """The sentence, and how often it would have to be said."""
        return (
            self.message
            if self.count == 1
            else Message("{message} ({count} times)", message=self.message, count=self.count)
        )

    def in_one_line(self, name: str) -> str:
        """The finding in the one line that goes to a person: place, weight, code, message, what to do."""
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
    """A line cannot mean anything the control would execute; carries the diagnostic that says why."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


AT_THE_STOP = "axis position after a program stop"
"""What rests on a place that a program has read behind a stop, where a hand may have moved the axes."""


def resting_on(found: Diagnostic, *assumed: str) -> Diagnostic:
    """The finding, which holds only as these are assumed."""
    return replace(found, assumed=(*found.assumed, *assumed))


def refusal(line: int, column: int, code: str, message: str, hint: str = "") -> Diagnostic:
    """An error diagnostic."""
    return Diagnostic(line, column, Severity.ERROR, code, message, hint)


def program_error(line: int, column: int, code: str, message: str, hint: str = "") -> ProgramError:
    """The exception that carries an error diagnostic."""
    return ProgramError(refusal(line, column, code, message, hint))

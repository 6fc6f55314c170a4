"""Where shops' files differ from the book: one note a kind for the file, or an error each when strict."""

from __future__ import annotations

from dataclasses import replace

from core.interpreter.statement import Statement
from core.language.diagnostics import Diagnostic, Severity
from core.language.omniturn import Line
from core.language.source import Source

_ODD_IN_COMMENT = frozenset("!@#$%^&*\"'?><,/\\|=-.")

_KINDS = {
    "blank-line": ("The line is blank.", "Take it out for the original control."),
    "title-line": ("A comment stands on a line by itself.", "Put it on a line with a command."),
    "comment-character": ("The comment holds more than letters, digits and blanks.", "Use plain text."),
    "tool-zero": ("The tool number has a leading zero.", "Write T1 for T01."),
    "subroutine-comment": ("A comment stands on the line that starts a subroutine.", "Move it down a line."),
    "line-ends": ("The lines end in a carriage return.", "Save the file with the line ends of this machine."),
    "last-newline": ("The last line has no line end.", "Press Return after it."),
}


class Style:
    """Collects the deviations of one program."""

    def __init__(self, *, strict: bool) -> None:
        self.found: list[Diagnostic] = []
        self._strict = strict
        self._told: dict[str, int] = {}  # kind → place in what was found

    def tell(self, kind: str, line: int, column: int = 0, count: int = 1) -> None:
        """Say that ``kind`` occurs at this place, there and behind it so often."""
        at = self._told.get(kind)
        if at is not None and not self._strict:
            self.found[at] = replace(self.found[at], count=self.found[at].count + count)
            return
        self._told[kind] = len(self.found)
        message, hint = _KINDS[kind]
        severity = Severity.ERROR if self._strict else Severity.NOTE
        self.found.append(Diagnostic(line, column, severity, kind, message, hint, count=count))

    def look_at_file(self, source: Source) -> None:
        """Line ends."""
        if "\r" in source.text:
            self.tell("line-ends", 1, count=source.text.count("\r"))
        if source.text and source.text[-1] not in "\r\n":
            self.tell("last-newline", len(source.lines))

    def look_at(self, line: Line, made: Statement) -> None:
        """Comments and tool numbers of one line."""
        tool = made.words.get("T")
        if tool is not None and tool.text[1:].startswith("0") and len(tool.text) > 2:
            self.tell("tool-zero", line.number, tool.column)
        if line.comment is None:
            return
        if not made.executable:
            self.tell("title-line", line.number, line.comment_column)
        if made.flow == "}":
            self.tell("subroutine-comment", line.number, line.comment_column)
        if not _ODD_IN_COMMENT.isdisjoint(line.comment):
            self.tell("comment-character", line.number, line.comment_column)

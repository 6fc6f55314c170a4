"""The list of what proving has found, each with what to do about it; pressing one goes to its line."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.status import formats
from app.desk.translation import tr
from app.editor.live_proof import Findings
from app.editor.text_view import TONES, WORDS
from app.screen.look import CENTRE, Look, Painter
from app.screen.sheet_panel import RowPanel
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message

ROW = 5.2  # units: two lines of text, at least a fingertip


class FindingList(RowPanel):
    """Rows in the order of lines; the row of the cursor's line is marked and stays visible."""

    notch = 1

    def __init__(self, look: Look, go_to: Callable[[Diagnostic], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._go_to = go_to
        self.findings = Findings()
        self._line = 0

    def show_findings(self, findings: Findings, line: int) -> None:
        """What was found, and the cursor's line."""
        if findings is not self.findings or line != self._line:
            self.findings, self._line = findings, line
            self.update()

    @property
    def words(self) -> str:
        """What the title line of the list says."""
        found = self.findings
        if found.trouble:
            return found.trouble
        if not found.number:
            return "PROVING"
        if not found.diagnostics:
            time = formats.duration(found.cycle_time)
            return Message("PROVED  ·  {blocks} BLOCKS  ·  CYCLE {time}", blocks=found.blocks, time=time)
        return Message(
            "FINDINGS  ·  {errors}  ·  {warnings}",
            errors=_many(found.errors, "ERROR"),
            warnings=_many(found.warnings, "WARNING"),
        )

    def following(self, line: int) -> Diagnostic | None:
        """The next error after a line, round the end; without errors the next of what else was found."""
        placed = [d for d in self.findings.diagnostics if d.line]
        found = [d for d in placed if d.severity is Severity.ERROR] or placed
        return next((d for d in found if d.line > line), found[0] if found else None)

    def draw(self, painter: Painter) -> None:
        u, high, found = self.look.u, self.look.row(ROW, 9.0, touch=True), self.findings.diagnostics
        self.frame(painter, self.words)
        room = QRectF(0.6 * u, 2.3 * u, self.width() - 1.2 * u, self.height() - 2.5 * u)
        here = next((n for n, each in enumerate(found) if each.line == self._line), -1)
        room = self.scrolled(painter, room, self.fitting(room, high, len(found)), len(found), here)
        for number, box in self.boxes(room, high):
            self._row(painter, box, found[number])

    def _row(self, painter: Painter, box: QRectF, found: Diagnostic) -> None:
        u = self.look.u
        if found.line == self._line:
            painter.fill(box, "here")
        patch = QRectF(box.x() + 0.4 * u, box.center().y() - 1.6 * u, 3.2 * u, 3.2 * u)
        painter.fill(patch, TONES[found.severity])
        painter.write(patch, tr(WORDS[found.severity])[0], 2.0, "on_state", at=CENTRE)
        line = QRectF(box.x() + 4.4 * u, box.y(), 8 * u, box.height())
        painter.write(line, str(found.line or "FILE"), 1.8, "text")
        room = box.adjusted(10.4 * u, 0.4 * u, -0.4 * u, -box.height() / 2)
        painter.write(room, found.text, 1.8, "text", bold=False, fit=False)
        painter.write(room.translated(0, room.height()), found.hint, 1.6, "soft", bold=False, fit=False)
        self.place(box, lambda: self._go_to(found), kind="row", on=found.line == self._line)


def _many(count: int, word: str) -> str:
    return f"{count} {word}" if count == 1 else f"{count} {word}S"

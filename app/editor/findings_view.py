"""The list of what proving has found, each with what to do about it; pressing one goes to its line."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QRectF
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QWidget

from app.desk import formats
from app.desk.translation import tr
from app.editor.live_proof import Findings
from app.editor.text_view import TONES, WORDS
from app.screen.look import CENTRE, Look, Painter
from app.screen.panel import Panel
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message

ROW = 5.2  # units: two lines of text, at least a fingertip


class FindingList(Panel):
    """Rows in the order of lines; the row of the cursor's line is marked and kept in sight."""

    def __init__(self, look: Look, go_to: Callable[[Diagnostic], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._go_to = go_to
        self.findings = Findings()
        self._line = 0
        self._top = 0

    def show_findings(self, findings: Findings, line: int) -> None:
        """What was found, and the cursor's line."""
        if findings is self.findings and line == self._line:
            return
        here = next((n for n, d in enumerate(findings.diagnostics) if d.line == line), None)
        if here is not None and not self._top <= here < self._top + self._rows:
            self._top = here
        self.findings, self._line = findings, line
        self._top = max(0, min(self._top, len(findings.diagnostics) - self._rows))
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

    @property
    def _rows(self) -> int:
        return max(1, int((self.height() - 3.0 * self.look.u) / self._high))

    @property
    def _high(self) -> float:
        """Of a row, pixels."""
        return self.look.row(ROW, 9.0, touch=True)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """One row a notch."""
        self._leaf_by(-round(event.angleDelta().y() / 120))

    def _leaf_by(self, rows: int) -> None:
        most = max(0, len(self.findings.diagnostics) - self._rows)
        self._top = max(0, min(most, self._top + rows))
        self.update()

    def draw(self, painter: Painter) -> None:
        u, high = self.look.u, self._high
        self.frame(painter, self.words)
        shown = self.findings.diagnostics[self._top : self._top + self._rows]
        room = QRectF(0.6 * u, 2.3 * u, self.width() - 1.2 * u, self.height() - 2.5 * u)
        seen = (self._top, self._rows, len(self.findings.diagnostics))
        room = self.leaf(painter, room, seen, self._leaf_by)
        for place, found in enumerate(shown):
            box = QRectF(room.x(), room.y() + place * high, room.width(), high)
            self._row(painter, box, found)

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
        self.place(box, lambda: self._go_to(found))


def _many(count: int, word: str) -> str:
    return f"{count} {word}" if count == 1 else f"{count} {word}S"

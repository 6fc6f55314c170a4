"""SEARCHTO panel that compares the machine state at the line with the current state.

Differences are marked by a color and a sign.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ALIGN_CENTER, ALIGN_LEFT, ScreenTheme, ThemedPainter
from app.screen.window_layout import FINGERTIP_PX
from app.searchto.restart_plan import StateRow
from core.message import Message

DIFFERENCE_SYMBOL = "≠"
PASS_BEFORE, PASS_AFTER = "Previous pass", "Next pass"
FOLD_KEY = "Fold"
_FOLD, _LARGE, _PLAIN, _LETTERS = 4.4, 4.0, 2.7, 2.6  # Units.
_PASS_KEY_HEIGHT = 4.4  # Units: height of a fingertip.
_LABEL, _SIGN = 0.25, 0.61  # Fractions of a row: end of the label, position of the sign.


@dataclass(frozen=True, slots=True)
class NearestValidLine:
    """Valid line near a rejected line, which the operator can select instead.

    It contains the key that selects it, its line number (0 if there is no such line) and its text.
    """

    key_name: str
    label: str
    line_number: int
    line_text: str


@dataclass(frozen=True, slots=True)
class StatePanelContent:
    """Content of the panel: the state rows of a valid line, or the reason why a line is rejected.

    For a rejected line, it also contains the nearest valid lines.
    """

    title: str = ""
    state_rows: tuple[StateRow, ...] = ()
    refusal_reason: str = ""
    nearest_valid_lines: tuple[NearestValidLine, ...] = ()
    pass_text: str = ""  # The pass and the number of passes, for a line that runs more than once.
    shows_all_rows: bool = False  # Equal rows are shown, too.


class RestartStatePanel(Panel):
    """The panel that shows the state rows, or why a line is rejected."""

    content = RedrawingAttribute(StatePanelContent())

    def __init__(self, theme: ScreenTheme, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._press = press

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the state rows and the keys for the passes, or the reason why the line is rejected."""
        shown = self.content
        self.frame(
            painter,
            shown.title,
            "alarm" if shown.refusal_reason else "frame",
            0.3 if shown.refusal_reason else 0.16,
        )
        if shown.refusal_reason:
            self._refusal(painter)
        elif shown.state_rows:
            room = self.inside()
            if shown.pass_text:
                self._draw_passes(
                    painter, room.adjusted(0, room.height() - _PASS_KEY_HEIGHT * self.theme.unit_px, 0, 0)
                )
                room.adjust(0, 0, 0, -(_PASS_KEY_HEIGHT + 0.6) * self.theme.unit_px)
            self._draw_table(painter, room)

    def _draw_passes(self, painter: ThemedPainter, area: QRectF) -> None:
        """Draw the selected pass (execution) of the line between two touch keys."""
        wide = area.height() * 2
        sides = ((area.x(), "◀", PASS_BEFORE), (area.right() - wide, "▶", PASS_AFTER))
        for left, sign, key in sides:
            box = QRectF(left, area.y(), wide, area.height())
            self.key(painter, box, sign, 2.4, partial(self._press, key), color="accent")
        words = area.adjusted(wide, 0, -wide, 0)
        painter.draw_text_line(words, self.content.pass_text, 2.0, "text", at=ALIGN_CENTER)

    def _draw_table(self, painter: ThemedPainter, area: QRectF) -> None:
        """Draw the rows with differences in large letters, followed by the rows without differences.

        The rows without differences are collapsed into one row, or drawn one by one.
        """
        u, shown = self.theme.unit_px, self.content
        other = tuple(row for row in shown.state_rows if row.must_change)
        equal = tuple(row for row in shown.state_rows if not row.must_change)
        fold = _FOLD * u if equal else 0.0
        rows = (StateRow("", tr("AT THIS LINE"), tr("NOW")), *other)
        least = area.height() / (len(shown.state_rows) + 2) if shown.shows_all_rows else 0.0
        high = min(_LARGE * u, (area.height() - fold) / len(rows)) if not least else min(_PLAIN * u, least)
        for number, row in enumerate(rows):
            box = QRectF(area.x(), area.y() + number * high, area.width(), high)
            self._row(painter, box, row, min(_LETTERS, high / u * 0.78), head=number == 0)
        if not equal:
            return
        foot = QRectF(
            area.x(), area.y() + len(rows) * high, area.width(), high if shown.shows_all_rows else fold
        )
        if not other:
            painter.draw_text_line(foot, tr("NO DIFFERENCES FROM CURRENT STATE"), 2.2, "text")
            foot.translate(0, foot.height())
        self._draw_fold_key(painter, foot, equal)
        for number, row in enumerate(equal if shown.shows_all_rows else (), start=1):
            self._row(painter, foot.translated(0, number * high), row, min(1.9, high / u * 0.78), head=False)

    def _draw_fold_key(self, painter: ThemedPainter, box: QRectF, equal: tuple[StateRow, ...]) -> None:
        """Draw the row that summarizes the rows without differences.

        A touch on this row expands or collapses them.
        """
        u = self.theme.unit_px
        painter.fill_rect(box.adjusted(0, 0.2 * u, 0, -0.2 * u), "key")
        words = tr(Message("{count} IDENTICAL", count=len(equal)))
        sign = "▲" if self.content.shows_all_rows else "▼"
        painter.draw_text_line(
            box.adjusted(u, 0, 0, 0),
            Message("{sign}  Tab  {words}", sign=sign, words=words),
            1.7,
            "accent",
            raw=True,
        )
        names = ", ".join(tr(row.label) for row in equal)
        painter.draw_text_line(
            box.adjusted(24 * u, 0, -u, 0), names, 1.6, "soft", bold=False, raw=True, fit=False
        )
        short = max(0.0, FINGERTIP_PX - box.height())
        self.add_target(box.adjusted(0, -short, 0, 0), partial(self._press, FOLD_KEY))

    def _row(self, painter: ThemedPainter, box: QRectF, row: StateRow, size: float, *, head: bool) -> None:
        u = self.theme.unit_px
        label, sign = _LABEL * box.width(), _SIGN * box.width()
        differs = row.must_change and not head
        painter.draw_text_line(
            QRectF(box.x(), box.y(), label - u, box.height()), row.label, size, "soft", bold=False
        )
        wanted = QRectF(box.x() + label, box.y(), sign - label - u, box.height())
        now = box.adjusted(sign + 2.4 * u, 0, 0, 0)
        painter.draw_text_line(
            wanted, row.required_value, size, "accent" if head else "mark" if differs else "text"
        )
        ink = "accent" if head else "text" if differs else "soft"
        painter.draw_text_line(now, row.current_value, size, ink, bold=head or differs)
        if differs:
            between = QRectF(box.x() + sign, box.y(), 2 * u, box.height())
            painter.draw_text_line(between, DIFFERENCE_SYMBOL, size + 0.3, "mark", at=ALIGN_CENTER)

    def _refusal(self, painter: ThemedPainter) -> None:
        look, u, room = self.theme, self.theme.unit_px, self.inside()
        painter.setPen(look.get_color("alarm"))
        painter.setFont(look.fit_font(self.content.refusal_reason, 2.2, 2 * room.width(), is_bold=True))
        flags = int(ALIGN_LEFT) | 0x1000  # Qt.TextWordWrap
        painter.draw_wrapped_text(
            QRectF(room.x(), room.y(), room.width(), 9 * u), flags, tr(self.content.refusal_reason)
        )
        for number, near in enumerate(self.content.nearest_valid_lines):
            box = QRectF(room.x(), room.y() + (11 + 9.4 * number) * u, room.width(), 8.4 * u)
            self._near(painter, box, near)

    def _near(self, painter: ThemedPainter, box: QRectF, near: NearestValidLine) -> None:
        u = self.theme.unit_px
        painter.fill_rect(box, "key")
        ink = "accent" if near.line_number else "soft"
        painter.draw_text_line(
            QRectF(box.x(), box.y(), 5 * u, box.height()), near.key_name, 2.4, ink, at=ALIGN_CENTER
        )
        text = box.adjusted(5.6 * u, 0.6 * u, -u, -0.6 * u)
        text.setHeight(text.height() / 2)
        painter.draw_text_line(text, near.label, 2.1, ink)
        painter.draw_text_line(
            text.translated(0, text.height()), near.line_text, 2.0, "text", bold=False, fit=False
        )
        if near.line_number:
            self.add_target(box, partial(self._press, near.key_name))

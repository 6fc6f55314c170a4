"""Panel of SEARCHTO with the state at the line and the present state. Differences have a color and a sign."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QRectF
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.screen.look import CENTRE, LEFT, Look, Painter
from app.screen.panel import Panel, Shown
from app.screen.window_layout import FINGER
from app.searchto.searchto_plan import StateRow
from core.message import Message

DIFFERS = "≠"
PASS_BEFORE, PASS_AFTER = "Previous pass", "Next pass"
FOLD = "Fold"
_FOLD, _LARGE, _PLAIN, _LETTERS = 4.4, 4.0, 2.7, 2.6  # Units.
_PASSES = 4.4  # Units: height of a fingertip.
_LABEL, _SIGN = 0.25, 0.61  # Fractions of a row: end of the label, position of the sign.


@dataclass(frozen=True, slots=True)
class NearestGood:
    """A valid line near a rejected one: the key that selects it, its number (0 for none) and its text."""

    key: str
    label: str
    line: int
    text: str


@dataclass(frozen=True, slots=True)
class StateShown:
    """The rows of a valid line, or the reason for a rejected line with the nearest valid lines."""

    title: str = ""
    rows: tuple[StateRow, ...] = ()
    why: str = ""
    near: tuple[NearestGood, ...] = ()
    passes: str = ""  # The pass and the number of passes, for a line that runs more than once.
    whole: bool = False  # Equal rows are shown, too.


class StatePanel(Panel):
    """The panel that shows the state rows or the refusal."""

    shown = Shown(StateShown())

    def __init__(self, look: Look, press: Callable[[str], None], parent: QWidget) -> None:
        super().__init__(look, parent)
        self._press = press

    def draw(self, painter: Painter) -> None:
        shown = self.shown
        self.frame(painter, shown.title, "alarm" if shown.why else "frame", 0.3 if shown.why else 0.16)
        if shown.why:
            self._refusal(painter)
        elif shown.rows:
            room = self.inside()
            if shown.passes:
                self._passes(painter, room.adjusted(0, room.height() - _PASSES * self.look.u, 0, 0))
                room.adjust(0, 0, 0, -(_PASSES + 0.6) * self.look.u)
            self._table(painter, room)

    def _passes(self, painter: Painter, room: QRectF) -> None:
        """Draw the pass with a touch key on either side."""
        wide = room.height() * 2
        sides = ((room.x(), "◀", PASS_BEFORE), (room.right() - wide, "▶", PASS_AFTER))
        for left, sign, key in sides:
            box = QRectF(left, room.y(), wide, room.height())
            self.key(painter, box, sign, 2.4, partial(self._press, key), ink="accent")
        words = room.adjusted(wide, 0, -wide, 0)
        painter.write(words, self.shown.passes, 2.0, "text", at=CENTRE)

    def _table(self, painter: Painter, room: QRectF) -> None:
        """Draw the different rows large. Equal rows follow, folded into one row or one row each."""
        u, shown = self.look.u, self.shown
        other = tuple(row for row in shown.rows if row.differs)
        equal = tuple(row for row in shown.rows if not row.differs)
        fold = _FOLD * u if equal else 0.0
        rows = (StateRow("", tr("AT THIS LINE"), tr("NOW")), *other)
        least = room.height() / (len(shown.rows) + 2) if shown.whole else 0.0
        high = min(_LARGE * u, (room.height() - fold) / len(rows)) if not least else min(_PLAIN * u, least)
        for number, row in enumerate(rows):
            box = QRectF(room.x(), room.y() + number * high, room.width(), high)
            self._row(painter, box, row, min(_LETTERS, high / u * 0.78), head=number == 0)
        if not equal:
            return
        foot = QRectF(room.x(), room.y() + len(rows) * high, room.width(), high if shown.whole else fold)
        if not other:
            painter.write(foot, tr("NO DIFFERENCES FROM CURRENT STATE"), 2.2, "text")
            foot.translate(0, foot.height())
        self._fold(painter, foot, equal)
        for number, row in enumerate(equal if shown.whole else (), start=1):
            self._row(painter, foot.translated(0, number * high), row, min(1.9, high / u * 0.78), head=False)

    def _fold(self, painter: Painter, box: QRectF, equal: tuple[StateRow, ...]) -> None:
        """Draw the row that lists the equal rows. A touch folds or unfolds them."""
        u = self.look.u
        painter.fill(box.adjusted(0, 0.2 * u, 0, -0.2 * u), "key")
        words = tr(Message("{count} IDENTICAL", count=len(equal)))
        sign = "▲" if self.shown.whole else "▼"
        painter.write(
            box.adjusted(u, 0, 0, 0),
            Message("{sign}  Tab  {words}", sign=sign, words=words),
            1.7,
            "accent",
            raw=True,
        )
        names = ", ".join(tr(row.label) for row in equal)
        painter.write(box.adjusted(24 * u, 0, -u, 0), names, 1.6, "soft", bold=False, raw=True, fit=False)
        short = max(0.0, FINGER - box.height())
        self.place(box.adjusted(0, -short, 0, 0), partial(self._press, FOLD))

    def _row(self, painter: Painter, box: QRectF, row: StateRow, size: float, *, head: bool) -> None:
        u = self.look.u
        label, sign = _LABEL * box.width(), _SIGN * box.width()
        differs = row.differs and not head
        painter.write(QRectF(box.x(), box.y(), label - u, box.height()), row.label, size, "soft", bold=False)
        wanted = QRectF(box.x() + label, box.y(), sign - label - u, box.height())
        now = box.adjusted(sign + 2.4 * u, 0, 0, 0)
        painter.write(wanted, row.wanted, size, "accent" if head else "mark" if differs else "text")
        ink = "accent" if head else "text" if differs else "soft"
        painter.write(now, row.now, size, ink, bold=head or differs)
        if differs:
            between = QRectF(box.x() + sign, box.y(), 2 * u, box.height())
            painter.write(between, DIFFERS, size + 0.3, "mark", at=CENTRE)

    def _refusal(self, painter: Painter) -> None:
        look, u, room = self.look, self.look.u, self.inside()
        painter.setPen(look.colour("alarm"))
        painter.setFont(look.fit(self.shown.why, 2.2, 2 * room.width(), bold=True))
        flags = int(LEFT) | 0x1000  # Qt.TextWordWrap
        painter.wrap(QRectF(room.x(), room.y(), room.width(), 9 * u), flags, tr(self.shown.why))
        for number, near in enumerate(self.shown.near):
            box = QRectF(room.x(), room.y() + (11 + 9.4 * number) * u, room.width(), 8.4 * u)
            self._near(painter, box, near)

    def _near(self, painter: Painter, box: QRectF, near: NearestGood) -> None:
        u = self.look.u
        painter.fill(box, "key")
        ink = "accent" if near.line else "soft"
        painter.write(QRectF(box.x(), box.y(), 5 * u, box.height()), near.key, 2.4, ink, at=CENTRE)
        text = box.adjusted(5.6 * u, 0.6 * u, -u, -0.6 * u)
        text.setHeight(text.height() / 2)
        painter.write(text, near.label, 2.1, ink)
        painter.write(text.translated(0, text.height()), near.text, 2.0, "text", bold=False, fit=False)
        if near.line:
            self.place(box, partial(self._press, near.key))

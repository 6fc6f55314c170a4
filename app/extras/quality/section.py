"""One section of the page of measured parts: a table with keys and a question, and perhaps a drawing."""

from __future__ import annotations

from app.desk.desk import Desk
from app.desk.status.formats import fixed
from app.extras.quality.parts_data import PartsData, parts_of
from app.extras.quality.plots import ChartDrawing
from app.offsets.offset_values import Mode, to_mm
from app.production.parts_watch import PartsWatch
from app.special.special_functions import FigureFunction
from core.store.production.measured_parts import FeatureRow

NO_PROGRAM = "SELECT A PROGRAM FIRST. EACH PROGRAM HAS ITS OWN FEATURES"
NO_FEATURE = "NO FEATURES YET. ADD A FEATURE IN SECTION 1 WITH F2"


class QualitySection(FigureFunction):
    """What all sections share: the book, the program on the desk, its unit, the marked feature."""

    chart_share: float = 0.0  # of the height: what the drawing takes below the table

    def __init__(self, desk: Desk, watch: PartsWatch) -> None:
        super().__init__(desk)
        self.watch = watch

    @property
    def data(self) -> PartsData:
        """What is kept of the program on the desk."""
        return parts_of(self.watch.book)

    @property
    def program(self) -> str:
        """Its name; empty where none is on the desk."""
        return self.watch.program

    @property
    def of_mill(self) -> bool:
        """Whether the machine is a mill: no slide's wear corrects a feature there, DL and DR are typed."""
        return self.desk.language == "klartext"

    @property
    def mode(self) -> Mode:
        """The control's unit, in which everything is typed and shown here."""
        return Mode(self.desk.snapshot().modal.metric, diameter=True)

    @property
    def feature(self) -> FeatureRow | None:
        """The marked feature."""
        rows = self.data.features
        return rows[self.marked] if self.marked < len(rows) else None

    def drawing(self) -> ChartDrawing:
        """What is drawn below the table."""
        return ChartDrawing()

    def typed(self, key: str) -> bool:
        """Arrows move the mark, whatever is typed; the rest is the entry's."""
        return self.moves(key) or super().typed(key)

    def settle(self) -> None:
        """The mark stays within the table."""
        self.marked = max(0, min(self.marked, self.count - 1))

    def missing(self) -> str:
        """What must be there first; empty when it is."""
        if not self.program:
            return NO_PROGRAM
        return self.watch.book.locked or ("" if self.data.features else NO_FEATURE)


def size(mm: float, mode: Mode) -> str:
    """A measured size: a ten thousandth of an inch and half of it, or a thousandth of a millimetre."""
    return fixed(mm, 3) if mode.metric else fixed(mm / mode.unit, 5)


def signed_size(mm: float, mode: Mode) -> str:
    """A deviation with its sign."""
    text = size(mm, mode)
    return text if not text.strip("0.") or text[0] not in "0123456789." else f"+{text}"


def typed_length(value: float, mode: Mode) -> float:
    """A typed length in mm."""
    return to_mm(value, mode.metric)


def mark_of(row: FeatureRow) -> str:
    """Ø of a diameter."""
    return "Ø " if row.kind == "diameter" else ""

"""One section of the page of measured parts: its table with keys, and what its chart is to draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from app.desk.desk import Desk
from app.desk.status.formats import fixed
from app.extras.quality.parts_data import PartsData, parts_of
from app.offsets.offset_values import Mode, to_mm
from app.production.parts_watch import PartsWatch
from app.special.special_functions import FigureFunction
from core.extras.quality.control_charts import Chart, ChartPair, findings
from core.extras.quality.measured_feature import Proposal
from core.store.production.measured_parts import FeatureRow

AHEAD = 4.0  # parts behind the last one, for which a correction is drawn
FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Curve:
    """Points over parts; ``number`` chooses its colour; ``dots``: each point is drawn; ``steps``: held on."""

    x: FloatArray
    y: FloatArray
    number: int = 0
    dots: bool = True
    name: str = ""
    steps: bool = False


@dataclass(frozen=True, slots=True)
class Level:
    """A line across: ``kind`` is centre, limit (of control) or tolerance."""

    value: float
    name: str
    kind: str


@dataclass(frozen=True, slots=True)
class Plot:
    """One plot; ``marks`` are points that a rule has found. Bars stand below one another with their names."""

    title: str = ""
    curves: tuple[Curve, ...] = ()
    levels: tuple[Level, ...] = ()
    marks: tuple[tuple[float, float], ...] = ()
    bars: tuple[tuple[str, float], ...] = ()
    across: str = ""  # what is told along the lower edge

    @property
    def empty(self) -> bool:
        """Whether there is nothing to draw."""
        return not (self.bars or any(len(curve.x) for curve in self.curves))


@dataclass(frozen=True, slots=True)
class ChartDrawing:
    """Plots below one another; two of the same ``of`` are the same drawing, and are not drawn again."""

    plots: tuple[Plot, ...] = ()
    of: object = field(default=None)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ChartDrawing) and self.of == other.of

    def __hash__(self) -> int:
        return hash(self.of)


def control_plots(
    pair: ChartPair, parts: Sequence[int], limits: tuple[float, float], names: tuple[str, str], unit: float
) -> tuple[Plot, ...]:
    """Location over spread, in units of ``unit`` mm, over the number of the (last) part of each point.

    The limits of size stand in the upper one where points are single parts: averages are no parts.
    """
    location = _plot(names[0], pair.location, _last_parts(parts, pair.size), unit)
    if pair.size == 1:
        tolerance = tuple(Level(limit / unit, "", "tolerance") for limit in limits)
        location = Plot(location.title, location.curves, (*location.levels, *tolerance), location.marks)
    first = 1 if pair.size == 1 else 0  # a moving range belongs to the later of its two parts
    spread = _plot(names[1], pair.spread, _last_parts(parts, pair.size)[first:], unit)
    return location, spread


def correction_plot(
    readings: Sequence[tuple[int, float]], found: Proposal, title: str, names: tuple[str, str], unit: float
) -> Plot:
    """Sizes over parts, the mean of those that count, and where a correction brings the parts behind them.

    Readings of one part stand beside each other; lengths in units of ``unit`` mm.
    """
    parts = np.asarray([part for part, _ in readings], dtype=np.float64)
    if (np.diff(parts) <= 0.0).any():
        parts = np.arange(1.0, len(parts) + 1.0)  # measured twice, or counted anew: by turns
    sizes = np.asarray([size for _, size in readings]) / unit
    last, first = parts[-1], parts[-min(found.count, len(parts))]
    now = Curve(np.array([first, last]), np.full(2, found.mean / unit), 1, dots=False, name=names[0])
    then = Curve(
        np.array([last + 1.0, last + 1.0 + AHEAD]),
        np.full(2, found.expected / unit),
        2,
        dots=False,
        name=names[1],
    )
    middle = Level(found.feature.middle / unit, "", "centre")
    tolerance = tuple(Level(limit / unit, "", "tolerance") for limit in found.feature.limits)
    return Plot(title, (Curve(parts, sizes), now, then), (middle, *tolerance))


def _last_parts(parts: Sequence[int], size: int) -> FloatArray:
    whole = len(parts) // size * size
    return np.asarray(parts[size - 1 : whole : size], dtype=np.float64)


def _plot(title: str, chart: Chart, x: FloatArray, unit: float) -> Plot:
    y = chart.points / unit
    levels = (
        Level(chart.centre / unit, "", "centre"),
        Level(chart.upper / unit, "", "limit"),
        Level(chart.lower / unit, "", "limit"),
    )
    points = sorted({finding.point for finding in findings(chart)})
    marks = tuple((float(x[point]), float(y[point])) for point in points)
    return Plot(title, (Curve(x, y),), levels, marks)


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
        return self.desk.machine.language == "klartext"

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

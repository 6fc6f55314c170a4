"""Base of the sections of the page MEASURED PARTS: table, keys and chart data."""

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

AHEAD = 4.0  # number of parts after the last one for which a correction is drawn
FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Curve:
    """Curve over parts.

    ``number`` selects the color, ``dots`` draws points, ``steps`` draws steps.
    """

    x: FloatArray
    y: FloatArray
    number: int = 0
    dots: bool = True
    name: str = ""
    steps: bool = False


@dataclass(frozen=True, slots=True)
class Level:
    """Horizontal line. ``kind`` is centre, limit (control limit) or tolerance."""

    value: float
    name: str
    kind: str


@dataclass(frozen=True, slots=True)
class Plot:
    """Plot with curves or bars. ``marks`` are points that violate a rule."""

    title: str = ""
    curves: tuple[Curve, ...] = ()
    levels: tuple[Level, ...] = ()
    marks: tuple[tuple[float, float], ...] = ()
    bars: tuple[tuple[str, float], ...] = ()
    across: str = ""  # label of the horizontal axis

    @property
    def empty(self) -> bool:
        """Whether there is nothing to draw."""
        return not (self.bars or any(len(curve.x) for curve in self.curves))


@dataclass(frozen=True, slots=True)
class ChartDrawing:
    """Plots one below the other. Drawings with equal ``of`` are equal and are not drawn again."""

    plots: tuple[Plot, ...] = ()
    of: object = field(default=None)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ChartDrawing) and self.of == other.of

    def __hash__(self) -> int:
        return hash(self.of)


def control_plots(
    pair: ChartPair, parts: Sequence[int], limits: tuple[float, float], names: tuple[str, str], unit: float
) -> tuple[Plot, ...]:
    """Return the plots of location and spread over the part numbers, in units of ``unit`` mm.

    Each point is at the number of its last part. Size limits are shown in the upper plot only for single
    parts, because they do not apply to averages.
    """
    location = _plot(names[0], pair.location, _last_parts(parts, pair.size), unit)
    if pair.size == 1:
        tolerance = tuple(Level(limit / unit, "", "tolerance") for limit in limits)
        location = Plot(location.title, location.curves, (*location.levels, *tolerance), location.marks)
    first = 1 if pair.size == 1 else 0  # A moving range belongs to the later of its two parts.
    spread = _plot(names[1], pair.spread, _last_parts(parts, pair.size)[first:], unit)
    return location, spread


def correction_plot(
    readings: Sequence[tuple[int, float]], found: Proposal, title: str, names: tuple[str, str], unit: float
) -> Plot:
    """Return the plot of sizes over parts, with the mean and the expected size after a correction.

    Lengths are in units of ``unit`` mm. Repeated readings of a part are drawn next to each other.
    """
    parts = np.asarray([part for part, _ in readings], dtype=np.float64)
    if (np.diff(parts) <= 0.0).any():
        # A part was measured twice or the count was reset, so readings are numbered in sequence.
        parts = np.arange(1.0, len(parts) + 1.0)
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
    """Base class of the sections: parts book, loaded program, unit and selected feature."""

    chart_share: float = 0.0  # ratio of the height for the chart below the table

    def __init__(self, desk: Desk, watch: PartsWatch) -> None:
        super().__init__(desk)
        self.watch = watch

    @property
    def data(self) -> PartsData:
        """Stored data of the loaded program."""
        return parts_of(self.watch.book)

    @property
    def program(self) -> str:
        """Name of the loaded program, or an empty string."""
        return self.watch.program

    @property
    def of_mill(self) -> bool:
        """Whether the machine is a mill, where DL and DR replace wear corrections."""
        return self.desk.machine.language == "klartext"

    @property
    def mode(self) -> Mode:
        """Unit of the control, which applies to all entries and displays."""
        return Mode(self.desk.snapshot().modal.metric, diameter=True)

    @property
    def feature(self) -> FeatureRow | None:
        """Selected feature, or None."""
        rows = self.data.features
        return rows[self.marked] if self.marked < len(rows) else None

    def drawing(self) -> ChartDrawing:
        """Return the chart below the table."""
        return ChartDrawing()

    def typed(self, key: str) -> bool:
        """Handle a key: arrows move the selection, and other keys edit the entry."""
        return self.moves(key) or super().typed(key)

    def settle(self) -> None:
        """Limit the selection to the rows of the table."""
        self.marked = max(0, min(self.marked, self.count - 1))

    def missing(self) -> str:
        """Return the missing precondition of this section, or an empty string."""
        if not self.program:
            return NO_PROGRAM
        return self.watch.book.locked or ("" if self.data.features else NO_FEATURE)


def size(mm: float, mode: Mode) -> str:
    """Return a size with a resolution of 0.001 mm or .00001 in."""
    return fixed(mm, 3) if mode.metric else fixed(mm / mode.unit, 5)


def signed_size(mm: float, mode: Mode) -> str:
    """Return a deviation with its sign."""
    text = size(mm, mode)
    return text if not text.strip("0.") or text[0] not in "0123456789." else f"+{text}"


def typed_length(value: float, mode: Mode) -> float:
    """Convert a typed length to mm."""
    return to_mm(value, mode.metric)


def mark_of(row: FeatureRow) -> str:
    """Return the diameter sign for a diameter, or an empty string."""
    return "Ø " if row.kind == "diameter" else ""

"""Base class of the sections of the MEASURED PARTS page, with table, keys and chart data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from app.desk.desk import Desk
from app.desk.status.formats import format_fixed
from app.extras.quality.parts_data import PartsData, get_loaded_parts_data
from app.offsets.offset_values import UnitMode, convert_to_mm
from app.production.parts_watch import ProductionMonitor
from app.special.special_functions import NumericEntryFunction
from core.extras.quality.control_charts import ControlChart, ControlChartPair, find_rule_violations
from core.extras.quality.measured_feature import CorrectionProposal
from core.store.production.measured_parts import FeatureRow

FORECAST_PARTS = 4.0  # number of parts after the last one for which a correction is drawn
FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PlotCurve:
    """Curve in a plot whose horizontal axis is the part number.

    - ``color_index`` selects the color.
    - ``has_dots`` means that each point is drawn as a dot.
    - ``is_stepped`` means that the curve is drawn as steps.
    """

    part_sequence_numbers: FloatArray
    values: FloatArray
    color_index: int = 0
    has_dots: bool = True
    name: str = ""
    is_stepped: bool = False


@dataclass(frozen=True, slots=True)
class HorizontalLine:
    """Horizontal line in a plot.

    ``kind`` is centre (the center line), limit (a control limit) or tolerance.
    """

    value: float
    name: str
    line_type: str


@dataclass(frozen=True, slots=True)
class Plot:
    """Plot with curves or bars.

    ``violation_points`` are the points that violate a control-chart rule.
    """

    title: str = ""
    curves: tuple[PlotCurve, ...] = ()
    horizontal_lines: tuple[HorizontalLine, ...] = ()
    violation_points: tuple[tuple[float, float], ...] = ()
    bars: tuple[tuple[str, float], ...] = ()
    x_label: str = ""  # label of the horizontal axis

    @property
    def is_empty(self) -> bool:
        """Return whether the plot contains nothing to draw."""
        return not (self.bars or any(len(curve.part_sequence_numbers) for curve in self.curves))


@dataclass(frozen=True, slots=True)
class ChartDrawing:
    """Chart with plots that are arranged vertically.

    Charts with the same ``drawing_key`` are equal, so a chart is not drawn again if its key is unchanged.
    """

    plots: tuple[Plot, ...] = ()
    drawing_key: object = field(default=None)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ChartDrawing) and self.drawing_key == other.drawing_key

    def __hash__(self) -> int:
        return hash(self.drawing_key)


def make_control_plots(
    charts: ControlChartPair,
    part_numbers: Sequence[int],
    limits: tuple[float, float],
    names: tuple[str, str],
    unit_mm: float,
) -> tuple[Plot, ...]:
    """Return the control plots of location and spread over the part numbers.

    Lengths are in units of ``unit_mm`` mm. Each point is at the part number of the last part of its sample.
    The upper plot shows size limits only for samples of one part, because size limits do not apply to
    averages.
    """
    location = _plot(names[0], charts.location, _last_parts(part_numbers, charts.sample_size), unit_mm)
    if charts.sample_size == 1:
        tolerance = tuple(HorizontalLine(limit / unit_mm, "", "tolerance") for limit in limits)
        location = Plot(
            location.title,
            location.curves,
            (*location.horizontal_lines, *tolerance),
            location.violation_points,
        )
    first = 1 if charts.sample_size == 1 else 0  # A moving range belongs to the later of its two parts.
    spread = _plot(names[1], charts.spread, _last_parts(part_numbers, charts.sample_size)[first:], unit_mm)
    return location, spread


def make_correction_plot(
    readings: Sequence[tuple[int, float]],
    proposal: CorrectionProposal,
    title: str,
    names: tuple[str, str],
    unit_mm: float,
) -> Plot:
    """Return the plot of measured sizes by part number, for a proposed correction.

    The plot also shows the mean size and the size expected after the correction. Lengths are in units of
    ``unit_mm`` mm. If a part was measured repeatedly, its points are drawn next to each other.
    """
    parts = np.asarray([part for part, _ in readings], dtype=np.float64)
    if (np.diff(parts) <= 0.0).any():
        # A part was measured twice or the count was reset, so readings are numbered in sequence.
        parts = np.arange(1.0, len(parts) + 1.0)
    sizes = np.asarray([size for _, size in readings]) / unit_mm
    last, first = parts[-1], parts[-min(proposal.reading_count, len(parts))]
    now = PlotCurve(
        np.array([first, last]),
        np.full(2, proposal.mean_size_mm / unit_mm),
        1,
        has_dots=False,
        name=names[0],
    )
    then = PlotCurve(
        np.array([last + 1.0, last + 1.0 + FORECAST_PARTS]),
        np.full(2, proposal.expected_size_mm / unit_mm),
        2,
        has_dots=False,
        name=names[1],
    )
    middle = HorizontalLine(proposal.feature.middle / unit_mm, "", "centre")
    tolerance = tuple(HorizontalLine(limit / unit_mm, "", "tolerance") for limit in proposal.feature.limits)
    return Plot(title, (PlotCurve(parts, sizes), now, then), (middle, *tolerance))


def _last_parts(parts: Sequence[int], size: int) -> FloatArray:
    whole = len(parts) // size * size
    return np.asarray(parts[size - 1 : whole : size], dtype=np.float64)


def _plot(title: str, chart: ControlChart, x: FloatArray, unit: float) -> Plot:
    y = chart.point_values / unit
    levels = (
        HorizontalLine(chart.center_line / unit, "", "centre"),
        HorizontalLine(chart.upper_limit / unit, "", "limit"),
        HorizontalLine(chart.lower_limit / unit, "", "limit"),
    )
    points = sorted({finding.point_index for finding in find_rule_violations(chart)})
    marks = tuple((float(x[point]), float(y[point])) for point in points)
    return Plot(title, (PlotCurve(x, y),), levels, marks)


NO_PROGRAM_MESSAGE = "SELECT A PROGRAM FIRST. EACH PROGRAM HAS ITS OWN FEATURES"
NO_FEATURE_MESSAGE = "NO FEATURES YET. ADD A FEATURE IN SECTION 1 WITH F2"


class QualitySection(NumericEntryFunction):
    """Base class of the MEASURED PARTS sections, which provides the data, program, unit and feature."""

    chart_share: float = 0.0  # ratio of the height for the chart below the table

    def __init__(self, desk: Desk, parts_watch: ProductionMonitor) -> None:
        super().__init__(desk)
        self.watch = parts_watch

    @property
    def parts_data(self) -> PartsData:
        """Return the stored data of the loaded program."""
        return get_loaded_parts_data(self.watch.production_records)

    @property
    def program_name(self) -> str:
        """Return the name of the loaded program, or an empty string if no program is loaded."""
        return self.watch.program_name

    @property
    def is_mill(self) -> bool:
        """Return whether the machine is a mill.

        On a mill, the tool oversizes DL and DR are used instead of wear offsets.
        """
        return self.desk.machine.program_language == "klartext"

    @property
    def control_length_unit(self) -> UnitMode:
        """Return the unit of length of the control, which applies to all entries and displayed values."""
        return UnitMode(self.desk.read_snapshot().modal.metric, is_diameter=True)

    @property
    def selected_feature(self) -> FeatureRow | None:
        """Return the selected feature, or None if there is no feature."""
        rows = self.parts_data.features
        return rows[self.marked] if self.marked < len(rows) else None

    def make_chart(self) -> ChartDrawing:
        """Return the chart that is shown below the table."""
        return ChartDrawing()

    def handle_key(self, key: str) -> bool:
        """Handle a key and return whether it was used.

        The arrow keys move the selection. Other keys edit the entry.
        """
        return self.move_selection(key) or super().handle_key(key)

    def make_content_key(self, *more: object) -> tuple[object, ...]:
        """Return the values on which a table or chart depends; ``more`` are those of one section."""
        records = self.watch.production_records
        return (records.load_count, self.program_name, self.control_length_unit, *more)

    def limit_selection(self) -> None:
        """Move the selection to the last row if the selected row no longer exists."""
        self.marked = max(0, min(self.marked, self.row_count - 1))

    def find_unmet_precondition(self) -> str:
        """Return the reason why this section cannot be used, or an empty string if it can be used.

        For example, no program is loaded or no feature exists.
        """
        if not self.program_name:
            return NO_PROGRAM_MESSAGE
        return self.watch.production_records.lock_reason or (
            "" if self.parts_data.features else NO_FEATURE_MESSAGE
        )


def format_size(size_mm: float, value_mode: UnitMode) -> str:
    """Return a size in mm as text with a resolution of 0.001 mm or .00001 in."""
    return (
        format_fixed(size_mm, 3)
        if value_mode.is_metric
        else format_fixed(size_mm / value_mode.unit_length_mm, 5)
    )


def format_deviation(deviation_mm: float, value_mode: UnitMode) -> str:
    """Return a deviation in mm as text with its sign, in the unit of ``value_mode``."""
    text = format_size(deviation_mm, value_mode)
    return text if not text.strip("0.") or text[0] not in "0123456789." else f"+{text}"


def convert_entry_to_mm(value: float, value_mode: UnitMode) -> float:
    """Convert a typed length from the unit of ``value_mode`` to mm."""
    return convert_to_mm(value, value_mode.is_metric)


def get_diameter_symbol(row: FeatureRow) -> str:
    """Return the diameter symbol if the feature is a diameter, or else an empty string."""
    return "Ø " if row.kind == "diameter" else ""

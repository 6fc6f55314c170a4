"""Control charts of the marked feature, its Cpk, and the rules that tell drift."""

from __future__ import annotations

from itertools import pairwise

from app.desk.desk import Desk
from app.desk.pages.sheet import Row, Sheet
from app.desk.status.formats import NOTHING, fixed
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.extras.quality.parts_data import feature_of
from app.extras.quality.plots import ChartDrawing, control_plots
from app.extras.quality.section import QualitySection, mark_of, size
from app.production.parts_watch import PartsWatch
from core.executor.snapshot import Snapshot
from core.extras.quality.capability import capability
from core.extras.quality.control_charts import charts_of, findings
from core.extras.quality.quality_errors import QualityError
from core.message import Message
from core.store.production.measured_parts import FeatureRow, ReadingRow

SHOWN = 100  # newest readings that a chart is made of


class ChartsSection(QualitySection):
    """A row a feature, the charts of the marked one below."""

    name = "CONTROL CHARTS"
    use = "limits, Cpk, drift"
    chart_share = 0.62

    def __init__(self, desk: Desk, watch: PartsWatch) -> None:
        super().__init__(desk, watch)
        self._made: tuple[object, ChartDrawing] = (None, ChartDrawing())
        self._rows: tuple[object, tuple[Row, ...]] = (None, ())

    @property
    def count(self) -> int:
        """Features."""
        return len(self.data.features)

    def takes(self, _key: str) -> bool:
        """Nothing is typed here."""
        return False

    def take(self, _text: str) -> bool:
        """Nothing is typed here."""
        return False

    def typed(self, key: str) -> bool:
        """The arrows alone."""
        return self.moves(key)

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Mean, capability and drift of each feature."""
        self.settle()
        mode = self.mode
        of = (self.watch.book.loads, self.program, mode)
        if self._rows[0] != of:
            self._rows = of, tuple(self._row(each) for each in self.data.features)
        heads = ("FEATURE", "READINGS", Message("MEAN {mode}", mode=mode.name), "Cp", "Cpk", "DRIFT")
        title = (
            Message("CONTROL CHARTS  ·  {program}", program=self.program)
            if self.program
            else "CONTROL CHARTS"
        )
        return Sheet(title, heads, (0.2, 0.08, 0.15, 0.09, 0.09, 0.39), self._rows[1], self.marked,
                     raw=frozenset({0}), figures=frozenset({1}))  # fmt: skip

    def _row(self, row: FeatureRow) -> Row:
        feature, taken = feature_of(row), self._newest(row)
        values = [each.value for each in taken]
        if not values:
            return Row((row.name, "0", "", "", "", tr("FEATURE NOT MEASURED YET")), None)
        mean = mark_of(row) + size(sum(values) / len(values), self.mode)
        drift = self._drift(row, values)
        try:
            found = capability(values, *feature.limits, row.sample)
        except QualityError as error:
            return Row(
                (row.name, str(len(values)), mean, NOTHING, NOTHING, drift or str(error)),
                not drift,
                _tone(drift),
            )
        cp, cpk = (NOTHING if each is None else fixed(each, 2) for each in (found.cp, found.cpk))
        if not drift and found.at_least is not None:
            drift = tr(
                Message(
                    "no drift; Cpk is at least {minimum} (95 % confidence)",
                    minimum=fixed(found.at_least, 2),
                )
            )
            return Row((row.name, str(len(values)), mean, cp, cpk, drift), True, Tone.RUN)
        return Row((row.name, str(len(values)), mean, cp, cpk, drift), not drift, _tone(drift))

    def _newest(self, row: FeatureRow) -> tuple[ReadingRow, ...]:
        return self.data.readings_of(row.id)[-SHOWN:]

    def _drift(self, row: FeatureRow, values: list[float]) -> str:
        """The last thing that a rule has found, where it is among the last ten points."""
        try:
            chart = charts_of(values, row.sample).location
        except QualityError:
            return ""
        late = [each for each in findings(chart) if each.point >= len(chart.points) - 10]
        return tr(late[-1].words) if late else ""

    def drawing(self) -> ChartDrawing:
        """Location over spread of the marked feature, made when something has changed."""
        row, mode = self.feature, self.mode
        of = (self.watch.book.loads, self.program, row.id if row is not None else 0, mode)
        if self._made[0] != of:
            self._made = of, self._drawn(row, of)
        return self._made[1]

    def _drawn(self, row: FeatureRow | None, of: object) -> ChartDrawing:
        taken = self._newest(row) if row is not None else ()
        if row is None or not taken:
            return ChartDrawing((), of)
        parts = [each.part for each in taken]
        if any(after <= before for before, after in pairwise(parts)):
            parts = list(range(1, len(taken) + 1))  # counted anew, or measured twice: by turns
        try:
            pair = charts_of([each.value for each in taken], row.sample)
        except QualityError:
            return ChartDrawing((), of)
        names = (tr("INDIVIDUALS"), tr("MOVING RANGE")) if row.sample == 1 else (tr("AVERAGE"), tr("RANGE"))
        titled = (f"{row.name}  {names[0]}", names[1])
        return ChartDrawing(control_plots(pair, parts, feature_of(row).limits, titled, self.mode.unit), of)

    def prompt(self) -> str:
        """What the lines are."""
        return self.missing() or (
            "ARROWS: SELECT FEATURE. DASHED: CONTROL LIMITS, DOTTED: TOLERANCE, CIRCLED: RULE VIOLATIONS"
        )


def _tone(drift: str) -> Tone:
    return Tone.PAUSE if drift else Tone.READY

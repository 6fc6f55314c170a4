"""Control charts with Cpk of a feature, and trends: cycle time, load, wear, stops and availability."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np

from app.desk.arithmetic import EntryError
from app.desk.desk import Desk
from app.desk.pages.sheet import Row, Sheet, edited
from app.desk.status.formats import NOTHING, duration, fixed
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.extras.quality.parts_data import feature_of
from app.extras.quality.section import (
    ChartDrawing,
    Curve,
    Level,
    Plot,
    QualitySection,
    control_plots,
    mark_of,
    size,
)
from app.extras.quality.shift_figures import SETTING, hours_of, shift_of, spans_of, stops_of
from app.offsets.offset_values import signed
from app.production.parts_watch import PartsWatch
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.extras.quality.control_charts import QualityError, capability, charts_of, findings
from core.extras.quality.stops import Availability, Span, availability, pareto, times_between
from core.message import Message
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.store_errors import StoreError

KINDS = ("CYCLE TIME", "WEAR", "STOPS", "SPINDLE LOAD", "AVAILABILITY")
_MOST_BARS = 8


class TrendsSection(QualitySection):
    """Section with one row per trend and the chart of the selected trend below."""

    name = "TRENDS"
    use = "cycle times, stops, availability"
    chart_share = 0.42

    def __init__(
        self, desk: Desk, watch: PartsWatch, now: Callable[[], datetime] = lambda: datetime.now(UTC)
    ) -> None:
        super().__init__(desk, watch)
        self._now = now
        self._shift: tuple[int, int] | None = None
        self._made: tuple[object, ChartDrawing] = (None, ChartDrawing())
        self._rows: tuple[object, tuple[Row, ...]] = (None, ())

    @property
    def count(self) -> int:
        """Number of trends."""
        return len(self.kinds)

    @property
    def kind(self) -> str:
        """Selected trend."""
        return self.kinds[self.marked]

    @property
    def kinds(self) -> tuple[str, ...]:
        """Trends of this machine. A mill has no wear trend, because DL and DR are not recorded."""
        return tuple(each for each in KINDS if each != "WEAR" or not self.of_mill)

    @property
    def shift(self) -> tuple[int, int]:
        """First and last hour of the shift in local time, loaded once."""
        if self._shift is None:
            try:
                kept = self.desk.runs.counter.persistence.read_setting(SETTING)
            except StoreError:
                kept = None
            self._shift = hours_of(kept)
        return self._shift

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of the trends with their values."""
        self.settle()
        minute = int(self._now().timestamp() // 60)
        of = (self.watch.book.loads, self.program, self.mode, minute, self.shift)
        if self._rows[0] != of:
            self._rows = of, tuple(Row((kind, self._figure(kind))) for kind in self.kinds)
        question = tr("SHIFT HOURS, FOR EXAMPLE 6-14?") if self.kind == "AVAILABILITY" else ""
        title = Message("TRENDS  ·  {program}", program=self.program) if self.program else "TRENDS"
        return Sheet(title, ("", ""), (0.25, 0.75), self._rows[1], self.marked, question, self.entry.text,
                     raw=frozenset({1}))  # fmt: skip

    # --- values --------------------------------------------------------------------------------------

    def _figure(self, kind: str) -> str:
        return {
            "CYCLE TIME": self._cycle_words,
            "WEAR": self._wear_words,
            "STOPS": self._stop_words,
            "SPINDLE LOAD": self._load_words,
            "AVAILABILITY": self._availability_words,
        }[kind]()

    def _cycle_words(self) -> str:
        times = [row.seconds for row in self.data.whole_cycles]
        if not times:
            return tr("no part made yet")
        text = tr("last cycle {last}, shortest {best}, mean {mean} of {count} parts")
        figures = (fixed(each, 1) + " s" for each in (times[-1], min(times), sum(times) / len(times)))
        last, best, mean = figures
        return tr(Message(text, last=last, best=best, mean=mean, count=len(times)))

    def _wear_words(self) -> str:
        rows = self.data.corrections
        if not rows:
            return tr("no wear correction yet")
        last, metric = rows[-1], self.mode.metric
        letter, factor = ("T", 2.0) if last.kind == "tool" else ("D", 1.0)
        text = tr("{count} corrections; last correction: {offset} by X {x} Z {z} after part {part}")
        return tr(
            Message(
                text,
                count=len(rows),
                offset=f"{letter}{last.number}",
                x=signed(factor * last.x, metric),
                z=signed(last.z, metric),
                part=last.part,
            )
        )

    def _stop_words(self) -> str:
        stops = stops_of(self.watch.book.now.stops)
        rows = pareto(stops)
        if not rows:
            return tr("no stops yet")
        between = times_between(stops)
        mean = duration(sum(between) / len(between)) if between else NOTHING
        text = tr("{count} stops, on average {mean} apart; longest total: {reason}, {time}")
        return tr(
            Message(
                text, count=len(stops), mean=mean, reason=tr(rows[0].reason), time=duration(rows[0].seconds)
            )
        )

    def _load_words(self) -> str:
        loads = [row.load for row in self.data.cycles if row.load is not None]
        if not loads:
            return tr("no drive on this machine reports its load")
        return tr(
            Message(
                "last load {last} %, highest load {maximum} %",
                last=fixed(loads[-1], 0),
                maximum=fixed(max(loads), 0),
            )
        )

    def _availability_words(self) -> str:
        first, last = self.shift
        found = self.of_shift()
        if found is None:
            return tr(Message("{first}–{last}: the shift has not started", first=first, last=last))
        text = tr("{first}–{last}: {share} %, in cycle for {run} of {planned}")
        return tr(
            Message(
                text,
                first=first,
                last=last,
                share=fixed(100.0 * found.share, 0),
                run=duration(found.producing),
                planned=duration(found.planned),
            )
        )

    def of_shift(self) -> Availability | None:
        """Return the availability of the present or last shift for all programs, or None before the first."""
        now = self._now()
        shift = shift_of(self.shift, now)
        ends = min(shift.end, now.timestamp())
        if ends <= shift.start:
            return None
        return availability(Span(shift.start, ends), spans_of(self.data.day, now.timestamp()))

    # --- drawing -------------------------------------------------------------------------------------

    def drawing(self) -> ChartDrawing:
        """Return the chart of the selected trend."""
        of = (self.watch.book.loads, self.program, self.kind, self.mode)
        if self._made[0] != of:
            self._made = of, ChartDrawing(self._plots(), of)
        return self._made[1]

    def _plots(self) -> tuple[Plot, ...]:
        return {
            "CYCLE TIME": self._cycle_plots,
            "WEAR": self._wear_plots,
            "STOPS": self._stop_plots,
            "SPINDLE LOAD": self._load_plots,
            "AVAILABILITY": self._availability_plots,
        }[self.kind]()

    def _cycle_plots(self) -> tuple[Plot, ...]:
        rows = self.data.whole_cycles
        if not rows:
            return ()
        times = np.asarray([row.seconds for row in rows])
        mean = Level(float(times.mean()), "", "centre")
        return (Plot(tr("CYCLE TIME, s"), (Curve(_numbers(len(rows)), times),), (mean,), across=tr("parts")),)

    def _wear_plots(self) -> tuple[Plot, ...]:
        """Return the wear charts, with X of tools as a diameter.

        A correction applies until the next one.
        """
        unit, made = self.mode.unit, float(max((row.part for row in self.data.cycles), default=0))
        curves: list[list[Curve]] = [[], []]
        for number, (kind, offset) in enumerate(sorted({(r.kind, r.number) for r in self.data.corrections})):
            rows = [row for row in self.data.corrections if (row.kind, row.number) == (kind, offset)]
            first, last = rows[0], rows[-1]
            parts = np.asarray([0.0, *(float(row.part) for row in rows), max(made, float(last.part))])
            name = f"{'T' if kind == 'tool' else 'D'}{offset}"
            factor = 2.0 if kind == "tool" else 1.0
            x = np.asarray([first.was_x, *(row.x for row in rows), last.x]) * factor / unit
            z = np.asarray([first.was_z, *(row.z for row in rows), last.z]) / unit
            curves[0].append(Curve(parts, x, number, name=name, dots=False, steps=True))
            curves[1].append(Curve(parts, z, number, name=name, dots=False, steps=True))
        if not curves[0]:
            return ()
        titles = (f"{tr('WEAR X')}, {self.mode.name}", f"{tr('WEAR Z')}, {self.mode.name}")
        return tuple(Plot(title, tuple(each)) for title, each in zip(titles, curves, strict=True))

    def _stop_plots(self) -> tuple[Plot, ...]:
        rows = pareto(stops_of(self.watch.book.now.stops))[:_MOST_BARS]
        if not rows:
            return ()
        bars = tuple(
            (f"{tr(row.reason)}  {row.times} ×  {fixed(100 * row.together, 0)} %", row.seconds / 60.0)
            for row in rows
        )
        return (Plot(tr("MINUTES BY REASON, WITH CUMULATIVE PERCENTAGE"), bars=bars),)

    def _load_plots(self) -> tuple[Plot, ...]:
        rows = [row for row in self.data.cycles if row.load is not None]
        if not rows:
            return ()
        loads = np.asarray([float(row.load or 0.0) for row in rows])
        return (Plot(tr("SPINDLE LOAD, %"), (Curve(_numbers(len(rows)), loads),)),)

    def _availability_plots(self) -> tuple[Plot, ...]:
        found = self.of_shift()
        if found is None:
            return ()
        stood = found.planned - found.producing
        bars = ((tr("IN CYCLE"), found.producing / 60.0), (tr("NOT IN CYCLE"), stood / 60.0))
        return (Plot(tr("MINUTES OF THE SHIFT"), bars=bars),)

    # --- the shift -----------------------------------------------------------------------------------

    def takes(self, key: str) -> bool:
        """Return whether a character is part of the shift hours."""
        return self.kind == "AVAILABILITY" and len(key) == 1 and (key.isdigit() or key == "-")

    def typed(self, key: str) -> bool:
        """Handle a key: arrows select a trend, and other keys edit the shift hours."""
        if self.moves(key):
            self.entry.text = ""
            return True
        if self.kind != "AVAILABILITY":
            return False
        if key == "Enter":
            self.enter()
        elif self.takes(key) or key in {"Back", "Delete"}:
            self.desk.clear()
            self.entry.text = edited(self.entry.text, key, 5)
        else:
            return False
        return True

    def take(self, text: str) -> bool:
        """Set the first and last hour of the shift. Raises EntryError."""
        first, _, last = text.partition("-")
        if not (first.isdigit() and last.isdigit() and int(first) < 24 and int(last) <= 24):
            raise EntryError(tr("enter the start and end hour of the shift, such as 6-14"))
        if self.desk.refused(Act.FEATURES):
            return False
        self._shift = int(first), int(last)
        hours = list(self._shift)
        self.desk.runs.counter.persistence.note_change(
            Message("shift hours: {first} to {last}", first=first, last=last)
        )
        self.desk.keep(lambda: self.desk.runs.counter.persistence.save_setting(SETTING, hours))
        return True

    def prompt(self) -> str:
        """Return the prompt, or the reason why nothing is stored."""
        return self.watch.book.locked or ("ARROWS: SELECT TREND   ESC: BACK TO LIST")


def _numbers(count: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.arange(1, count + 1, dtype=np.float64)


SHOWN = 100  # number of latest readings in a chart


class ChartsSection(QualitySection):
    """Section with one row per feature and the charts of the selected feature below."""

    name = "CONTROL CHARTS"
    use = "limits, Cpk, drift"
    chart_share = 0.62

    def __init__(self, desk: Desk, watch: PartsWatch) -> None:
        super().__init__(desk, watch)
        self._made: tuple[object, ChartDrawing] = (None, ChartDrawing())
        self._rows: tuple[object, tuple[Row, ...]] = (None, ())

    @property
    def count(self) -> int:
        """Number of features."""
        return len(self.data.features)

    def takes(self, _key: str) -> bool:
        """Return False, because this section has no entry."""
        return False

    def take(self, _text: str) -> bool:
        """Return False, because this section has no entry."""
        return False

    def typed(self, key: str) -> bool:
        """Move the selection by arrow keys."""
        return self.moves(key)

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table with mean, capability and drift of each feature."""
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
        """Return the latest rule violation within the last ten points, or an empty string."""
        try:
            chart = charts_of(values, row.sample).location
        except QualityError:
            return ""
        late = [each for each in findings(chart) if each.point >= len(chart.points) - 10]
        return tr(late[-1].words) if late else ""

    def drawing(self) -> ChartDrawing:
        """Return the charts of location and spread of the selected feature, rebuilt after a change."""
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
            # The count was reset or a part was measured twice, so readings are numbered in sequence.
            parts = list(range(1, len(taken) + 1))
        try:
            pair = charts_of([each.value for each in taken], row.sample)
        except QualityError:
            return ChartDrawing((), of)
        names = (tr("INDIVIDUALS"), tr("MOVING RANGE")) if row.sample == 1 else (tr("AVERAGE"), tr("RANGE"))
        titled = (f"{row.name}  {names[0]}", names[1])
        return ChartDrawing(control_plots(pair, parts, feature_of(row).limits, titled, self.mode.unit), of)

    def prompt(self) -> str:
        """Return the prompt, which explains the lines of the chart."""
        return self.missing() or (
            "ARROWS: SELECT FEATURE. DASHED: CONTROL LIMITS, DOTTED: TOLERANCE, CIRCLED: RULE VIOLATIONS"
        )


def _tone(drift: str) -> Tone:
    return Tone.PAUSE if drift else Tone.READY

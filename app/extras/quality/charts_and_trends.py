"""Control charts and Cpk of part features; trends of cycle time, load, wear, stops, availability."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np

from app.desk.arithmetic import InvalidEntryError
from app.desk.desk import Desk
from app.desk.pages.table_content import TableContent, TableRow, apply_edit_key
from app.desk.status.formats import NO_VALUE, format_duration, format_fixed
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.extras.quality.parts_data import make_measured_feature
from app.extras.quality.section import (
    ChartDrawing,
    HorizontalLine,
    Plot,
    PlotCurve,
    QualitySection,
    format_size,
    get_diameter_symbol,
    make_control_plots,
)
from app.extras.quality.shift_results import (
    SHIFT_HOURS_SETTING,
    convert_stop_rows,
    find_shift,
    get_shift_hours,
    make_cycle_spans,
)
from app.offsets.offset_values import format_signed_length
from app.production.parts_watch import ProductionMonitor
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.extras.quality.control_charts import (
    QualityError,
    calculate_capability,
    find_rule_violations,
    make_charts,
)
from core.extras.quality.production_stops import (
    Availability,
    TimeSpan,
    analyze_stop_reasons,
    calculate_availability,
    calculate_times_between,
)
from core.message import Message
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.store_errors import StoreError

TREND_NAMES = ("CYCLE TIME", "WEAR", "STOPS", "SPINDLE LOAD", "AVAILABILITY")
_MOST_BARS = 8


class TrendsSection(QualitySection):
    """Section of MEASURED PARTS with one row per trend, and the chart of the selected trend."""

    name = "TRENDS"
    use = "cycle times, stops, availability"
    chart_share = 0.42

    def __init__(
        self,
        desk: Desk,
        parts_watch: ProductionMonitor,
        get_utc: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        super().__init__(desk, parts_watch)
        self._now = get_utc
        self._shift: tuple[int, int] | None = None
        self._made: tuple[object, ChartDrawing] = (None, ChartDrawing())
        self._rows: tuple[object, tuple[TableRow, ...]] = (None, ())

    @property
    def row_count(self) -> int:
        """Return the number of trends."""
        return len(self.trend_names)

    @property
    def selected_trend(self) -> str:
        """Return the name of the selected trend."""
        return self.trend_names[self.marked]

    @property
    def trend_names(self) -> tuple[str, ...]:
        """Return the names of the trends of this machine.

        A mill has no wear trend, because changes of DL and DR are not recorded.
        """
        return tuple(each for each in TREND_NAMES if each != "WEAR" or not self.is_mill)

    @property
    def shift_hours(self) -> tuple[int, int]:
        """Return the hours at which the shift starts and ends, in local time.

        The hours are loaded only once.
        """
        if self._shift is None:
            try:
                kept = self.desk.program_runs.part_counter.persistence.read_setting(SHIFT_HOURS_SETTING)
            except StoreError:
                kept = None
            self._shift = get_shift_hours(kept)
        return self._shift

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table with the current value of each trend."""
        self.limit_selection()
        minute = int(self._now().timestamp() // 60)
        key = self.make_content_key(minute, self.shift_hours)
        if self._rows[0] != key:
            self._rows = key, tuple(TableRow((kind, self._figure(kind))) for kind in self.trend_names)
        question = tr("SHIFT HOURS, FOR EXAMPLE 6-14?") if self.selected_trend == "AVAILABILITY" else ""
        title = Message("TRENDS  ·  {program}", program=self.program_name) if self.program_name else "TRENDS"
        return TableContent(
            title,
            ("", ""),
            (0.25, 0.75),
            self._rows[1],
            self.marked,
            question,
            self.entry.text,
            untranslated_columns=frozenset({1}),
        )

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
        times = [row.seconds for row in self.parts_data.complete_cycles]
        if not times:
            return tr("no part made yet")
        text = tr("last cycle {last}, shortest {best}, mean {mean} of {count} parts")
        stats = (format_fixed(each, 1) + " s" for each in (times[-1], min(times), sum(times) / len(times)))
        last, best, mean = stats
        return tr(Message(text, last=last, best=best, mean=mean, count=len(times)))

    def _wear_words(self) -> str:
        rows = self.parts_data.corrections
        if not rows:
            return tr("no wear correction yet")
        last, metric = rows[-1], self.control_length_unit.is_metric
        letter, factor = ("T", 2.0) if last.kind == "tool" else ("D", 1.0)
        text = tr("{count} corrections; last correction: {offset} by X {x} Z {z} after part {part}")
        return tr(
            Message(
                text,
                count=len(rows),
                offset=f"{letter}{last.number}",
                x=format_signed_length(factor * last.x, metric),
                z=format_signed_length(last.z, metric),
                part=last.part,
            )
        )

    def _stop_words(self) -> str:
        stops = convert_stop_rows(self.watch.production_records.current_data.stops)
        rows = analyze_stop_reasons(stops)
        if not rows:
            return tr("no stops yet")
        between = calculate_times_between(stops)
        mean = format_duration(sum(between) / len(between)) if between else NO_VALUE
        text = tr("{count} stops, on average {mean} apart; longest total: {reason}, {time}")
        return tr(
            Message(
                text,
                count=len(stops),
                mean=mean,
                reason=tr(rows[0].reason),
                time=format_duration(rows[0].seconds),
            )
        )

    def _load_words(self) -> str:
        loads = [row.load for row in self.parts_data.cycles if row.load is not None]
        if not loads:
            return tr("no drive on this machine reports its load")
        return tr(
            Message(
                "last load {last} %, highest load {maximum} %",
                last=format_fixed(loads[-1], 0),
                maximum=format_fixed(max(loads), 0),
            )
        )

    def _availability_words(self) -> str:
        first, last = self.shift_hours
        found = self.find_shift_availability()
        if found is None:
            return tr(Message("{first}–{last}: the shift has not started", first=first, last=last))
        text = tr("{first}–{last}: {share} %, in cycle for {run} of {planned}")
        return tr(
            Message(
                text,
                first=first,
                last=last,
                share=format_fixed(100.0 * found.producing_fraction, 0),
                run=format_duration(found.producing_s),
                planned=format_duration(found.planned_s),
            )
        )

    def find_shift_availability(self) -> Availability | None:
        """Return the availability of all programs in the current shift, or else in the last shift.

        Returns None if no time of the shift has passed yet.
        """
        now = self._now()
        shift = find_shift(self.shift_hours, now)
        ends = min(shift.end_s, now.timestamp())
        if ends <= shift.start_s:
            return None
        return calculate_availability(
            TimeSpan(shift.start_s, ends),
            make_cycle_spans(self.parts_data.recent_cycle_times, now.timestamp()),
        )

    # --- drawing -------------------------------------------------------------------------------------

    def make_chart(self) -> ChartDrawing:
        """Return the chart of the selected trend."""
        key = self.make_content_key(self.selected_trend)
        if self._made[0] != key:
            self._made = key, ChartDrawing(self._plots(), key)
        return self._made[1]

    def _plots(self) -> tuple[Plot, ...]:
        return {
            "CYCLE TIME": self._cycle_plots,
            "WEAR": self._wear_plots,
            "STOPS": self._stop_plots,
            "SPINDLE LOAD": self._load_plots,
            "AVAILABILITY": self._availability_plots,
        }[self.selected_trend]()

    def _cycle_plots(self) -> tuple[Plot, ...]:
        rows = self.parts_data.complete_cycles
        if not rows:
            return ()
        times = np.asarray([row.seconds for row in rows])
        mean = HorizontalLine(float(times.mean()), "", "centre")
        return (
            Plot(tr("CYCLE TIME, s"), (PlotCurve(_numbers(len(rows)), times),), (mean,), x_label=tr("parts")),
        )

    def _wear_plots(self) -> tuple[Plot, ...]:
        """Return the charts of the wear offsets in X and Z. The X wear of tools is a diameter.

        Each correction applies until the next correction.
        """
        unit, made = (
            self.control_length_unit.unit_length_mm,
            float(max((row.part for row in self.parts_data.cycles), default=0)),
        )
        curves: list[list[PlotCurve]] = [[], []]
        for number, (kind, offset) in enumerate(
            sorted({(r.kind, r.number) for r in self.parts_data.corrections})
        ):
            rows = [row for row in self.parts_data.corrections if (row.kind, row.number) == (kind, offset)]
            first, last = rows[0], rows[-1]
            parts = np.asarray([0.0, *(float(row.part) for row in rows), max(made, float(last.part))])
            name = f"{'T' if kind == 'tool' else 'D'}{offset}"
            factor = 2.0 if kind == "tool" else 1.0
            x = np.asarray([first.was_x, *(row.x for row in rows), last.x]) * factor / unit
            z = np.asarray([first.was_z, *(row.z for row in rows), last.z]) / unit
            curves[0].append(PlotCurve(parts, x, number, name=name, has_dots=False, is_stepped=True))
            curves[1].append(PlotCurve(parts, z, number, name=name, has_dots=False, is_stepped=True))
        if not curves[0]:
            return ()
        unit_name = self.control_length_unit.name
        titles = (f"{tr('WEAR X')}, {unit_name}", f"{tr('WEAR Z')}, {unit_name}")
        return tuple(Plot(title, tuple(each)) for title, each in zip(titles, curves, strict=True))

    def _stop_plots(self) -> tuple[Plot, ...]:
        stops = convert_stop_rows(self.watch.production_records.current_data.stops)
        rows = analyze_stop_reasons(stops)[:_MOST_BARS]
        if not rows:
            return ()
        bars = tuple(
            (f"{tr(row.reason)}  {row.times} ×  {format_fixed(100 * row.together, 0)} %", row.seconds / 60.0)
            for row in rows
        )
        return (Plot(tr("MINUTES BY REASON, WITH CUMULATIVE PERCENTAGE"), bars=bars),)

    def _load_plots(self) -> tuple[Plot, ...]:
        rows = [row for row in self.parts_data.cycles if row.load is not None]
        if not rows:
            return ()
        loads = np.asarray([float(row.load or 0.0) for row in rows])
        return (Plot(tr("SPINDLE LOAD, %"), (PlotCurve(_numbers(len(rows)), loads),)),)

    def _availability_plots(self) -> tuple[Plot, ...]:
        found = self.find_shift_availability()
        if found is None:
            return ()
        stood = found.planned_s - found.producing_s
        bars = ((tr("IN CYCLE"), found.producing_s / 60.0), (tr("NOT IN CYCLE"), stood / 60.0))
        return (Plot(tr("MINUTES OF THE SHIFT"), bars=bars),)

    # --- the shift -----------------------------------------------------------------------------------

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the shift hours."""
        return self.selected_trend == "AVAILABILITY" and len(key) == 1 and (key.isdecimal() or key == "-")

    def handle_key(self, key: str) -> bool:
        """Handle a key and return whether it was used.

        The arrow keys select a trend. Other keys edit the shift hours.
        """
        if self.move_selection(key):
            self.entry.text = ""
            return True
        if self.selected_trend != "AVAILABILITY":
            return False
        if key == "Enter":
            self.submit_entry()
        elif self.accepts_key(key) or key in {"Back", "Delete"}:
            self.desk.clear_prompt_line()
            self.entry.text = apply_edit_key(self.entry.text, key, 5)
        else:
            return False
        return True

    def accept_entry(self, text: str) -> bool:
        """Set the start and end hour of the shift from a text such as 6-14.

        Return False if the operator is not permitted to change the hours. Raises InvalidEntryError if the
        text is not a valid pair of hours.
        """
        first, _, last = text.partition("-")
        if not (first.isdecimal() and last.isdecimal() and int(first) < 24 and int(last) <= 24):
            raise InvalidEntryError(tr("enter the start and end hour of the shift, such as 6-14"))
        if self.desk.is_refused(ProtectedChange.FEATURES):
            return False
        self._shift = int(first), int(last)
        hours = list(self._shift)
        self.desk.program_runs.part_counter.persistence.log_change(
            Message("shift hours: {first} to {last}", first=first, last=last)
        )
        self.desk.try_save(
            lambda: self.desk.program_runs.part_counter.persistence.save_setting(SHIFT_HOURS_SETTING, hours)
        )
        return True

    def prompt_text(self) -> str:
        """Return the prompt that explains the keys, or the reason why production data are not stored."""
        return self.watch.production_records.lock_reason or ("ARROWS: SELECT TREND   ESC: BACK TO LIST")


def _numbers(count: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.arange(1, count + 1, dtype=np.float64)


CHART_READING_COUNT = 100  # number of latest readings in a chart


class ChartsSection(QualitySection):
    """Section of MEASURED PARTS with one row per feature, and the charts of the selected feature."""

    name = "CONTROL CHARTS"
    use = "limits, Cpk, drift"
    chart_share = 0.62

    def __init__(self, desk: Desk, parts_watch: ProductionMonitor) -> None:
        super().__init__(desk, parts_watch)
        self._made: tuple[object, ChartDrawing] = (None, ChartDrawing())
        self._rows: tuple[object, tuple[TableRow, ...]] = (None, ())

    @property
    def row_count(self) -> int:
        """Return the number of features."""
        return len(self.parts_data.features)

    def accepts_key(self, _key: str) -> bool:
        """Return False because this section has no entry field."""
        return False

    def accept_entry(self, _text: str) -> bool:
        """Return False because this section has no entry field."""
        return False

    def handle_key(self, key: str) -> bool:
        """Select a feature with the arrow keys, and return whether the key was used."""
        return self.move_selection(key)

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table with the mean, the capability and the drift of each feature."""
        self.limit_selection()
        mode = self.control_length_unit
        key = self.make_content_key()
        if self._rows[0] != key:
            self._rows = key, tuple(self._row(each) for each in self.parts_data.features)
        heads = ("FEATURE", "READINGS", Message("MEAN {mode}", mode=mode.name), "Cp", "Cpk", "DRIFT")
        title = (
            Message("CONTROL CHARTS  ·  {program}", program=self.program_name)
            if self.program_name
            else "CONTROL CHARTS"
        )
        return TableContent(title, heads, (0.2, 0.08, 0.15, 0.09, 0.09, 0.39), self._rows[1], self.marked,
                     untranslated_columns=frozenset({0}), numeric_columns=frozenset({1}))  # fmt: skip

    def _row(self, row: FeatureRow) -> TableRow:
        feature, taken = make_measured_feature(row), self._newest(row)
        values = [each.value for each in taken]
        if not values:
            return TableRow((row.name, "0", "", "", "", tr("FEATURE NOT MEASURED YET")), None)
        mean = get_diameter_symbol(row) + format_size(sum(values) / len(values), self.control_length_unit)
        drift = self._drift(row, values)
        try:
            found = calculate_capability(values, *feature.limits, row.sample)
        except QualityError as error:
            return TableRow(
                (row.name, str(len(values)), mean, NO_VALUE, NO_VALUE, drift or str(error)),
                not drift,
                _tone(drift),
            )
        cp, cpk = (NO_VALUE if each is None else format_fixed(each, 2) for each in (found.cp, found.cpk))
        if not drift and found.cpk_lower_bound is not None:
            drift = tr(
                Message(
                    "no drift; Cpk is at least {minimum} (95 % confidence)",
                    minimum=format_fixed(found.cpk_lower_bound, 2),
                )
            )
            return TableRow((row.name, str(len(values)), mean, cp, cpk, drift), True, StatusTone.RUN)
        return TableRow((row.name, str(len(values)), mean, cp, cpk, drift), not drift, _tone(drift))

    def _newest(self, row: FeatureRow) -> tuple[ReadingRow, ...]:
        return self.parts_data.select_readings(row.id)[-CHART_READING_COUNT:]

    def _drift(self, row: FeatureRow, values: list[float]) -> str:
        """Return a text about the latest rule violation in the last ten points, or an empty string."""
        try:
            chart = make_charts(values, row.sample).location
        except QualityError:
            return ""
        late = [
            each for each in find_rule_violations(chart) if each.point_index >= len(chart.point_values) - 10
        ]
        return tr(late[-1].rule_text) if late else ""

    def make_chart(self) -> ChartDrawing:
        """Return the control charts for location and spread of the selected feature.

        The charts are cached until the data change.
        """
        row = self.selected_feature
        key = self.make_content_key(row.id if row is not None else 0)
        if self._made[0] != key:
            self._made = key, self._drawn(row, key)
        return self._made[1]

    def _drawn(self, row: FeatureRow | None, key: object) -> ChartDrawing:
        taken = self._newest(row) if row is not None else ()
        if row is None or not taken:
            return ChartDrawing((), key)
        parts = [each.part for each in taken]
        if any(after <= before for before, after in pairwise(parts)):
            # The count was reset or a part was measured twice, so readings are numbered in sequence.
            parts = list(range(1, len(taken) + 1))
        try:
            pair = make_charts([each.value for each in taken], row.sample)
        except QualityError:
            return ChartDrawing((), key)
        names = (tr("INDIVIDUALS"), tr("MOVING RANGE")) if row.sample == 1 else (tr("AVERAGE"), tr("RANGE"))
        titled = (f"{row.name}  {names[0]}", names[1])
        limits, unit_mm = make_measured_feature(row).limits, self.control_length_unit.unit_length_mm
        return ChartDrawing(make_control_plots(pair, parts, limits, titled, unit_mm), key)

    def prompt_text(self) -> str:
        """Return the prompt that explains the lines in the chart, or the reason why no chart is available."""
        return self.find_unmet_precondition() or (
            "ARROWS: SELECT FEATURE. DASHED: CONTROL LIMITS, DOTTED: TOLERANCE, CIRCLED: RULE VIOLATIONS"
        )


def _tone(drift: str) -> StatusTone:
    return StatusTone.PAUSE if drift else StatusTone.READY

"""Section of MEASURED PARTS for readings and the resulting wear correction.

Readings are typed or received from a gauge.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.extras.quality.parts_data import make_measured_feature, write_readings_csv
from app.extras.quality.section import (
    ChartDrawing,
    QualitySection,
    convert_entry_to_mm,
    format_deviation,
    format_size,
    get_diameter_symbol,
)
from app.extras.quality.serial_gauge import Gauge, GaugeReading, NoGauge
from app.extras.quality.wear_correction import (
    CorrectionPreview,
    make_correction_proposal,
    make_offset_correction,
)
from app.offsets.offset_changes import ConfirmedOffsetChanges, OffsetHistory, find_change_refusal
from app.production.parts_watch import ProductionMonitor
from core.access.access_table import ProtectedChange
from core.executor.snapshot import Snapshot
from core.extras.quality.control_charts import QualityError
from core.message import Message
from core.store.production import measured_parts
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.store_rows import OffsetKind

CHART_HEIGHT_RATIO = 0.45  # ratio of the height for the chart of a proposed correction
OUTLIER_TOLERANCES = 3.0  # tolerances of deviation above which a typing error or another part is likely
MM_PER_UNIT = {"mm": 1.0, "in": 25.4}


@dataclass(frozen=True, slots=True)
class NewReading:
    """Reading that has not been stored yet."""

    feature: FeatureRow
    part_number: int
    size_mm: float  # in mm
    measured_unit: str
    source_name: str
    gauge_name: str = ""


class ReadingsSection(QualitySection):
    """Section for entering readings, with one row per feature.

    A typed size belongs to the selected feature and the current part.
    """

    name = "READINGS"
    use = "measure a part and see the correction needed"

    def __init__(
        self, desk: Desk, parts_watch: ProductionMonitor, csv_folder: Path, gauge: Gauge | None = None
    ) -> None:
        super().__init__(desk, parts_watch)
        self.csv_folder = csv_folder
        self.gauge = gauge or NoGauge()
        self._part = 0  # 0 means the last part that was made
        self.correction_effect = CorrectionPreview(desk)
        # table, number and reason of the last accepted correction
        self._last: tuple[OffsetKind, int, str] | None = None

    @property
    def row_count(self) -> int:
        """Return the number of features."""
        return len(self.parts_data.features)

    @property
    def part_number(self) -> int:
        """Return the number of the part that is being measured."""
        return self._part or max(1, self.desk.program_runs.part_counter.part_count)

    # --- display -------------------------------------------------------------------------------------

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table with nominal size, last reading, deviation and rating of each feature.

        While a correction is proposed, the table shows the effect of the correction instead.
        """
        self.limit_selection()
        mode, feature = self.control_length_unit, self.selected_feature
        self.chart_share = CHART_HEIGHT_RATIO if self.correction_effect.is_question_open else 0.0
        made = self.correction_effect.make_table(mode) if self.correction_effect.is_question_open else None
        if made is not None:
            return made
        rows = tuple(self._row(each) for each in self.parts_data.features)
        question = ""
        if feature is not None:
            question = tr(
                Message("MEASURED {name} OF PART {part}?", name=feature.name, part=self.part_number)
            )
        heads = ("FEATURE", Message("NOMINAL {mode}", mode=mode.name), "PART", "MEASURED", "DEVIATION", "")
        words = self.correction_effect.describe_status() if self.correction_effect.is_question_open else ""
        correction_hint = (
            ("Enter the deviation in DL and DR of the tool table (F8 of the main menu).")
            if self.is_mill
            else "F8 proposes a correction, F4 undoes the last correction."
        )
        notes = (words or self._gauge_words(), correction_hint)
        title = (
            Message("READINGS  ·  {program}", program=self.program_name) if self.program_name else "READINGS"
        )
        return TableContent(
            title,
            heads,
            (0.2, 0.19, 0.08, 0.19, 0.16, 0.18),
            rows,
            self.marked,
            question,
            self.entry.text,
            notes,
            untranslated_columns=frozenset({0}),
            numeric_columns=frozenset({2}),
        )

    def _row(self, row: FeatureRow) -> TableRow:
        mode, feature, taken = (
            self.control_length_unit,
            make_measured_feature(row),
            self.parts_data.select_readings(row.id),
        )
        nominal = get_diameter_symbol(row) + format_size(row.nominal, mode)
        if not taken:
            return TableRow((row.name, nominal, "", "", "", tr("NOT MEASURED YET")), False, StatusTone.OFF)
        last = taken[-1]
        good = feature.good(last.value)
        off = format_deviation(last.value - feature.middle, mode)
        words = tr("GOOD") if good else tr("TOO SMALL") if last.value < feature.middle else tr("TOO LARGE")
        cells = (
            row.name,
            nominal,
            str(last.part),
            get_diameter_symbol(row) + format_size(last.value, mode),
            off,
            words,
        )
        return TableRow(cells, good, StatusTone.RUN if good else StatusTone.ALARM)

    def _gauge_words(self) -> str:
        return self.gauge.status_text

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys for the part number, the gauge, the CSV file and the correction."""
        correct = {
            "F8": FunctionKey("CORRECT", self.propose_correction),
            "F4": FunctionKey("UNDO", self.undo_correction),
        }
        return {
            "F2": FunctionKey(tr("PART −"), partial(self._step, -1)),
            "F3": FunctionKey(tr("PART +"), partial(self._step, 1)),
            "F9": FunctionKey("REMOVE", self.remove_last_reading),
            "F5": FunctionKey("GAUGE OFF" if self.gauge.is_receiving else "GAUGE ON", self.toggle_gauge),
            "F6": FunctionKey("CSV", self.write_csv_file),
            **({} if self.is_mill else correct),
        }

    def _step(self, by: int) -> None:
        self.desk.clear_prompt_line()
        self._part = max(1, self.part_number + by)
        if self._part == self.desk.program_runs.part_counter.part_count:
            self._part = 0

    def prompt_text(self) -> str:
        """Return the prompt for entering a reading, or the reason why no reading can be entered."""
        return self.find_unmet_precondition() or ("TYPE THE MEASURED SIZE AND PRESS ENTER. ESC: BACK TO LIST")

    def make_chart(self) -> ChartDrawing:
        """Return the chart of a proposed correction."""
        return (
            self.correction_effect.make_chart(self.control_length_unit)
            if self.correction_effect.is_question_open
            else ChartDrawing()
        )

    # --- readings ------------------------------------------------------------------------------------

    def accept_entry(self, text: str) -> bool:
        """Store the typed size of the selected feature, and return whether the size was accepted.

        Raises InvalidEntryError if the text is not a valid size.
        """
        feature = self.selected_feature
        if feature is None:
            self.desk.say(self.find_unmet_precondition())
            return False
        mode = self.control_length_unit
        value = convert_entry_to_mm(evaluate_expression(text), mode)
        return self._offer(NewReading(feature, self.part_number, value, mode.name, "typed"))

    def _offer(self, reading: NewReading) -> bool:
        """Store a reading. If its size is implausible, ask the operator to confirm the reading first.

        Raises InvalidEntryError if the size is 0 or less.
        """
        row, feature = reading.feature, make_measured_feature(reading.feature)
        if reading.size_mm <= 0.0:
            raise InvalidEntryError(
                Message("{row} must be more than 0; type the measured size, not the deviation", row=row.name)
            )
        if abs(reading.size_mm - feature.middle) > OUTLIER_TOLERANCES * feature.width:
            asked = tr("{name} {size} FAR OUT OF TOLERANCE. Y: SAVE   N: MEASURE AGAIN")
            shown = format_size(reading.size_mm, self.control_length_unit)
            self.desk.ask_operator(
                tr(Message(asked, name=row.name, size=shown)), partial(self._keep, reading)
            )
            return True
        self.desk.clear_prompt_line()
        self._keep(reading)
        return True

    def _keep(self, taken: NewReading) -> None:
        row = ReadingRow(
            0,
            taken.feature.id,
            taken.part_number,
            taken.size_mm,
            taken.measured_unit,
            "",
            taken.source_name,
            taken.gauge_name,
        )
        self.watch.production_records.write_change(
            ProtectedChange.READINGS,
            lambda c: measured_parts.add_reading(c, row),
            partial(self._on_reading_saved, taken),
            self.watch.report_refusal,
            Message(
                "program {program}, part {part}: {feature} measured as {taken} mm",
                feature=taken.feature.name,
                part=taken.part_number,
                program=self.parts_data.program_name,
                taken=f"{taken.size_mm:g}",
            ),
        )

    def _on_reading_saved(self, reading: NewReading) -> None:
        """Report the stored reading and select the next feature."""
        text = tr("{name}, PART {part}: {size} SAVED")
        self.desk.say(
            tr(
                Message(
                    text,
                    name=reading.feature.name,
                    part=reading.part_number,
                    size=format_size(reading.size_mm, self.control_length_unit),
                )
            )
        )
        if self.selected_feature is not None and self.selected_feature.id == reading.feature.id:
            self.marked = (self.marked + 1) % max(1, self.row_count)

    def remove_last_reading(self) -> None:
        """Ask for confirmation, and then remove the latest reading of the selected feature (F9)."""
        feature = self.selected_feature
        taken = self.parts_data.select_readings(feature.id) if feature is not None else ()
        if feature is None or not taken:
            self.desk.say(self.find_unmet_precondition() or tr("FEATURE NOT MEASURED YET"))
            return
        last = taken[-1]
        asked = tr("PRESS Y TO REMOVE READING {size} FROM PART {part}, N TO KEEP IT")
        done = partial(self.desk.say, tr("READING REMOVED"))
        self.desk.ask_operator(
            tr(Message(asked, size=format_size(last.value, self.control_length_unit), part=last.part)),
            lambda: self.watch.production_records.write_change(
                ProtectedChange.READINGS,
                lambda c: measured_parts.void_reading(c, last.id),
                done,
                self.watch.report_refusal,
                Message(
                    "program {program}, part {part}: reading of {feature} ({last} mm) removed",
                    feature=feature.name,
                    part=last.part,
                    program=self.parts_data.program_name,
                    last=f"{last.value:g}",
                ),
            ),
        )

    # --- gauge ---------------------------------------------------------------------------------------

    def toggle_gauge(self) -> None:
        """Start or stop receiving readings from the gauge (F5)."""
        self.desk.clear_prompt_line()
        why = self.gauge.toggle_receiving()
        if why:
            self.desk.say(why)

    def process_device_input(self, *, is_displayed: bool) -> None:
        """Store received gauge readings for the selected feature if the section is displayed.

        This method is called once per frame.
        """
        for found in self.gauge.fetch_readings():
            if isinstance(found, GaugeReading) and not is_displayed:
                self.desk.say(tr("GAUGE READING IGNORED. OPEN READINGS, THEN MEASURE AGAIN"))
            elif isinstance(found, GaugeReading):
                self._measured(found)
            else:
                self.desk.say(found)

    def _measured(self, found: GaugeReading) -> None:
        feature = self.selected_feature
        if feature is None:
            self.desk.say(self.find_unmet_precondition())
            return
        unit = found.unit or self.gauge.default_unit
        try:
            self._offer(
                NewReading(
                    feature, self.part_number, found.value * MM_PER_UNIT[unit], unit, "gauge", self.gauge.name
                )
            )
        except InvalidEntryError as error:
            self.desk.show_refusal(str(error))

    def close(self) -> None:
        """Stop receiving readings from the gauge."""
        self.gauge.close()

    # --- correction ----------------------------------------------------------------------------------

    def propose_correction(self) -> None:
        """Propose a wear correction from the readings of the selected feature (F8).

        The operator applies the proposed correction with Y.
        """
        feature = self.selected_feature
        if feature is None:
            self.desk.say(self.find_unmet_precondition())
            return
        if not self._settled():
            return
        try:
            found = make_correction_proposal(self.parts_data, feature, self.control_length_unit)
            if found.reason:
                mean = format_size(found.mean_size_mm, self.control_length_unit)
                self.desk.say(f"{feature.name} {mean}: {tr(found.reason)}")
                return
            change = make_offset_correction(found, self.desk, self.control_length_unit)
        except (QualityError, InvalidEntryError) as error:
            self.desk.show_refusal(str(error))
            return
        asked = tr(Message("{words}. Y: APPLY   N: DO NOT APPLY", words=change.correction_text))
        self.desk.ask_operator(asked, partial(self._correct, feature))
        taken = tuple((each.part, each.value) for each in self.parts_data.select_readings(feature.id))
        self.correction_effect.show_proposal(self.desk.prompt_notice, found, change, taken)

    def _settled(self) -> bool:
        """Return whether all data are stored and loaded, and show a message if they are not.

        This check prevents a second proposal while an earlier correction is still being stored.
        """
        settled = self.watch.production_records.is_up_to_date and not self.desk.offset_book.is_saving
        if not settled:
            self.desk.say(tr("STILL READING STORED DATA. PRESS F8 AGAIN"))
        return settled

    def _correct(self, feature: FeatureRow) -> None:
        """Recalculate the correction from the current data, and apply it."""
        if not self._settled():
            return
        try:
            change = make_offset_correction(
                make_correction_proposal(self.parts_data, feature, self.control_length_unit),
                self.desk,
                self.control_length_unit,
            )
        except (QualityError, InvalidEntryError) as error:
            self.desk.show_refusal(str(error))
            return
        why = self.desk.offset_book.change_fields(
            change.offset_kind, change.offset_number, change.new_values, change.reason
        )
        if why:
            self.desk.say(why)
            return
        self._last = change.offset_kind, change.offset_number, change.reason
        self.desk.show_success(tr(Message("{words}; APPLIES FROM NEXT PART", words=change.correction_text)))

    def undo_correction(self) -> None:
        """Undo the last correction after confirmation (F4).

        This is possible only if the correction is the latest change of the offset table.
        """
        why = self._undo_barred()
        if not why and self._last is not None:
            kind, number, _reason = self._last
            questions = ConfirmedOffsetChanges(OffsetHistory(self.desk, kind, self.control_length_unit))
            why = questions.ask_to_undo_change(kind, number, tr("CORRECTION UNDONE"))
        if why:
            self.desk.say(why)

    def _undo_barred(self) -> str:
        """Return the reason why the last correction cannot be undone now, or an empty string if it can."""
        if self._last is None:
            return tr("NO CORRECTION APPLIED ON THIS PAGE. HISTORY: MAIN MENU, F8/F9")
        kind, _number, reason = self._last
        last = self.desk.offset_book.read_history(kind, 1)
        if not last or last[0].why != reason:
            return tr("CANNOT UNDO: A LATER CHANGE EXISTS. HISTORY: MAIN MENU, F8/F9")
        return find_change_refusal(self.desk.read_snapshot(), is_correction=True)

    # --- file ----------------------------------------------------------------------------------------

    def write_csv_file(self) -> None:
        """Write the readings of the program to a CSV file on a worker (F6)."""
        if self.find_unmet_precondition():
            self.desk.say(self.find_unmet_precondition())
            return
        data, folder = self.parts_data, self.csv_folder
        self.watch.production_records.worker.enqueue_work(
            lambda: write_readings_csv(data, folder), self._written, self.watch.report_refusal
        )

    def _written(self, path: Path) -> None:
        self.desk.show_success(tr(Message("SAVED: {path}", path=path)))

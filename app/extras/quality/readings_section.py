"""Readings of parts, typed or from a gauge, and the resulting wear correction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from app.desk.arithmetic import EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.extras.quality.gauge_wire import Gauge, NoGauge, Reading
from app.extras.quality.parts_data import feature_of, write_readings
from app.extras.quality.section import ChartDrawing, QualitySection, mark_of, signed_size, size, typed_length
from app.extras.quality.wear_correction import CorrectionEffect, correction, proposal
from app.offsets.offset_changes import OffsetHistory, OffsetQuestions, refusal
from app.production.parts_watch import PartsWatch
from core.access.access_table import Act
from core.executor.snapshot import Snapshot
from core.extras.quality.control_charts import QualityError
from core.message import Message
from core.store.production import measured_parts
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.store_rows import Kind

CHART = 0.45  # ratio of the height for the chart of a proposed correction
FAR = 3.0  # tolerances of deviation above which a typing error or another part is likely
MM = {"mm": 1.0, "in": 25.4}


@dataclass(frozen=True, slots=True)
class NewReading:
    """Reading that is to be stored."""

    feature: FeatureRow
    part: int
    value: float  # in mm
    unit: str
    source: str
    gauge: str = ""


class ReadingsSection(QualitySection):
    """Section with one row per feature.

    The typed size belongs to the selected feature and the present part.
    """

    name = "READINGS"
    use = "measure a part and see the correction needed"

    def __init__(self, desk: Desk, watch: PartsWatch, folder: Path, gauge: Gauge | None = None) -> None:
        super().__init__(desk, watch)
        self.folder = folder
        self.gauge = gauge or NoGauge()
        self._part = 0  # 0 means the last part that was made
        self.effect = CorrectionEffect(desk)
        # table, number and reason of the last accepted correction
        self._last: tuple[Kind, int, str] | None = None

    @property
    def count(self) -> int:
        """Number of features."""
        return len(self.data.features)

    @property
    def part(self) -> int:
        """Number of the measured part."""
        return self._part or max(1, self.desk.runs.counter.count)

    # --- display -------------------------------------------------------------------------------------

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table with nominal size, last reading, deviation and rating per feature."""
        self.settle()
        mode, feature = self.mode, self.feature
        self.chart_share = CHART if self.effect.stands else 0.0
        made = self.effect.sheet(mode) if self.effect.stands else None
        if made is not None:
            return made
        rows = tuple(self._row(each) for each in self.data.features)
        question = ""
        if feature is not None:
            question = tr(Message("MEASURED {name} OF PART {part}?", name=feature.name, part=self.part))
        heads = ("FEATURE", Message("NOMINAL {mode}", mode=mode.name), "PART", "MEASURED", "DEVIATION", "")
        words = self.effect.words() if self.effect.stands else ""
        way = (
            ("Enter the deviation in DL and DR of the tool table (F8 of the main menu).")
            if self.of_mill
            else "F8 proposes a correction, F4 undoes the last correction."
        )
        notes = (words or self._gauge_words(), way)
        title = Message("READINGS  ·  {program}", program=self.program) if self.program else "READINGS"
        return Sheet(title, heads, (0.2, 0.19, 0.08, 0.19, 0.16, 0.18), rows, self.marked, question,
                     self.entry.text, notes, raw=frozenset({0}), figures=frozenset({2}))  # fmt: skip

    def _row(self, row: FeatureRow) -> Row:
        mode, feature, taken = self.mode, feature_of(row), self.data.readings_of(row.id)
        nominal = mark_of(row) + size(row.nominal, mode)
        if not taken:
            return Row((row.name, nominal, "", "", "", tr("NOT MEASURED YET")), False, Tone.OFF)
        last = taken[-1]
        good = feature.good(last.value)
        off = signed_size(last.value - feature.middle, mode)
        words = tr("GOOD") if good else tr("TOO SMALL") if last.value < feature.middle else tr("TOO LARGE")
        cells = (row.name, nominal, str(last.part), mark_of(row) + size(last.value, mode), off, words)
        return Row(cells, good, Tone.RUN if good else Tone.ALARM)

    def _gauge_words(self) -> str:
        return self.gauge.words

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys for the part number, gauge, file and correction."""
        correct = {"F8": Key("CORRECT", self.propose), "F4": Key("UNDO", self.undo)}
        return {
            "F2": Key(tr("PART −"), partial(self._step, -1)),
            "F3": Key(tr("PART +"), partial(self._step, 1)),
            "F9": Key("REMOVE", self.take_out),
            "F5": Key("GAUGE OFF" if self.gauge.open else "GAUGE ON", self.turn_gauge),
            "F6": Key("CSV", self.write_file),
            **({} if self.of_mill else correct),
        }

    def _step(self, by: int) -> None:
        self.desk.clear()
        self._part = max(1, self.part + by)
        if self._part == self.desk.runs.counter.count:
            self._part = 0

    def prompt(self) -> str:
        """Return the prompt for the entry of a reading."""
        return self.missing() or ("TYPE THE MEASURED SIZE AND PRESS ENTER. ESC: BACK TO LIST")

    def drawing(self) -> ChartDrawing:
        """Return the chart of a proposed correction."""
        return self.effect.drawing(self.mode) if self.effect.stands else ChartDrawing()

    # --- readings ------------------------------------------------------------------------------------

    def take(self, text: str) -> bool:
        """Store a typed size of the selected feature. Raises EntryError."""
        feature = self.feature
        if feature is None:
            self.desk.say(self.missing())
            return False
        mode = self.mode
        value = typed_length(value_of(text), mode)
        return self._offer(NewReading(feature, self.part, value, mode.name, "typed"))

    def _offer(self, taken: NewReading) -> bool:
        """Store a reading.

        An implausible size requires confirmation. Raises EntryError for a size of 0 or less.
        """
        row, feature = taken.feature, feature_of(taken.feature)
        if taken.value <= 0.0:
            raise EntryError(
                Message("{row} must be more than 0; type the measured size, not the deviation", row=row.name)
            )
        if abs(taken.value - feature.middle) > FAR * feature.width:
            asked = tr("{name} {size} FAR OUT OF TOLERANCE. Y: SAVE   N: MEASURE AGAIN")
            shown = size(taken.value, self.mode)
            self.desk.ask(tr(Message(asked, name=row.name, size=shown)), partial(self._keep, taken))
            return True
        self.desk.clear()
        self._keep(taken)
        return True

    def _keep(self, taken: NewReading) -> None:
        row = ReadingRow(
            0, taken.feature.id, taken.part, taken.value, taken.unit, "", taken.source, taken.gauge
        )
        self.watch.book.write(
            Act.READINGS,
            lambda c: measured_parts.add_reading(c, row),
            partial(self._kept, taken),
            self.watch.refuse,
            Message(
                "program {program}, part {part}: {feature} measured as {taken} mm",
                feature=taken.feature.name,
                part=taken.part,
                program=self.data.program,
                taken=f"{taken.value:g}",
            ),
        )

    def _kept(self, taken: NewReading) -> None:
        """Report the stored reading and select the next feature."""
        text = tr("{name}, PART {part}: {size} SAVED")
        self.desk.say(
            tr(Message(text, name=taken.feature.name, part=taken.part, size=size(taken.value, self.mode)))
        )
        if self.feature is not None and self.feature.id == taken.feature.id:
            self.marked = (self.marked + 1) % max(1, self.count)

    def take_out(self) -> None:
        """Remove the latest reading of the selected feature after confirmation (F9)."""
        feature = self.feature
        taken = self.data.readings_of(feature.id) if feature is not None else ()
        if feature is None or not taken:
            self.desk.say(self.missing() or tr("FEATURE NOT MEASURED YET"))
            return
        last = taken[-1]
        asked = tr("PRESS Y TO REMOVE READING {size} FROM PART {part}, N TO KEEP IT")
        done = partial(self.desk.say, tr("READING REMOVED"))
        self.desk.ask(
            tr(Message(asked, size=size(last.value, self.mode), part=last.part)),
            lambda: self.watch.book.write(
                Act.READINGS,
                lambda c: measured_parts.void_reading(c, last.id),
                done,
                self.watch.refuse,
                Message(
                    "program {program}, part {part}: reading of {feature} ({last} mm) removed",
                    feature=feature.name,
                    part=last.part,
                    program=self.data.program,
                    last=f"{last.value:g}",
                ),
            ),
        )

    # --- gauge ---------------------------------------------------------------------------------------

    def turn_gauge(self) -> None:
        """Start or stop receiving readings from the gauge (F5)."""
        self.desk.clear()
        why = self.gauge.turn()
        if why:
            self.desk.say(why)

    def listen(self, *, seen: bool) -> None:
        """Assign received gauge readings to the selected feature while the section is visible.

        Called once per frame.
        """
        for found in self.gauge.received():
            if isinstance(found, Reading) and not seen:
                self.desk.say(tr("GAUGE READING IGNORED. OPEN READINGS, THEN MEASURE AGAIN"))
            elif isinstance(found, Reading):
                self._measured(found)
            else:
                self.desk.say(found)

    def _measured(self, found: Reading) -> None:
        feature = self.feature
        if feature is None:
            self.desk.say(self.missing())
            return
        unit = found.unit or self.gauge.unit
        try:
            self._offer(
                NewReading(feature, self.part, found.value * MM[unit], unit, "gauge", self.gauge.name)
            )
        except EntryError as error:
            self.desk.refuse(str(error))

    def close(self) -> None:
        """Close the gauge."""
        self.gauge.close()

    # --- correction ----------------------------------------------------------------------------------

    def propose(self) -> None:
        """Propose a correction from the readings of the selected feature (F8).

        Y applies the correction.
        """
        feature = self.feature
        if feature is None:
            self.desk.say(self.missing())
            return
        if not self._settled():
            return
        try:
            found = proposal(self.data, feature, self.mode)
            if found.why:
                mean = size(found.mean, self.mode)
                self.desk.say(f"{feature.name} {mean}: {tr(found.why)}")
                return
            change = correction(found, self.desk, self.mode)
        except (QualityError, EntryError) as error:
            self.desk.refuse(str(error))
            return
        asked = tr(Message("{words}. Y: APPLY   N: DO NOT APPLY", words=change.words))
        self.desk.ask(asked, partial(self._correct, feature))
        taken = tuple((each.part, each.value) for each in self.data.readings_of(feature.id))
        self.effect.show(self.desk.notice, found, change, taken)

    def _settled(self) -> bool:
        """Return whether all data is stored and loaded.

        This prevents a second proposal of a pending correction.
        """
        settled = self.watch.book.settled and not self.desk.book.busy
        if not settled:
            self.desk.say(tr("STILL READING STORED DATA. PRESS F8 AGAIN"))
        return settled

    def _correct(self, feature: FeatureRow) -> None:
        """Apply the correction, calculated again from the present data."""
        if not self._settled():
            return
        try:
            change = correction(proposal(self.data, feature, self.mode), self.desk, self.mode)
        except (QualityError, EntryError) as error:
            self.desk.refuse(str(error))
            return
        why = self.desk.book.change(change.kind, change.number, change.values, change.why)
        if why:
            self.desk.say(why)
            return
        self._last = change.kind, change.number, change.why
        self.desk.done(tr(Message("{words}; APPLIES FROM NEXT PART", words=change.words)))

    def undo(self) -> None:
        """Ask whether to undo the last correction (F4), if no later change exists."""
        why = self._undo_barred()
        if not why and self._last is not None:
            kind, number, _reason = self._last
            questions = OffsetQuestions(OffsetHistory(self.desk, kind, self.mode))
            why = questions.undo(kind, number, tr("CORRECTION UNDONE"))
        if why:
            self.desk.say(why)

    def _undo_barred(self) -> str:
        """Return the reason why the last correction cannot be undone, or an empty string."""
        if self._last is None:
            return tr("NO CORRECTION APPLIED ON THIS PAGE. HISTORY: MAIN MENU, F8/F9")
        kind, _number, reason = self._last
        last = self.desk.book.history(kind, 1)
        if not last or last[0].why != reason:
            return tr("CANNOT UNDO: A LATER CHANGE EXISTS. HISTORY: MAIN MENU, F8/F9")
        return refusal(self.desk.snapshot(), correction=True)

    # --- file ----------------------------------------------------------------------------------------

    def write_file(self) -> None:
        """Write the readings of the program as a CSV file on a worker (F6)."""
        if self.missing():
            self.desk.say(self.missing())
            return
        data, folder = self.data, self.folder
        self.watch.book.worker.queue(lambda: write_readings(data, folder), self._written, self.watch.refuse)

    def _written(self, path: Path) -> None:
        self.desk.done(tr(Message("SAVED: {path}", path=path)))

"""Calculation, preview and application of the wear correction that is proposed for a feature."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from app.desk.arithmetic import InvalidEntryError
from app.desk.desk import Desk
from app.desk.pages.table_content import TableContent
from app.desk.status.formats import format_fixed
from app.desk.translation import tr
from app.extras.quality.parts_data import PartsData, make_measured_feature
from app.extras.quality.section import ChartDrawing, format_deviation, format_size, make_correction_plot
from app.offsets.active_offsets import make_secondary_offsets, make_tool_offsets
from app.offsets.offset_changes import find_change_refusal
from app.offsets.offset_effect import OffsetEffectWorker, OffsetTables
from app.offsets.offset_values import (
    UnitMode,
    add_correction,
    describe_range_error,
    format_signed_length,
    parse_field_increment,
)
from app.offsets.part_effect import make_part_table
from core.extras.quality.control_charts import QualityError
from core.extras.quality.measured_feature import CorrectingOffset, CorrectionProposal, propose_correction
from core.message import Message
from core.store.production.measured_parts import FeatureRow
from core.store.store_rows import FIELDS_BY_KIND, FieldValue, OffsetKind, SecondaryOffsetRow, ToolOffsetRow

CORRECTION_STEP_MM = {
    True: 0.001,
    False: 0.0001 * 25.4,
}  # rounding of a correction in mm, for metric and inch


def make_correction_proposal(data: PartsData, row: FeatureRow, value_mode: UnitMode) -> CorrectionProposal:
    """Return the correction that follows from the readings since the last correction.

    Raises QualityError if no correction can be calculated from these readings.
    """
    feature = make_measured_feature(row)
    sizes = [each.value for each in data.select_readings_since_correction(row)]
    if not sizes and data.select_readings(row.id):
        name = feature.corrected_by
        raise QualityError(
            Message(
                "{row}: none of the parts started since the last change of {name} has been measured yet",
                row=row.name,
                name=name,
            )
        )
    return propose_correction(feature, sizes, CORRECTION_STEP_MM[value_mode.is_metric])


@dataclass(frozen=True, slots=True)
class OffsetCorrection:
    """Change of one value in the offset table, with the new value and the operator message."""

    offset_kind: OffsetKind
    offset_number: int
    new_values: dict[str, FieldValue]
    reason: str  # reason for the history
    correction_text: str  # for example ``T3 WEAR X −.0006: SPIGOT .5012 → .5006``


def make_offset_correction(
    proposal: CorrectionProposal, desk: Desk, value_mode: UnitMode
) -> OffsetCorrection:
    """Return the proposed correction as a change of the offset table.

    Raises InvalidEntryError with the reason if the change is not possible, for example if the offset table is
    locked or the tool has no offsets.
    """
    feature, book = proposal.feature, desk.offset_book
    why_not = book.lock_reason or find_change_refusal(desk.read_snapshot(), is_correction=True)
    if why_not:
        raise InvalidEntryError(why_not)
    kind = OffsetKind.TOOL if feature.by is CorrectingOffset.TOOL else OffsetKind.SECONDARY
    change = format_signed_length(proposal.change_mm, value_mode.is_metric)
    why = tr(
        Message(
            "{name} measured: the mean of {count} readings is {mean}, offset change {change}",
            name=feature.name,
            mean=format_size(proposal.mean_size_mm, value_mode),
            count=proposal.reading_count,
            change=change,
        )
    )
    name = f"wear_{feature.axis}" if kind is OffsetKind.TOOL else feature.axis
    row = book.get_rows(kind).get(feature.number)
    value = (
        _tool_value(name, row, proposal, value_mode, feature.number)
        if kind is OffsetKind.TOOL
        else _secondary_value(name, row, proposal, value_mode)
    )
    words = tr(
        Message(
            "{offset} {change}: {feature} {old} → {new}",
            offset=feature.corrected_by,
            change=change,
            feature=feature.name,
            old=format_size(proposal.mean_size_mm, value_mode),
            new=format_size(proposal.expected_size_mm, value_mode),
        )
    )
    return OffsetCorrection(kind, feature.number, {name: value}, why, words)


def _tool_value(
    name: str, row: object, proposal: CorrectionProposal, mode: UnitMode, number: int
) -> FieldValue:
    """Return the new wear offset of a tool.

    The correction is added to the wear offset, as F2 does in the tool table.
    """
    if not isinstance(row, ToolOffsetRow):
        raise InvalidEntryError(tr(Message("NO OFFSETS SET FOR T{number}", number=number)))
    return parse_field_increment(name, row, format_fixed(proposal.change_mm / mode.unit_length_mm, 10), mode)


def _secondary_value(name: str, row: object, proposal: CorrectionProposal, mode: UnitMode) -> FieldValue:
    """Return the new value of a D offset, with X as a radius.

    If the offset has no value yet, its old value is assumed to be 0.
    """
    before = row if isinstance(row, SecondaryOffsetRow) else SecondaryOffsetRow()
    value = add_correction(
        getattr(before, name), proposal.offset_change_mm / mode.unit_length_mm, mode.is_metric
    )
    field = FIELDS_BY_KIND[OffsetKind.SECONDARY][name]
    if not field.is_valid_value(value):
        shown, low, high = (
            format_signed_length(value, mode.is_metric),
            field.minimum / mode.unit_length_mm,
            field.maximum / mode.unit_length_mm,
        )
        raise InvalidEntryError(describe_range_error(field.label, shown, mode.name, low, high))
    return value


CHART_READING_COUNT = 25  # number of latest readings in the chart


@dataclass(slots=True)
class CorrectionPreview:
    """Preview of a proposed correction, shown while the operator is asked to confirm it.

    The worker of the offset pages simulates the part with the old and the new offsets.
    """

    desk: Desk
    question: str = ""
    proposal: CorrectionProposal | None = None
    _readings: tuple[tuple[int, float], ...] = ()  # part number and size in mm
    _drawn: tuple[object, ChartDrawing] = field(default=(None, ChartDrawing()))

    @property
    def is_question_open(self) -> bool:
        """Return whether the prompt line still shows the question about the correction."""
        return bool(self.question) and self.desk.prompt_notice == self.question

    def show_proposal(
        self,
        question: str,
        proposal: CorrectionProposal,
        change: OffsetCorrection,
        readings: tuple[tuple[int, float], ...],
    ) -> None:
        """Show a proposed correction, and start simulating the part before and after the correction."""
        again = (question, proposal, readings) == (self.question, self.proposal, self._readings)
        self.question, self.proposal, self._readings = question, proposal, readings
        effect, job = self._effect, self.desk.program_loader.loaded_program.job
        if effect is not None and effect.compare_part is not None and job is not None and not again:
            effect.request_part(effect.compare_part, job, *self._tables(change))

    @property
    def _effect(self) -> OffsetEffectWorker | None:
        return self.desk.page_registry.find_model(OffsetEffectWorker)

    def _tables(self, change: OffsetCorrection) -> tuple[OffsetTables, OffsetTables]:
        book = self.desk.offset_book
        tools: dict[int, ToolOffsetRow] = dict(book.tool_offsets)
        secondary: dict[int, SecondaryOffsetRow] = dict(book.secondary_offsets)
        before = OffsetTables(make_tool_offsets(tools), make_secondary_offsets(secondary))
        values: Mapping[str, Any] = change.new_values
        if change.offset_kind is OffsetKind.TOOL:
            tools[change.offset_number] = tools[change.offset_number]._replace(**values)
        else:
            secondary[change.offset_number] = secondary.get(
                change.offset_number, SecondaryOffsetRow()
            )._replace(**values)
        return before, OffsetTables(make_tool_offsets(tools), make_secondary_offsets(secondary))

    def make_table(self, value_mode: UnitMode) -> TableContent | None:
        """Return the table of diameters and shoulders before and after the correction.

        Returns None if no simulation result is available.
        """
        effect = self._effect
        if effect is None or effect.is_busy or effect.error_text or effect.compared_part is None:
            return None
        return make_part_table(effect.compared_part, value_mode)

    def describe_status(self) -> str:
        """Return the status of the simulation as display text."""
        effect = self._effect
        if (
            effect is None
            or effect.compare_part is None
            or self.desk.program_loader.loaded_program.job is None
        ):
            return ""
        if effect.is_busy:
            return tr("SIMULATING THE PART WITH OLD AND NEW OFFSETS")
        return (
            tr(Message("PARTS WITH OLD AND NEW OFFSETS CANNOT BE COMPARED: {why}", why=effect.error_text))
            if effect.error_text
            else ""
        )

    def make_chart(self, value_mode: UnitMode) -> ChartDrawing:
        """Return the chart of the readings, their mean, and the expected size of the next parts."""
        found = self.proposal
        if found is None or not self._readings:
            return ChartDrawing()
        of = (self.question, self._readings, value_mode)
        if self._drawn[0] != of:
            change = format_deviation(found.expected_size_mm - found.mean_size_mm, value_mode)
            title = tr(Message("{name}: {change} FROM NEXT PART", name=found.feature.name, change=change))
            newest = self._readings[-CHART_READING_COUNT:]
            plot = make_correction_plot(
                newest, found, title, (tr("NOW"), tr("AFTER")), value_mode.unit_length_mm
            )
            self._drawn = of, ChartDrawing((plot,), of)
        return self._drawn[1]

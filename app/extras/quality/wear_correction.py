"""Proposed wear correction of a feature: its effect on the part, and its application."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from app.desk.arithmetic import EntryError
from app.desk.desk import Desk
from app.desk.pages.sheet import Sheet
from app.desk.status.formats import fixed
from app.desk.translation import tr
from app.extras.quality.parts_data import PartsData, feature_of
from app.extras.quality.section import ChartDrawing, correction_plot, signed_size, size
from app.offsets.offset_changes import refusal
from app.offsets.offset_effect import Effect, Tables
from app.offsets.offset_values import Mode, added, out_of_range, signed, value_added
from app.offsets.offsets_in_force import secondary_offsets, tool_offsets
from app.offsets.part_effect import part_table
from core.extras.quality.control_charts import QualityError
from core.extras.quality.measured_feature import CorrectedBy, Proposal, propose
from core.message import Message
from core.store.production.measured_parts import FeatureRow
from core.store.store_rows import FIELDS, Kind, SecondaryRow, ToolRow, Value

RESOLUTION = {True: 0.001, False: 0.0001 * 25.4}  # rounding of a correction in mm, for metric and inch


def proposal(data: PartsData, row: FeatureRow, mode: Mode) -> Proposal:
    """Return the correction that the readings since the last correction require.

    Raises QualityError.
    """
    feature = feature_of(row)
    sizes = [each.value for each in data.since_correction(row)]
    if not sizes and data.readings_of(row.id):
        name = feature.corrected_by
        raise QualityError(
            Message(
                "{row}: none of the parts started since the last change of {name} has been measured yet",
                row=row.name,
                name=name,
            )
        )
    return propose(feature, sizes, RESOLUTION[mode.metric])


@dataclass(frozen=True, slots=True)
class Correction:
    """Change of one field of one offset, with the values to store and the text for the operator."""

    kind: Kind
    number: int
    values: dict[str, Value]
    why: str  # reason for the history
    words: str  # for example ``T3 WEAR X −.0006: SPIGOT .5012 → .5006``


def correction(found: Proposal, desk: Desk, mode: Mode) -> Correction:
    """Return the proposal as a change of the offset table. Raises EntryError with the obstacle."""
    feature, book = found.feature, desk.book
    why_not = book.locked or refusal(desk.snapshot(), correction=True)
    if why_not:
        raise EntryError(why_not)
    kind = Kind.TOOL if feature.by is CorrectedBy.TOOL else Kind.SECONDARY
    change = signed(found.change, mode.metric)
    why = tr(
        Message(
            "{name} measured: the mean of {count} readings is {mean}, offset change {change}",
            name=feature.name,
            mean=size(found.mean, mode),
            count=found.count,
            change=change,
        )
    )
    name = f"wear_{feature.axis}" if kind is Kind.TOOL else feature.axis
    row = book.of(kind).get(feature.number)
    value = _tool_value(name, row, found, mode, feature.number) if kind is Kind.TOOL else _secondary_value(
        name, row, found, mode
    )  # fmt: skip
    words = tr(
        Message(
            "{offset} {change}: {feature} {old} → {new}",
            offset=feature.corrected_by,
            change=change,
            feature=feature.name,
            old=size(found.mean, mode),
            new=size(found.expected, mode),
        )
    )
    return Correction(kind, feature.number, {name: value}, why, words)


def _tool_value(name: str, row: object, found: Proposal, mode: Mode, number: int) -> Value:
    """Return the new wear value, added as F2 of the tool table adds an entry."""
    if not isinstance(row, ToolRow):
        raise EntryError(tr(Message("NO OFFSETS SET FOR T{number}", number=number)))
    return value_added(name, row, fixed(found.change / mode.unit, 10), mode)


def _secondary_value(name: str, row: object, found: Proposal, mode: Mode) -> Value:
    """Return the new value of a D offset (X as a radius).

    An offset that is not set counts as 0.
    """
    before = row if isinstance(row, SecondaryRow) else SecondaryRow()
    value = added(getattr(before, name), found.offset_change / mode.unit, mode.metric)
    field = FIELDS[Kind.SECONDARY][name]
    if not field.takes(value):
        shown, low, high = signed(value, mode.metric), field.low / mode.unit, field.high / mode.unit
        raise EntryError(out_of_range(field.word, shown, mode.name, low, high))
    return value


SHOWN = 25  # number of latest readings in the chart


@dataclass(slots=True)
class CorrectionEffect:
    """Display of a proposed correction while its question is open.

    The worker of the offset pages simulates the part with the old and new offsets.
    """

    desk: Desk
    question: str = ""
    found: Proposal | None = None
    _readings: tuple[tuple[int, float], ...] = ()  # part number and size in mm
    _drawn: tuple[object, ChartDrawing] = field(default=(None, ChartDrawing()))

    @property
    def stands(self) -> bool:
        """Whether the question of the correction is still on the prompt line."""
        return bool(self.question) and self.desk.notice == self.question

    def show(
        self, question: str, found: Proposal, change: Correction, readings: tuple[tuple[int, float], ...]
    ) -> None:
        """Show a proposal, and let the worker simulate the part before and after the correction."""
        again = (question, found, readings) == (self.question, self.found, self._readings)
        self.question, self.found, self._readings = question, found, readings
        effect, job = self._effect, self.desk.session.now.job
        if effect is not None and effect.compare is not None and job is not None and not again:
            effect.ask_part(effect.compare, job, *self._tables(change))

    @property
    def _effect(self) -> Effect | None:
        return self.desk.pages.find(Effect)

    def _tables(self, change: Correction) -> tuple[Tables, Tables]:
        book = self.desk.book
        tools: dict[int, ToolRow] = dict(book.tools)
        secondary: dict[int, SecondaryRow] = dict(book.secondary)
        before = Tables(tool_offsets(tools), secondary_offsets(secondary))
        values: Mapping[str, Any] = change.values
        if change.kind is Kind.TOOL:
            tools[change.number] = tools[change.number]._replace(**values)
        else:
            secondary[change.number] = secondary.get(change.number, SecondaryRow())._replace(**values)
        return before, Tables(tool_offsets(tools), secondary_offsets(secondary))

    def sheet(self, mode: Mode) -> Sheet | None:
        """Return the table of diameters and shoulders before and after, or None without a simulated part."""
        effect = self._effect
        if effect is None or effect.busy or effect.trouble or effect.part is None:
            return None
        return part_table(effect.part, mode)

    def words(self) -> str:
        """Return the status of the simulation as text."""
        effect = self._effect
        if effect is None or effect.compare is None or self.desk.session.now.job is None:
            return ""
        if effect.busy:
            return tr("SIMULATING THE PART WITH OLD AND NEW OFFSETS")
        return (
            tr(Message("PARTS WITH OLD AND NEW OFFSETS CANNOT BE COMPARED: {why}", why=effect.trouble))
            if effect.trouble
            else ""
        )

    def drawing(self, mode: Mode) -> ChartDrawing:
        """Return the chart of the readings, their mean and the expected size of the next parts."""
        found = self.found
        if found is None or not self._readings:
            return ChartDrawing()
        of = (self.question, self._readings, mode)
        if self._drawn[0] != of:
            change = signed_size(found.expected - found.mean, mode)
            title = tr(Message("{name}: {change} FROM NEXT PART", name=found.feature.name, change=change))
            newest = self._readings[-SHOWN:]
            plot = correction_plot(newest, found, title, (tr("NOW"), tr("AFTER")), mode.unit)
            self._drawn = of, ChartDrawing((plot,), of)
        return self._drawn[1]

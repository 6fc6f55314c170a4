"""The proposed wear correction of a feature, taken over as a typed one: history, range, the next part."""

from __future__ import annotations

from dataclasses import dataclass

from app.desk.arithmetic import EntryError
from app.desk.desk import Desk
from app.desk.status.formats import fixed
from app.desk.translation import tr
from app.extras.quality.parts_data import PartsData, feature_of
from app.extras.quality.section import size
from app.offsets.offset_history import refusal
from app.offsets.offset_values import Mode, added, out_of_range, signed, value_added
from core.extras.quality.measured_feature import CorrectedBy
from core.extras.quality.quality_errors import QualityError
from core.extras.quality.wear_proposal import Proposal, propose
from core.message import Message
from core.store.production.measured_parts import FeatureRow
from core.store.store_rows import FIELDS, Kind, SecondaryRow, ToolRow, Value

RESOLUTION = {True: 0.001, False: 0.0001 * 25.4}  # mm: what a correction is rounded to, metric and inch


def proposal(data: PartsData, row: FeatureRow, mode: Mode) -> Proposal:
    """What the readings since the last correction ask for. Raises QualityError."""
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
    """A change of one field of one offset: what to save and what the operator reads of it."""

    kind: Kind
    number: int
    values: dict[str, Value]
    why: str  # for the history
    words: str  # ``T3 WEAR X −.0006: SPIGOT .5012 → .5006``


def correction(found: Proposal, desk: Desk, mode: Mode) -> Correction:
    """The proposal as an entry of the table of offsets. Raises EntryError with what is in the way."""
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
    """As F2 of the tool table adds what is typed."""
    if not isinstance(row, ToolRow):
        raise EntryError(tr(Message("NO OFFSETS SET FOR T{number}", number=number)))
    return value_added(name, row, fixed(found.change / mode.unit, 10), mode)


def _secondary_value(name: str, row: object, found: Proposal, mode: Mode) -> Value:
    """A D offset is a radius in X; one that was never set is 0."""
    before = row if isinstance(row, SecondaryRow) else SecondaryRow()
    value = added(getattr(before, name), found.offset_change / mode.unit, mode.metric)
    field = FIELDS[Kind.SECONDARY][name]
    if not field.takes(value):
        shown, low, high = signed(value, mode.metric), field.low / mode.unit, field.high / mode.unit
        raise EntryError(out_of_range(field.word, shown, mode.name, low, high))
    return value

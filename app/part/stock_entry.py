"""Entry of a program's stock and stick-out, with conversion from and to the text in the store."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path

from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.status.formats import MM_PER_INCH, format_length
from app.desk.stored_part import StoredPart
from core.part.stock_spec import StockError, StockSpec, parse_stock_specification

_DECIMALS = 6


class StockKind(StrEnum):
    """The kinds of stock.

    ``UNSPECIFIED`` means that no stock is specified.
    """

    UNSPECIFIED = "none"
    BAR = "bar"
    TUBE = "tube"
    PROFILE = "profile"
    PREVIOUS_PART = "after"


class StockField(StrEnum):
    """The entry fields of a stock.

    All fields except kind and file are lengths.
    """

    KIND = "kind"
    DIAMETER = "diameter"
    BORE = "bore"
    LENGTH = "length"
    FILE = "file"
    ALLOWANCE = "allowance"
    STICK_OUT = "stick_out"


_ROUND_FIELDS = (StockField.DIAMETER, StockField.LENGTH, StockField.ALLOWANCE)
_FILE_FIELDS = (StockField.FILE, StockField.ALLOWANCE)
_FIELDS = {
    StockKind.UNSPECIFIED: (),
    StockKind.BAR: _ROUND_FIELDS,
    StockKind.TUBE: (StockField.DIAMETER, StockField.BORE, StockField.LENGTH, StockField.ALLOWANCE),
    StockKind.PROFILE: _FILE_FIELDS,
    StockKind.PREVIOUS_PART: _FILE_FIELDS,
}
_KINDS = {
    StockKind.UNSPECIFIED: "",
    StockKind.BAR: "BAR",
    StockKind.TUBE: "TUBE",
    StockKind.PROFILE: "PROFILE",
    StockKind.PREVIOUS_PART: "PART FROM ANOTHER PROGRAM",
}
_STICK_LIMITS_MM = (0.0, 40.0 * MM_PER_INCH)


@dataclass(frozen=True, slots=True)
class StockEntry:
    """Stock entry with lengths in mm.

    A length of 0 means not specified. ``file`` is the file of a profile or of the preceding program.
    """

    kind: StockKind = StockKind.UNSPECIFIED
    diameter: float = 0.0
    bore: float = 0.0
    length: float = 0.0
    allowance: float = 0.0
    file: str = ""
    stick_out: float = 0.0

    @classmethod
    def from_stored_part(cls, stored: StoredPart) -> StockEntry:
        """Return the entry for the stored data.

        If the stock text is invalid, only the stick-out is used.
        """
        out = stored.stick_out_mm or 0.0
        try:
            spec = parse_stock_specification(stored.stock_text) if stored.stock_text else StockSpec("")
        except StockError:
            return cls(stick_out=out)
        kind = StockKind(stored.stock_text.partition(":")[0]) if stored.stock_text else StockKind.UNSPECIFIED
        file = spec.profile or spec.after
        return cls(kind, spec.diameter, spec.bore, spec.length, spec.allowance, file, out)

    @property
    def fields(self) -> tuple[StockField, ...]:
        """Return the fields that apply to this kind of stock."""
        return (StockField.KIND, *_FIELDS[self.kind], StockField.STICK_OUT)

    def format_field(self, field: StockField, is_metric: bool) -> str:
        """Return the text of a field, or an empty string if the field is not specified."""
        if field is StockField.FILE:
            return Path(self.file).name
        if field is StockField.KIND:
            return _KINDS[self.kind]
        value = float(getattr(self, field))
        return format_length(value, is_metric) if value else ""

    def typed(self, field: StockField, text: str, is_metric: bool) -> StockEntry:
        """Return a copy of the entry in which one length is replaced by a typed length.

        The typed length is in mm if ``is_metric`` is True, and otherwise in inches. Raise InvalidEntryError
        if the length is not valid for the field.
        """
        value = evaluate_expression(text) * (1.0 if is_metric else MM_PER_INCH)
        if value < 0.0:
            raise InvalidEntryError("a stock length cannot be negative; enter 0 to clear the length")
        low, high = _STICK_LIMITS_MM
        if field is StockField.STICK_OUT and not low <= value <= high:
            raise InvalidEntryError("the stick-out must be more than 0 and at most 40 in")
        changed = replace(self, **{field.value: round(value, _DECIMALS)})  # type: ignore[arg-type]
        if changed.kind is StockKind.TUBE and changed.diameter and changed.bore >= changed.diameter:
            raise InvalidEntryError("the bore of a tube must be smaller than its diameter")
        return changed

    @property
    def missing_field(self) -> StockField | None:
        """Return the first required field without a value, or None if no value is missing."""
        wanted = {
            StockKind.BAR: (StockField.DIAMETER,),
            StockKind.TUBE: (StockField.DIAMETER, StockField.BORE),
            StockKind.PROFILE: (StockField.FILE,),
            StockKind.PREVIOUS_PART: (StockField.FILE,),
        }.get(self.kind, ())
        return next((name for name in wanted if not getattr(self, name)), None)

    @property
    def words(self) -> str:
        """Return the stock in the syntax of the command-line option ``--stock``.

        Return an empty string if no stock is specified. Raise StockError if the values do not describe a
        valid stock.
        """
        if self.kind is StockKind.UNSPECIFIED:
            return ""
        if self.kind in {StockKind.PROFILE, StockKind.PREVIOUS_PART}:
            sizes = [self.file]
        else:
            round_ones = [self.diameter, *([self.bore] if self.kind is StockKind.TUBE else [])]
            sizes = [_format_length(each) for each in (*round_ones, *([self.length] if self.length else []))]
        allowance = f"+{_format_length(self.allowance)}" if self.allowance else ""
        text = f"{self.kind}:{':'.join(sizes)}{allowance}"
        parse_stock_specification(text)
        return text


def _format_length(mm: float) -> str:
    """Return a length as text.

    The text is in inches or in mm, whichever is shorter.
    """
    inches, metric = (f"{value:.6f}".rstrip("0").rstrip(".") for value in (mm / MM_PER_INCH, mm))
    exact = abs(float(inches) * MM_PER_INCH - mm) < 1e-6
    return inches if exact and len(inches) <= len(metric) + 2 else f"{metric}mm"

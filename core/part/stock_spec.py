"""Stock specifications that a user enters, such as ``bar:1.0+.02`` or ``tube:25mm:10mm``.

A specification can also refer to a profile file, such as ``profile:FILE.csv``. Lengths are in inches, or in
millimeters if followed by ``mm``. The face of the stock is at Z0 plus the allowance after ``+``.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

from core.input_file import convert_exceptions
from core.message import CodedError, Message
from core.part.stock import Point, Stock
from core.part.stock_forms import SPECIFICATION_FORMS

_INCH = 25.4
_LENGTH = re.compile(r"(\d+\.?\d*|\.\d+)(mm|in)?", re.IGNORECASE)
_MAX_SIZE_MM = 1000.0  # mm
_EXTRA_LENGTH_MM = 10.0  # mm of stock past the last cut if no length is specified


class StockError(CodedError, ValueError):
    """Error raised for an invalid stock specification, with a complete sentence as its message."""


@dataclass(frozen=True, slots=True)
class StockSpec:
    """A stock specification, in mm.

    If ``length`` is 0, the stock is as long as the program needs. ``profile`` is the path of a profile
    file, and ``after`` is the program that machined the stock before. Both are empty strings for a bar or a
    tube.
    """

    given: str
    diameter: float = 0.0
    bore: float = 0.0
    length: float = 0.0
    allowance: float = 0.0
    profile: str = ""
    after: str = ""
    points: str = ""  # text of the profile file, in the unit of the program

    def stock(self, back_z_mm: float, unit_mm: float) -> Stock:
        """Return the bar, tube or profile that is specified.

        ``back_z_mm`` is the least Z of all cuts, in mm. ``unit_mm`` is the length unit of the program, in
        mm. Raises StockError if the text of a profile is invalid.
        """
        if self.points:
            return parse_stock_profile(self.given, self.points, unit_mm, self.allowance)
        front = self.allowance
        ends = front - self.length if self.length else min(back_z_mm, front) - _EXTRA_LENGTH_MM, front
        hole = tuple((z, self.bore / 2) for z in ends) if self.bore else ()
        return Stock(self.given, tuple((z, self.diameter / 2) for z in ends), hole)


def parse_stock_specification(text: str) -> StockSpec:
    """Return the parsed specification.

    Raises StockError for an invalid specification. The message contains the fault and the permitted forms
    or values.
    """
    kind, _, rest = text.strip().partition(":")
    if kind in {"profile", "after"}:
        if not rest:
            raise StockError(
                Message("{text} has no file name; write {kind}:FILE", text=f"{text!r}", kind=kind), "no-file"
            )
        name, allowance = _split_allowance(rest)
        return StockSpec(text, allowance=allowance, **{kind: name})  # type: ignore[arg-type]
    if kind not in {"bar", "tube"}:
        raise StockError(
            Message(
                "{text} is not a stock specification; use one of these forms: {forms}",
                text=f"{text!r}",
                forms=SPECIFICATION_FORMS,
            ),
            "unknown-form",
        )
    sizes, plus, extra = rest.partition("+")
    allowance = _parse_length(extra, text) if plus else 0.0
    lengths = [_parse_length(each, text) for each in sizes.split(":")]
    return _round_stock(text, kind, lengths, allowance)


def _round_stock(text: str, kind: str, lengths: list[float], allowance: float) -> StockSpec:
    diameters = 1 if kind == "bar" else 2
    if not diameters <= len(lengths) <= diameters + 1:
        raise StockError(
            Message(
                "{text} has {lengths_count} dimensions; use one of these forms: {forms}",
                text=f"{text!r}",
                lengths_count=len(lengths),
                forms=SPECIFICATION_FORMS,
            ),
            "size-count",
        )
    diameter, bore = lengths[0], lengths[1] if kind == "tube" else 0.0
    if not 0.0 < diameter <= _MAX_SIZE_MM:
        raise StockError(
            Message(
                "{text}: a diameter must be more than 0 and at most {largest} in",
                text=f"{text!r}",
                largest=f"{_MAX_SIZE_MM / _INCH:.0f}",
            ),
            "diameter",
        )
    if kind == "tube" and not 0.0 < bore < diameter:
        raise StockError(
            Message(
                "{text}: the bore of a tube must be more than 0 and less than its diameter",
                text=f"{text!r}",
            ),
            "bore",
        )
    length = lengths[diameters] if len(lengths) > diameters else 0.0
    if len(lengths) > diameters and not 0.0 < length <= 10.0 * _MAX_SIZE_MM:
        raise StockError(Message("{text}: a length must be more than 0", text=f"{text!r}"), "length")
    return StockSpec(text, diameter, bore, length, allowance)


def _split_allowance(rest: str) -> tuple[str, float]:
    """Return the file name and the allowance.

    A file name may contain a plus sign, so only a plus sign before a length at the end starts an allowance.
    """
    name, plus, extra = rest.rpartition("+")
    if plus and _LENGTH.fullmatch(extra.strip()):
        return name, _parse_length(extra, rest)
    return rest, 0.0


def _parse_length(text: str, whole: str) -> float:
    """Return the length in mm that a string specifies.

    Raises StockError if the string is not a length.
    """
    found = _LENGTH.fullmatch(text.strip())
    if found is None:
        raise StockError(
            Message(
                "{whole}: {text} is not a length; write 1.25 (inches) or 30mm",
                whole=f"{whole!r}",
                text=f"{text!r}",
            ),
            "not-a-length",
        )
    return float(found[1]) * (1.0 if (found[2] or "").lower() == "mm" else _INCH)


def parse_stock_profile(specification: str, text: str, unit_mm: float, allowance: float) -> Stock:
    """Return the stock that is specified by CSV points.

    The columns are Z, r and optionally the radius of the bore, in units of ``unit_mm`` mm. Raises StockError
    if the text is not valid.
    """
    rows = _parse_rows(text)
    if len(rows) < 2:
        raise StockError("a profile needs at least two points, with z, r in each row", "too-few-points")
    if len({len(row) for row in rows}) > 1:
        raise StockError(
            "all rows of a profile must have the same columns, either z, r or z, r, bore", "rows-differ"
        )
    if rows[0][0] > rows[-1][0]:
        rows.reverse()
    if any(a[0] > b[0] for a, b in pairwise(rows)):
        raise StockError("the points of a profile must run in one direction along Z", "turns-back")
    if any(row[1] < 0.0 for row in rows) or any(len(row) > 2 and not 0.0 <= row[2] <= row[1] for row in rows):
        raise StockError(
            "profile radii cannot be negative, and the bore radius cannot be larger than the outside radius",
            "radius",
        )
    outside: tuple[Point, ...] = tuple((row[0] * unit_mm + allowance, row[1] * unit_mm) for row in rows)
    bore: tuple[Point, ...] = tuple(
        (row[0] * unit_mm + allowance, row[2] * unit_mm) for row in rows if len(row) > 2
    )
    return Stock(specification, outside, bore)


def _parse_rows(text: str) -> list[list[float]]:
    """Return the numbers of each row, without the header and the comments that begin with #."""
    import csv

    with convert_exceptions(
        lambda _error: StockError("the profile is damaged; it must be CSV text with columns z, r", "damaged")
    ):
        return _numbered_rows(csv.reader(io.StringIO(text)))


def _numbered_rows(rows: Iterable[list[str]]) -> list[list[float]]:
    return [
        _numbers(row, number)
        for number, row in enumerate(rows, start=1)
        if row and not row[0].lstrip().startswith("#") and (number > 1 or _LENGTH.search(row[0]))
    ]


def _numbers(row: list[str], number: int) -> list[float]:
    try:
        values = [float(each) for each in row]
    except ValueError:
        values = [math.nan]
    if not all(map(math.isfinite, values)):
        shown = " ".join(",".join(row).split())[:80]
        raise StockError(
            Message(
                "row {number} of the profile must contain only numbers: {value}", number=number, value=shown
            ),
            "not-numbers",
        )
    if max(map(abs, values)) > 10.0 * _MAX_SIZE_MM:
        raise StockError(
            Message(
                "row {number} of the profile has a value that is too large; check the unit", number=number
            ),
            "too-far-out",
        )
    if not 2 <= len(values) <= 3:
        raise StockError(
            Message(
                "row {number} of the profile has {values_count} numbers; write either z, r or "
                "z, r, bore in each row",
                number=number,
                values_count=len(values),
            ),
            "number-count",
        )
    return values

"""Effect of an offset change on the part, with the old and new size of each diameter and shoulder."""

from __future__ import annotations

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.status.formats import format_length
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.offsets.offset_values import UnitMode, format_signed_length
from core.language.diagnostics import Diagnostic
from core.message import Message, join_messages
from core.proving.offset_comparison import (
    FEATURE_TOLERANCE_MM,
    FeatureKind,
    OffsetComparisonResult,
    Pair,
    PartFeature,
)

_NO_VALUE = "–"


def make_part_table(part: OffsetComparisonResult, value_mode: UnitMode) -> TableContent:
    """Return a table of the diameters, bores and shoulders of the part, starting at the face.

    The table also lists the findings that the offset change adds or removes. A lamp marks each feature that
    changes, or that exists only in the old or the new part.
    """
    unit = tr("MM") if value_mode.is_metric else tr("INCH")
    return TableContent(
        join_messages("  ·  ", (tr("EFFECT ON THE PART"), unit)),
        ("FEATURE", "BEFORE", "AFTER", "DIFFERENCE"),
        (0.4, 0.2, 0.2, 0.2),
        tuple(_row(each, value_mode) for each in part.feature_pairs),
        notes=tuple(_note(each, gone=gone) for gone, each in _findings(part))[:3],
        numeric_columns=frozenset({1, 2, 3}),
    )


def _findings(part: OffsetComparisonResult) -> list[tuple[bool, Diagnostic]]:
    return [
        *((False, each) for each in part.new_findings),
        *((True, each) for each in part.resolved_findings),
    ]


def _note(found: Diagnostic, *, gone: bool) -> str:
    if gone:
        return tr(
            Message("LINE {line}: FINDING {check} NO LONGER REPORTED", line=found.line, check=found.code)
        )
    return tr(Message("LINE {line}: {what}", line=found.line, what=tr(found.text)))


def _row(pair: Pair, mode: UnitMode) -> TableRow:
    one = pair.this_feature or pair.other_feature
    assert one is not None
    change = pair.difference_mm
    same = change is not None and abs(change) <= FEATURE_TOLERANCE_MM
    difference_text = _NO_VALUE if same else tr("ONLY IN THE OLD OR THE NEW PART")
    if change is not None and not same:
        difference_text = format_signed_length(change, mode.is_metric)
    cells = (
        _name_feature(one, mode),
        _figure(pair.this_feature, mode),
        _figure(pair.other_feature, mode),
        difference_text,
    )
    return TableRow(cells, is_lamp_lit=not same, tone=StatusTone.OFF if same else StatusTone.PAUSE)


def _figure(feature: PartFeature | None, mode: UnitMode) -> str:
    return _NO_VALUE if feature is None else format_length(feature.at, mode.is_metric)


def _name_feature(feature: PartFeature, mode: UnitMode) -> str:
    """Return the name of a feature, for example ``DIAMETER Z 0 … -.5``.

    The name of a shoulder contains its two diameters.
    """
    a, b = feature.extent_mm
    if feature.kind in {FeatureKind.DIAMETER, FeatureKind.BORE}:
        word = tr("DIAMETER") if feature.kind is FeatureKind.DIAMETER else tr("BORE")
        return f"{word}  Z {_format_short(a, mode)} … {_format_short(b, mode)}"
    word = tr("SHOULDER") if feature.kind is FeatureKind.SHOULDER else tr("BORE SHOULDER")
    return f"{word}  Ø {_format_short(2 * a, mode)} … {_format_short(2 * b, mode)}"


def _format_short(mm: float, mode: UnitMode) -> str:
    """Return a length in mm as text, rounded to .001 in or 0.01 mm."""
    text = f"{mm:.2f}" if mode.is_metric else f"{mm / 25.4:.3f}"
    return "0" if not text.strip("-0.") else text

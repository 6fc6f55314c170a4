"""Effect of a change of offsets on the part: each diameter and shoulder before and after."""

from __future__ import annotations

from app.desk.pages.sheet import Row, Sheet
from app.desk.status.formats import length
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.offsets.offset_values import Mode, signed
from core.language.diagnostics import Diagnostic
from core.message import Message, join_messages
from core.proving.other_offsets import SAME, Feature, FeatureKind, OtherPart, Pair

_NONE = "–"


def part_table(part: OtherPart, mode: Mode) -> Sheet:
    """Return a table of the part features, from the face on, with the findings that appear or disappear.

    A lamp marks features that change.
    """
    unit = tr("MM") if mode.metric else tr("INCH")
    return Sheet(
        join_messages("  ·  ", (tr("EFFECT ON THE PART"), unit)),
        ("FEATURE", "BEFORE", "AFTER", "DIFFERENCE"),
        (0.4, 0.2, 0.2, 0.2),
        tuple(_row(each, mode) for each in part.pairs),
        notes=tuple(_note(each, gone=gone) for gone, each in _findings(part))[:3],
        figures=frozenset({1, 2, 3}),
    )


def _findings(part: OtherPart) -> list[tuple[bool, Diagnostic]]:
    return [*((False, each) for each in part.added), *((True, each) for each in part.gone)]


def _note(found: Diagnostic, *, gone: bool) -> str:
    if gone:
        return tr(
            Message("LINE {line}: FINDING {check} NO LONGER REPORTED", line=found.line, check=found.code)
        )
    return tr(Message("LINE {line}: {what}", line=found.line, what=tr(found.text)))


def _row(pair: Pair, mode: Mode) -> Row:
    one = pair.here or pair.there
    assert one is not None
    change = pair.difference
    same = change is not None and abs(change) <= SAME
    told = _NONE if same else tr("ONLY IN THE OLD OR THE NEW PART")
    if change is not None and not same:
        told = signed(change, mode.metric)
    cells = (_name(one, mode), _figure(pair.here, mode), _figure(pair.there, mode), told)
    return Row(cells, lit=not same, tone=Tone.OFF if same else Tone.PAUSE)


def _figure(feature: Feature | None, mode: Mode) -> str:
    return _NONE if feature is None else length(feature.at, mode.metric)


def _name(feature: Feature, mode: Mode) -> str:
    """Return the name of a feature, for example ``DIAMETER Z 0 … -.5``. A shoulder has its two diameters."""
    a, b = feature.reach
    if feature.kind in {FeatureKind.DIAMETER, FeatureKind.BORE}:
        word = tr("DIAMETER") if feature.kind is FeatureKind.DIAMETER else tr("BORE")
        return f"{word}  Z {_short(a, mode)} … {_short(b, mode)}"
    word = tr("SHOULDER") if feature.kind is FeatureKind.SHOULDER else tr("BORE SHOULDER")
    return f"{word}  Ø {_short(2 * a, mode)} … {_short(2 * b, mode)}"


def _short(mm: float, mode: Mode) -> str:
    """Return a length in mm as text, rounded to .001 in or 0.01 mm."""
    text = f"{mm:.2f}" if mode.metric else f"{mm / 25.4:.3f}"
    return "0" if not text.strip("-0.") else text

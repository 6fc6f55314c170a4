"""Shift report as a self-contained HTML page that prints on A4 and Letter."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from html import escape

from app.desk.status.formats import duration, fixed, local_time
from app.desk.translation import spoken, tr
from app.extras.quality.parts_data import feature_of
from app.extras.quality.shift_figures import ProgramFigures, ShiftFigures, stamp
from app.offsets.offset_values import signed
from app.production.tool_life_watch import life_of
from app.report.html_tables import PAGE_END, figure, page_head, pairs, table, verdict
from core.message import Message
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.store_rows import Change, Kind, SecondaryRow, ToolRow

_WIDE, _HIGH = 900, 64  # size of the time line
_MOST = 500  # maximum number of table rows
_MM_PER_INCH = 25.4
_LETTER = {Kind.TOOL: "T", Kind.SECONDARY: "D", Kind.ZERO: "G", Kind.SHAPE: "T", Kind.MILL_TOOL: "T"}


def title_of(found: ShiftFigures, machine: str) -> str:
    """Return the title with start and end in local time."""
    first, last = (datetime.fromtimestamp(each).strftime("%Y-%m-%d %H:%M") for each in found.shift)
    of = f"{machine}: " if machine else ""
    return of + tr(Message("shift from {first} to {last}", first=first, last=last))


def shift_html(found: ShiftFigures, machine: str, made: str, *, metric: bool) -> str:
    """Return the HTML page of the shift report.

    Lengths are in mm if ``metric`` is set and otherwise in inches, with X of tools as a diameter.
    """
    body = "".join(
        f"<h2>{escape(head)}</h2>{text}" if head else text for head, text in _sections(found, metric=metric)
    )
    return page_head(title_of(found, machine), made, spoken()) + body + PAGE_END


def facts(found: ShiftFigures) -> list[tuple[str, str]]:
    """Return the main results: parts, availability, stops, alarms and readings."""
    rows = [(tr("Parts"), str(found.parts))]
    share = found.availability
    if share is not None:
        words = tr(
            Message(
                "{share} %: in cycle for {run} of {planned}",
                share=fixed(100.0 * share.share, 1),
                run=duration(share.producing),
                planned=duration(share.planned),
            )
        )
        rows += [
            (tr("Availability"), words),
            (tr("Stops"), f"{len(found.stops)}, {duration(found.stopped)}"),
            (tr("Not recorded"), duration(found.untold)),
        ]
    rows.append((tr("Alarms and E-stops"), str(len(found.alarms))))
    words = tr(Message("{bad} of {count} readings", bad=len(found.bad), count=found.measured))
    rows.append((tr("Out of tolerance"), words))
    return rows


def _sections(found: ShiftFigures, *, metric: bool) -> Iterator[tuple[str, str]]:
    yield "", "".join(verdict("doubt", note) for note in found.notes)
    yield "", pairs(facts(found)) + figure(_time_line(found), tr("green: cycles; amber: stops; red: alarms"))
    yield (
        tr("Parts by program"),
        _table(
            (
                tr("PROGRAM"),
                tr("PARTS"),
                tr("CYCLES WITHOUT A PART"),
                tr("SHORTEST"),
                tr("MEAN"),
                tr("LONGEST"),
            ),
            [_program(each) for each in found.programs],
        ),
    )
    yield (
        tr("Stops by reason"),
        _table(
            (tr("REASON"), tr("OCCURRENCES"), tr("TIME"), tr("SHARE")),
            [
                (tr(r.reason), str(r.times), duration(r.seconds), f"{fixed(100 * r.share, 0)} %")
                for r in found.stood
            ],
        ),
    )
    yield (
        tr("All stops"),
        _table(
            (tr("START TIME"), tr("TIME"), tr("REASON"), tr("PROGRAM"), tr("LINE")),
            [
                (local_time(r.at), duration(r.seconds), tr(r.reason), r.program, str(r.line or ""))
                for r in found.stops
            ],
        ),
    )
    yield (
        tr("Alarms and E-stops"),
        _table(
            (tr("TIME"), tr("DESCRIPTION"), tr("LINE")),
            [(local_time(row.at), row.text, str(row.line or "")) for row in found.alarms],
        ),
    )
    yield tr("Tool life used so far"), _lives(found)
    yield (
        tr("Offsets changed"),
        _table(
            (tr("TIME"), tr("OFFSET"), tr("BEFORE"), tr("AFTER"), tr("REASON"), tr("WHO")),
            [_change(each, metric=metric) for each in found.offsets],
        ),
    )
    yield (
        tr("Out of tolerance"),
        _table(
            (tr("TIME"), tr("PROGRAM"), tr("PART"), tr("FEATURE"), tr("SIZE"), tr("LIMITS")),
            [_reading(*each, metric=metric) for each in found.bad],
        ),
    )


def _table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    if not rows:
        return f"<p>{escape(tr('none'))}</p>"
    more = tr(Message("and {count} more", count=len(rows) - _MOST)) if len(rows) > _MOST else ""
    return table(heads, [tuple(map(escape, row)) for row in rows[:_MOST]]) + (f"<p>{escape(more)}</p>")


def _program(row: ProgramFigures) -> tuple[str, ...]:
    none = ", ".join(f"{count} × {tr(how)}" for how, count in row.others)
    if not row.times:
        return row.program, str(row.parts), none, "", "", ""
    times = (min(row.times), sum(row.times) / len(row.times), max(row.times))
    return (row.program, str(row.parts), none, *(f"{fixed(each, 1)} s" for each in times))


def _lives(found: ShiftFigures) -> str:
    now = _table(
        (tr("TOOL"), tr("USED"), tr("LIFE USED")),
        [
            (f"T{row.number}", life_of(row).words, f"{fixed(100 * life_of(row).share, 0)} %")
            for row in found.lives
        ],
    )
    changed = _table(
        (tr("TIME"), tr("TOOL"), tr("USAGE"), tr("REASON")),
        [
            (
                local_time(r.at),
                f"T{r.number}",
                tr(Message("{parts} parts, {time}", parts=r.parts, time=duration(r.seconds))),
                r.why,
            )
            for r in found.inserts
        ],
    )
    return f"{now}<h3>{escape(tr('Inserts changed in this shift'))}</h3>{changed}"


def _change(row: Change, *, metric: bool) -> tuple[str, ...]:
    name = f"{_LETTER.get(row.kind, row.kind.value)}{row.number}"
    name = f"{name}, {tr('SHAPE')}" if row.kind is Kind.SHAPE else name
    sides = tuple(_side(each, metric=metric) for each in (row.old, row.new))
    return (local_time(row.at), name, *sides, row.why, row.who)


def _side(row: object, *, metric: bool) -> str:
    """Return the values of an offset row as text."""
    if row is None:
        return tr("not set")
    if isinstance(row, ToolRow):
        own = (2 * row.x, row.z, row.nose_radius, 2 * row.wear_x, row.wear_z)
        x, z, radius, wear_x, wear_z = (signed(each, metric) for each in own)
        return f"X {x} Z {z} R {radius}, {tr('wear')} X {wear_x} Z {wear_z}"
    if isinstance(row, SecondaryRow):
        return f"X {signed(row.x, metric)} Z {signed(row.z, metric)} R {signed(row.r, metric)}"
    return ", ".join(f"{key} {value:g}" if isinstance(value, float) else f"{key} {value}"
                     for key, value in getattr(row, "_asdict", dict)().items() if value)  # fmt: skip


def _reading(feature: FeatureRow, row: ReadingRow, *, metric: bool) -> tuple[str, ...]:
    low, high = feature_of(feature).limits
    return (
        local_time(row.at),
        feature.program,
        str(row.part),
        feature.name,
        _size(row.value, metric=metric),
        f"{_size(low, metric=metric)} … {_size(high, metric=metric)}",
    )


def _size(mm: float, *, metric: bool) -> str:
    return Message("{unit} mm", unit=fixed(mm, 3)) if metric else f"{fixed(mm / _MM_PER_INCH, 5)} {tr('in')}"


def _time_line(found: ShiftFigures) -> str:
    """Return the time line as SVG: cycles, stops and alarms, with the hours below."""
    start, length = found.shift.start, found.shift.end - found.shift.start

    def x(moment: float) -> float:
        return _WIDE * min(1.0, max(0.0, (moment - start) / length))

    def bar(first: float, last: float, colour: str, y: int, high: int, least: float = 0.6) -> str:
        wide = max(least, x(last) - x(first))
        return f'<rect x="{x(first):.1f}" y="{y}" width="{wide:.1f}" height="{high}" fill="{colour}"/>'

    parts = [bar(start, found.until, "#e3e7eb", 6, 34)]
    for stop in found.stops:
        at = stamp(stop.at)
        parts.append(bar(at, at + stop.seconds, "#f0b23c", 6, 34))
    parts += [bar(span.start, span.end, "#2e7d32", 6, 34) for span in found.running]
    parts += [bar(stamp(row.at), stamp(row.at), "#b3261e", 2, 42, 2.0) for row in found.alarms]
    hours = max(1, round(length / 3600 / 12))
    moment = start
    while moment <= found.shift.end:
        text = datetime.fromtimestamp(moment).strftime("%H:%M")
        parts.append(f'<text x="{min(x(moment), _WIDE - 34):.0f}" y="58" font-size="12">{text}</text>')
        moment += hours * 3600
    return f'<svg viewBox="0 0 {_WIDE} {_HIGH}" width="{_WIDE}" height="{_HIGH}">{"".join(parts)}</svg>'

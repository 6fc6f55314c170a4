"""Shift report as a self-contained HTML page that can be printed on A4 and Letter paper."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from html import escape

from app.desk.status.formats import format_duration, format_fixed, format_local_time
from app.desk.translation import get_language, tr
from app.extras.quality.parts_data import make_measured_feature
from app.extras.quality.shift_results import ProgramResults, ShiftResults, parse_store_time
from app.offsets.offset_values import format_signed_length
from app.production.tool_life_watch import make_tool_life
from app.report.html_tables import (
    HTML_END,
    make_drawing_block,
    make_name_value_table,
    make_page_head,
    make_result_line,
    make_table,
)
from core.message import Message
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.store_rows import OffsetChange, OffsetKind, SecondaryOffsetRow, ToolOffsetRow

_WIDE, _HIGH = 900, 64  # size of the time line
_MOST = 500  # maximum number of table rows
_MM_PER_INCH = 25.4
_LETTER = {
    OffsetKind.TOOL: "T",
    OffsetKind.SECONDARY: "D",
    OffsetKind.ZERO: "G",
    OffsetKind.SHAPE: "T",
    OffsetKind.MILL_TOOL: "T",
}


def make_title(results: ShiftResults, machine_name: str) -> str:
    """Return the title of the report with the start and end of the shift in local time."""
    first, last = (datetime.fromtimestamp(each).strftime("%Y-%m-%d %H:%M") for each in results.shift)
    of = f"{machine_name}: " if machine_name else ""
    return of + tr(Message("shift from {first} to {last}", first=first, last=last))


def make_shift_html(results: ShiftResults, machine_name: str, created_at: str, *, is_metric: bool) -> str:
    """Return the HTML page of the shift report.

    Lengths are in mm if ``is_metric`` is True, or else in inches. X of tools is a diameter.
    """
    body = "".join(
        f"<h2>{escape(head)}</h2>{text}" if head else text
        for head, text in _sections(results, metric=is_metric)
    )
    return make_page_head(make_title(results, machine_name), created_at, get_language()) + body + HTML_END


def make_summary_rows(results: ShiftResults) -> list[tuple[str, str]]:
    """Return the rows of the main results: parts, availability, stops, alarms and readings."""
    rows = [(tr("Parts"), str(results.part_count))]
    share = results.availability
    if share is not None:
        words = tr(
            Message(
                "{share} %: in cycle for {run} of {planned}",
                share=format_fixed(100.0 * share.producing_fraction, 1),
                run=format_duration(share.producing_s),
                planned=format_duration(share.planned_s),
            )
        )
        rows += [
            (tr("Availability"), words),
            (tr("Stops"), f"{len(results.stop_rows)}, {format_duration(results.total_stop_time_s)}"),
            (tr("Not recorded"), format_duration(results.unrecorded_time_s)),
        ]
    rows.append((tr("Alarms and E-stops"), str(len(results.alarms))))
    words = tr(
        Message("{bad} of {count} readings", bad=len(results.bad_readings), count=results.reading_count)
    )
    rows.append((tr("Out of tolerance"), words))
    return rows


def _sections(found: ShiftResults, *, metric: bool) -> Iterator[tuple[str, str]]:
    yield "", "".join(make_result_line("doubt", note) for note in found.notes)
    yield (
        "",
        make_name_value_table(make_summary_rows(found))
        + make_drawing_block(_time_line(found), tr("green: cycles; amber: stops; red: alarms")),
    )
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
            [_program(each) for each in found.program_results],
        ),
    )
    yield (
        tr("Stops by reason"),
        _table(
            (tr("REASON"), tr("OCCURRENCES"), tr("TIME"), tr("SHARE")),
            [
                (
                    tr(r.reason),
                    str(r.times),
                    format_duration(r.seconds),
                    f"{format_fixed(100 * r.share, 0)} %",
                )
                for r in found.stop_reasons
            ],
        ),
    )
    yield (
        tr("All stops"),
        _table(
            (tr("START TIME"), tr("TIME"), tr("REASON"), tr("PROGRAM"), tr("LINE")),
            [
                (
                    format_local_time(r.at),
                    format_duration(r.seconds),
                    tr(r.reason),
                    r.program,
                    str(r.line or ""),
                )
                for r in found.stop_rows
            ],
        ),
    )
    yield (
        tr("Alarms and E-stops"),
        _table(
            (tr("TIME"), tr("DESCRIPTION"), tr("LINE")),
            [(format_local_time(row.at), row.text, str(row.line or "")) for row in found.alarms],
        ),
    )
    yield tr("Tool life used so far"), _lives(found)
    yield (
        tr("Offsets changed"),
        _table(
            (tr("TIME"), tr("OFFSET"), tr("BEFORE"), tr("AFTER"), tr("REASON"), tr("WHO")),
            [_change(each, metric=metric) for each in found.offset_changes],
        ),
    )
    yield (
        tr("Out of tolerance"),
        _table(
            (tr("TIME"), tr("PROGRAM"), tr("PART"), tr("FEATURE"), tr("SIZE"), tr("LIMITS")),
            [_reading(*each, metric=metric) for each in found.bad_readings],
        ),
    )


def _table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    if not rows:
        return f"<p>{escape(tr('none'))}</p>"
    more = tr(Message("and {count} more", count=len(rows) - _MOST)) if len(rows) > _MOST else ""
    return make_table(heads, [tuple(map(escape, row)) for row in rows[:_MOST]]) + (f"<p>{escape(more)}</p>")


def _program(row: ProgramResults) -> tuple[str, ...]:
    none = ", ".join(f"{count} × {tr(how)}" for how, count in row.incomplete_cycles)
    if not row.cycle_times_s:
        return row.program_name, str(row.part_count), none, "", "", ""
    times = (min(row.cycle_times_s), sum(row.cycle_times_s) / len(row.cycle_times_s), max(row.cycle_times_s))
    return (row.program_name, str(row.part_count), none, *(f"{format_fixed(each, 1)} s" for each in times))


def _lives(found: ShiftResults) -> str:
    now = _table(
        (tr("TOOL"), tr("USED"), tr("LIFE USED")),
        [
            (
                f"T{row.number}",
                make_tool_life(row).words,
                f"{format_fixed(100 * make_tool_life(row).share, 0)} %",
            )
            for row in found.tool_lives
        ],
    )
    changed = _table(
        (tr("TIME"), tr("TOOL"), tr("USAGE"), tr("REASON")),
        [
            (
                format_local_time(r.at),
                f"T{r.number}",
                tr(Message("{parts} parts, {time}", parts=r.parts, time=format_duration(r.seconds))),
                r.why,
            )
            for r in found.insert_changes
        ],
    )
    return f"{now}<h3>{escape(tr('Inserts changed in this shift'))}</h3>{changed}"


def _change(row: OffsetChange, *, metric: bool) -> tuple[str, ...]:
    name = f"{_LETTER.get(row.kind, row.kind.value)}{row.number}"
    name = f"{name}, {tr('SHAPE')}" if row.kind is OffsetKind.SHAPE else name
    sides = tuple(_side(each, metric=metric) for each in (row.old, row.new))
    return (format_local_time(row.at), name, *sides, row.why, row.who)


def _side(row: object, *, metric: bool) -> str:
    """Return the values of one offset table row as text."""
    if row is None:
        return tr("not set")
    if isinstance(row, ToolOffsetRow):
        own = (2 * row.x, row.z, row.nose_radius, 2 * row.wear_x, row.wear_z)
        x, z, radius, wear_x, wear_z = (format_signed_length(each, metric) for each in own)
        return f"X {x} Z {z} R {radius}, {tr('wear')} X {wear_x} Z {wear_z}"
    if isinstance(row, SecondaryOffsetRow):
        return (
            f"X {format_signed_length(row.x, metric)} Z {format_signed_length(row.z, metric)} R "
            f"{format_signed_length(row.r, metric)}"
        )
    return ", ".join(f"{key} {value:g}" if isinstance(value, float) else f"{key} {value}"
                     for key, value in getattr(row, "_asdict", dict)().items() if value)  # fmt: skip


def _reading(feature: FeatureRow, row: ReadingRow, *, metric: bool) -> tuple[str, ...]:
    low, high = make_measured_feature(feature).limits
    return (
        format_local_time(row.at),
        feature.program,
        str(row.part),
        feature.name,
        _size(row.value, metric=metric),
        f"{_size(low, metric=metric)} … {_size(high, metric=metric)}",
    )


def _size(mm: float, *, metric: bool) -> str:
    return (
        Message("{unit} mm", unit=format_fixed(mm, 3))
        if metric
        else f"{format_fixed(mm / _MM_PER_INCH, 5)} {tr('in')}"
    )


def _time_line(results: ShiftResults) -> str:
    """Return an SVG timeline of cycles, stops and alarms, with the hours below."""
    start, length = results.shift.start_s, results.shift.end_s - results.shift.start_s

    def calculate_x(moment: float) -> float:
        return _WIDE * min(1.0, max(0.0, (moment - start) / length))

    def make_bar_svg(first: float, last: float, colour: str, y: int, high: int, least: float = 0.6) -> str:
        wide = max(least, calculate_x(last) - calculate_x(first))
        return (
            f'<rect x="{calculate_x(first):.1f}" y="{y}" width="{wide:.1f}" height="{high}" fill="{colour}"/>'
        )

    parts = [make_bar_svg(start, results.evaluated_until_s, "#e3e7eb", 6, 34)]
    for stop in results.stop_rows:
        at = parse_store_time(stop.at)
        parts.append(make_bar_svg(at, at + stop.seconds, "#f0b23c", 6, 34))
    parts += [make_bar_svg(span.start_s, span.end_s, "#2e7d32", 6, 34) for span in results.cycle_spans]
    parts += [
        make_bar_svg(parse_store_time(row.at), parse_store_time(row.at), "#b3261e", 2, 42, 2.0)
        for row in results.alarms
    ]
    hours = max(1, round(length / 3600 / 12))
    moment = start
    while moment <= results.shift.end_s:
        text = datetime.fromtimestamp(moment).strftime("%H:%M")
        parts.append(
            f'<text x="{min(calculate_x(moment), _WIDE - 34):.0f}" y="58" font-size="12">{text}</text>'
        )
        moment += hours * 3600
    return f'<svg viewBox="0 0 {_WIDE} {_HIGH}" width="{_WIDE}" height="{_HIGH}">{"".join(parts)}</svg>'

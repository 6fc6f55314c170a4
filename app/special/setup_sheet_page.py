"""The setup sheet as HTML, in the language of the screen: one page that opens anywhere, and is set as PDF."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from app.desk.translation import tr
from app.report import part_drawings
from app.report.html_tables import clock, figure, pairs, table, verdict
from app.special.setup_sheet import SetupSheet, outside_words


def setup_sheet_html(
    sheet: SetupSheet, facts: Sequence[tuple[str, str]], remarks: Mapping[int, str], notes: Sequence[str]
) -> str:
    """The body of the page; ``facts`` stand first, ``remarks`` are those of the tools, by number."""
    rows = [
        *facts,
        (tr("TIME PER PART"), clock(sheet.cycle)),
        (tr("STOCK"), sheet.stock_words),
        *sheet.held_words,
    ]
    if outside_words(sheet):
        rows.append((tr("PART"), outside_words(sheet)))
    return "".join(
        (_verdict(sheet), pairs(rows), _notes(notes), _tools(sheet, remarks), _offsets(sheet), _stops(sheet),
         _section(sheet))
    )  # fmt: skip


def _verdict(sheet: SetupSheet) -> str:
    if not sheet.verdict:
        return ""
    return verdict("bad" if sheet.errors else "doubt", sheet.verdict)


def _section(sheet: SetupSheet) -> str:
    if sheet.stock is None:
        return ""
    drawing = part_drawings.section(sheet.stock, sheet.part, sheet.clamping)
    text = tr("Section view: the stock is light, the finished part is dark")
    return figure(
        drawing, text + ("; " + tr("features milled by live tools are not shown") if sheet.milled else "")
    )


def _notes(notes: Sequence[str]) -> str:
    if not notes:
        return ""
    lines = "".join(f"<p>{escape(each)}</p>" for each in notes)
    return f"<h3>{escape(tr('NOTES'))}</h3>{lines}"


def _tools(sheet: SetupSheet, remarks: Mapping[int, str]) -> str:
    rows = [
        (
            f"T{tool.number}" if tool.number else tr("no T word"),
            part_drawings.tool_picture(tool.shape),
            _said(sheet.shape_words(tool), remarks.get(tool.number, "")),
            escape(sheet.offset_words(tool)),
            f"{tool.time.total:.1f}",
        )
        for tool in sheet.tools
    ]
    head = (tr("STATION"), tr("PICTURE"), tr("TOOL"), tr("OFFSET"), "s")
    return f"<h3>{escape(tr('TOOLS'))}</h3>" + table(head, rows)


def _said(words: str, remark: str) -> str:
    return f"<b>{escape(remark)}</b><br>{escape(words)}" if remark else escape(words)


def _offsets(sheet: SetupSheet) -> str:
    length = sheet.length
    rows = [(f"D{n}", length(d.x), length(d.z), f"R {length(d.r)}") for n, d in sheet.secondary]
    rows += [(f"G{n}", length(zero.x), length(zero.z), f"C {zero.c:g}°") for n, zero in sheet.zero]
    if not rows:
        return ""
    head = (tr("OFFSET"), tr("X (radius)"), "Z", "")
    return f"<h3>{escape(tr('SECONDARY AND ZERO OFFSETS'))}</h3>" + table(head, rows)


def _stops(sheet: SetupSheet) -> str:
    rows = [
        (sheet.stop_word(stop), str(stop.line), clock(stop.at), escape(stop.message)) for stop in sheet.stops
    ]
    head = (tr("STOP"), tr("LINE"), tr("AFTER"), tr("MESSAGE TO THE OPERATOR"))
    found = table(head, rows) if rows else f"<p>{escape(tr('None.'))}</p>"
    return f"<h3>{escape(tr('STOPS'))}</h3>{found}"

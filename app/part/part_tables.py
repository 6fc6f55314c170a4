"""Tables of the page PART: findings of a program, and its specified and assumed stock."""

from __future__ import annotations

import textwrap

from app.desk.pages.sheet import Row, Sheet
from app.desk.status.formats import length
from app.desk.status.machine_status import Tone
from app.desk.translation import tr
from app.part.part_sheet import PartSheet, Section
from app.part.stock_entry import StockField
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message, join_messages
from core.part.stock import Stock

ACROSS = 74  # characters of a note
_TONES = {Severity.ERROR: Tone.ALARM, Severity.WARNING: Tone.PAUSE, Severity.NOTE: Tone.OFF}


def table(page: PartSheet) -> Sheet:
    """Return the table that the page shows now."""
    return _findings_table(page) if page.section is Section.FINDINGS else _stock_table(page)


# --- findings ------------------------------------------------------------------------------------


def _findings_table(page: PartSheet) -> Sheet:
    found = page.findings
    rows = tuple(_finding_row(each) for each in found)
    title = tr(Message("FINDINGS  ·  {name}", name=page.loaded.name or tr("NO PROGRAM")))
    question = (
        tr(Message("REASON FOR TURNING OFF THE {check} CHECK?", check=page.silencing))
        if page.silencing
        else ""
    )
    notes = _notes(page)
    return Sheet(
        title,
        ("LINE", "CHECK", "DESCRIPTION"),
        (0.12, 0.34, 0.54),
        rows,
        page.marked if rows else -1,
        question,
        page.text,
        notes,
        figures=frozenset({0}),
    )


def _notes(page: PartSheet) -> tuple[str, ...]:
    found = page.finding
    if found is None:
        return (_nothing(page),)
    told = [*_wrapped(tr(found.text)), *_wrapped(tr(found.hint))]
    return (*told[:5], _at(page, found))


def _nothing(page: PartSheet) -> str:
    loaded = page.loaded
    if loaded.busy or loaded.proof is None:
        return tr("NOT PROVED YET")
    part = loaded.part
    if part is None or part.report is None:
        why = tr(part.trouble) if part is not None else ""
        return why or tr("NO FINDINGS. THIS PROGRAM DOES NOT MAKE A PART")
    return tr("NO FINDINGS")


def _at(page: PartSheet, found: Diagnostic) -> str:
    if found.silenced:
        of_machine = found.check in page.of_machine
        return tr("TURNED OFF IN THE MACHINE FILE") if of_machine else tr("F4: UNDO")
    if not found.n:
        return ""
    return tr(Message("MOTION SEGMENT {number}", number=found.n))


# --- stock ---------------------------------------------------------------------------------------


def _stock_table(page: PartSheet) -> Sheet:
    entry, unit = page.entry, tr("MM") if page.metric else tr("INCH")
    rows = tuple(Row((_word(name), _said(page, name), _assumed(page, name))) for name in entry.fields)
    return Sheet(
        join_messages(
            "  ·  ", (tr(Message("STOCK  ·  {name}", name=page.loaded.name or tr("NO PROGRAM"))), unit)
        ),
        ("", "SPECIFIED", "ASSUMED"),
        (0.34, 0.33, 0.33),
        rows,
        page.marked,
        _question(page),
        page.text,
        _stock_notes(page),
        raw=frozenset({1}),
        figures=frozenset({1, 2}),
    )


def _said(page: PartSheet, name: StockField) -> str:
    cell = page.entry.cell(name, page.metric)
    return tr(cell) if name is StockField.KIND and cell else cell or "–"


def _assumed(page: PartSheet, name: StockField) -> str:
    """Return the value that is assumed where no value is specified."""
    if name is StockField.STICK_OUT:
        return length(page.stick_out, page.metric) if page.stick_out else ""
    part = page.loaded.part
    stock = part.report.stock if part is not None and part.report is not None else None
    if stock is None or page.kept.stock:
        return ""
    return _of(stock, name, page.metric)


def _question(page: PartSheet) -> str:
    if not page.name or page.marked_field is StockField.KIND:
        return ""
    return f"{_word(page.marked_field)}?"


def _stock_notes(page: PartSheet) -> tuple[str, ...]:
    lacks = page.entry.lacks
    if lacks is not None:
        return (tr(Message("STOCK DATA INCOMPLETE: ENTER {field}", field=_word(lacks))),)
    if page.marked_field is StockField.STICK_OUT and not page.holds:
        return (tr("THE STICK-OUT IS USED ONLY IF THE MACHINE FILE HAS A [clamping] SECTION"),)
    part = page.loaded.part
    told = part.report.assumed if part is not None and part.report is not None else ()
    said = (f"{tr('ASSUMED')}: {tr(each)}" for each in told[:3])
    return tuple(textwrap.shorten(each, ACROSS, placeholder=" …") for each in said)


def _finding_row(found: Diagnostic) -> Row:
    check = found.check or found.code
    line = str(found.line) if found.line else tr("FILE")
    lit = found.severity is not Severity.NOTE
    return Row((line, check, tr(found.text)), lit, _TONES[found.severity])


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, ACROSS)


def _word(name: StockField) -> str:
    return {
        StockField.KIND: tr("STOCK"),
        StockField.DIAMETER: tr("DIAMETER"),
        StockField.BORE: tr("BORE"),
        StockField.LENGTH: tr("LENGTH"),
        StockField.FILE: tr("FILE"),
        StockField.ALLOWANCE: tr("ALLOWANCE"),
        StockField.STICK_OUT: tr("STICK-OUT"),
    }[name]


def _of(stock: Stock, name: StockField, metric: bool) -> str:
    """Return the text of a field of the assumed stock."""
    if name is StockField.KIND:
        return tr("TUBE") if stock.bore else tr("BAR")
    figures = {
        StockField.DIAMETER: 2.0 * stock.radius,
        StockField.LENGTH: stock.front - stock.back,
        StockField.ALLOWANCE: stock.front,
        StockField.BORE: 2.0 * max((r for _, r in stock.bore), default=0.0),
    }
    return length(figures[name], metric) if name in figures else ""

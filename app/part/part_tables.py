"""Tables of the PART page: findings of a program, and specified and assumed stock values."""

from __future__ import annotations

import textwrap

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.status.formats import format_length
from app.desk.status.machine_status import StatusTone
from app.desk.translation import tr
from app.part.part_model import PartPageModel, PartPageTable
from app.part.stock_entry import StockField
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message, join_messages
from core.part.stock import Stock

NOTE_WIDTH_CHARS = 74  # characters of a note
_SEVERITY_TONES = {
    Severity.ERROR: StatusTone.ALARM,
    Severity.WARNING: StatusTone.PAUSE,
    Severity.NOTE: StatusTone.OFF,
}


def make_table(model: PartPageModel) -> TableContent:
    """Return the table that the page shows now."""
    return _findings_table(model) if model.shown_table is PartPageTable.FINDINGS else _stock_table(model)


# --- findings ------------------------------------------------------------------------------------


def _findings_table(page: PartPageModel) -> TableContent:
    found = page.findings
    rows = tuple(_finding_row(each) for each in found)
    title = tr(Message("FINDINGS  ·  {name}", name=page.loaded_program.name or tr("NO PROGRAM")))
    question = (
        tr(Message("REASON FOR TURNING OFF THE {check} CHECK?", check=page.check_to_disable))
        if page.check_to_disable
        else ""
    )
    notes = _notes(page)
    return TableContent(
        title,
        ("LINE", "CHECK", "DESCRIPTION"),
        (0.12, 0.34, 0.54),
        rows,
        page.selected_row_index if rows else -1,
        question,
        page.entry_text,
        notes,
        numeric_columns=frozenset({0}),
    )


def _notes(page: PartPageModel) -> tuple[str, ...]:
    found = page.selected_finding
    if found is None:
        return (_nothing(page),)
    note_lines = [*_wrapped(tr(found.text)), *_wrapped(tr(found.hint))]
    return (*note_lines[:5], _at(page, found))


def _nothing(page: PartPageModel) -> str:
    loaded = page.loaded_program
    if loaded.is_busy or loaded.proof is None:
        return tr("NOT PROVED YET")
    part = loaded.part_proof
    if part is None or part.report is None:
        why = tr(part.error_text) if part is not None else ""
        return why or tr("NO FINDINGS. THIS PROGRAM DOES NOT MAKE A PART")
    return tr("NO FINDINGS")


def _at(page: PartPageModel, found: Diagnostic) -> str:
    if found.downgrade_reason:
        of_machine = found.check_name in page.machine_disabled_checks
        return tr("TURNED OFF IN THE MACHINE FILE") if of_machine else tr("F4: UNDO")
    if not found.block_number:
        return ""
    return tr(Message("MOTION SEGMENT {number}", number=found.block_number))


# --- stock ---------------------------------------------------------------------------------------


def _stock_table(page: PartPageModel) -> TableContent:
    entry, unit = page.stock_entry, tr("MM") if page.is_metric else tr("INCH")
    rows = tuple(
        TableRow((_word(name), _said(page, name), _format_assumed(page, name))) for name in entry.fields
    )
    return TableContent(
        join_messages(
            "  ·  ",
            (tr(Message("STOCK  ·  {name}", name=page.loaded_program.name or tr("NO PROGRAM"))), unit),
        ),
        ("", "SPECIFIED", "ASSUMED"),
        (0.34, 0.33, 0.33),
        rows,
        page.selected_row_index,
        _question(page),
        page.entry_text,
        _stock_notes(page),
        untranslated_columns=frozenset({1}),
        numeric_columns=frozenset({1, 2}),
    )


def _said(page: PartPageModel, name: StockField) -> str:
    cell = page.stock_entry.format_field(name, page.is_metric)
    return tr(cell) if name is StockField.KIND and cell else cell or "–"


def _format_assumed(page: PartPageModel, name: StockField) -> str:
    """Return, as text, the stock value that is assumed when the operator has not specified one."""
    if name is StockField.STICK_OUT:
        return format_length(page.assumed_stick_out_mm, page.is_metric) if page.assumed_stick_out_mm else ""
    part = page.loaded_program.part_proof
    stock = part.report.stock if part is not None and part.report is not None else None
    if stock is None or page.stored_part.stock_text:
        return ""
    return _format_stock_value(stock, name, page.is_metric)


def _question(page: PartPageModel) -> str:
    if not page.program_name or page.selected_field is StockField.KIND:
        return ""
    return f"{_word(page.selected_field)}?"


def _stock_notes(page: PartPageModel) -> tuple[str, ...]:
    lacks = page.stock_entry.missing_field
    if lacks is not None:
        return (tr(Message("STOCK DATA INCOMPLETE: ENTER {field}", field=_word(lacks))),)
    if page.selected_field is StockField.STICK_OUT and not page.has_workholding:
        return (tr("THE STICK-OUT IS USED ONLY IF THE MACHINE FILE HAS A [clamping] SECTION"),)
    part = page.loaded_program.part_proof
    assumptions = part.report.assumptions if part is not None and part.report is not None else ()
    said = (f"{tr('ASSUMED')}: {tr(each)}" for each in assumptions[:3])
    return tuple(textwrap.shorten(each, NOTE_WIDTH_CHARS, placeholder=" …") for each in said)


def _finding_row(found: Diagnostic) -> TableRow:
    check = found.check_name or found.code
    line = str(found.line) if found.line else tr("FILE")
    lit = found.severity is not Severity.NOTE
    return TableRow((line, check, tr(found.text)), lit, _SEVERITY_TONES[found.severity])


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, NOTE_WIDTH_CHARS)


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


def _format_stock_value(stock: Stock, name: StockField, metric: bool) -> str:
    """Return the text of a field of the assumed stock."""
    if name is StockField.KIND:
        return tr("TUBE") if stock.bore_profile else tr("BAR")
    lengths_mm = {
        StockField.DIAMETER: 2.0 * stock.max_radius_mm,
        StockField.LENGTH: stock.front_z_mm - stock.back_z_mm,
        StockField.ALLOWANCE: stock.front_z_mm,
        StockField.BORE: 2.0 * max((r for _, r in stock.bore_profile), default=0.0),
    }
    return format_length(lengths_mm[name], metric) if name in lengths_mm else ""

"""Time-consuming work of the setup sheet: the proof, the rows, the page and the files.

To save start-up time, this module is imported only when it is needed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from html import escape
from pathlib import Path

from app.desk.background_work import WorkRequest
from app.desk.pages.table_content import TableRow
from app.desk.translation import get_language, tr
from app.programs.atomic_files import FileOperationError, copy_to_medium, flush_folder
from app.report import part_drawings
from app.report.html_tables import (
    HTML_END,
    format_duration,
    hash_program_text,
    make_drawing_block,
    make_headline,
    make_name_value_table,
    make_page_head,
    make_result_line,
    make_table,
)
from app.report.pdf_file import PaperSize, make_pdf
from app.special.setup_sheet import SetupSheet, format_finished_size, make_setup_sheet
from core.executor.job import Job
from core.machine.machine_model import Machine
from core.message import Message
from core.part.insert_codes import InsertCodeError
from core.part.tool_outline import ToolOutline, make_tool_outline
from core.part.tool_shape import ToolShape
from core.proving.program_tools import PartSettings


def make_sheet_html(
    sheet: SetupSheet, fact_rows: Sequence[tuple[str, str]], remarks: Mapping[int, str], notes: Sequence[str]
) -> str:
    """Return the HTML body of the setup sheet.

    ``fact_rows`` are the rows at the top of the sheet. ``remarks`` contains the remarks about tools, by
    tool number.
    """
    rows = [
        *fact_rows,
        (tr("TIME PER PART"), format_duration(sheet.cycle_time_s)),
        (tr("STOCK"), sheet.stock_text),
        *sheet.clamping_texts,
    ]
    if format_finished_size(sheet):
        rows.append((tr("PART"), format_finished_size(sheet)))
    return "".join(
        (
            _verdict(sheet),
            make_name_value_table(rows),
            _notes(notes),
            _tools(sheet, remarks),
            _offsets(sheet),
            _stops(sheet),
            _section(sheet),
        )
    )


def _verdict(sheet: SetupSheet) -> str:
    if not sheet.findings_summary:
        return ""
    return make_result_line("bad" if sheet.error_count else "doubt", sheet.findings_summary)


def _section(sheet: SetupSheet) -> str:
    if sheet.stock is None:
        return ""
    drawing = part_drawings.draw_section(sheet.stock, sheet.finished_part, sheet.clamping)
    text = tr("Section view: the stock is light, the finished part is dark")
    return make_drawing_block(
        drawing, text + ("; " + tr("features milled by live tools are not shown") if sheet.is_milled else "")
    )


def _notes(notes: Sequence[str]) -> str:
    if not notes:
        return ""
    lines = "".join(f"<p>{escape(each)}</p>" for each in notes)
    return f"<h3>{escape(tr('NOTES'))}</h3>{lines}"


def _tools(sheet: SetupSheet, remarks: Mapping[int, str]) -> str:
    rows = [
        (
            f"T{tool.tool_number}" if tool.tool_number else tr("no T word"),
            part_drawings.draw_tool(tool.tool_shape),
            _said(sheet.describe_tool_shape(tool), remarks.get(tool.tool_number, "")),
            escape(sheet.format_offset(tool)),
            f"{tool.tool_times.total_time_s:.1f}",
        )
        for tool in sheet.setup_tools
    ]
    head = (tr("STATION"), tr("PICTURE"), tr("TOOL"), tr("OFFSET"), "s")
    return f"<h3>{escape(tr('TOOLS'))}</h3>" + make_table(head, rows)


def _said(words: str, remark: str) -> str:
    return f"<b>{escape(remark)}</b><br>{escape(words)}" if remark else escape(words)


def _offsets(sheet: SetupSheet) -> str:
    length = sheet.format_length
    rows = [
        (f"D{n}", length(d.x), length(d.z), f"R {length(d.nose_radius)}") for n, d in sheet.secondary_offsets
    ]
    rows += [(f"G{n}", length(zero.x), length(zero.z), f"C {zero.c:g}°") for n, zero in sheet.zero_offsets]
    if not rows:
        return ""
    head = (tr("OFFSET"), tr("X (radius)"), "Z", "")
    return f"<h3>{escape(tr('SECONDARY AND ZERO OFFSETS'))}</h3>" + make_table(head, rows)


def _stops(sheet: SetupSheet) -> str:
    rows = [
        (
            sheet.format_stop_code(stop),
            str(stop.line_number),
            format_duration(stop.time_s),
            escape(stop.message),
        )
        for stop in sheet.program_stops
    ]
    head = (tr("STOP"), tr("LINE"), tr("AFTER"), tr("MESSAGE TO THE OPERATOR"))
    found = make_table(head, rows) if rows else f"<p>{escape(tr('None.'))}</p>"
    return f"<h3>{escape(tr('STOPS'))}</h3>{found}"


@dataclass(frozen=True, slots=True)
class PreparedSheet:
    """Setup sheet of one job, with the outlines of its tools by number."""

    job: Job
    setup_sheet: SetupSheet
    tool_outlines: Mapping[int, ToolOutline | None]


def make_sheet_rows(prepared: PreparedSheet, remarks: Mapping[int, str]) -> Iterator[TableRow]:
    """Yield the table rows of the setup sheet: time, stock, clamping, tools, offsets and stops."""
    sheet = prepared.setup_sheet
    if sheet.findings_summary:
        yield TableRow((tr("ERRORS") if sheet.error_count else tr("WARNINGS"), sheet.findings_summary, ""))
    part = format_finished_size(sheet)
    stock = sheet.stock_text + (f"\n{tr('PART')} {part}" if part else "")
    yield TableRow((tr("TIME PER PART"), format_duration(sheet.cycle_time_s), ""))
    yield TableRow((tr("STOCK"), stock, ""))
    for name, words in sheet.clamping_texts:
        yield TableRow((name, words, ""))
    for tool in sheet.setup_tools:
        remark = remarks.get(tool.tool_number, "")
        words = f"{remark}: {sheet.describe_tool_shape(tool)}" if remark else sheet.describe_tool_shape(tool)
        offset = f"{sheet.format_offset(tool)}   {tool.tool_times.total_time_s:.1f} s"
        name = f"T{tool.tool_number}" if tool.tool_number else tr("no T word")
        yield TableRow(
            (name, f"{words}\n{offset}", ""), tool_outline=prepared.tool_outlines.get(tool.tool_number)
        )
    length = sheet.format_length
    for n, d in sheet.secondary_offsets:
        yield TableRow((f"D{n}", f"X {length(d.x)}   Z {length(d.z)}   R {length(d.nose_radius)}", ""))
    for n, zero in sheet.zero_offsets:
        yield TableRow((f"G{n}", f"X {length(zero.x)}   Z {length(zero.z)}   C {zero.c:g}°", ""))
    for stop in sheet.program_stops:
        at = tr(Message("LINE {line}", line=stop.line_number))
        yield TableRow(
            (sheet.format_stop_code(stop), f"{stop.message}\n{at}, {format_duration(stop.time_s)}", "")
        )


def prepare_sheet(
    job: Job, machine: Machine, part_settings: PartSettings | None, watch: WorkRequest
) -> PreparedSheet:
    """Prepare the setup sheet of a job.

    This function runs on a worker thread.
    """
    sheet = make_setup_sheet(job.shared_program, job.setup, machine, part_settings or PartSettings(), watch)
    return PreparedSheet(
        job, sheet, {tool.tool_number: _outline(tool.tool_shape) for tool in sheet.setup_tools}
    )


def _outline(shape: ToolShape | None) -> ToolOutline | None:
    try:
        return make_tool_outline(shape) if shape is not None else None
    except InsertCodeError:
        return None


def make_sheet_page(
    prepared: PreparedSheet,
    program_name: str,
    machine: Machine,
    remarks: Mapping[int, str],
    notes: Sequence[str],
) -> tuple[str, str, str]:
    """Return the title, date and HTML body of the setup sheet."""
    facts = [
        (tr("MACHINE"), machine.name),
        (tr("PROGRAM CHECKSUM (SHA-256)"), hash_program_text(prepared.job.source)),
    ]
    body = make_sheet_html(prepared.setup_sheet, facts, remarks, notes)
    title = tr(Message("Setup sheet: {program}", program=program_name))
    return title, datetime.now().strftime("%Y-%m-%d %H:%M"), body


def write_sheet_files(
    page: tuple[str, str, str], program_name: str, folder: Path, paper_size: PaperSize
) -> str:
    """Write the setup sheet as PDF and HTML, and return the name of the PDF file.

    This function runs on a worker thread. Each file is replaced atomically. Raise FileOperationError on
    failure.
    """
    title, made, body = page
    name = f"{program_name}-setup"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        pdf = make_pdf(make_headline(title, made) + body, title, paper_size)
    except OSError as error:
        raise FileOperationError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=folder, cause=error.strerror)
        ) from error
    html = make_page_head(title, made, get_language()) + body + HTML_END
    copy_to_medium(folder / f"{name}.html", html.encode("utf-8", "backslashreplace"))
    copy_to_medium(folder / f"{name}.pdf", pdf)
    flush_folder(folder)
    return f"{name}.pdf"

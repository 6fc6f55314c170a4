"""Slow work of the setup sheet: proof, rows, page and files; imported only when needed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from html import escape
from pathlib import Path

from app.desk.background_work import Request
from app.desk.pages.sheet import Row
from app.desk.translation import spoken, tr
from app.programs.whole_file import FileError, settle, write_out
from app.report import part_drawings
from app.report.html_tables import (
    PAGE_END,
    clock,
    figure,
    headline,
    page_head,
    pairs,
    table,
    text_hash,
    verdict,
)
from app.report.pdf_file import Paper, pdf_of
from app.special.setup_sheet import SetupSheet, outside_words, setup_sheet
from core.executor.job import Job
from core.machine.machine_model import Machine
from core.message import Message
from core.part.insert_codes import InsertCodeError
from core.part.tool_outline import ToolOutline, outline
from core.part.tool_shape import ToolShape
from core.proving.program_tools import PartSetting


def setup_sheet_html(
    sheet: SetupSheet, facts: Sequence[tuple[str, str]], remarks: Mapping[int, str], notes: Sequence[str]
) -> str:
    """Return the body of the HTML page.

    ``facts`` are the first rows, and ``remarks`` are the remarks about tools by number.
    """
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


@dataclass(frozen=True, slots=True)
class MadeSheet:
    """Setup sheet of one job, with the outlines of its tools by number."""

    job: Job
    sheet: SetupSheet
    outlines: Mapping[int, ToolOutline | None]


def rows_of(made: MadeSheet, remarks: Mapping[int, str]) -> Iterator[Row]:
    """Yield the rows of the sheet: time, stock, clamping, tools, offsets and stops."""
    sheet = made.sheet
    if sheet.verdict:
        yield Row((tr("ERRORS") if sheet.errors else tr("WARNINGS"), sheet.verdict, ""))
    part = outside_words(sheet)
    stock = sheet.stock_words + (f"\n{tr('PART')} {part}" if part else "")
    yield Row((tr("TIME PER PART"), clock(sheet.cycle), ""))
    yield Row((tr("STOCK"), stock, ""))
    for name, words in sheet.held_words:
        yield Row((name, words, ""))
    for tool in sheet.tools:
        remark = remarks.get(tool.number, "")
        words = f"{remark}: {sheet.shape_words(tool)}" if remark else sheet.shape_words(tool)
        offset = f"{sheet.offset_words(tool)}   {tool.time.total:.1f} s"
        name = f"T{tool.number}" if tool.number else tr("no T word")
        yield Row((name, f"{words}\n{offset}", ""), outline=made.outlines.get(tool.number))
    length = sheet.length
    for n, d in sheet.secondary:
        yield Row((f"D{n}", f"X {length(d.x)}   Z {length(d.z)}   R {length(d.r)}", ""))
    for n, zero in sheet.zero:
        yield Row((f"G{n}", f"X {length(zero.x)}   Z {length(zero.z)}   C {zero.c:g}°", ""))
    for stop in sheet.stops:
        at = tr(Message("LINE {line}", line=stop.line))
        yield Row((sheet.stop_word(stop), f"{stop.message}\n{at}, {clock(stop.at)}", ""))


def made_of(job: Job, machine: Machine, setting: PartSetting | None, watch: Request) -> MadeSheet:
    """Prepare the sheet of a job; runs on a worker."""
    sheet = setup_sheet(job.reading, job.setup, machine, setting or PartSetting(), watch)
    return MadeSheet(job, sheet, {tool.number: _outline(tool.shape) for tool in sheet.tools})


def _outline(shape: ToolShape | None) -> ToolOutline | None:
    try:
        return outline(shape) if shape is not None else None
    except InsertCodeError:
        return None


def page_of(
    made: MadeSheet, program: str, machine: Machine, remarks: Mapping[int, str], notes: Sequence[str]
) -> tuple[str, str, str]:
    """Return title, date and body of the page."""
    facts = [(tr("MACHINE"), machine.name), (tr("PROGRAM CHECKSUM (SHA-256)"), text_hash(made.job.source))]
    body = setup_sheet_html(made.sheet, facts, remarks, notes)
    title = tr(Message("Setup sheet: {program}", program=program))
    return title, datetime.now().strftime("%Y-%m-%d %H:%M"), body


def write(page: tuple[str, str, str], program: str, folder: Path, paper: Paper) -> str:
    """Write the sheet as PDF and HTML on the worker, and return the PDF's name.

    Each file is replaced atomically. Raises FileError.
    """
    title, made, body = page
    name = f"{program}-setup"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        pdf = pdf_of(headline(title, made) + body, title, paper)
    except OSError as error:
        raise FileError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=folder, cause=error.strerror)
        ) from error
    html = page_head(title, made, spoken()) + body + PAGE_END
    write_out(folder / f"{name}.html", html.encode("utf-8", "backslashreplace"))
    write_out(folder / f"{name}.pdf", pdf)
    settle(folder)
    return f"{name}.pdf"

"""Report of a proof as one HTML page, with result, drawings, findings, tools, times, stops and offsets.

All text from programs and files is escaped. The page loads no external resources and contains no scripts.
"""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

from app.report import part_drawings
from app.report.html_tables import (
    format_duration,
    hash_program_text,
    make_drawing_block,
    make_name_value_table,
    make_result_line,
    make_table,
)
from app.report.run_record import ReportRecorder
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect, ProgramSource
from core.message import Message
from core.part.tool_shape import ToolShape
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from core.interpreter.shared.job_setup import InterpreterSetup
    from core.machine.machine_model import Machine
    from core.proving.proof_report import PartReport, ProofReport

_MAX_PICTURES = 30  # maximum number of pictures of findings
_MM_PER_INCH = 25.4


class ProgramReport:
    """Section of a report about one program."""

    def __init__(
        self,
        source: ProgramSource,
        report: ProofReport,
        part_report: PartReport | None,
        run_record: ReportRecorder,
        machine: Machine,
        setup: InterpreterSetup,
    ) -> None:
        self._source, self._report, self._part, self._record = source, report, part_report, run_record
        self._machine, self._setup = machine, setup
        self._metric = report.is_metric or report.dialect is not Dialect.OMNITURN

    def make_html(self) -> str:
        """Return the report section as HTML."""
        return "".join(
            (
                self._head(), self._drawings(), self._findings(), self._tools(), self._stops(),
                self._offsets(),
            )
        )  # fmt: skip

    # --- --- values

    def _length(self, mm: float) -> str:
        return (
            Message("{unit} mm", unit=f"{mm:.3f}")
            if self._metric
            else Message("{mm} in", mm=f"{mm / _MM_PER_INCH:.4f}")
        )

    def _volume(self, mm3: float) -> str:
        return f"{mm3:.1f} mm³" if self._metric else f"{mm3 / _MM_PER_INCH**3:.4f} in³"

    # --- --- result --------

    def _head(self) -> str:
        report, times = self._report, self._report.program_times
        errors, warnings = len(report.errors), self._count(Severity.WARNING)
        words = (
            Message("{errors}; the program will not run", errors=_many(errors, "error"))
            if errors
            else "Proved"
        )
        words += f"; {_many(warnings, 'warning')}" if warnings else ""
        rows = [
            ("Machine", f"{self._machine.name} ({self._machine.source})"),
            (
                "Program",
                Message(
                    "{blocks} program blocks, {elementary} motions and actions, {dialect}",
                    blocks=report.block_count,
                    elementary=report.elementary_block_count,
                    dialect=report.dialect,
                ),
            ),
            ("Text (SHA-256)", hash_program_text(self._source)),
            (
                "Cycle",
                Message(
                    "{cycle}: cutting {cutting} s, rapid {rapid} s, dwell {dwell} s, waiting {wait} s",
                    cycle=format_duration(times.cycle_time_s),
                    cutting=f"{times.cutting_time_s:.1f}",
                    rapid=f"{times.rapid_time_s:.1f}",
                    dwell=f"{times.dwell_time_s:.1f}",
                    wait=f"{times.wait_time_s:.1f}",
                ),
            ),
            *self._stock_rows(),
        ]
        look = "bad" if errors else "doubt" if warnings else "good"
        return make_result_line(look, words) + make_name_value_table(rows)

    def _count(self, severity: Severity) -> int:
        return sum(each.severity is severity for each in self._report.diagnostics)

    def _stock_rows(self) -> list[tuple[str, str]]:
        part = self._part
        if part is None or part.stock is None:
            return []
        stock = part.stock
        bore = (
            Message(", bore diameter {bore}", bore=self._length(2 * stock.bore_profile[0][1]))
            if stock.bore_profile
            else ""
        )
        taken = Message(
            "stock not specified; a bar of Ø {radius}{bore} is assumed",
            radius=self._length(2 * stock.max_radius_mm),
            bore=bore,
        )
        name = stock.specification_text or taken
        rows = [
            ("Stock", f"{name}; {self._volume(part.stock_volume_mm3)}"),
            ("Cut away", self._volume(part.removed_volume_mm3)),
        ]
        if part.last_piece is not None and part.last_piece.outside_profile:
            outside = part.last_piece.outside_profile
            size = self._length(2 * max(r for _, r in outside))
            rows.append(("Part", f"Ø {size} × {self._length(outside[0][0] - outside[-1][0])}"))
        if part.parted_pieces:
            rows.append(("Parted off", _many(len(part.parted_pieces), "piece")))
        rows += [("Assumed", words) for words in part.assumptions]
        return rows + [("Not checked", words) for words in part.unchecked_data]

    # --- drawings

    def _drawings(self) -> str:
        part, record = self._part, self._record
        if part is None or part.stock is None:
            return "<p>No section view is shown because the program does not turn a part.</p>"
        clamping = record.part_settings.clamping
        short = (
            Message(
                "; only the first {moves_count} moves are shown", moves_count=f"{len(record.tip_moves):,}"
            )
            if record.is_truncated
            else ""
        )
        milled = "; milling with live tools is not shown" if part.is_milled else ""
        if part.section_halves is not None:
            milled = "; milling is shown with C at 0"
        cut_open = make_drawing_block(
            part_drawings.draw_section(part.stock, part.last_piece, clamping, part.section_halves),
            Message("Section (light: stock, dark: finished part){milled}", milled=milled),
        )
        if not record.tip_moves:
            return cut_open
        return cut_open + make_drawing_block(
            part_drawings.path(part.stock, part.last_piece, clamping, record.tip_moves, part.section_halves),
            Message("Tool paths (solid: cuts, dashed: rapids, thick: threads){short}", short=short),
        )

    # --- findings

    def _findings(self) -> str:
        found = self._report.diagnostics
        if not found:
            return "<h3>Findings</h3><p>None.</p>"
        places = self._draw_findings(found)
        return "<h3>Findings</h3>" + "".join(
            self._finding(each, places.get(each.block_number, "")) for each in found
        )

    def _finding(self, each: Diagnostic, picture: str) -> str:
        lines = self._source.lines
        text = lines[each.line - 1] if 0 < each.line <= len(lines) else ""
        where = Message("Line {line}", line=each.line) if each.line else "Program"
        code = f"<pre>{escape(text)}</pre>" if text.strip() else ""
        hint = f'<p class="hint">{escape(each.hint)}</p>' if each.hint else ""
        return (
            f'<div class="finding {each.severity}"><div><p><b>{where}</b> {each.severity} '
            f"<code>{escape(each.code)}</code></p>{code}<p>{escape(each.text)}</p>{hint}</div>{picture}</div>"
        )

    def _draw_findings(self, found: Sequence[Diagnostic]) -> dict[int, str]:
        """Return the drawings of the findings about the part, by block number."""
        wanted = list(dict.fromkeys(each.block_number for each in found if each.block_number))[:_MAX_PICTURES]
        if self._part is None or not wanted:
            return {}
        held = self._record.find_material_before_blocks(wanted)
        moves = {move.n: move for move in self._record.tip_moves if move.n in held}
        shapes, clamping = self._part.tool_shapes, self._record.part_settings.clamping
        return {
            n: part_drawings.draw_finding(move, held[n], shapes.get(move.modal.tool), clamping)
            for n, move in moves.items()
        }

    # --- tables

    def _tools(self) -> str:
        shapes = self._part.tool_shapes if self._part is not None else {}
        numbers = sorted(
            {
                *self._report.tool_numbers,
                *(n for n, time in self._record.tool_times.items() if time.total_time_s),
            }
        )
        rows = [self._tool(n, shapes.get(n)) for n in numbers]
        return (
            "<h3>Tools and times</h3>"
            f"{make_table(('Tool', 'Outline', 'Shape', 'Cutting s', 'Rapid s', 'Time at rest, s'), rows)}"
        )

    def _tool(self, number: int, shape: ToolShape | None) -> tuple[str, ...]:
        time = self._record.tool_times.get(number)
        seconds = (time.cutting_s, time.rapid_s, time.other_s) if time is not None else (0.0, 0.0, 0.0)
        name = format_edge_name(number) if number else "no tool"
        said = "" if shape == self._record.part_settings.shapes.get(number) else " (assumed)"
        words = escape(self._describe_shape(shape) + said)
        return name, part_drawings.draw_tool(shape), words, *(f"{each:.1f}" for each in seconds)

    def _describe_shape(self, shape: ToolShape | None) -> str:
        """Return the specified shape data of a tool as text."""
        if shape is None:
            return "unknown"
        sizes = (
            ("Ø", shape.diameter), ("width", shape.width), ("nose radius", shape.nose_radius),
            ("pitch", shape.pitch), ("cuts", shape.length), ("stick-out", shape.stick_out),
        )  # fmt: skip
        words = [str(shape.kind), shape.insert, shape.holder and f"in {shape.holder}"]
        words += [f"{name} {self._length(mm)}" for name, mm in sizes if mm]
        words += [f"point {shape.point:g}°"] if shape.point else []
        words += [Message("tip quadrant {tip}", tip=shape.tip)] if shape.tip else []
        return ", ".join(filter(None, words))

    def _stops(self) -> str:
        rows = [
            (
                f"M0{int(stop.is_optional)}",
                str(stop.line_number),
                format_duration(stop.time_s),
                escape(stop.message),
            )
            for stop in self._record.program_stops
        ]
        head = ("Stop", "Line", "After", "Message to the operator")
        return "<h3>Stops</h3>" + (make_table(head, rows) if rows else "<p>None.</p>")

    def _offsets(self) -> str:
        setup, length = self._setup, self._length
        rows = [
            (
                format_edge_name(n),
                length(row.x),
                length(row.z),
                f"nose radius {length(row.nose_radius)}",
            )
            for n in self._report.tool_numbers
            if (row := setup.tools.get(n)) is not None
        ]
        rows += [
            (format_edge_name(n), "not set", "not set", "X and Z are assumed to be 0")
            for n in self._report.missing_tool_numbers
        ]
        rows += [
            (f"D{n}", length(d.x), length(d.z), f"radius {length(d.nose_radius)}")
            for n in sorted(self._record.used_secondary_offsets)
            if (d := setup.secondary.get(n)) is not None
        ]
        rows += [
            (f"G{n}", length(zero.x), length(zero.z), f"C {zero.c:g}°")
            for n in sorted(self._record.used_zero_offsets)
            if (zero := setup.zero.get(n)) is not None
        ]
        return "<h3>Offsets</h3>" + make_table(("Offset", "X (radius)", "Z", ""), rows)


# --- the page


def make_program_section(name: str, section: str) -> str:
    """Return the HTML section of one program with its heading."""
    return f"<section><h2>{escape(name)}</h2>{section}</section>\n"


def make_unproved_section(reason: str) -> str:
    """Return the HTML section of a program that could not be proved."""
    return make_result_line("bad", "Not proved") + f"<p>{escape(reason)}</p>"


def make_offset_comparison(comparison_text: str) -> str:
    """Return the effect of changed offsets as HTML, with the same text as on the command line."""
    return f"<h3>With different offsets</h3><pre>{escape(comparison_text)}</pre>"


def _many(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"

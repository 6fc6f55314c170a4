"""Findings of a long program between an edit and the next proof. It does not use Qt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.editor.live_proof import ProofFindings, map_findings_by_line
from core.language.diagnostics import Diagnostic


def adjust_findings(
    findings: ProofFindings,
    first_line: int,
    old_line_count: int,
    new_line_count: int,
    line_errors: Sequence[Diagnostic],
) -> ProofFindings:
    """Return the findings of the last proof after an edit.

    The edit replaced ``old_line_count`` lines by ``new_line_count`` lines, beginning with ``first_line``,
    which counts from 1. The findings of the replaced lines are removed, and the findings of later lines
    move with their lines. ``line_errors`` are the syntax errors of the new lines.
    """
    shift = new_line_count - old_line_count
    end = first_line + old_line_count
    retained = [
        replace(each, line=each.line + shift) if each.line >= end and shift else each
        for each in findings.diagnostics
        if not first_line <= each.line < end
    ]
    diagnostics = tuple(sorted((*retained, *line_errors), key=lambda each: (each.line, each.column)))
    if diagnostics == findings.diagnostics:
        return findings
    return replace(findings, diagnostics=diagnostics, line_findings=map_findings_by_line(diagnostics))

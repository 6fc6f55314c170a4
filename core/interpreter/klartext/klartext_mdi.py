"""Klartext blocks that the operator enters on the MDI page."""

from __future__ import annotations

from core.interpreter.klartext.klartext_program import Program
from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext import parse_line
from core.language.source import ProgramSource
from core.message import Message

_HINT = "Use this command in a program."


_CONTEXT_ERRORS: tuple[tuple[type, str], ...] = (
    (nodes.BeginBlock, "BEGIN PGM begins a program"),
    (nodes.EndBlock, "END PGM ends a program and cannot be used in MDI"),
    (nodes.BlankCorner, "BLK FORM defines the blank of a program and cannot be used in MDI"),
    (nodes.Label, "LBL marks a position in a program and cannot be used in MDI"),
    (nodes.LabelCall, "CALL LBL jumps to another block and cannot be used in MDI"),
    (nodes.ConditionalJump, "A jump goes to another block and cannot be used in MDI"),
    (nodes.ProgramCall, "CALL PGM calls another program and cannot be used in MDI"),
    (nodes.CornerBlock, "RND and CHF are allowed only between two blocks of a contour"),
)


def read_mdi_block(source: ProgramSource, *, is_inch: bool) -> Program:
    """Parse an MDI block and return it as a program with one block.

    The function does not raise exceptions. Blocks that depend on other blocks are reported as errors.
    """
    line = parse_line(1, source.lines[0] if source.lines else "")
    problem = line.error or _check_context(line)
    return Program(
        source, [line], end_index=1, is_inch=is_inch, diagnostics=[problem] if problem is not None else []
    )


def _check_context(line: nodes.KlartextLine) -> Diagnostic | None:
    """Return the error for a block that depends on other blocks, or None if it can be executed alone."""
    node = line.node
    column = getattr(node, "column", 1) or 1
    if line.is_skippable:
        return _refuse(1, "/ skips a program block and has no meaning in MDI")
    for kind, why in _CONTEXT_ERRORS:
        if isinstance(node, kind):
            return _refuse(column, why)
    if isinstance(node, nodes.PathFunction):
        if node.function_name.startswith(("APPR", "DEP")):
            return _refuse(
                column,
                Message(
                    "{form} approaches or departs from a contour and cannot be used in MDI",
                    form=node.function_name,
                ),
            )
        if node.compensation in {"L", "R"}:
            return _refuse(
                column,
                Message(
                    "R{compensation} needs a contour of more than one block and cannot be used in MDI",
                    compensation=node.compensation,
                ),
            )
    if isinstance(node, nodes.CycleLine) and node.cycle_number == 12:
        return _refuse(column, "Cycle 12 selects another program and cannot be used in MDI")
    return None


def _refuse(column: int, what: str) -> Diagnostic:
    return make_error_diagnostic(1, column, "not-alone-mdi", Message("{what}.", what=what), _HINT)

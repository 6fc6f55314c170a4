"""One Klartext block on its own, as it is typed in MDI: what needs other blocks is refused."""

from __future__ import annotations

from core.interpreter.klartext.klartext_program import Program
from core.language.diagnostics import Diagnostic, refusal
from core.language.klartext import klartext_nodes as nodes
from core.language.klartext import read_line
from core.language.source import Source
from core.message import Message

_HINT = "Use this command in a program."
_NEEDS_OTHERS: tuple[tuple[type, str], ...] = (
    (nodes.Begin, "BEGIN PGM begins a program"),
    (nodes.End, "END PGM ends a program and cannot be used in MDI"),
    (nodes.BlankForm, "BLK FORM defines the blank of a program and cannot be used in MDI"),
    (nodes.Label, "LBL marks a position in a program and cannot be used in MDI"),
    (nodes.Call, "CALL LBL jumps to another block and cannot be used in MDI"),
    (nodes.Jump, "A jump goes to another block and cannot be used in MDI"),
    (nodes.ProgramCall, "CALL PGM calls another program and cannot be used in MDI"),
    (nodes.Corner, "RND and CHF are allowed only between two blocks of a contour"),
)


def read_single(source: Source, *, inch: bool) -> Program:
    """A block of MDI as a program of one block that needs no frame. Raises nothing.

    Refused is what has no meaning without other blocks, with its column.
    """
    line = read_line(1, source.lines[0] if source.lines else "")
    problem = line.error or _alone(line)
    return Program(source, [line], end=1, inch=inch, problems=[problem] if problem is not None else [])


def _alone(line: nodes.KlartextLine) -> Diagnostic | None:
    """Why this block means nothing on its own, None where it does."""
    node = line.node
    column = getattr(node, "column", 1) or 1
    if line.skip:
        return _refuse(1, "/ skips a program block and has no meaning in MDI")
    for kind, why in _NEEDS_OTHERS:
        if isinstance(node, kind):
            return _refuse(column, why)
    if isinstance(node, nodes.Move):
        if node.form.startswith(("APPR", "DEP")):
            return _refuse(
                column,
                Message(
                    "{form} approaches or departs from a contour and cannot be used in MDI", form=node.form
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
    if isinstance(node, nodes.CycleLine) and node.number == 12:
        return _refuse(column, "Cycle 12 selects another program and cannot be used in MDI")
    return None


def _refuse(column: int, what: str) -> Diagnostic:
    return refusal(1, column, "not-alone-mdi", Message("{what}.", what=what), _HINT)

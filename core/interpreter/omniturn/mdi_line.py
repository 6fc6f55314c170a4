"""One line on its own, as it is typed in MDI: read like a line of a program, without what needs others."""

from __future__ import annotations

from core.interpreter.diagnostic_log import refusal
from core.interpreter.omniturn import code_table
from core.interpreter.omniturn.loops_and_subroutines import Structure
from core.interpreter.omniturn.omniturn_program import Program, read_statement
from core.interpreter.omniturn.omniturn_statement import PLANE, UNREADABLE, Statement
from core.language.diagnostics import Diagnostic, ProgramError
from core.language.source import Source

_WHY = {
    "LS": "begins a loop, and its lines and LF would have to follow",
    "LF": "ends a loop, and there is none",
    "}": "begins a subroutine, and those stand in programs",
    "RF": "ends a contour, and there is none",
    "P": "calls a subroutine, and those stand in programs",
    "M95": "calls a subroutine, and those stand in programs",
    "M97": "calls a subroutine, and those stand in programs",
    "M98": "calls a subroutine, and those stand in programs",
    "M99": "ends a subroutine, and there is none",
    PLANE: "belongs to plane switching, whose lines would have to follow",
}
_MODAL = {
    35: "needs a G92 on the next line",
    36: "needs a G92 on the next line",
    40: "ends nose compensation, which looks at the lines around it",
    41: "begins nose compensation, which looks at the lines that follow",
    42: "begins nose compensation, which looks at the lines that follow",
}
_HINT = "Write it in a program."


def read_single(source: Source) -> Program:
    """A line of MDI as a program of one line that needs no end. Raises nothing.

    Refused is what has no meaning without other lines, with its column.
    """
    text = source.lines[0] if source.lines else ""
    try:
        made, problems = read_statement(1, text)
    except ProgramError as problem:
        made, problems = None, [problem.diagnostic]
    if made is not None and not problems:
        refused = _alone(made)
        problems = [refused] if refused is not None else []
    executable = made is not None and made.executable
    unknown = (made,) if made is not None and made.m not in {None, *code_table.M_KNOWN} else ()
    return Program(
        source=source,
        steps=[made],
        structure=Structure({}, {}, {}, {}, 1, {}),
        diagnostics=tuple(problems),
        blocks=int(executable),
        names_units=True,
        m_codes=unknown,
    )


def _alone(made: Statement) -> Diagnostic | None:
    """Why this line means nothing on its own, None where it does."""
    if made.flow and made.flow != UNREADABLE:
        word = made.m_word.text if made.flow in {"M95", "M97", "M98", "M99"} and made.m_word else made.flow
        name = made.text if made.flow == PLANE else word
        return _refuse(made, 1, f"{name} {_WHY[made.flow]}")
    if made.block_delete:
        return _refuse(made, 1, "/ leaves a line of a program out, and there is nothing to leave out")
    for code in made.modal:
        if code in _MODAL:
            return _refuse(made, 1, f"G{code} {_MODAL[code]}")
    if made.one_shot in code_table.CONTOUR_CYCLES and made.code is not None:
        what = f"{made.code.text} cuts a contour, and its lines would have to follow"
        return _refuse(made, made.code.column, what)
    radius = made.words.get("R")
    if radius is not None and made.moves and made.one_shot is None:
        return _refuse(made, radius.column, f"{radius.text} rounds the corner with the next move")
    return None


def _refuse(made: Statement, column: int, what: str) -> Diagnostic:
    return refusal(made.line, column, "not-alone-mdi", f"{what}.", _HINT)

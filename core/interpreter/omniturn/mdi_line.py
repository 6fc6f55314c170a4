"""One line on its own, as it is typed in MDI: read like a line of a program, without what needs others."""

from __future__ import annotations

from core.interpreter.omniturn.code_table import FLOW_CODES, G_CODES
from core.interpreter.omniturn.loops_and_subroutines import Structure
from core.interpreter.omniturn.omniturn_program import Program, of_machine_file, read_statement
from core.interpreter.omniturn.omniturn_statement import PLANE, UNREADABLE, Statement
from core.interpreter.omniturn.plain_moves import Columns, ReadyLines
from core.language.diagnostics import Diagnostic, ProgramError, refusal
from core.language.source import Source

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
    unknown = (made,) if made is not None and of_machine_file(made) else ()
    return Program(
        source=source,
        ready=ReadyLines(Columns.empty(1), {0: made}),
        structure=Structure({}, {}, {}, {}, 1, {}),
        diagnostics=tuple(problems),
        blocks=int(executable),
        names_units=True,
        m_codes=unknown,
    )


def _alone(made: Statement) -> Diagnostic | None:
    """Why this line means nothing on its own, None where it does."""
    if made.flow and made.flow != UNREADABLE:
        return _refuse(made, 1, _steers(made))
    if made.block_delete:
        return _refuse(made, 1, "/ leaves a line of a program out, and there is nothing to leave out")
    for code in made.modal:
        if G_CODES[code].not_in_mdi:
            return _refuse(made, 1, f"G{code} {G_CODES[code].not_in_mdi}")
    if made.code is not None and made.entry.not_in_mdi:
        return _refuse(made, made.code.column, f"{made.code.text} {made.entry.not_in_mdi}")
    radius = made.words.get("R")
    if radius is not None and made.moves and made.one_shot is None:
        return _refuse(made, radius.column, f"{radius.text} rounds the corner with the next move")
    return None


def _steers(made: Statement) -> str:
    if made.flow == PLANE:
        return f"{made.text} {FLOW_CODES['~PLXC'].not_in_mdi}"
    word = made.m_word.text if made.m_word else made.flow
    return f"{word} {FLOW_CODES[made.flow].not_in_mdi}"


def _refuse(made: Statement, column: int, what: str) -> Diagnostic:
    return refusal(made.line, column, "not-alone-mdi", f"{what}.", _HINT)

"""One line on its own, as it is typed in MDI: read like a line of a program, without what needs others."""

from __future__ import annotations

from core.interpreter.omniturn.codes.code_table import FLOW_CODES, G_CODES
from core.interpreter.omniturn.flow.loops_and_subroutines import Structure
from core.interpreter.omniturn.motion.plain_moves import Columns, ReadyLines
from core.interpreter.omniturn.omniturn_program import Program, of_machine_file, read_statement
from core.interpreter.omniturn.omniturn_statement import PLANE, UNREADABLE, Statement
from core.language.diagnostics import Diagnostic, ProgramError, refusal
from core.language.source import Source
from core.message import Message

_HINT = "Use this command in a program."


def read_single(source: Source) -> Program:
    """A line of MDI as a program of one line that needs no end. Raises nothing.

    Refused is what has no meaning without other lines, with its column.
    """
    text = source.lines[0] if source.lines else ""
    try:
        statement, problems = read_statement(1, text)
    except ProgramError as problem:
        statement, problems = None, [problem.diagnostic]
    if statement is not None and not problems:
        refused = _alone(statement)
        problems = [refused] if refused is not None else []
    executable = statement is not None and statement.executable
    unknown = (statement,) if statement is not None and of_machine_file(statement) else ()
    return Program(
        source=source,
        ready=ReadyLines(Columns.empty(1), {0: statement}),
        structure=Structure({}, {}, {}, {}, 1, {}),
        diagnostics=tuple(problems),
        blocks=int(executable),
        names_units=True,
        m_codes=unknown,
    )


def _alone(statement: Statement) -> Diagnostic | None:
    """Why this line means nothing on its own, None where it does."""
    if statement.flow and statement.flow != UNREADABLE:
        return _refuse(statement, 1, _steers(statement))
    if statement.block_delete:
        return _refuse(statement, 1, "/ skips a program line and has no meaning in MDI.")
    for code in statement.modal:
        if G_CODES[code].not_in_mdi:
            return _refuse(statement, 1, Message(G_CODES[code].not_in_mdi, code=f"G{code}"))
    if statement.code is not None and statement.entry.not_in_mdi:
        return _refuse(
            statement,
            statement.code.column,
            Message(statement.entry.not_in_mdi, code=statement.code.text),
        )
    radius = statement.words.get("R")
    if radius is not None and statement.moves and statement.one_shot is None:
        return _refuse(
            statement,
            radius.column,
            Message(
                "{radius} rounds the corner with the next move, but MDI runs only one line.",
                radius=radius.text,
            ),
        )
    return None


def _steers(statement: Statement) -> str:
    if statement.flow == PLANE:
        plane = FLOW_CODES["~PLXC"]
        return Message(plane.not_in_mdi, code=statement.text)
    word = statement.m_word.text if statement.m_word else statement.flow
    return Message(FLOW_CODES[statement.flow].not_in_mdi, code=word)


def _refuse(statement: Statement, column: int, text: str) -> Diagnostic:
    return refusal(statement.line, column, "not-alone-mdi", text, _HINT)

"""Contours of SL cycles: CONTOUR DEF, DECLARE CONTOUR, contour formulas (QC10 = …) and SEL CONTOUR."""

from __future__ import annotations

import re

from core.language.formulas import Formula, FormulaError, FormulaReader, Grammar, Operation
from core.language.klartext import q_parameters
from core.language.klartext.klartext_faults import syntax, unsupported
from core.language.klartext.klartext_nodes import (
    ContourDeclare,
    ContourDef,
    ContourFormula,
    ContourPart,
    Selection,
)
from core.language.klartext.line_cursor import Cursor
from core.message import Message

_CONTOUR = re.compile(r"([PI])\s*[0-9]+\s*=?\s*")
_DEPTH = re.compile(r"DEPTH|V(?=[0-9])")
_QC = re.compile(r"QC\s*([0-9]+)")
_EQUALS = re.compile(r"=")
_HIGHEST = 99
_OPERATORS = {"|": "union", "&": "intersection", "\\": "without", "^": "either"}
_GRAMMAR = Grammar(
    number=re.compile(r"(?!)"),
    parameter=re.compile(r"(QC)\s*([0-9]{1,4})"),
    operators={sign: (10, name) for sign, name in _OPERATORS.items()},
    functions={},
)


def definition(cursor: Cursor, column: int) -> ContourDef:
    """Behind ``CONTOUR DEF``: ``P1 = LBL 1 I2 = "ISLE.H" P3 = QC4``; one depth for all is what is milled."""
    parts: list[ContourPart] = []
    while not cursor.done:
        match = cursor.take(_CONTOUR)
        if match is None:
            if cursor.keyword("VOID") or cursor.take(_DEPTH):
                raise unsupported(
                    cursor.line, cursor.column, ("CONTOUR DEF with a separate depth for one contour")
                )
            raise cursor.expected(
                "CONTOUR DEF accepts only pockets (P) and islands (I)",
                "Write, for example, P1 = LBL 1 I2 = LBL 2.",
            )
        parts.append(_where(cursor)._replace(pocket=match.group(1) == "P"))
    if not parts:
        raise cursor.expected("CONTOUR DEF does not name a contour", "Write, for example, P1 = LBL 1.")
    return ContourDef(tuple(parts), column)


def _where(cursor: Cursor) -> ContourPart:
    """A subprogram, a program of its own, or a contour that DECLARE CONTOUR has named."""
    if cursor.keyword("LBL"):
        return ContourPart(cursor.name("LBL", q_parameters.MOST_LABEL), None)
    if file := cursor.quoted():
        return ContourPart(0, None, file)
    if _QC.match(cursor.upper, cursor.at):
        return ContourPart(0, None, declared=_number(cursor))
    raise cursor.expected("Expected a contour: LBL n, a program name in quotes, or QC n")


def _number(cursor: Cursor) -> int:
    column, match = cursor.column, cursor.take(_QC)
    if match is None:
        raise cursor.expected("Expected QC and a contour number", "Write QC and a number.")
    if int(match.group(1)[:6]) > _HIGHEST:
        text = Message("Contour numbers go up to QC{highest}.", highest=_HIGHEST)
        raise syntax(cursor.line, column, text, "Use a smaller contour number.")
    return int(match.group(1))


def declaration(cursor: Cursor, column: int) -> ContourDeclare:
    """Behind ``DECLARE CONTOUR``: ``QC1 = "120.H"``. Raises ProgramError."""
    number = _number(cursor)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected(Message("Expected '=' after QC{number}", number=number))
    part = _where(cursor)
    if cursor.take(_DEPTH):
        raise unsupported(cursor.line, column, "A contour with a separate depth")
    if not cursor.done:
        raise cursor.expected("Unexpected word in DECLARE CONTOUR")
    return ContourDeclare(number, part, column)


def formula(cursor: Cursor, column: int) -> ContourFormula:
    """``QC10 = ( QC1 | QC3 ) \\ QC2``. Raises ProgramError; signs that differ need brackets."""
    number = _number(cursor)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected(Message("Expected '=' after QC{number}", number=number))
    reader = FormulaReader(_GRAMMAR, cursor.upper, cursor.at)
    try:
        made = reader.formula()
    except FormulaError as problem:
        cursor.at = problem.at
        cursor.blanks()
        raise cursor.expected(f"A contour formula joins QC by | & \\ and ^ for QC{number}") from None
    _demand_brackets(cursor, made, column)
    cursor.at = reader.at
    cursor.blanks()
    if not cursor.done:
        raise cursor.expected("A contour formula joins QC by | & \\ and ^")
    return ContourFormula(number, made, column)


def _demand_brackets(cursor: Cursor, made: Formula, column: int) -> None:
    """Raises ProgramError for two signs side by side: nobody should have to know which counts first."""
    text = re.sub(r"[^|&\\^()]", "", cursor.upper[column - 1 :])
    while re.search(r"\([^()]*\)", text):
        inner = re.search(r"\(([^()]*)\)", text)
        assert inner is not None
        _demand_one_sign(cursor, inner.group(1), column)
        text = text.replace(inner.group(0), "", 1)
    if isinstance(made, Operation):
        _demand_one_sign(cursor, text, column)


def _demand_one_sign(cursor: Cursor, signs: str, column: int) -> None:
    if len(set(signs)) > 1:
        text = Message(
            "A contour formula mixes {signs} without parentheses.", signs=" and ".join(sorted(set(signs)))
        )
        raise syntax(cursor.line, column, text, "Add parentheses.")


def selection(cursor: Cursor, column: int) -> Selection | ContourFormula:
    """Behind ``SEL CONTOUR``: a program with contour formulas, or a contour QC. Raises ProgramError."""
    if _QC.match(cursor.upper, cursor.at):
        reader = FormulaReader(_GRAMMAR, cursor.upper, cursor.at)
        made, number = reader.formula(), _number(cursor)
        if not cursor.done:
            raise cursor.expected("Unexpected word in SEL CONTOUR")
        return ContourFormula(number, made, column, selected=True)
    name = cursor.text_name() or cursor.rest().strip('"')
    if not name:
        raise cursor.expected("SEL CONTOUR needs a program name")
    return Selection("CONTOUR", name, column)

"""Contours of SL cycles: CONTOUR DEF."""

from __future__ import annotations

import re

from core.language.klartext import q_parameters
from core.language.klartext.klartext_faults import unsupported
from core.language.klartext.klartext_nodes import ContourDef, ContourPart
from core.language.klartext.line_cursor import Cursor
from core.language.klartext.refused_codes import CONTOUR_FORMULA

_CONTOUR = re.compile(r"([PI])\s*[0-9]+\s*=?\s*")
_DEPTH = re.compile(r"DEPTH|V(?=[0-9])")
_QC = re.compile(r"QC\s*[0-9]")


def definition(cursor: Cursor, column: int) -> ContourDef:
    """Behind ``CONTOUR DEF``: ``P1 = LBL 1 I2 = "ISLE.H"``; one depth for all is what is milled."""
    parts: list[ContourPart] = []
    while not cursor.done:
        match = cursor.take(_CONTOUR)
        if match is None:
            if cursor.keyword("VOID") or cursor.take(_DEPTH):
                raise unsupported(
                    cursor.line, cursor.column, "CONTOUR DEF with a separate depth for one contour"
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
    """A subprogram, or a program of its own."""
    if cursor.keyword("LBL"):
        return ContourPart(cursor.name("LBL", q_parameters.MOST_LABEL), None)
    if file := cursor.quoted():
        return ContourPart(0, None, file)
    if _QC.match(cursor.upper, cursor.at):
        raise CONTOUR_FORMULA.error(cursor.line, cursor.column)
    raise cursor.expected("Expected a contour: LBL n, or a program name in quotes")

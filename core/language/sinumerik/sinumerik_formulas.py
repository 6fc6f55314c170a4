"""Formulas of SINUMERIK: R parameters, variables, operators and functions."""

from __future__ import annotations

import re

from core.language.formulas import FUNCTIONS, Formula, FormulaReader, Grammar
from core.language.line_reading import UNSIGNED

GRAMMAR = Grammar(
    number=re.compile(rf"{UNSIGNED}(?:EX[+-]?[0-9]{{1,3}})?"),
    # $P_… and the like are system variables, their indices are part of the name.
    parameter=re.compile(r"(R(?=[0-9\[])|\$[A-Z][A-Z0-9_]*(?:\[[^\]]*\])?|[A-Z_][A-Z_][A-Z0-9_]*)([0-9]*)"),
    operators={
        "*": (80, "times"),
        "/": (80, "over"),
        "DIV": (80, "integer quotient"),
        "MOD": (80, "remainder"),
        "+": (70, "plus"),
        "-": (70, "minus"),
        "AND": (40, "and"),
        "XOR": (30, "exclusive or"),
        "OR": (20, "or"),
        "==": (10, "equal"),
        "<>": (10, "unequal"),
        ">=": (10, "greater than or equal"),
        "<=": (10, "less than or equal"),
        ">": (10, "greater"),
        "<": (10, "less"),
    },
    functions={
        **FUNCTIONS,
        "ATAN2": "direction",
        "POT": "square",
        "TRUNC": "integer part",
        "ROUND": "nearest whole number",
        "MINVAL": "smaller",
        "MAXVAL": "larger",
        "NOT": "not",
    },
    constants={"TRUE": 1.0, "FALSE": 0.0, "$PI": 3.141592653589793},
    separator=",",
    negation=90,
    indexed=True,
)
"""Formulas behind ``=``, in brackets of a target, and of conditions. Comparisons bind weakest of all."""


def formula_at(text: str, at: int) -> tuple[Formula, int]:
    """Return the formula that begins at ``at``, and the index behind it. Raises FormulaError."""
    reader = FormulaReader(GRAMMAR, text, at)
    return reader.formula(), reader.at

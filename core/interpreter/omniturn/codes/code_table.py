"""Table of all OmniTurn codes, with one entry for each code.

An entry contains the form, words, meaning of F, group, limits and errors of a code. The entries are in
``move_codes``, ``cycle_codes`` and ``flow_codes``. Codes without an entry do not exist.

``handler`` names the function that executes the code, as ``folder.file:name`` in this dialect's package.
``action_kind`` determines the order of the actions on a line. An invalid entry raises an error when the
table is loaded, or fails ``tests/interpreter/test_code_table.py``. ``language_page`` generates
``docs/language.md`` from this table. The examples in the table are proved.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

from core.interpreter.omniturn.codes.code_entry import PLAIN_WORDS, ActionKind, CodeEntry, FMeaning
from core.interpreter.omniturn.codes.cycle_codes import CYCLE_CHAPTERS
from core.interpreter.omniturn.codes.flow_codes import FLOW_CHAPTERS
from core.interpreter.omniturn.codes.move_codes import MOVE_CHAPTERS

PLAIN_LINE_ENTRY = CodeEntry(
    "", "", "", "", action_kind=ActionKind.PLAIN_MOVE, handler="motion.straight_moves:make_statement_move",
    allowed_words=PLAIN_WORDS, f_meaning=FMeaning.FEED
)  # fmt: skip

CODE_CHAPTERS = (*MOVE_CHAPTERS, *CYCLE_CHAPTERS, *FLOW_CHAPTERS)
"""All code chapters in page order, each with its title and codes."""

G_CODES = {int(code.name[1:]): code for _, codes in CODE_CHAPTERS for code in codes if code.name[0] == "G"}
"""G codes by number. One-shot codes apply only to their own line, and a line can contain one of them."""

M_CODES = {
    int(code.name[1:]): code
    for _, codes in CODE_CHAPTERS
    for code in codes
    if code.name[0] == "M" and code.action_kind is not ActionKind.FLOW
}
"""M codes of the control, by number. The machine file defines all others."""

LETTER_ENTRIES = {
    code.name: code for _, codes in CODE_CHAPTERS for code in codes if code.action_kind is ActionKind.WORD
}
"""Words that have their own entry in the list of codes, by word."""

FLOW_CODES = {
    code.name: code for _, codes in CODE_CHAPTERS for code in codes if code.action_kind is ActionKind.FLOW
}
"""Codes that control the order of execution, by name.

``allowed_words`` lists exactly the words that the line can contain.
"""


def load_handler(code: CodeEntry) -> Callable[..., Any]:
    """Return the function that executes a code, and import its module on first use."""
    return _function(code.handler)


@cache
def _function(handler: str) -> Callable[..., Any]:
    file, _, path = handler.partition(":")
    found: Any = import_module(f"core.interpreter.omniturn.{file}")
    for name in path.split("."):
        found = getattr(found, name)
    function: Callable[..., Any] = found
    return function

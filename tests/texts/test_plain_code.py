"""Names, comments and docstrings of the product contain none of the words that the glossary replaces."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tests.glossary import avoided

ROOT = Path(__file__).parents[2]
UNCLEAR_NAMES = frozenset({"look", "of", "take", "go", "told", "along", "out", "way", "on"})
"""Names that say neither what a function does nor what a value is."""
ACCEPTED_NAMES = frozenset(
    {
        "core/machine/machine_tables.py: on",
        "drivers/hal/hal_table.py: on",
        "drivers/inverter/family_table.py: on",
        "core/extras/sharing/sharing_table.py: look",
    }
)
"""Keys of the machine file."""
NOT_CHECKED = frozenset({"kept", "keeps", "centre", "slides", "palms", "millimetre", "is no", "is none"})
"""Words that only texts for readers must not contain, or that are normal in "if there is no"."""
ACCEPTED: dict[str, frozenset[str]] = {
    "figures": frozenset(
        {
            "drivers/hal/bridge/hal_bridge.py",
            "drivers/hal/bridge/packets.py",
            "drivers/hal/hal_link.py",
            "drivers/hal/hal_session.py",
        }
    ),
    "trouble": frozenset(
        {"app/extras/pendant/driver/pendant_station.py", "core/executor/station_signals.py", "core/ports.py"}
    ),
    "behind": frozenset(
        {
            "core/interpreter/code_book_page.py",
            "core/interpreter/omniturn/codes/omniturn_book.py",
            "core/language/code_book.py",
        }
    ),
    "way": frozenset({"drivers/hal/hal_axes.py"}),
    "anew": frozenset({"app/cli/run_command.py"}),
}
"""Files with keys of files and messages that other programs read, by the word that they contain."""


@cache
def sources() -> dict[str, str]:
    paths = (path for top in ("app", "core", "drivers") for path in sorted((ROOT / top).rglob("*.py")))
    return {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in paths}


@cache
def words_of_code() -> dict[str, str]:
    return {name: "\n".join(iter_words(text)) for name, text in sources().items()}


def iter_words(text: str) -> Iterator[str]:
    """Names, comments and docstrings; other strings are texts, which have tests of their own."""
    docstrings = {
        node.body[0].lineno
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node)
    }
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in {tokenize.NAME, tokenize.COMMENT} or token.start[0] in docstrings:
            yield token.string


def iter_defined_names(tree: ast.AST) -> Iterator[str]:
    """Functions, and fields of classes."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            yield node.name
        if isinstance(node, ast.ClassDef):
            fields = (each.target for each in node.body if isinstance(each, ast.AnnAssign))
            yield from (each.id for each in fields if isinstance(each, ast.Name))


@pytest.mark.parametrize("word", sorted({*avoided(), "told"} - NOT_CHECKED))
def test_code_does_not_contain_avoided_word(word: str) -> None:
    found = re.compile(rf"\b{re.escape(word)}\b")
    assert {name for name, text in words_of_code().items() if found.search(text)} == ACCEPTED.get(word, set())


def test_functions_and_fields_do_not_have_unclear_names() -> None:
    found = {
        f"{name}: {each}"
        for name, text in sources().items()
        for each in iter_defined_names(ast.parse(text))
        if each in UNCLEAR_NAMES
    }
    assert found == ACCEPTED_NAMES

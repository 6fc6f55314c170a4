"""Names, comments and docstrings of the product contain none of the words that the glossary replaces."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from tests.glossary import avoided

HOUSE = Path(__file__).parents[2]
RIDDLES = frozenset({"look", "of", "take", "go", "told", "along", "out", "way", "on"})
"""Names that say neither what a function does nor what a value is."""

ACCEPTED: dict[str, int] = {}
"""Uses of a word in code that have another meaning, by the word."""


@cache
def sources() -> dict[str, str]:
    paths = (path for top in ("app", "core", "drivers") for path in sorted((HOUSE / top).rglob("*.py")))
    return {path.relative_to(HOUSE).as_posix(): path.read_text("utf-8") for path in paths}


def written(text: str) -> Iterator[str]:
    """Names, comments and docstrings; other strings are texts, which have tests of their own."""
    docstrings = {
        node.body[0].lineno
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node)
    }
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in {tokenize.NAME, tokenize.COMMENT} or token.start[0] in docstrings:
            yield token.string


def public_names(tree: ast.AST) -> Iterator[str]:
    """Functions, methods and fields of classes."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            yield node.name
        if isinstance(node, ast.ClassDef):
            fields = (each.target for each in node.body if isinstance(each, ast.AnnAssign))
            yield from (each.id for each in fields if isinstance(each, ast.Name))


def test_no_code_contains_a_word_that_the_glossary_replaces() -> None:
    words = re.compile(rf"\b({'|'.join(map(re.escape, avoided()))})\b")
    found = Counter(
        word for text in sources().values() for each in written(text) for word in words.findall(each)
    )
    assert {word: count for word, count in found.items() if count > ACCEPTED.get(word, 0)} == {}


def test_no_function_and_no_field_is_named_by_a_riddle() -> None:
    found = {
        f"{name}: {each}"
        for name, text in sources().items()
        for each in public_names(ast.parse(text))
        if each in RIDDLES
    }
    assert sorted(found) == []

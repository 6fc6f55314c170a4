"""Texts in a syntax tree: whole strings, templates of messages, and strings that are composed of parts."""

from __future__ import annotations

import ast
from collections.abc import Iterator

_MARKS = frozenset({"tr", "Message", "end_interrupted_runs"})
_WITH_VALUES = frozenset({"DriverError", "ScriptError", "Fault"})  # templates where values follow by name
_OF_PAGES = frozenset({"meaning", "purpose"})  # of keys of the machine file, for its page
_MISTAKES = frozenset(
    {"ValueError", "RuntimeError", "TypeError", "TimeoutError", "KeyError", "AssertionError"}
    # ValueErrors with a code, whose texts are not translated either
    | {"CodeEntryError", "GaugeError", "PartError", "ShiftTimesError"}
)


def find_marked_texts(tree: ast.Module) -> Iterator[str]:
    """Yield the texts in ``tr("…")`` and the templates of messages, regardless of their contents."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and node.args and _is_marked(node):
            for part in ast.walk(node.args[0]):
                if isinstance(part, ast.Constant) and isinstance(part.value, str):
                    yield part.value


def _is_marked(call: ast.Call) -> bool:
    name = _name(call.func)
    return name in _MARKS or (name in _WITH_VALUES and any(each.arg != "reason" for each in call.keywords))


def find_texts(tree: ast.Module) -> Iterator[str]:
    """Yield every whole string except docstrings, errors for programmers, patterns and log messages."""
    skipped = _skipped(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr | ast.BinOp) and _pieces(node) is not None:
            skipped.update(id(part) for part in _own_parts(node))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in skipped:
            yield node.value


def find_composed_texts(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield the line number and the text of every string that is composed of parts.

    In the text, ``{}`` replaces each value.
    """
    skipped = _skipped(tree)
    for node in ast.walk(tree):
        if id(node) not in skipped and isinstance(node, ast.JoinedStr | ast.BinOp):
            pieces = _pieces(node)
            if pieces is not None and None in pieces:
                skipped.update(id(part) for part in _own_parts(node))
                yield node.lineno, "".join("{}" if piece is None else piece for piece in pieces)


def _skipped(tree: ast.Module) -> set[int]:
    """Return the ids of the nodes in docstrings, errors for programmers, patterns and log messages."""
    found: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            found.add(id(node.value))
        elif isinstance(node, ast.Call) and _is_silent(node.func):
            found.update(id(part) for part in ast.walk(node))
        elif isinstance(node, ast.keyword) and node.arg in _OF_PAGES:
            found.update(id(part) for part in ast.walk(node.value))
    return found


def _is_silent(called: ast.expr) -> bool:
    if isinstance(called, ast.Attribute) and _name(called.value) == "_log":
        return True
    return _name(called) in _MISTAKES | {"compile", "execute", "executescript", "names"}


def _name(node: ast.expr) -> str:
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def _pieces(node: ast.expr) -> list[str | None] | None:
    """Return the parts of a composed string, in which None represents a value.

    Returns None if the node is not a string.
    """
    if isinstance(node, ast.Constant):
        return [node.value] if isinstance(node.value, str) else None
    if isinstance(node, ast.JoinedStr):
        return [str(v.value) if isinstance(v, ast.Constant) else None for v in node.values]
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        left, right = _pieces(node.left), _pieces(node.right)
        if left is None and right is None:
            return None
        return (left or [None]) + (right or [None])
    return None


def _own_parts(node: ast.expr) -> Iterator[ast.AST]:
    """Yield the syntax nodes that are parts of a string, except the expressions of inserted values."""
    yield node
    if isinstance(node, ast.JoinedStr):
        yield from (value for value in node.values if isinstance(value, ast.Constant))
        for value in node.values:
            if isinstance(value, ast.FormattedValue) and value.format_spec is not None:
                yield from ast.walk(value.format_spec)
    elif isinstance(node, ast.BinOp):
        yield from _own_parts(node.left)
        yield from _own_parts(node.right)

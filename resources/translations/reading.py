"""Texts in a syntax tree: whole ones, and those that are put together, with holes for what is put in."""

from __future__ import annotations

import ast
from collections.abc import Iterator

_MISTAKES = frozenset(
    {"ValueError", "RuntimeError", "TypeError", "TimeoutError", "KeyError", "AssertionError"}
    # ValueErrors with a code, whose texts are not translated either
    | {"CodeEntryError", "GaugeError", "PartError", "ShiftTimesError"}
)


def marked(tree: ast.Module) -> Iterator[str]:
    """What stands in ``tr("…")``: whatever it looks like, it is read."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and _name(node.func) == "tr" and node.args:
            for part in ast.walk(node.args[0]):
                if isinstance(part, ast.Constant) and isinstance(part.value, str):
                    yield part.value


def texts_of(tree: ast.Module) -> Iterator[str]:
    """Every string of a module but docstrings, programmer's mistakes, patterns and logs."""
    skipped = _skipped(tree)
    inner: set[int] = set()
    for node in ast.walk(tree):
        if id(node) in skipped:
            continue
        if isinstance(node, ast.JoinedStr | ast.BinOp) and id(node) not in inner:
            pieces = _pieces(node)
            if pieces is not None:
                inner.update(id(part) for part in _own_parts(node))
                yield _with_holes(pieces)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in inner:
            yield node.value


def _skipped(tree: ast.Module) -> set[int]:
    """Docstrings, mistakes of the programmer, patterns and logs; with all that is in them."""
    found: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            found.add(id(node.value))
        elif isinstance(node, ast.Call) and _is_silent(node.func):
            found.update(id(part) for part in ast.walk(node))
    return found


def _is_silent(called: ast.expr) -> bool:
    if isinstance(called, ast.Attribute) and _name(called.value) == "_log":
        return True
    return _name(called) in _MISTAKES | {"compile", "execute", "executescript"}


def _name(node: ast.expr) -> str:
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def _pieces(node: ast.expr) -> list[str | None] | None:
    """The text of a composed string, None for each hole; None when it is no string at all."""
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
    """The parts that became pieces; expressions in holes are looked at by themselves."""
    yield node
    if isinstance(node, ast.JoinedStr):
        yield from (value for value in node.values if isinstance(value, ast.Constant))
        for value in node.values:
            if isinstance(value, ast.FormattedValue) and value.format_spec is not None:
                yield from ast.walk(value.format_spec)
    elif isinstance(node, ast.BinOp):
        yield from _own_parts(node.left)
        yield from _own_parts(node.right)


def _with_holes(pieces: list[str | None]) -> str:
    number, text = 0, ""
    for piece in pieces:
        if piece is None:
            number += 1
            text += f"%{number}"
        else:
            text += piece
    return text

"""Small changes of the code of functions, one at a time: what tests of a room must notice.

A mutant is made from the source of its module and put into the function that is loaded already, so that a
process that has everything loaded can be forked for each.
"""

from __future__ import annotations

import ast
import copy
import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

Change = Callable[[ast.AST], ast.AST | None]  # the node instead; None: no statement instead

_PAIRS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip
_CALLS = {"min": "max", "max": "min", "any": "all", "all": "any"}


@dataclass(frozen=True, slots=True)
class Mutant:
    """``place`` counts the nodes of the module's tree, ``kind`` says which change of it."""

    path: str
    function: str  # qualified, of the outermost function
    first: int  # line of the statement
    line: int
    place: int
    kind: str
    words: str

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.path}:{self.line} {self.function}: {self.words}"


def mutants_of(path: Path) -> list[Mutant]:
    """Every change of every function of a module."""
    tree = ast.parse(path.read_text())
    places = {id(node): number for number, node in enumerate(ast.walk(tree))}
    begins = {
        id(node): statement.lineno
        for statement in ast.walk(tree)  # inner ones come later
        if isinstance(statement, ast.stmt)
        for node in ast.walk(statement)
    }
    found = []
    for function, name in _functions(tree, ""):
        for node in _nodes(function):
            for kind, words in _kinds(node):
                at = places[id(node)]
                found.append(Mutant(str(path), name, begins[id(node)], node.lineno, at, kind, words))
    return found


def _functions(node: ast.AST, above: str) -> Iterator[tuple[ast.FunctionDef, str]]:
    """Outermost functions, those of classes too; protocols have no code."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef):
            yield child, f"{above}{child.name}"
        elif isinstance(child, ast.ClassDef) and "Protocol" not in map(ast.unparse, child.bases):
            yield from _functions(child, f"{above}{child.name}.")


def _nodes(function: ast.FunctionDef) -> Iterator[Any]:
    """What is executed in it: no annotations, no docstrings, nothing that a log or an error only says."""
    for statement in function.body:
        waiting: list[ast.AST] = [statement]
        while waiting:
            node = waiting.pop()
            if isinstance(node, ast.Raise | ast.JoinedStr | ast.Assert):
                continue
            if isinstance(node, ast.expr | ast.stmt):
                yield node
            skipped = {"annotation", "returns", "decorator_list"}
            for name, value in ast.iter_fields(node):
                if name not in skipped:
                    waiting += [each for each in (value if isinstance(value, list) else [value]) if _is(each)]


def _is(value: object) -> bool:
    return isinstance(value, ast.AST)


def _kinds(node: ast.AST) -> Iterator[tuple[str, str]]:
    """The changes that a node allows, each with its words."""
    text = ast.unparse(node).splitlines()[0][:70]
    match node:
        case ast.Compare(ops=[op]) if type(op) in _PAIRS:
            yield "swap", f"{text} with {_PAIRS[type(op)].__name__}"
        case ast.BinOp(op=op) | ast.BoolOp(op=op) | ast.AugAssign(op=op) if type(op) in _PAIRS:
            yield "swap", f"{text} with {_PAIRS[type(op)].__name__}"
        case ast.UnaryOp(op=ast.Not() | ast.USub()):
            yield "bare", f"{text} without its sign"
        case ast.Constant(value=bool() | int() | float()):
            yield "constant", f"{text} is another"
        case ast.If() | ast.IfExp() | ast.While():
            yield "negate", f"{text} the other way"
        case ast.Expr(value=ast.Call()):
            yield "drop", f"{text} left out"
        case ast.Assign(targets=[ast.Attribute()]):
            yield "drop", f"{text} left out"
        case ast.Return(value=ast.expr() as value) if not isinstance(value, ast.Constant):
            yield "nothing", f"{text} returns None"
        case ast.Call(func=ast.Name(id=name)) if name in _CALLS:
            yield "call", f"{text} with {_CALLS[name]}"


def _changed(node: Any, kind: str) -> ast.AST:
    match kind:
        case "swap" if isinstance(node, ast.Compare):
            other: Any = _PAIRS[type(node.ops[0])]()
            node.ops = [other]
        case "swap":
            node.op = _PAIRS[type(node.op)]()
        case "bare":
            operand: ast.AST = node.operand
            return operand
        case "constant":
            node.value = (not node.value) if isinstance(node.value, bool) else node.value + 1
        case "negate":
            node.test = ast.UnaryOp(ast.Not(), node.test)
        case "drop":
            return ast.Pass()
        case "nothing":
            node.value = None
        case "call":
            node.func.id = _CALLS[node.func.id]
    changed: ast.AST = node
    return changed


class _At(ast.NodeTransformer):
    """Replaces one node, known by itself."""

    def __init__(self, wanted: ast.AST, kind: str) -> None:
        self._wanted, self._kind = wanted, kind

    def visit(self, node: ast.AST) -> Any:
        if node is self._wanted:
            return ast.copy_location(_changed(node, self._kind), node)
        return self.generic_visit(node)


def code_of(mutant: Mutant) -> CodeType:
    """The code of the function with the change."""
    tree = copy.deepcopy(ast.parse(Path(mutant.path).read_text()))
    node = next(each for number, each in enumerate(ast.walk(tree)) if number == mutant.place)
    module = ast.fix_missing_locations(_At(node, mutant.kind).visit(tree))
    return next(
        code
        for code in _codes(compile(module, mutant.path, "exec"))
        if code.co_qualname == mutant.function and "<locals>" not in code.co_qualname
    )


def _codes(code: CodeType) -> Iterator[CodeType]:
    for each in code.co_consts:
        if isinstance(each, CodeType):
            yield each
            yield from _codes(each)


def put_in(mutant: Mutant) -> bool:
    """Change the function that is loaded; False where it cannot be found behind what decorates it."""
    owner: Any = import_module(mutant.path.removesuffix(".py").replace("/", "."))
    *above, name = mutant.function.split(".")
    for each in above:
        owner = getattr(owner, each)
    code = code_of(mutant)
    for function in _behind(vars(owner).get(name)):
        if function.__code__.co_qualname == mutant.function and function.__code__.co_firstlineno == (
            code.co_firstlineno
        ):
            function.__code__ = code
            return True
    return False


def _behind(found: Any) -> Iterator[FunctionType]:
    """The functions of a property, a class method, a decorated function."""
    match found:
        case property():
            yield from _behind(found.fget)
            yield from _behind(found.fset)
        case staticmethod() | classmethod():
            yield from _behind(found.__func__)
        case functools.cached_property():
            yield from _behind(found.func)
        case FunctionType():
            yield found
            yield from _behind(getattr(found, "__wrapped__", None))
        case _ if found is not None:
            yield from _behind(getattr(found, "__wrapped__", None))

"""Shapes from a file: steps with the fields of the forms, one behind the other, as the page writes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from app.extras.shapes.shape_form import COLUMNS, ShapeForm
from core.extras.shapes.lines.code_lines import plain
from core.extras.shapes.pieces import begun, setting_at, with_shape
from core.extras.shapes.shape import Shape
from core.extras.shapes.shape_fields import WORDS, Kind, Setting
from core.extras.shapes.shape_table import SHAPES_OF
from core.extras.shapes.templates import HEAD
from core.language.source import Dialect
from core.message import Message, nearest

KIND, POINTS = "kind", "points"
_KEYS = {"KIND": "edge_kind"}  # the field of EDGE TURN that would be called as the step's own

Step = Mapping[str, object]


class StepError(Exception):
    """Steps that make no program; each mistake names its step and its key."""

    def __init__(self, mistakes: Sequence[str]) -> None:
        super().__init__("; ".join(mistakes))


@dataclass(frozen=True, slots=True)
class Written:
    """The program; ``kinds`` are the steps, ``words`` what is to be said of their lines."""

    lines: tuple[str, ...]
    kinds: tuple[str, ...]
    words: tuple[str, ...]


def kinds_of(dialect: Dialect) -> dict[str, Shape]:
    """The shapes by the name that a step has for them."""
    return {shape.name.lower(): shape for shape in SHAPES_OF[dialect].values()}


def keys_of(shape: Shape) -> dict[str, str]:
    """By the keys of a step the words of its fields; a contour has points besides."""
    return {_KEYS.get(each.word, each.word.lower()): each.word for each in shape.fields}


def written(steps: Sequence[Step], new: Setting) -> Written:
    """The program of these steps, as the forms write them. Raises StepError."""
    shapes = [_shape(number, step, new.dialect) for number, step in enumerate(steps, 1)]
    mistakes = [text for number, step in enumerate(steps, 1) for text in _strange(number, step, shapes)]
    if mistakes := [*(each for each in shapes if isinstance(each, str)), *mistakes]:
        raise StepError(mistakes)
    lines: list[str] = []
    at, said = 0, list[str]()
    for number, (step, shape) in enumerate(zip(steps, shapes, strict=True), 1):
        assert isinstance(shape, Shape)
        if shape.name != HEAD.name and not begun(lines, new.dialect):
            raise StepError(
                [
                    Message(
                        "step {number}: a program must begin with a head; put a step with kind = "
                        '"head" first',
                        number=number,
                    )
                ]
            )
        form = _form(number, step, shape, setting_at(lines, at, new.shop, new))
        lines, at = with_shape(lines, at, form.one, form.setting)
        said += [
            Message("step {number}, {shape}: {word}", number=number, shape=shape.name.lower(), word=word)
            for word in form.words
        ]
    return Written(
        tuple(lines), tuple(each.name.lower() for each in shapes if isinstance(each, Shape)), tuple(said)
    )


def _shape(number: int, step: Step, dialect: Dialect) -> Shape | str:
    """The shape of a step, else what is wrong with its kind."""
    kinds = kinds_of(dialect)
    kind = step.get(KIND)
    if not isinstance(kind, str):
        return Message("step {number} has no kind; use one of {kinds}", number=number, kinds=", ".join(kinds))
    name = " ".join(kind.lower().replace("-", " ").replace("_", " ").split())
    if name in kinds:
        return kinds[name]
    near = nearest(name, kinds)
    return Message(
        "step {number}: kind {kind} does not exist; {nearest}",
        number=number,
        kind=kind,
        nearest=f"did you mean {near}?" if near else f"use one of {', '.join(kinds)}",
    )


def _strange(number: int, step: Step, shapes: Sequence[Shape | str]) -> list[str]:
    """Keys that its shape has not, and values that are neither figures nor words."""
    shape = shapes[number - 1]
    if isinstance(shape, str):
        return []
    keys = {KIND, *keys_of(shape), *((POINTS,) if shape.contour else ())}
    found: list[str] = []
    for key, value in step.items():
        where = Message("step {number}, {shape}", number=number, shape=shape.name.lower())
        if key not in keys:
            near = nearest(key, keys)
            found.append(
                Message(
                    "{place}: {key} is unknown; {nearest}",
                    place=where,
                    key=key,
                    nearest=f"did you mean {near}?" if near else f"known: {', '.join(sorted(keys))}",
                )
            )
        elif key != POINTS and (isinstance(value, bool) or not isinstance(value, int | float | str)):
            found.append(Message("{place}: {key} must be a number or a word", place=where, key=key))
    return found


def _form(number: int, step: Step, shape: Shape, setting: Setting) -> ShapeForm:
    """The form with what the step says typed into it. Raises StepError with what the form refuses."""
    form = ShapeForm(shape, setting)
    where = Message("step {number}, {shape}", number=number, shape=shape.name.lower())
    for key, word in keys_of(shape).items():
        if key in step:
            known = shape.field(word)
            assert known is not None
            said = _text(step[key])
            form.typed[word] = said.upper() if known.kind in WORDS else said
            if known.kind is Kind.CHOICE and known.choices and form.typed[word] not in known.choices:
                raise StepError(
                    [
                        Message(
                            "{place}: {key} cannot be {text}; use one of {choices}",
                            place=where,
                            key=key,
                            text=said,
                            choices=", ".join(known.choices).lower(),
                        )
                    ]
                )
    if POINTS in step:
        form.rows = _rows(where, step[POINTS])
    form.work()
    if form.troubles:
        raise StepError([f"{where}: {_key(shape, word)}: {text}" for word, text in form.troubles.items()])
    return form


def _rows(where: str, points: object) -> list[dict[str, str]]:
    """Points as the form has them: x, z, and chamfer c, radius r or arc a."""
    if not isinstance(points, list) or not all(isinstance(each, dict) for each in points):
        raise StepError(
            [
                Message(
                    "{place}: points must be a list, such as [{{x = .5, z = 0}}, {{z = -1, r = .1}}]",
                    place=where,
                )
            ]
        )
    for count, point in enumerate(points, 1):
        for key in point:
            if key.upper() not in COLUMNS:
                raise StepError(
                    [
                        Message(
                            "{place}: point {count}: key {key} is unknown; use one of {columns}",
                            place=where,
                            count=count,
                            key=key,
                            columns=", ".join(COLUMNS).lower(),
                        )
                    ]
                )
    return [{key.upper(): _text(value) for key, value in point.items()} for point in points]


def _text(value: object) -> str:
    return plain(float(value), 6) if isinstance(value, int | float) else str(value)


def _key(shape: Shape, word: str) -> str:
    """A field as a step calls it; a row of points keeps its number."""
    return next((key for key, own in keys_of(shape).items() if own == word), f"point {word.lstrip('#')}")

"""Shapes from a file: steps with the fields of the forms, written as in the editor."""

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
_KEYS = {"KIND": "edge_kind"}  # The field KIND of EDGE TURN would conflict with the key of the step.

Step = Mapping[str, object]


class StepError(Exception):
    """Error for invalid steps. Each message names the step and the key."""

    def __init__(self, mistakes: Sequence[str]) -> None:
        super().__init__("; ".join(mistakes))


@dataclass(frozen=True, slots=True)
class Written:
    """Generated program.

    ``kinds`` are the kinds of the steps, and ``words`` are remarks about the lines.
    """

    lines: tuple[str, ...]
    kinds: tuple[str, ...]
    words: tuple[str, ...]


def kinds_of(dialect: Dialect) -> dict[str, Shape]:
    """Return the shapes of a language by the kind of their step."""
    return {shape.name.lower(): shape for shape in SHAPES_OF[dialect].values()}


def keys_of(shape: Shape) -> dict[str, str]:
    """Return the words of a shape's fields by the key of the step."""
    return {_KEYS.get(each.word, each.word.lower()): each.word for each in shape.fields}


def written(steps: Sequence[Step], new: Setting) -> Written:
    """Return the program of the steps, as the forms write it. Raises StepError."""
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
    """Return the shape of a step, or an error message about its kind."""
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
    """Return error messages about unknown keys and invalid values of a step."""
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
    """Return the form with the values of a step. Raises StepError if the form rejects them."""
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
    """Return the entries of points: x, z, and chamfer c, radius r or arc a. Raises StepError."""
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
    """Return the key of a field in a step, or ``point`` with a number."""
    return next((key for key, own in keys_of(shape).items() if own == word), f"point {word.lstrip('#')}")

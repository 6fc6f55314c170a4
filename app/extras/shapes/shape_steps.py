"""Generation of a program from a file of steps, each of which contains the fields of one form.

The generated program is identical to the program that the editor's forms write.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from app.extras.shapes.shape_form import POINT_COLUMNS, ShapeForm
from core.extras.shapes.editor_shape import Shape
from core.extras.shapes.lines.code_lines import format_short_number
from core.extras.shapes.shape_fields import TEXT_KINDS, FieldKind, ProgramSettings
from core.extras.shapes.shape_pieces import find_active_settings, has_units, insert_shape
from core.extras.shapes.shape_table import SHAPES_BY_DIALECT
from core.extras.shapes.templates import HEAD_SHAPE
from core.language.source import Dialect
from core.message import Message, find_similar_word

KIND, POINTS = "kind", "points"
_KEYS = {"KIND": "edge_kind"}  # The field KIND of EDGE TURN would conflict with the key of the step.

ShapeStep = Mapping[str, object]


class InvalidStepError(Exception):
    """Error raised if steps are invalid.

    Each part of the message names the step and the key.
    """

    def __init__(self, mistakes: Sequence[str]) -> None:
        super().__init__("; ".join(mistakes))


@dataclass(frozen=True, slots=True)
class GeneratedProgram:
    """Program that was generated from steps.

    ``step_kinds`` are the kinds of the steps. ``remarks`` contains notes about the program lines.
    """

    program_lines: tuple[str, ...]
    step_kinds: tuple[str, ...]
    remarks: tuple[str, ...]


def get_shapes_by_kind(dialect: Dialect) -> dict[str, Shape]:
    """Return the shapes of a programming language, by the kind that a step specifies."""
    return {shape.name.lower(): shape for shape in SHAPES_BY_DIALECT[dialect].values()}


def map_keys_to_fields(shape: Shape) -> dict[str, str]:
    """Return the field names of a shape, by the key that a step uses."""
    return {_KEYS.get(each.name, each.name.lower()): each.name for each in shape.fields}


def generate_program(steps: Sequence[ShapeStep], settings: ProgramSettings) -> GeneratedProgram:
    """Return the program that the forms write for the steps.

    Raises InvalidStepError if a step is invalid, or if the first step is not a program head.
    """
    shapes = [_shape(number, step, settings.dialect) for number, step in enumerate(steps, 1)]
    mistakes = [text for number, step in enumerate(steps, 1) for text in _strange(number, step, shapes)]
    if mistakes := [*(each for each in shapes if isinstance(each, str)), *mistakes]:
        raise InvalidStepError(mistakes)
    lines: list[str] = []
    at, said = 0, list[str]()
    for number, (step, shape) in enumerate(zip(steps, shapes, strict=True), 1):
        assert isinstance(shape, Shape)
        if shape.name != HEAD_SHAPE.name and not has_units(lines, settings.dialect):
            raise InvalidStepError(
                [
                    Message(
                        "step {number}: a program must begin with a head; put a step with kind = "
                        '"head" first',
                        number=number,
                    )
                ]
            )
        form = _form(number, step, shape, find_active_settings(lines, at, settings.shop, settings))
        lines, at = insert_shape(lines, at, form.filled_shape, form.settings)
        said += [
            Message("step {number}, {shape}: {word}", number=number, shape=shape.name.lower(), word=word)
            for word in form.remarks
        ]
    return GeneratedProgram(
        tuple(lines), tuple(each.name.lower() for each in shapes if isinstance(each, Shape)), tuple(said)
    )


def _shape(number: int, step: ShapeStep, dialect: Dialect) -> Shape | str:
    """Return the shape of a step, or an error message about its kind."""
    kinds = get_shapes_by_kind(dialect)
    kind = step.get(KIND)
    if not isinstance(kind, str):
        return Message("step {number} has no kind; use one of {kinds}", number=number, kinds=", ".join(kinds))
    name = " ".join(kind.lower().replace("-", " ").replace("_", " ").split())
    if name in kinds:
        return kinds[name]
    near = find_similar_word(name, kinds)
    return Message(
        "step {number}: kind {kind} does not exist; {nearest}",
        number=number,
        kind=kind,
        nearest=f"did you mean {near}?" if near else f"use one of {', '.join(kinds)}",
    )


def _strange(number: int, step: ShapeStep, shapes: Sequence[Shape | str]) -> list[str]:
    """Return error messages about unknown keys and invalid values of a step."""
    shape = shapes[number - 1]
    if isinstance(shape, str):
        return []
    keys = {KIND, *map_keys_to_fields(shape), *((POINTS,) if shape.has_point_table else ())}
    found: list[str] = []
    for key, value in step.items():
        where = Message("step {number}, {shape}", number=number, shape=shape.name.lower())
        if key not in keys:
            near = find_similar_word(key, keys)
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


def _form(number: int, step: ShapeStep, shape: Shape, settings: ProgramSettings) -> ShapeForm:
    """Return the form that is filled in with the values of a step.

    Raises InvalidStepError if the form rejects a value.
    """
    form = ShapeForm(shape, settings)
    where = Message("step {number}, {shape}", number=number, shape=shape.name.lower())
    for key, word in map_keys_to_fields(shape).items():
        if key in step:
            known = shape.find_field(word)
            assert known is not None
            said = _text(step[key])
            form.entered_texts[word] = said.upper() if known.kind in TEXT_KINDS else said
            if (
                known.kind is FieldKind.CHOICE
                and known.choices
                and form.entered_texts[word] not in known.choices
            ):
                raise InvalidStepError(
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
        form.point_texts = _rows(where, step[POINTS])
    form.calculate()
    if form.error_texts:
        raise InvalidStepError(
            [f"{where}: {_key(shape, word)}: {text}" for word, text in form.error_texts.items()]
        )
    return form


def _rows(where: str, points: object) -> list[dict[str, str]]:
    """Return the typed texts of each contour point, by column.

    The keys in ``points`` are x, z, c (chamfer), r (radius) and a (arc). Raises InvalidStepError if the
    points are invalid.
    """
    if not isinstance(points, list) or not all(isinstance(each, dict) for each in points):
        raise InvalidStepError(
            [
                Message(
                    "{place}: points must be a list, such as [{{x = .5, z = 0}}, {{z = -1, r = .1}}]",
                    place=where,
                )
            ]
        )
    for count, point in enumerate(points, 1):
        for key in point:
            if key.upper() not in POINT_COLUMNS:
                raise InvalidStepError(
                    [
                        Message(
                            "{place}: point {count}: key {key} is unknown; use one of {columns}",
                            place=where,
                            count=count,
                            key=key,
                            columns=", ".join(POINT_COLUMNS).lower(),
                        )
                    ]
                )
    return [{key.upper(): _text(value) for key, value in point.items()} for point in points]


def _text(value: object) -> str:
    return format_short_number(float(value), 6) if isinstance(value, int | float) else str(value)


def _key(shape: Shape, word: str) -> str:
    """Return the key that a step uses for a field, or a text such as ``point 2`` for a point."""
    return next(
        (key for key, own in map_keys_to_fields(shape).items() if own == word), f"point {word.lstrip('#')}"
    )

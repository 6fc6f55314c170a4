"""Generation of the points of PATTERN DEF and of cycles 220 and 221, in machining order."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.geometry.lines_and_arcs import Point
from core.geometry.rotation_frames import Vector
from core.interpreter.klartext.cycles.cycle_moves import CycleTool
from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import State
from core.language.klartext.klartext_faults import INPUT_VALUE_INCORRECT
from core.language.klartext.klartext_nodes import PatternDefinition, PatternPart

MAX_POINT_COUNT = 10_000
_LENGTHS = frozenset({"X", "Y", "Z", "D", "DX", "DY"})


def compute_points(state: State, node: PatternDefinition) -> list[Vector]:
    """Return X, Y and the height above Q203 for each point, in mm.

    Raises ProgramError if a number is invalid or the pattern has too many points.
    """
    parts = [(part, _numbers(state, part)) for part in node.parts]
    found_count = sum(_count_points(state, part, values) for part, values in parts)
    if found_count > MAX_POINT_COUNT:
        text = "The pattern has too many points: {found_count}."
        hint = "The maximum is {most_points} points."
        raise state.make_error(
            node.column,
            INPUT_VALUE_INCORRECT,
            text,
            hint,
            found_count=found_count,
            most_points=MAX_POINT_COUNT,
        )
    return [(*at, values.get("Z", 0.0)) for part, values in parts for at in _of_a_part(state, part, values)]


def _count_points(state: State, part: PatternPart, values: dict[str, float]) -> int:
    """Return the number of points of one part of a PATTERN DEF.

    Raises ProgramError for an invalid number.
    """
    if part.pattern_kind == "POS":
        return 1
    if part.pattern_kind not in {"PAT", "FRAME"}:
        return _count(state, part, values["NUM"])
    columns, rows = _count(state, part, values["NUMX"]), _count(state, part, values["NUMY"])
    inner = max(columns - 2, 0) * max(rows - 2, 0) if part.pattern_kind == "FRAME" else 0
    return columns * rows - inner


def _numbers(state: State, part: PatternPart) -> dict[str, float]:
    return {
        word.axis: word_values.number(state, word.value, word.axis, word_values.MAX_COORDINATE)
        * (state.mm_per_unit if word.axis in _LENGTHS else 1.0)
        for word in part.words
    }


def _of_a_part(state: State, part: PatternPart, values: dict[str, float]) -> Iterator[tuple[float, float]]:
    x, y = values["X"], values["Y"]
    if part.pattern_kind == "POS":
        yield x, y
    elif part.pattern_kind == "ROW":
        angle = math.radians(values.get("ROT", 0.0))
        for at in range(_count(state, part, values["NUM"])):
            yield x + at * values["D"] * math.cos(angle), y + at * values["D"] * math.sin(angle)
    elif part.pattern_kind in {"PAT", "FRAME"}:
        yield from _grid(state, part, values)
    else:
        count = _count(state, part, values["NUM"])
        step = values["STEP"] if part.pattern_kind == "PITCHCIRC" else 360.0 / count
        yield from _circle((x, y), values["D"] / 2.0, count, values.get("START", 0.0), step)


def _grid(state: State, part: PatternPart, values: dict[str, float]) -> Iterator[tuple[float, float]]:
    """Yield the points of a grid row by row in alternating directions, or the points of a frame."""
    columns, rows = _count(state, part, values["NUMX"]), _count(state, part, values["NUMY"])
    turn = values.get("ROT", 0.0)
    u = math.radians(turn + values.get("ROTX", 0.0))
    v = math.radians(turn + 90.0 + values.get("ROTY", 0.0))
    for column, row in _alternating_cells(columns, rows, is_frame=part.pattern_kind == "FRAME"):
        along, across = column * values["DX"], row * values["DY"]
        yield (
            values["X"] + along * math.cos(u) + across * math.cos(v),
            values["Y"] + along * math.sin(u) + across * math.sin(v),
        )


def _count(state: State, part: PatternPart, number: float) -> int:
    if number != int(number) or not 1 <= number <= MAX_POINT_COUNT:
        text = "{form}: {number} is not a valid number of points."
        hint = "Enter a whole number of 1 or more."
        raise state.make_error(
            part.column, INPUT_VALUE_INCORRECT, text, hint, form=part.pattern_kind, number=number
        )
    return int(number)


def compute_circle_points(tool: CycleTool) -> list[Point]:
    """Return the points of cycle 220. Raises ProgramError for invalid parameters."""
    centre, radius = (tool.read_length_mm(216), tool.read_length_mm(217)), tool.read_length_mm(244) / 2.0
    count, first = _told_count(tool, 241), tool.read_parameter(245, 0.0)
    step = tool.read_parameter(247, 0.0)
    if not step:
        swept = tool.read_parameter(246, first + 360.0) - first
        step = swept / count if abs(swept) >= 360.0 or count == 1 else swept / (count - 1)
    return list(_circle(centre, radius, count, first, step))


def compute_row_points(tool: CycleTool) -> list[Point]:
    """Return the points of cycle 221 row by row, in alternating directions.

    Raises ProgramError for invalid parameters.
    """
    x, y = tool.read_length_mm(225), tool.read_length_mm(226)
    columns, rows = _told_count(tool, 242), _told_count(tool, 243)
    text = "Q242={columns} and Q243={rows} result in {count} positions."
    hint = "The maximum is {most_points} points."
    tool.check_condition(
        columns * rows <= MAX_POINT_COUNT,
        text,
        hint,
        columns=columns,
        rows=rows,
        count=columns * rows,
        most_points=MAX_POINT_COUNT,
    )
    angle = math.radians(tool.read_parameter(224, 0.0))
    c, s, found = math.cos(angle), math.sin(angle), list[Point]()
    for column, row in _alternating_cells(columns, rows):
        u, v = column * tool.read_length_mm(237), row * tool.read_length_mm(238)
        found.append((x + u * c - v * s, y + u * s + v * c))
    return found


def _told_count(tool: CycleTool, q: int) -> int:
    count, text = tool.read_whole_number(q), "Q{parameter}={count} is not a valid number of positions."
    tool.check_condition(
        1 <= count <= MAX_POINT_COUNT, text, "Enter a valid number.", parameter=q, count=count
    )
    return count


def _circle(center: Point, radius: float, count: int, first: float, step: float) -> Iterator[Point]:
    """Yield ``count`` points on a circle, starting at the angle ``first``; angles are in degrees."""
    for angle in (math.radians(first + at * step) for at in range(count)):
        yield center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle)


def _alternating_cells(columns: int, rows: int, *, is_frame: bool = False) -> Iterator[tuple[int, int]]:
    """Yield the column and row of each point of a grid or its border, in reverse in every second row."""
    for row in range(rows):
        is_inner = is_frame and 0 < row < rows - 1
        order = range(0, columns, max(columns - 1, 1)) if is_inner else range(columns)
        yield from ((column, row) for column in (order if row % 2 == 0 else reversed(order)))

"""Search, comparison and rewriting of the shapes in the text of a program.

A shape is found by its comment. It is intact if its fields produce the lines in the text. If a value was
changed by hand and one field explains the change, the field adopts the value. Otherwise the shape is
reported as changed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from core.extras.shapes.contour import ContourPoint, read_contour
from core.extras.shapes.editor_shape import (
    TOOL_FIELD_WORD,
    Shape,
    ShapeInstance,
    make_shape_instance,
    read_comment,
)
from core.extras.shapes.shape_fields import (
    LENGTH_KINDS,
    FieldKind,
    FieldValue,
    FieldValues,
    ProgramSettings,
    ShopData,
)
from core.extras.shapes.shape_table import find_shape
from core.extras.shapes.templates import MM, RADIUS
from core.language.source import Dialect

_COMMENT = {
    Dialect.OMNITURN: re.compile(r"\(([^()]*)\)\s*$"),
    Dialect.SINUMERIK: re.compile(r";([^;]*)$"),
}
_MODES = re.compile(r"G7([0-3])(?!\d)")
_S_MODES = re.compile(r"(G700?(?!\d)|G710?(?!\d)|DIAMON|DIAMOF)")
_BLOCK_NUMBER = re.compile(r"N\d+(?=[A-Z])")
_TOOL = re.compile(r"(?:^|[^A-Z])T(\d+)")
_SUB = {
    Dialect.OMNITURN: re.compile(r"}(\d+)"),
    Dialect.SINUMERIK: re.compile(r"^(?:CONTOUR_|%_N_PART_)(\d+)(?::|_SPF)"),
}
_END = {
    Dialect.OMNITURN: re.compile(r"\s*(?:M30|M02|M99|})"),
    Dialect.SINUMERIK: re.compile(r"\s*(?:N\d+\s*)?(?:M30|M0?2|M17|RET)\b(?!=)", re.IGNORECASE),
}
_BEGINS = ("}", "%_N_PART_")  # start of a subroutine
_LABEL = re.compile(r"CONTOUR_\d+(?:_END)?:")
_FIRST_CUT = re.compile(r"G1X-?[.\d]+Z-?[.\d]+F[.\d]+")
_WORD = re.compile(r"([A-Z~_=:,(\"]+)([-+]?(?:\d+\.?\d*|\.\d+))?")
_SCALED = LENGTH_KINDS | {FieldKind.FEED, FieldKind.RATE, FieldKind.SURFACE_SPEED}
_FEET = {True: 0.3048, False: 1.0 / 0.3048}  # by metric, conversion between ft/min and m/min
_MOST_CHANGES = 4  # largest number of hand-changed values that are adopted


@dataclass(frozen=True, slots=True)
class ProgramShape:
    """A shape in the text of a program.

    ``first_line`` is the number of its first line, counted from 0, and ``line_count`` is the number of its
    lines. ``adopted_field_names`` are the fields whose values were adopted from the lines. ``edited_line`` is
    the line, counted from 0, that differs from the lines that the fields produce, or -1.
    """

    first_line: int
    line_count: int
    shape_instance: ShapeInstance
    settings: ProgramSettings
    adopted_field_names: tuple[str, ...] = ()
    edited_line: int = -1

    @property
    def next_line(self) -> int:
        """Return the number of the first line after the shape."""
        return self.first_line + self.line_count


def normalize_line(line: str, dialect: Dialect = Dialect.OMNITURN) -> str:
    """Return a line in capitals without comments and spaces.

    A plane selection in comment syntax is retained. In SINUMERIK, the block number is removed.
    """
    bare = line.strip()
    if dialect is Dialect.SINUMERIK:
        return _BLOCK_NUMBER.sub("", bare.partition(";")[0].upper().replace(" ", ""), count=1)
    if bare.startswith("("):
        return bare.upper().replace(" ", "")
    return _COMMENT[dialect].sub("", bare).upper().replace(" ", "")


def ends_program(line: str, dialect: Dialect) -> bool:
    """Return whether a line ends a program or a subroutine."""
    return _END[dialect].match(line) is not None and not starts_subroutine(line)


def starts_subroutine(line: str) -> bool:
    """Return whether a line starts a subroutine that a form has written or that a form can extend."""
    return line.lstrip().upper().startswith(_BEGINS)


def has_units(lines: Sequence[str], dialect: Dialect) -> bool:
    """Return whether a program already specifies its units, in its header or in other lines."""
    if dialect is Dialect.OMNITURN:
        return any(line.upper().startswith(("G90", "G91")) for line in lines[:1])
    codes = [code for line in lines if (code := normalize_line(line, dialect))]
    return any(not code.startswith("%") and not _END[dialect].match(code) for code in codes)


# --- Settings in force at a line


def find_active_settings(
    lines: Sequence[str], line_number: int, shop: ShopData, initial_settings: ProgramSettings | None = None
) -> ProgramSettings:
    """Return the settings that are active before line ``line_number``, counted from 0.

    ``initial_settings`` contains the settings for a program that does not specify any.
    """
    now = replace(initial_settings or ProgramSettings(), shop=shop)
    for line in lines[:line_number]:
        now = _after(line, now)
    used = {int(n) for line in lines for n in _SUB[now.dialect].findall(normalize_line(line, now.dialect))}
    free = next(number for number in range(1, len(used) + 2) if number not in used)
    return replace(now, free_subroutine_number=free)


def _after(line: str, now: ProgramSettings) -> ProgramSettings:
    code = normalize_line(line, now.dialect)
    if code.startswith("("):
        return now
    if now.dialect is Dialect.SINUMERIK:
        for mode in _S_MODES.findall(code):
            diameter = mode == "DIAMON" if mode.startswith("D") else now.diameter
            now = replace(now, diameter=diameter, metric=now.metric if mode[0] == "D" else mode[:3] == "G71")
    for mode in _MODES.findall(code) if now.dialect is Dialect.OMNITURN else ():
        words = {"metric": mode == "1"} if mode in "01" else {"diameter": mode == "2"}
        now = replace(now, **words)
    for tool in _TOOL.findall(code):
        now = replace(now, used=now.used | {int(tool)})
    if code.startswith((*_BEGINS, "M99", "M17")):
        now = replace(now, is_subroutine=code.startswith(_BEGINS))
    head = _parse_comment(line, now.dialect)
    return now if head is None or head[0].name != "HEAD" else _with_head(head[1], now)


def _with_head(values: FieldValues, now: ProgramSettings) -> ProgramSettings:
    clear, bar, material = values.get("CLEAR"), values.get("BAR"), values.get("MATERIAL")
    return replace(
        now,
        metric=values.get("UNIT") == MM,
        diameter=values.get("WORDS") != RADIUS,
        tool_change_z=clear if isinstance(clear, float) else now.tool_change_z,
        bar=bar if isinstance(bar, float) else 0.0,
        material=material if isinstance(material, str) else "",
    )


def _parse_comment(line: str, dialect: Dialect) -> tuple[Shape, dict[str, FieldValue]] | None:
    """Return the shape and the fields from the comment of a line.

    The result is None if the line has no shape comment.
    """
    found = _COMMENT[dialect].search(line)
    if found is None or line.lstrip().startswith(("(", ";")):
        return None
    known = find_shape(found[1].split(), dialect)
    if known is None:
        return None
    shape, words = known
    values = read_comment(shape, words)
    if not words or values is None:
        return None
    tool = _TOOL.search(normalize_line(line, dialect))
    if shape.find_field(TOOL_FIELD_WORD) is not None:
        if tool is None:
            return None
        values[TOOL_FIELD_WORD] = float(tool[1])
    return shape, values


def find_damaged_comment(
    lines: Sequence[str], line_number: int, dialect: Dialect
) -> tuple[int, Shape] | None:
    """Return the line and the shape of a damaged comment at or above line ``line_number``, or None.

    Lines are counted from 0. A comment counts as damaged if it begins with a shape's name and still has two
    of its fields. The name alone is not enough, because programmers also use words such as DRILL in
    comments.
    """
    for line in range(min(line_number, len(lines) - 1), -1, -1):
        found = _COMMENT[dialect].search(lines[line])
        known = find_shape(found[1].split(), dialect) if found is not None else None
        if known is None:
            continue
        shape, words = known
        if _parse_comment(lines[line], dialect) is not None:
            return None
        if sum(each.name in words for each in shape.fields) > 1:
            return line, shape
    return None


# --- Shapes of a text


def find_program_shapes(
    lines: Sequence[str], shop: ShopData, initial_settings: ProgramSettings | None = None
) -> list[ProgramShape]:
    """Return all shapes of a program in order."""
    found: list[ProgramShape] = []
    now, at = replace(initial_settings or ProgramSettings(), shop=shop), 0
    while at < len(lines):
        head = _parse_comment(lines[at], now.dialect)
        if head is None:
            now, at = _after(lines[at], now), at + 1
            continue
        piece = _piece(lines, at, head, now)
        found.append(piece)
        for line in lines[at : piece.next_line]:
            now = _after(line, now)
        at = piece.next_line
    return found


def _piece(
    lines: Sequence[str], at: int, head: tuple[Shape, dict[str, FieldValue]], setting: ProgramSettings
) -> ProgramShape:
    shape, values = head
    if shape.name == "HEAD":
        setting = _with_head(values, setting)
    reach = at + 1
    end, dialect = _END[setting.dialect], setting.dialect
    while (
        reach < len(lines) and not end.match(lines[reach]) and _parse_comment(lines[reach], dialect) is None
    ):
        reach += 1
    there = [normalize_line(line, dialect) for line in lines[at:reach]]
    best: ProgramShape | None = None
    for rows in _contours(shape, there, setting):
        one = make_shape_instance(shape, values, setting, rows)
        found = _compare_with_text(one, there, at, setting)
        if best is None or found.edited_line < 0 or found.edited_line > best.edited_line >= 0:
            best = found
        if found.edited_line < 0:
            return found
    assert best is not None
    return best


def _compare_with_text(
    filled_shape: ShapeInstance, there: list[str], at: int, settings: ProgramSettings
) -> ProgramShape:
    """Return the shape as a piece, after comparing the lines that its fields produce with the text."""
    wanted = make_code_lines(filled_shape, settings)
    if wanted and there[: len(wanted)] == wanted:
        return ProgramShape(at, len(wanted), filled_shape, settings)
    taken = _adopt_fields(filled_shape, there[: len(wanted)], settings, _MOST_CHANGES) if wanted else None
    if taken is not None:
        words = tuple(w for w, v in taken.field_values.items() if filled_shape.field_values.get(w) != v)
        return ProgramShape(at, len(wanted), taken, settings, words)
    apart = next(
        (n for n, (a, b) in enumerate(zip(wanted, there, strict=False)) if a != b),
        min(len(wanted), len(there)) - 1,
    )
    return ProgramShape(at, len(there), filled_shape, settings, edited_line=at + max(apart, 0))


def make_code_lines(shape: ShapeInstance, settings: ProgramSettings) -> list[str]:
    """Return the code lines of a shape without comments, or [] if its fields are incomplete or invalid."""
    if shape.find_errors(settings) and _incomplete(shape):
        return []
    try:
        return [normalize_line(line, settings.dialect) for line in shape.make_lines(settings)]
    except (ArithmeticError, ValueError, IndexError):
        return []  # a comment may contain any values


def _incomplete(one: ShapeInstance) -> bool:
    return any(one.field_values.get(each.name) is None for each in one.applicable_fields)


def _contours(
    shape: Shape, there: list[str], settings: ProgramSettings
) -> Iterator[tuple[ContourPoint, ...]]:
    """Yield the contour point tables that these program lines may represent.

    For a shape without a contour, one empty table is yielded.
    """
    if not shape.has_point_table:
        yield ()
        return
    if settings.dialect is Dialect.SINUMERIK:
        yield from _sinumerik_contours(there, settings)
        yield ()
        return
    first = next((n for n, line in enumerate(there) if line.startswith("G75")), None)
    if first is not None and "RF" in there[first:]:
        rows = read_contour(there[first + 1 : there.index("RF", first)], settings)
        if rows:
            yield rows
        yield from _bare_contours(there[there.index("RF", first) :], settings)  # G75 may have a shifted one
    else:
        yield from _bare_contours(there, settings)
    yield ()


def _sinumerik_contours(there: list[str], settings: ProgramSettings) -> Iterator[tuple[ContourPoint, ...]]:
    """Yield the possible contours of a SINUMERIK shape, from the first cut to the retract move.

    The retract move may be the last line of the contour or the line after the contour, so both are tried.
    """
    labels = [n for n, line in enumerate(there) if _LABEL.fullmatch(line)]
    begin = next((n for n, line in enumerate(there) if _FIRST_CUT.fullmatch(line)), len(there))
    end = next((n for n in range(begin, len(there)) if there[n].startswith(("G0", "G40"))), len(there))
    for last in (labels[1] - 1, labels[1]) if len(labels) > 1 else (end - 1, end):
        rows = read_contour(there[begin:last], settings)
        if rows:
            yield rows


def _bare_contours(there: list[str], settings: ProgramSettings) -> Iterator[tuple[ContourPoint, ...]]:
    """Yield the possible contours of a shape without roughing, from the approach to the retract move.

    The retract move may be the next rapid after the contour or the line before this rapid, so both are
    tried.
    """
    began = [
        n
        for n, line in enumerate(there)
        if re.fullmatch(r"(?:G95F[.\d]+|G01|F[.\d]+)?Z-?[.\d]+(?:D\d+)?", line)
    ]
    approach = next((line for line in there if line.startswith("G00X")), "")
    for begin in began[:2]:
        end = next((n for n in range(begin + 1, len(there)) if there[n].startswith("G00")), len(there))
        z = re.search(r"Z(-?[.\d]+)", there[begin])
        x = re.search(r"X(-?[.\d]+)", approach)
        for last in (end - 1, end):
            rows = read_contour(there[begin + 1 : last], settings)
            if rows and z and x:
                across = float(x[1]) * (1.0 if settings.diameter else 2.0)
                yield (ContourPoint(across, float(z[1])), *rows)


# --- Values changed by hand


def _adopt_fields(
    filled_shape: ShapeInstance, there: list[str], settings: ProgramSettings, left: int
) -> ShapeInstance | None:
    """Return the shape with field values that produce the lines in the text, or None if none do."""
    wanted = make_code_lines(filled_shape, settings)
    if wanted == there:
        return filled_shape
    change = _first_change(wanted, there)
    if change is None or not left:
        return None
    before, after = change
    for word, value in _explaining(filled_shape, before, after):
        other = replace(filled_shape, field_values={**filled_shape.field_values, word: value})
        if not make_code_lines(other, settings) or _agreeing(
            make_code_lines(other, settings), there
        ) <= _agreeing(wanted, there):
            continue
        found = _adopt_fields(other, there, settings, left - 1)
        if found is not None:
            return found
    return None


def _agreeing(wanted: list[str], there: list[str]) -> int:
    """Return the number of equal words before the first difference between the two lists of lines."""
    count = 0
    for a, b in zip(wanted, there, strict=False):
        for this, that in zip(_WORD.findall(a), _WORD.findall(b), strict=False):
            if this != that:
                return count
            count += 1
    return count


def _first_change(wanted: list[str], there: list[str]) -> tuple[float, float] | None:
    """Return the first number that differs, as (before, after).

    The result is None if anything other than numbers differs too.
    """
    if len(wanted) != len(there):
        return None
    for a, b in zip(wanted, there, strict=True):
        here, other = _WORD.findall(a), _WORD.findall(b)
        if [letter for letter, _ in here] != [letter for letter, _ in other]:
            return None
        for (_, was), (_, now) in zip(here, other, strict=True):
            if was != now and was and now:
                return float(was), float(now)
    return None


def _explaining(filled_shape: ShapeInstance, before: float, after: float) -> Iterator[tuple[str, float]]:
    """Yield the fields whose values explain an edited number, each with its new value.

    The number may be the field's value itself, negated, doubled or halved.
    """
    for word, value in filled_shape.field_values.items():
        if isinstance(value, str):
            continue
        for sign in (1.0, -1.0, 2.0, 0.5, -2.0, -0.5):
            if abs(value * sign - before) < 1e-6:
                yield word, round(after / sign, 6)


# --- Writing


def insert_shape(
    lines: Sequence[str],
    line_number: int,
    shape: ShapeInstance,
    settings: ProgramSettings,
    replaced_piece: ProgramShape | None = None,
) -> tuple[list[str], int]:
    """Return the text with a shape inserted before line ``line_number``, and the number of the next line.

    If ``replaced_piece`` is not None, the shape replaces this piece. M30 is added to a program without an
    end. The subroutine of a bar feed loop is added at the end of the program, and the next line is then
    inside the subroutine.
    """
    text = list(lines)
    while text and not text[-1].strip():
        text.pop()
    new = shape.make_lines(settings)
    line_number = replaced_piece.first_line if replaced_piece is not None else min(line_number, len(text))
    text[line_number : replaced_piece.next_line if replaced_piece is not None else line_number] = new
    ends = r"\s*/?M(30|02)" if settings.dialect is Dialect.OMNITURN else r"\s*(N\d+\s*)?M(30|0?2|17)\b(?!=)"
    if not any(re.match(ends, line) for line in text):
        text.append("M30")
    next_line_number = line_number + len(new)
    tail = shape.shape.make_program_end_lines(shape)
    if tail and replaced_piece is None and tail[0] not in (normalize_line(line) for line in text):
        text += tail
        next_line_number = len(text) - 1
    return text, next_line_number


def convert_unit(
    shape: ShapeInstance, old_settings: ProgramSettings, new_settings: ProgramSettings
) -> ShapeInstance:
    """Return a shape with lengths and feeds converted to the program's new unit."""
    if old_settings.metric == new_settings.metric:
        return shape
    scale = 25.4 if new_settings.metric else 1.0 / 25.4
    values = dict(shape.field_values)
    for each in shape.shape.fields:
        value = values.get(each.name)
        if isinstance(value, float) and each.kind in _SCALED:
            places = 4 if new_settings.metric and each.kind in LENGTH_KINDS else 6
            values[each.name] = round(
                value * (_FEET[new_settings.metric] if each.kind is FieldKind.SURFACE_SPEED else scale),
                places,
            )
    rows = tuple(_scaled(row, scale) for row in shape.contour_points)
    return replace(shape, field_values=values, contour_points=rows)


def _scaled(row: ContourPoint, scale: float) -> ContourPoint:
    x, z = (None if value is None else round(value * scale, 5) for value in (row.x, row.z))
    chamfer, radius, arc = (round(value * scale, 5) for value in (row.chamfer, row.radius, row.arc))
    return ContourPoint(x, z, chamfer, radius, arc)


def rewrite_program_shapes(
    lines: Sequence[str], shop: ShopData, pieces: Sequence[ProgramShape]
) -> tuple[list[str], int]:
    """Rewrite the shapes of a program after its head was changed, for example to another unit.

    Return the new text, and the number of shapes that were not rewritten because they were edited by hand.
    """
    text, stay = list(lines), 0
    shift = 0
    new = ProgramSettings(dialect=pieces[0].settings.dialect) if pieces else None
    for piece in pieces:
        if piece.shape_instance.shape.name == "HEAD":
            continue
        if piece.edited_line >= 0:
            stay += 1
            continue
        first = piece.first_line + shift
        setting = find_active_settings(text, first, shop, new)
        again = convert_unit(piece.shape_instance, piece.settings, setting).make_lines(setting)
        text[first : first + piece.line_count] = again
        shift += len(again) - piece.line_count
    return text, stay

"""Shapes in the text of a program: found by their comments, compared, written and replaced.

A shape is intact if its fields produce the lines in the text. If a value was changed by hand and one field
explains the change, the field adopts it. Otherwise the shape is reported as changed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from core.extras.shapes.contour import Row, read_contour
from core.extras.shapes.shape import TOOL_WORD, Filled, Shape, filled, read_comment
from core.extras.shapes.shape_fields import LENGTHS, Kind, Setting, Shop, Value, Values
from core.extras.shapes.shape_table import named
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
_SCALED = LENGTHS | {Kind.FEED, Kind.RATE, Kind.SURFACE}
_FEET = {True: 0.3048, False: 1.0 / 0.3048}  # by metric, conversion between ft/min and m/min
_MOST_CHANGES = 4  # largest number of hand-changed values that are adopted


@dataclass(frozen=True, slots=True)
class Piece:
    """A shape in a text: ``first`` is its first line, counted from 0, and ``count`` the number of lines.

    ``taken`` are the fields that were adopted from the lines. ``foreign`` is the line, counted from 0, that
    differs from the lines of the fields, or -1.
    """

    first: int
    count: int
    filled: Filled
    setting: Setting
    taken: tuple[str, ...] = ()
    foreign: int = -1

    @property
    def behind(self) -> int:
        """Number of the first line after the shape."""
        return self.first + self.count


def code_of(line: str, dialect: Dialect = Dialect.OMNITURN) -> str:
    """Return a line without comment and spaces, in capitals; a line of plane switching remains complete.

    In SINUMERIK, the block number is also removed.
    """
    bare = line.strip()
    if dialect is Dialect.SINUMERIK:
        return _BLOCK_NUMBER.sub("", bare.partition(";")[0].upper().replace(" ", ""), count=1)
    if bare.startswith("("):
        return bare.upper().replace(" ", "")
    return _COMMENT[dialect].sub("", bare).upper().replace(" ", "")


def ends_program(line: str, dialect: Dialect) -> bool:
    """Return whether a line ends a program or a subroutine."""
    return _END[dialect].match(line) is not None and not begins_subroutine(line)


def begins_subroutine(line: str) -> bool:
    """Return whether a line starts a subroutine that a form has written or can write into."""
    return line.lstrip().upper().startswith(_BEGINS)


def begun(lines: Sequence[str], dialect: Dialect) -> bool:
    """Return whether a program already specifies its units, in its header or in other lines."""
    if dialect is Dialect.OMNITURN:
        return any(line.upper().startswith(("G90", "G91")) for line in lines[:1])
    codes = [code for line in lines if (code := code_of(line, dialect))]
    return any(not code.startswith("%") and not _END[dialect].match(code) for code in codes)


# --- Settings in force at a line


def setting_at(lines: Sequence[str], at: int, shop: Shop, new: Setting | None = None) -> Setting:
    """Return the settings in force before line ``at``, counted from 0.

    ``new`` has the settings for a program that does not specify any.
    """
    now = replace(new or Setting(), shop=shop)
    for line in lines[:at]:
        now = _after(line, now)
    used = {int(n) for line in lines for n in _SUB[now.dialect].findall(code_of(line, now.dialect))}
    free = next(number for number in range(1, len(used) + 2) if number not in used)
    return replace(now, free_sub=free)


def _after(line: str, now: Setting) -> Setting:
    code = code_of(line, now.dialect)
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
        now = replace(now, called=code.startswith(_BEGINS))
    head = _head_of(line, now.dialect)
    return now if head is None or head[0].name != "HEAD" else _with_head(head[1], now)


def _with_head(values: Values, now: Setting) -> Setting:
    clear, bar, material = values.get("CLEAR"), values.get("BAR"), values.get("MATERIAL")
    return replace(
        now,
        metric=values.get("UNIT") == MM,
        diameter=values.get("WORDS") != RADIUS,
        change_z=clear if isinstance(clear, float) else now.change_z,
        bar=bar if isinstance(bar, float) else 0.0,
        material=material if isinstance(material, str) else "",
    )


def _head_of(line: str, dialect: Dialect) -> tuple[Shape, dict[str, Value]] | None:
    """Return the shape whose comment a line has, with its fields; None without such a comment."""
    found = _COMMENT[dialect].search(line)
    if found is None or line.lstrip().startswith(("(", ";")):
        return None
    known = named(found[1].split(), dialect)
    if known is None:
        return None
    shape, words = known
    values = read_comment(shape, words)
    if not words or values is None:
        return None
    tool = _TOOL.search(code_of(line, dialect))
    if shape.field(TOOL_WORD) is not None:
        if tool is None:
            return None
        values[TOOL_WORD] = float(tool[1])
    return shape, values


def unreadable(lines: Sequence[str], at: int, dialect: Dialect) -> tuple[int, Shape] | None:
    """Return the line, counted from 0, and the shape of a damaged comment above line ``at``; or None.

    Such a comment begins with the name of a shape and still has two of its fields, because programmers also
    use names such as DRILL in comments.
    """
    for line in range(min(at, len(lines) - 1), -1, -1):
        found = _COMMENT[dialect].search(lines[line])
        known = named(found[1].split(), dialect) if found is not None else None
        if known is None:
            continue
        shape, words = known
        if _head_of(lines[line], dialect) is not None:
            return None
        if sum(each.word in words for each in shape.fields) > 1:
            return line, shape
    return None


# --- Shapes of a text


def pieces(lines: Sequence[str], shop: Shop, new: Setting | None = None) -> list[Piece]:
    """Return all shapes of a program in order."""
    found: list[Piece] = []
    now, at = replace(new or Setting(), shop=shop), 0
    while at < len(lines):
        head = _head_of(lines[at], now.dialect)
        if head is None:
            now, at = _after(lines[at], now), at + 1
            continue
        piece = _piece(lines, at, head, now)
        found.append(piece)
        for line in lines[at : piece.behind]:
            now = _after(line, now)
        at = piece.behind
    return found


def _piece(lines: Sequence[str], at: int, head: tuple[Shape, dict[str, Value]], setting: Setting) -> Piece:
    shape, values = head
    if shape.name == "HEAD":
        setting = _with_head(values, setting)
    reach = at + 1
    end, dialect = _END[setting.dialect], setting.dialect
    while reach < len(lines) and not end.match(lines[reach]) and _head_of(lines[reach], dialect) is None:
        reach += 1
    there = [code_of(line, dialect) for line in lines[at:reach]]
    best: Piece | None = None
    for rows in _contours(shape, there, setting):
        one = filled(shape, values, setting, rows)
        found = _held_against(one, there, at, setting)
        if best is None or found.foreign < 0 or found.foreign > best.foreign >= 0:
            best = found
        if found.foreign < 0:
            return found
    assert best is not None
    return best


def _held_against(one: Filled, there: list[str], at: int, setting: Setting) -> Piece:
    """Return the piece for these fields, compared with the lines in the text."""
    wanted = codes(one, setting)
    if wanted and there[: len(wanted)] == wanted:
        return Piece(at, len(wanted), one, setting)
    taken = _taken_over(one, there[: len(wanted)], setting, _MOST_CHANGES) if wanted else None
    if taken is not None:
        words = tuple(w for w, v in taken.values.items() if one.values.get(w) != v)
        return Piece(at, len(wanted), taken, setting, words)
    apart = next(
        (n for n, (a, b) in enumerate(zip(wanted, there, strict=False)) if a != b),
        min(len(wanted), len(there)) - 1,
    )
    return Piece(at, len(there), one, setting, foreign=at + max(apart, 0))


def codes(one: Filled, setting: Setting) -> list[str]:
    """Return the code lines of a shape without comments; [] if its fields are incomplete or invalid."""
    if one.refusals(setting) and _incomplete(one):
        return []
    try:
        return [code_of(line, setting.dialect) for line in one.lines(setting)]
    except (ArithmeticError, ValueError, IndexError):
        return []  # a comment may contain any values


def _incomplete(one: Filled) -> bool:
    return any(one.values.get(each.word) is None for each in one.fields)


def _contours(shape: Shape, there: list[str], setting: Setting) -> Iterator[tuple[Row, ...]]:
    """Yield the point tables that these lines may contain; one empty table for a shape without a contour."""
    if not shape.contour:
        yield ()
        return
    if setting.dialect is Dialect.SINUMERIK:
        yield from _sinumerik_contours(there, setting)
        yield ()
        return
    first = next((n for n, line in enumerate(there) if line.startswith("G75")), None)
    if first is not None and "RF" in there[first:]:
        rows = read_contour(there[first + 1 : there.index("RF", first)], setting)
        if rows:
            yield rows
    else:
        yield from _bare_contours(there, setting)
    yield ()


def _sinumerik_contours(there: list[str], setting: Setting) -> Iterator[tuple[Row, ...]]:
    """Yield the contours from the first cut to the move away from the part.

    This move is the last line or the line after it.
    """
    labels = [n for n, line in enumerate(there) if _LABEL.fullmatch(line)]
    begin = next((n for n, line in enumerate(there) if _FIRST_CUT.fullmatch(line)), len(there))
    end = next((n for n in range(begin, len(there)) if there[n].startswith(("G0", "G40"))), len(there))
    for last in (labels[1] - 1, labels[1]) if len(labels) > 1 else (end - 1, end):
        rows = read_contour(there[begin:last], setting)
        if rows:
            yield rows


def _bare_contours(there: list[str], setting: Setting) -> Iterator[tuple[Row, ...]]:
    """Yield the contours without roughing, from the approach to the move away from the part.

    This move is the last line or the line before it.
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
            rows = read_contour(there[begin + 1 : last], setting)
            if rows and z and x:
                across = float(x[1]) * (1.0 if setting.diameter else 2.0)
                yield (Row(across, float(z[1])), *rows)


# --- Values changed by hand


def _taken_over(one: Filled, there: list[str], setting: Setting, left: int) -> Filled | None:
    """Return the shape with fields that match the lines; None if no such fields exist."""
    wanted = codes(one, setting)
    if wanted == there:
        return one
    change = _first_change(wanted, there)
    if change is None or not left:
        return None
    before, after = change
    for word, value in _explaining(one, before, after):
        other = replace(one, values={**one.values, word: value})
        if not codes(other, setting) or _agreeing(codes(other, setting), there) <= _agreeing(wanted, there):
            continue
        found = _taken_over(other, there, setting, left - 1)
        if found is not None:
            return found
    return None


def _agreeing(wanted: list[str], there: list[str]) -> int:
    """Return the number of words before the first difference."""
    count = 0
    for a, b in zip(wanted, there, strict=False):
        for this, that in zip(_WORD.findall(a), _WORD.findall(b), strict=False):
            if this != that:
                return count
            count += 1
    return count


def _first_change(wanted: list[str], there: list[str]) -> tuple[float, float] | None:
    """Return the first number that differs, before and after; None if other parts differ too."""
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


def _explaining(one: Filled, before: float, after: float) -> Iterator[tuple[str, float]]:
    """Yield the fields whose value is in the changed word: unchanged, negated, doubled or halved."""
    for word, value in one.values.items():
        if isinstance(value, str):
            continue
        for sign in (1.0, -1.0, 2.0, 0.5, -2.0, -0.5):
            if abs(value * sign - before) < 1e-6:
                yield word, round(after / sign, 6)


# --- Writing


def with_shape(
    lines: Sequence[str], at: int, one: Filled, setting: Setting, instead: Piece | None = None
) -> tuple[list[str], int]:
    """Return the text with a shape inserted before line ``at``, or replacing a piece, and the next line.

    A program without an end gets M30. A bar feed loop gets its subroutine at the end of the program, and the
    next line is then inside the subroutine.
    """
    text = list(lines)
    while text and not text[-1].strip():
        text.pop()
    new = one.lines(setting)
    at = instead.first if instead is not None else min(at, len(text))
    text[at : instead.behind if instead is not None else at] = new
    ends = r"\s*/?M(30|02)" if setting.dialect is Dialect.OMNITURN else r"\s*(N\d+\s*)?M(30|0?2|17)\b(?!=)"
    if not any(re.match(ends, line) for line in text):
        text.append("M30")
    behind = at + len(new)
    tail = one.shape.ends(one)
    if tail and instead is None and tail[0] not in (code_of(line) for line in text):
        text += tail
        behind = len(text) - 1
    return text, behind


def in_unit_of(one: Filled, before: Setting, now: Setting) -> Filled:
    """Return a shape with lengths and feeds converted to the program's new unit."""
    if before.metric == now.metric:
        return one
    scale = 25.4 if now.metric else 1.0 / 25.4
    values = dict(one.values)
    for each in one.shape.fields:
        value = values.get(each.word)
        if isinstance(value, float) and each.kind in _SCALED:
            places = 4 if now.metric and each.kind in LENGTHS else 6
            values[each.word] = round(
                value * (_FEET[now.metric] if each.kind is Kind.SURFACE else scale), places
            )
    rows = tuple(_scaled(row, scale) for row in one.rows)
    return replace(one, values=values, rows=rows)


def _scaled(row: Row, scale: float) -> Row:
    x, z = (None if value is None else round(value * scale, 5) for value in (row.x, row.z))
    chamfer, radius, arc = (round(value * scale, 5) for value in (row.chamfer, row.radius, row.arc))
    return Row(x, z, chamfer, radius, arc)


def renewed(lines: Sequence[str], shop: Shop, before: Sequence[Piece]) -> tuple[list[str], int]:
    """Rewrite the pieces after a changed head; return the text and the number of pieces left unchanged.

    Pieces that were changed by hand are left unchanged.
    """
    text, stay = list(lines), 0
    shift = 0
    new = Setting(dialect=before[0].setting.dialect) if before else None
    for piece in before:
        if piece.filled.shape.name == "HEAD":
            continue
        if piece.foreign >= 0:
            stay += 1
            continue
        first = piece.first + shift
        setting = setting_at(text, first, shop, new)
        again = in_unit_of(piece.filled, piece.setting, setting).lines(setting)
        text[first : first + piece.count] = again
        shift += len(again) - piece.count
    return text, stay

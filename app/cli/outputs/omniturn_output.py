"""Output of elementary blocks of OmniTurn programs, in inches and minutes.

Long columns of numbers are formatted together for speed. The result is the same as if each number were
formatted separately.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.cli.outputs.units import (
    MM_PER_INCH,
    MM_S_PER_FT_MIN,
    Json,
    make_common_block_json,
    round_degrees,
    round_seconds,
    to_inches,
    to_inches_per_minute,
)

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import (
        Block,
        FloatArray,
        IntArray,
        StraightMoveSeries,
        TimedSeries,
    )


_EXACT_STEPS = 1e12  # number of steps up to which a float is certainly an exact integer
_HALF_STEP_RANGE = 1e-3  # distance from half a step within which Python's ``round`` is used
_DIGITS = 12  # digits of an integer below _SURE
_EXPONENT_LIMIT = 1e-4  # limit below which ``repr`` uses an exponent
_ZERO, _POINT, _MINUS, _LINE_END, _NOTHING = *b"0.-\n", 0


def round_exactly(values: FloatArray, decimal_places: int) -> FloatArray:
    """Return the values (m,) rounded exactly like ``round(value, decimal_places) + 0.0``."""
    steps = values * 10.0**decimal_places
    whole = np.rint(steps)
    found: FloatArray = whole / 10.0**decimal_places + 0.0
    halves = np.abs(np.abs(steps - whole) - 0.5) < _HALF_STEP_RANGE
    for at in np.flatnonzero(halves | ~(np.abs(steps) < _EXACT_STEPS)).tolist():
        found[at] = round(float(values[at]), decimal_places) + 0.0
    return found


def format_decimals(values: FloatArray, decimal_places: int) -> list[str]:
    """Return each value (m,) as the shortest decimal text, identical to ``repr`` of the rounded value.

    The values are rounded to ``decimal_places``, which is at most 11. A decimal fraction of at most twelve
    digits is already the shortest text of its double. The function therefore only writes the digits and
    omits leading and trailing zeros.
    """
    found = round_exactly(values, decimal_places)
    size = np.abs(found)
    count = np.rint(size * 10.0**decimal_places)
    plain = (count < _EXACT_STEPS) & ((size >= _EXPONENT_LIMIT) | (count == 0.0))
    texts = _join_digits(np.where(plain, count, 0.0).astype(np.int64), found < 0.0, decimal_places)
    for at in np.flatnonzero(~plain).tolist():
        texts[at] = repr(float(found[at]))
    return texts


def _join_digits(count: IntArray, negative: npt.NDArray[np.bool_], decimal_places: int) -> list[str]:
    """Return each number (m,) as a decimal string.

    ``count`` has the numbers as integer multiples of 10^-``decimal_places``. Each string has at least one
    digit before and after the decimal point.
    """
    digits, point = _digit_table(count), _DIGITS - decimal_places
    for at in range(point - 1):
        digits[at] *= count >= 10 ** (_DIGITS - 1 - at)
    is_trailing_zero = np.ones(len(count), bool)
    for at in range(_DIGITS - 1, point, -1):
        is_trailing_zero &= digits[at] == _ZERO
        digits[at] *= ~is_trailing_zero
    text = np.empty((_DIGITS + 3, len(count)), np.uint8)
    text[0] = np.where(negative, _MINUS, _NOTHING)
    text[1 : point + 1], text[point + 1], text[point + 2 : -1], text[-1] = (
        digits[:point], _POINT, digits[point:], _LINE_END
    )  # fmt: skip
    lines = np.ascontiguousarray(text.T)
    characters: bytes = lines[lines != _NOTHING].tobytes()
    return characters.decode("ascii").split("\n")[:-1]


def _digit_table(count: IntArray) -> npt.NDArray[np.uint8]:
    """Return twelve digit characters for each integer, with the most significant digit first.

    The shape of the result is (12, m).
    """
    groups = np.stack([count // 10**8, count // 10**4 % 10**4, count % 10**4])
    fours = _four_digit_table()[groups].view(np.uint8)
    return fours.reshape(3, len(count), 4).transpose(0, 2, 1).reshape(_DIGITS, len(count))


@cache
def _four_digit_table() -> npt.NDArray[np.uint32]:
    """Return a table of the four digits of each number from 0 to 9999.

    Each integer of the table packs four characters. The shape of the table is (10000,).
    """
    return np.frombuffer("".join([f"{each:04d}" for each in range(10_000)]).encode(), np.uint32)


_PLACEHOLDER = "\0"  # a character that JSON text cannot contain
TABLE_HEAD = "    n  line  kind        X radius          Z         feed      rpm       t  block\n"


def make_block_json(block: Block, source_line: str, start_s: float, end_s: float) -> Json:
    """Return the JSON object of an elementary block, with the keys and units of docs/json.md.

    Keys that do not apply to the block are null.
    """
    arc = block.kind == "arc"
    circular = arc or block.kind == "plane-arc"
    turned = block.kind == "rotate"  # its speed is in rpm
    return {
        **make_common_block_json(block, source_line),
        "x": to_inches(block.x),
        "z": to_inches(block.z),
        "c": round_degrees(block.c),
        "mx": to_inches(block.mx),
        "mz": to_inches(block.mz),
        "cx": to_inches(block.cx) if arc else None,
        "cz": to_inches(block.cz) if arc else None,
        "dir": ("cw" if block.clockwise else "ccw") if circular else None,
        **_plane_json(block),
        "feed": None if turned else _feed_value(block),
        "feed_mode": None if turned else "ipr" if block.per_rev else "ipm",
        "rpm": round(block.rpm, 6) + 0.0,
        "css": None if block.css is None else round(block.css / MM_S_PER_FT_MIN, 6),
        "t0": round_seconds(start_s),
        "t1": round_seconds(end_s),
    }


def _feed_value(block: Block) -> float:
    """Return the feed of a block, in in/rev if it is a feed per revolution and otherwise in in/min."""
    return to_inches(block.feed) if block.per_rev else to_inches_per_minute(block.feed)


def format_row(block: Block, start_s: float) -> str:
    """Return a block as a table row."""
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:10s}{to_inches(block.x):11.5f}{to_inches(block.z):11.5f}"
        f"{_feed_text(block)}{start_s:8.2f}  {block.text}\n"
    )


def _feed_text(block: Block) -> str:
    """Return the feed and spindle speed of a block as text for the table."""
    feed = f"{to_inches(block.feed):.5f}/r" if block.per_rev else f"{to_inches_per_minute(block.feed):.2f}/m"
    return f"{feed:>13s}{block.rpm:9.0f}"


# --- Many moves together, with exactly the same text as single moves --------------------------------------


def format_series(moves: TimedSeries) -> str:
    """Return one table row for each move of a series."""
    series = moves.series
    line = f"%5d %5d  {series.pattern.kind:10s}%11.5f%11.5f%s%8.2f  %s\n"
    lines = series.line.tolist()
    texts = series.source_lines()
    x, z = (round_exactly(mm / MM_PER_INCH, 9).tolist() for mm in (series.x, series.z))
    columns = (
        series.n.tolist(),
        lines,
        x,
        z,
        _feed_texts(series, _feed_text),
        moves.start_times_s.tolist(),
        texts,
    )
    return "".join([line % each for each in zip(*columns, strict=True)])


def _feed_texts(series: StraightMoveSeries, text: Callable[[Block], str]) -> Iterable[str]:
    """Return ``text(block)`` for each move of a series. ``text`` may use only the feed of the block."""
    like = series.pattern
    if series.feed is None:
        return [text(like)] * len(series)
    feeds = series.feed.tolist()
    texts = {each: text(replace(like, feed=each)) for each in set(feeds)}
    return map(texts.__getitem__, feeds)


def make_series_json(moves: TimedSeries) -> str:
    """Return the JSON objects of a series of moves, one per line."""
    series, like, lines = moves.series, moves.series.pattern, moves.series.line.tolist()
    texts = _texts_json(series.source_lines())  # the text of a plain move is its source line
    columns = {
        "n": map(str, series.n.tolist()),
        "line": map(str, lines),
        "source": texts,
        "text": texts,
        "x": format_decimals(series.x / MM_PER_INCH, 9),
        "z": format_decimals(series.z / MM_PER_INCH, 9),
        "mx": format_decimals((series.x + like.offset_x) / MM_PER_INCH, 9),
        "mz": format_decimals((series.z + like.offset_z) / MM_PER_INCH, 9),
        "feed": _feed_texts(series, lambda block: json.dumps(_feed_value(block))),
        "t0": format_decimals(moves.start_times_s, 6),
        "t1": format_decimals(moves.end_times_s, 6),
    }
    cells = {key: json.dumps(value) for key, value in make_block_json(like, "", 0.0, 0.0).items()}
    cells |= dict.fromkeys(columns, _PLACEHOLDER)
    line = ", ".join(f'"{key}": {cell}' for key, cell in cells.items())
    varying = [columns[key] for key in cells if key in columns]
    return _interleave(f"{{{line}}}\n".split(_PLACEHOLDER), varying, len(series))


def _texts_json(texts: Sequence[str]) -> list[str]:
    """Return each text as JSON. The texts are encoded together for speed and must not contain line breaks."""
    return json.dumps(texts, separators=("\n", ": "))[1:-1].split("\n")


def _interleave(separators: Sequence[str], columns: Sequence[Iterable[str]], count: int) -> str:
    """Return ``count`` lines of text, each with one item from every column.

    Every line has the same ``separators`` before, between and after its columns.
    """
    width = len(separators) + len(columns)
    woven = [""] * (count * width)
    for at, text in enumerate(separators):
        woven[2 * at :: width] = [text] * count
    for at, column in enumerate(columns):
        woven[2 * at + 1 :: width] = column
    return "".join(woven)


def _plane_json(block: Block) -> Json:
    """Return the end point and the arc center of a block in the virtual mill's coordinate system.

    In the side plane of the part, the Z value is a diameter.
    """
    plane_move = block.plane
    if plane_move is None:
        return dict.fromkeys(("px", "py", "pz", "pcx", "pcy"))
    x, y, z = plane_move.end
    return {
        "px": to_inches(x),
        "py": to_inches(y),
        "pz": to_inches(2 * z if plane_move.is_on_side_plane else z),
        "pcx": None if plane_move.center is None else to_inches(plane_move.center[0]),
        "pcy": None if plane_move.center is None else to_inches(plane_move.center[1]),
    }

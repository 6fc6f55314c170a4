"""Elementary blocks of OmniTurn programs as the commands show them: inches and minutes.

Long columns of numbers are rounded and written all at once, to the letter as Python does each by itself.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from app.cli.figures.units import (
    MM_PER_INCH,
    MM_S_PER_FT_MIN,
    Json,
    block_head,
    degrees,
    inches,
    per_minute,
    seconds,
)

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import Block, Floats, Ints, Series, TimedSeries


_SURE = 1e12  # a number of steps up to which it is a whole one, with digits to spare
_HALF = 1e-3  # nearer than that to the half of a step it is rounded by its decimals
_DIGITS = 12  # of a whole number below _SURE
_SHORT = 1e-4  # below it ``repr`` has an exponent
_ZERO, _POINT, _MINUS, _LINE_END, _NOTHING = *b"0.-\n", 0


def rounded(values: Floats, places: int) -> Floats:
    """As ``round(value, places) + 0.0`` rounds each of them, (m,)."""
    steps = values * 10.0**places
    whole = np.rint(steps)
    found: Floats = whole / 10.0**places + 0.0
    halves = np.abs(np.abs(steps - whole) - 0.5) < _HALF
    for at in np.flatnonzero(halves | ~(np.abs(steps) < _SURE)).tolist():
        found[at] = round(float(values[at]), places) + 0.0
    return found


def decimals(values: Floats, places: int) -> list[str]:
    """The shortest text of each of the ``rounded`` values, (m,), as ``repr`` has it; at most 11 places.

    A decimal fraction of twelve digits is the shortest of its double: what is left to do is to write digits
    and to leave out the noughts at both ends.
    """
    found = rounded(values, places)
    size = np.abs(found)
    count = np.rint(size * 10.0**places)
    plain = (count < _SURE) & ((size >= _SHORT) | (count == 0.0))
    texts = _written(np.where(plain, count, 0.0).astype(np.int64), found < 0.0, places)
    for at in np.flatnonzero(~plain).tolist():
        texts[at] = repr(float(found[at]))
    return texts


def _written(count: Ints, negative: npt.NDArray[np.bool_], places: int) -> list[str]:
    """So many (m,) steps of as many ``places``, with one digit at least on either side of the point."""
    digits, point = _digits(count), _DIGITS - places
    for at in range(point - 1):
        digits[at] *= count >= 10 ** (_DIGITS - 1 - at)
    nought = np.ones(len(count), bool)
    for at in range(_DIGITS - 1, point, -1):
        nought &= digits[at] == _ZERO
        digits[at] *= ~nought
    text = np.empty((_DIGITS + 3, len(count)), np.uint8)
    text[0] = np.where(negative, _MINUS, _NOTHING)
    text[1 : point + 1], text[point + 1], text[point + 2 : -1], text[-1] = (
        digits[:point], _POINT, digits[point:], _LINE_END
    )  # fmt: skip
    lines = np.ascontiguousarray(text.T)
    characters: bytes = lines[lines != _NOTHING].tobytes()
    return characters.decode("ascii").split("\n")[:-1]


def _digits(count: Ints) -> npt.NDArray[np.uint8]:
    """The twelve digits of each number, as characters: (12, m), the first ones first."""
    groups = np.stack([count // 10**8, count // 10**4 % 10**4, count % 10**4])
    fours = _fours()[groups].view(np.uint8)
    return fours.reshape(3, len(count), 4).transpose(0, 2, 1).reshape(_DIGITS, len(count))


@cache
def _fours() -> npt.NDArray[np.uint32]:
    """The four digits of 0 to 9999, as characters in one number (10000,)."""
    return np.frombuffer("".join([f"{each:04d}" for each in range(10_000)]).encode(), np.uint32)


_VARIES = "\0"  # no text in JSON holds it
HEAD = "    n  line  kind        X radius          Z         feed      rpm       t  block\n"


def block_json(block: Block, source_line: str, t0: float, t1: float) -> Json:
    """One elementary block with the keys and units of docs/json.md; keys that do not apply are null."""
    arc = block.kind == "arc"
    circular = arc or block.kind == "plane-arc"
    turned = block.kind == "rotate"  # its speed is rpm
    return {
        **block_head(block, source_line),
        "x": inches(block.x),
        "z": inches(block.z),
        "c": degrees(block.c),
        "mx": inches(block.mx),
        "mz": inches(block.mz),
        "cx": inches(block.cx) if arc else None,
        "cz": inches(block.cz) if arc else None,
        "dir": ("cw" if block.clockwise else "ccw") if circular else None,
        **_plane_json(block),
        "feed": None if turned else _feed_value(block),
        "feed_mode": None if turned else "ipr" if block.per_rev else "ipm",
        "rpm": round(block.rpm, 6) + 0.0,
        "css": None if block.css is None else round(block.css / MM_S_PER_FT_MIN, 6),
        "t0": seconds(t0),
        "t1": seconds(t1),
    }


def _feed_value(block: Block) -> float:
    """Feed of a block in in/min or in/rev."""
    return inches(block.feed) if block.per_rev else per_minute(block.feed)


def row(block: Block, t0: float) -> str:
    """One line of the table for a person."""
    return (
        f"{block.n:5d} {block.line:5d}  {block.kind:10s}{inches(block.x):11.5f}{inches(block.z):11.5f}"
        f"{_feed(block)}{t0:8.2f}  {block.text}\n"
    )


def _feed(block: Block) -> str:
    """Feed and speed in the table."""
    feed = f"{inches(block.feed):.5f}/r" if block.per_rev else f"{per_minute(block.feed):.2f}/m"
    return f"{feed:>13s}{block.rpm:9.0f}"


# --- many moves at once, to the letter as one by one ------------------------------------------------------


def series_rows(moves: TimedSeries) -> str:
    """The lines of the table."""
    series = moves.series
    line = f"%5d %5d  {series.pattern.kind:10s}%11.5f%11.5f%s%8.2f  %s\n"
    lines = series.line.tolist()
    texts = series.source_lines()
    x, z = (rounded(mm / MM_PER_INCH, 9).tolist() for mm in (series.x, series.z))
    columns = (series.n.tolist(), lines, x, z, _of_feeds(series, _feed), moves.t0.tolist(), texts)
    return "".join([line % each for each in zip(*columns, strict=True)])


def _of_feeds(series: Series, text: Callable[[Block], str]) -> Iterable[str]:
    """The text of each move, which follows from its feed."""
    like = series.pattern
    if series.feed is None:
        return [text(like)] * len(series)
    feeds = series.feed.tolist()
    texts = {each: text(replace(like, feed=each)) for each in set(feeds)}
    return map(texts.__getitem__, feeds)


def series_json(moves: TimedSeries) -> str:
    """The objects, a line each."""
    series, like, lines = moves.series, moves.series.pattern, moves.series.line.tolist()
    texts = _texts_json(series.source_lines())  # a plain move's text is its line
    columns = {
        "n": map(str, series.n.tolist()),
        "line": map(str, lines),
        "source": texts,
        "text": texts,
        "x": decimals(series.x / MM_PER_INCH, 9),
        "z": decimals(series.z / MM_PER_INCH, 9),
        "mx": decimals((series.x + like.offset_x) / MM_PER_INCH, 9),
        "mz": decimals((series.z + like.offset_z) / MM_PER_INCH, 9),
        "feed": _of_feeds(series, lambda block: json.dumps(_feed_value(block))),
        "t0": decimals(moves.t0, 6),
        "t1": decimals(moves.t1, 6),
    }
    cells = {key: json.dumps(value) for key, value in block_json(like, "", 0.0, 0.0).items()}
    cells |= dict.fromkeys(columns, _VARIES)
    line = ", ".join(f'"{key}": {cell}' for key, cell in cells.items())
    varying = [columns[key] for key in cells if key in columns]
    return _woven(f"{{{line}}}\n".split(_VARIES), varying, len(series))


def _texts_json(texts: Sequence[str]) -> list[str]:
    """Each text as JSON has it; all at once, for a call costs more than the text. None has a line end."""
    return json.dumps(texts, separators=("\n", ": "))[1:-1].split("\n")


def _woven(between: Sequence[str], columns: Sequence[Iterable[str]], count: int) -> str:
    """So many lines of columns with the same text before, ``between`` and after them in each."""
    width = len(between) + len(columns)
    woven = [""] * (count * width)
    for at, text in enumerate(between):
        woven[2 * at :: width] = [text] * count
    for at, column in enumerate(columns):
        woven[2 * at + 1 :: width] = column
    return "".join(woven)


def _plane_json(block: Block) -> Json:
    """End and centre of a block in the virtual mill's frame; on the side of the part its Z is a diameter."""
    way = block.plane
    if way is None:
        return dict.fromkeys(("px", "py", "pz", "pcx", "pcy"))
    x, y, z = way.end
    return {
        "px": inches(x),
        "py": inches(y),
        "pz": inches(2 * z if way.on_side else z),
        "pcx": None if way.centre is None else inches(way.centre[0]),
        "pcy": None if way.centre is None else inches(way.centre[1]),
    }

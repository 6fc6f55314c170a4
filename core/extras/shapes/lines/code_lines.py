"""Program lines of a shape and of a bar feed loop: words, rapids, cuts and feeds of this control."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from core.extras.shapes.contour import SAME, Row, points
from core.extras.shapes.shape_fields import Setting
from core.language.source import Dialect


class Bars(NamedTuple):
    """A bar feed loop.

    ``many`` parts of the length ``long`` are made. The bar is fed at ``rate`` per minute to the tool
    ``stop``, which leaves ``stock`` on the face. ``each`` feeds the bar for each part, otherwise it is fed
    once. ``part`` is the number of the part's subroutine.
    """

    many: int
    long: float
    each: bool
    stop: float
    stock: float
    rate: float
    part: int

    @property
    def out(self) -> float:
        """Length by which the bar is fed out at a time."""
        return self.long if self.each else self.many * self.long


def write_bars(code: Code, bars: Bars) -> None:
    """Write a bar feed loop in the language of the program."""
    (_sinumerik if code.setting.dialect is Dialect.SINUMERIK else _omniturn)(code, bars)


def _omniturn(code: Code, bars: Bars) -> None:
    """Write the loop with LS … LF. G97 only carries the comment, which is not allowed inside a loop."""
    call, loop = f"P{bars.part}", f"LS{bars.many}"
    code.write("G97", loop) if bars.each else code.write("G97")
    code.write(f"T{bars.stop:.0f}")
    _to_stop(code, bars)
    code.write("M13", f"G94F{plain(bars.rate)}{code.z(bars.stock)}", "M12")
    code.forget()
    code.away()
    if bars.each:
        code.write(call, "LF")
    else:
        code.write(loop, call, f"G10{code.point(0.0, -bars.long)}", "LF", "T0")


def _sinumerik(code: Code, bars: Bars) -> None:
    """Write the loop with REPEAT between two labels; ATRANS shifts zero along a bar that is fed once."""
    opens, closes = code.setting.shop.chuck or (0, 0)
    begin, end = f"BAR_{bars.part}", f"BAR_{bars.part}_END"
    code.write(*([f"{begin}:"] if bars.each else []), f"T{bars.stop:.0f} D1", "M5")
    code.forget()
    _to_stop(code, bars)
    code.write(f"M{opens}", f"G94 G1 {code.z(bars.stock)} F{plain(bars.rate)}", f"M{closes}")
    code.forget()
    code.away()
    code.write(*([] if bars.each else [f"{begin}:"]), f"PART_{bars.part}")
    if not bars.each:
        code.write(" ".join(("ATRANS", code.z(-bars.long))))
    code.write(f"{end}:")
    if bars.many > 1:
        code.write(" ".join(("REPEAT", begin, end, f"P={bars.many - 1}")))
    if not bars.each:
        code.write("TRANS")


def _to_stop(code: Code, bars: Bars) -> None:
    """Write the move of the stop to the end of the bar."""
    code.rapid(0.0, code.setting.clear)
    code.rapid(z=bars.stock - bars.out)


class Along(NamedTuple):
    """Turning of a contour: roughing in passes of ``rough`` (0 for none), then one pass along the contour.

    The contour ends at a radius clear of the material. ``offset`` is the number of the nose compensation, or
    0. ``label`` is a number for the contour in languages that label contours.
    """

    rows: Sequence[Row]
    beside: float
    inside: bool
    feed: float
    rough: float = 0.0
    leave: float = 0.0
    rough_feed: float = 0.0
    offset: float = 0.0
    label: float = 0.0


class Tap(NamedTuple):
    """A tap on the axis from ``start`` to ``end`` with ``pitch`` at ``rpm``; ``into`` is its M code.

    ``rigid`` turns the spindle in step with Z if the language permits; otherwise a floating holder is used.
    """

    start: float
    end: float
    pitch: float
    rpm: float
    into: str
    dwell: float
    rigid: bool = False


class Code:
    """Writer of lines that tracks the modal state of the program.

    X is given as a radius. Words that are already in force are not repeated.
    """

    loops = True  # LS … LF can repeat a group of lines
    edge = 1.0  # cutting edge of the tools, in languages with several edges per tool

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.lines: list[str] = []
        self._rapid = False
        self._feed = ""

    def write(self, *lines: str) -> None:
        """Add lines unchanged."""
        self.lines += lines

    def forget(self) -> None:
        """Clear the tracked modal state, after lines that were added unchanged."""
        self._rapid, self._feed = False, ""

    # --- Words

    def x(self, radius: float, letter: str = "X") -> str:
        """Return the word of a radius, as a diameter if the program uses diameters."""
        s = self.setting
        value = 2.0 * radius if s.diameter else radius
        return letter + plain(rounded(value, metric=s.metric, twice=s.diameter))

    def z(self, value: float, letter: str = "Z") -> str:
        """Return the word of a length along Z, or of another length that is never a diameter."""
        return letter + plain(rounded(value, metric=self.setting.metric))

    def point(self, x: float | None, z: float | None) -> str:
        """Return the X and Z words of a move; None omits a word."""
        return ("" if x is None else self.x(x)) + ("" if z is None else self.z(z))

    # --- Moves

    def noted(self, comment: str) -> list[str]:
        """Return the lines with a comment on the first line."""
        return [f"{self.lines[0]}({comment})", *self.lines[1:]]

    def begin(self, tool: float, rpm: float, x: float, z: float | None, turns: str = "M03") -> None:
        """Write tool, spindle and rapids to ``x`` at the tool change Z, and then to ``z``."""
        self.write(f"T{tool:.0f}")
        if rpm:
            self.write(f"{turns}S{plain(rpm, 0)}")
        self.forget()
        self.rapid(x, self.setting.clear)
        if z is not None:
            self.rapid(z=z)

    def rapid(self, x: float | None = None, z: float | None = None) -> None:
        """Write a rapid."""
        self.write(("" if self._rapid else "G00") + self.point(x, z))
        self._rapid = True

    def cut(self, x: float | None = None, z: float | None = None, feed: float = 0.0, more: str = "") -> None:
        """Write a feed move; 0 as ``feed`` retains the feed rate, and ``more`` follows the point."""
        self.write(self.fed(feed) + self.point(x, z) + more)

    def fed(self, feed: float) -> str:
        """Return the words that make the next move a cut at ``feed`` per revolution; empty if in force."""
        word = f"F{plain(feed, 6)}" if feed else self._feed
        if word == self._feed:
            again = "G01" if self._rapid else ""
        else:
            again = f"G95{word}" if self._rapid or not self._feed else word
        self._feed, self._rapid = word, False
        return again

    def set_feed(self, feed: float) -> None:
        """Write a line with only a feed, for the following moves."""
        self.write(self.fed(feed) or f"F{plain(feed, 6)}")

    def line(self, x: float | None, z: float | None, chamfer: float, radius: float) -> None:
        """Write a line of a contour, with the corner to the next line."""
        corner = self.z(chamfer, "C") if chamfer else self.z(radius, "R") if radius else ""
        self.write(self.fed(0.0) + self.point(x, z) + corner)

    def arc(self, x: float, z: float, radius: float, *, convex: bool) -> None:
        """Write an arc from the last point: convex like a shoulder of a shaft, or concave like a fillet."""
        self.write(f"{'G02' if convex else 'G03'}{self.point(x, z)}{self.z(radius, 'R')}")

    def dwell(self, seconds: float) -> None:
        """Write a dwell; 0 s writes nothing."""
        if seconds:
            self.write(f"G04F{plain(seconds)}")

    def away(self) -> None:
        """Write a rapid along Z to the tool change position."""
        self.rapid(z=self.setting.clear)

    # --- Contours and holes

    def along(self, way: Along) -> None:
        """Write roughing with G75 if specified, then the contour, with compensation if specified."""
        there = points(way.rows)
        first = there[0]
        if way.rough:
            self.set_feed(way.rough_feed)
            self.write(f"G75{self.z(way.rough, 'I')}{self.z(way.leave, 'U')}F{_feed(way.rough_feed)}")
            self.write(self.point(first[1], first[0]))
            self.contour(way.rows)
            self.write("RF")
            self.rapid(x=first[1])
        if way.offset:
            self.set_feed(way.feed)
            self.write("G42" if way.inside else "G41", f"{self.z(first[0])}D{way.offset:.0f}")
        else:
            self.cut(z=first[0], feed=way.feed)
        self.contour(way.rows)
        if abs(way.beside - there[-1][1]) > 1e-9:
            self.cut(x=way.beside)

    def contour(self, rows: Sequence[Row]) -> None:
        """Write the lines of a contour after its first point, which the tool has already reached."""
        for (_, before), (row, here) in pairwise(zip(rows, points(rows), strict=True)):
            x = here[1] if row.x is not None and (row.arc or abs(here[1] - before[1]) > SAME) else None
            z = here[0] if row.z is not None and (row.arc or abs(here[0] - before[0]) > SAME) else None
            if row.arc:
                self.arc(here[1], here[0], abs(row.arc), convex=row.arc > 0)
            elif x is not None or z is not None:
                self.line(x, z, row.chamfer, row.radius)

    def let_go(self, offset: float) -> None:
        """Cancel the compensation if a contour used this offset."""
        if offset:
            self.write("G40")

    def drill(self, end: float, peck: float, feed: float, start: float) -> None:
        """Write a hole from the present position to ``end``, with pecks or in one pass.

        ``start`` is the depth of an existing hole.
        """
        word = f"F{plain(feed, 6)}"
        self.write("G95")
        if peck:
            back = self.z(self.setting.near / 2.0, "R") if start else ""
            self.write(f"G83{self.z(end)}{self.z(peck, 'K')}{word}{back}")
        else:
            self.write(f"G81{self.z(end)}{word}")
        self.forget()

    def tap(self, tool: float, tap: Tap) -> None:
        """Write a tap: feed in at the pitch, reverse the spindle, feed out."""
        self.begin(tool, tap.rpm, 0.0, tap.start, tap.into)
        self.cut(z=tap.end, feed=tap.pitch)
        self.write("M03" if tap.into == "M04" else "M04")
        self.dwell(tap.dwell)
        self.cut(z=tap.start)

    # --- Spindle

    def surface_speed(self, surface: float, most: float) -> None:
        """Write constant surface speed, limited to ``most`` rpm."""
        self.write(f"G96S{plain(surface, 0)}", f"G77S{plain(most, 0)}")

    def constant_speed(self) -> None:
        """Write the return to rpm, before another tool."""
        self.write("G97")


def _feed(value: float) -> str:
    return f"{value:.6f}".rstrip("0").replace("0.", ".", 1) if value < 1 else f"{value:g}"


# by metric; step to which a word is rounded, twice as large for a diameter
_STEPS = {False: 0.00005, True: 0.0005}
_NUMBER = re.compile(r"(M?)(\d+)(?:P(\d+))?(?:MM)?")
_NO_ZERO = re.compile(r"(?<![\d.])\.(?=\d)")
_NAME = str.maketrans({"/": "S", "-": "A", ".": "P", "#": "N"})
_BACK = str.maketrans({"S": "/", "A": "-", "P": ".", "N": "#"})


def plain(value: float, places: int = 5) -> str:
    """Return a number as programs write it, without zeros before the point or at the end: .5, -.035, 2."""
    text = f"{value:.{places}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    if text in {"-0", "-", ""}:
        return "0"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def figure(value: float, places: int = 5) -> str:
    """Return a number as SINUMERIK programs write it: 0.5, -0.035, 2."""
    return with_zero(plain(value, places))


def with_zero(word: str) -> str:
    """Return a word from ``plain`` with a zero before its point."""
    return _NO_ZERO.sub("0.", word)


def rounded(value: float, *, metric: bool, twice: bool = False) -> float:
    """Return a length rounded to the step of the control; ``twice`` rounds to the step of a diameter."""
    step = _STEPS[metric] * (2.0 if twice else 1.0)
    return round(value / step) * step


def rounded_up(radius: float, *, metric: bool) -> float:
    """Return a depth rounded up to the step of the control.

    In passes of equal chip area, a slightly smaller depth would require one more pass.
    """
    step = _STEPS[metric]
    return math.ceil(radius / step - 1e-6) * step


def in_comment(value: float, places: int = 5) -> str:
    """Return a number for a comment, with P for the point and a leading M for minus: 0P5, M0P035."""
    text = f"{abs(value):.{places}f}".rstrip("0").rstrip(".")
    sign = "M" if value < 0 and text.strip("0.") else ""
    return sign + text.replace(".", "P")


def from_comment(text: str) -> float | None:
    """Return the number written by ``in_comment``; None if the text has another format."""
    found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    value = float(f"{found[2]}.{found[3] or 0}")
    return -value if found[1] else value


def name_in_comment(name: str) -> str:
    """Return a thread size in letters and digits: 1/2 is 1S2, 1-1/8 is 1A1S8, M10X1.25 is M10X1P25."""
    return name.translate(_NAME)


def name_from_comment(text: str) -> str:
    """Return the name that ``name_in_comment`` has written."""
    return text.translate(_BACK)

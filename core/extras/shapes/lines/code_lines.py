"""The lines of a shape and of a bar loop: numbers as words, rapids, cuts and feeds of this control."""

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
    """``many`` parts of ``long``, fed by ``rate`` a minute to the tool ``stop``, which leaves ``stock``.

    ``each``: the bar is fed for each part, else once. ``part`` is the number of its subroutine.
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
        """How far the bar comes out at a time."""
        return self.long if self.each else self.many * self.long


def write_bars(code: Code, bars: Bars) -> None:
    """In the language of the program."""
    (_sinumerik if code.setting.dialect is Dialect.SINUMERIK else _omniturn)(code, bars)


def _omniturn(code: Code, bars: Bars) -> None:
    """LS … LF. G97 changes nothing: it carries the comment, which has no place inside a loop."""
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
    """REPEAT between two labels; a bar that was fed once is gone along by ATRANS."""
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
    """The stop to the end of the bar."""
    code.rapid(0.0, code.setting.clear)
    code.rapid(z=bars.stock - bars.out)


class Along(NamedTuple):
    """A contour that is turned: roughed in passes of ``rough`` (0: not), then along it once.

    ``beside`` is the radius beside the metal where it ends, ``offset`` the number of the nose compensation,
    0 for none, ``label`` a number for the contour where the language names it.
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
    """A tap on the axis: from ``start`` in to ``end``, by ``pitch`` at ``rpm``, turned by ``into``.

    ``rigid``: the spindle is held and turned with Z, where the language can; else a holder gives.
    """

    start: float
    end: float
    pitch: float
    rpm: float
    into: str
    dwell: float
    rigid: bool = False


class Code:
    """Lines in the modes of a program. X is given as a radius; what is in force is not written again."""

    loops = True  # a group of lines is repeated by LS … LF
    edge = 1.0  # the cutting edge of the tools, where the language has several a tool

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.lines: list[str] = []
        self._rapid = False
        self._feed = ""

    def write(self, *lines: str) -> None:
        """Lines as they are."""
        self.lines += lines

    def forget(self) -> None:
        """Behind lines that were written as they are: nobody knows what flag and feed are in force."""
        self._rapid, self._feed = False, ""

    # --- words

    def x(self, radius: float, letter: str = "X") -> str:
        """The word of a radius, as the program has X."""
        s = self.setting
        value = 2.0 * radius if s.diameter else radius
        return letter + plain(rounded(value, metric=s.metric, twice=s.diameter))

    def z(self, value: float, letter: str = "Z") -> str:
        """The word of a length along Z, or of one that is never a diameter."""
        return letter + plain(rounded(value, metric=self.setting.metric))

    def point(self, x: float | None, z: float | None) -> str:
        """X and Z of a move; what is None is not written."""
        return ("" if x is None else self.x(x)) + ("" if z is None else self.z(z))

    # --- moves

    def noted(self, comment: str) -> list[str]:
        """The lines, the first with this comment."""
        return [f"{self.lines[0]}({comment})", *self.lines[1:]]

    def begin(self, tool: float, rpm: float, x: float, z: float | None, turns: str = "M03") -> None:
        """Tool, spindle, and rapids to ``x`` at the clear Z and from there to ``z``."""
        self.write(f"T{tool:.0f}")
        if rpm:
            self.write(f"{turns}S{plain(rpm, 0)}")
        self.forget()
        self.rapid(x, self.setting.clear)
        if z is not None:
            self.rapid(z=z)

    def rapid(self, x: float | None = None, z: float | None = None) -> None:
        """A rapid."""
        self.write(("" if self._rapid else "G00") + self.point(x, z))
        self._rapid = True

    def cut(self, x: float | None = None, z: float | None = None, feed: float = 0.0, more: str = "") -> None:
        """A feed move; ``feed`` 0 is the one before. ``more``: words behind the point."""
        self.write(self.fed(feed) + self.point(x, z) + more)

    def fed(self, feed: float) -> str:
        """The words that make the next move a cut by ``feed`` a turn: none where that is in force."""
        word = f"F{plain(feed, 6)}" if feed else self._feed
        if word == self._feed:
            again = "G01" if self._rapid else ""
        else:
            again = f"G95{word}" if self._rapid or not self._feed else word
        self._feed, self._rapid = word, False
        return again

    def set_feed(self, feed: float) -> None:
        """A feed alone on its line, for the moves behind it."""
        self.write(self.fed(feed) or f"F{plain(feed, 6)}")

    def line(self, x: float | None, z: float | None, chamfer: float, radius: float) -> None:
        """A line of a contour, with the corner to the next."""
        corner = self.z(chamfer, "C") if chamfer else self.z(radius, "R") if radius else ""
        self.write(self.fed(0.0) + self.point(x, z) + corner)

    def arc(self, x: float, z: float, radius: float, *, convex: bool) -> None:
        """An arc from the last point, convex as the shoulder of a shaft or concave as a fillet."""
        self.write(f"{'G02' if convex else 'G03'}{self.point(x, z)}{self.z(radius, 'R')}")

    def dwell(self, seconds: float) -> None:
        """A wait; of no seconds none."""
        if seconds:
            self.write(f"G04F{plain(seconds)}")

    def away(self) -> None:
        """Along Z to where tools change."""
        self.rapid(z=self.setting.clear)

    # --- along a contour, holes

    def along(self, way: Along) -> None:
        """Roughing by G75 where a depth of a pass is said, then the contour, compensated where asked for."""
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
        """The lines from the first point on, which the tool has reached already."""
        for (_, before), (row, here) in pairwise(zip(rows, points(rows), strict=True)):
            x = here[1] if row.x is not None and (row.arc or abs(here[1] - before[1]) > SAME) else None
            z = here[0] if row.z is not None and (row.arc or abs(here[0] - before[0]) > SAME) else None
            if row.arc:
                self.arc(here[1], here[0], abs(row.arc), convex=row.arc > 0)
            elif x is not None or z is not None:
                self.line(x, z, row.chamfer, row.radius)

    def let_go(self, offset: float) -> None:
        """Compensation off, where a contour was compensated by this offset."""
        if offset:
            self.write("G40")

    def drill(self, end: float, peck: float, feed: float, start: float) -> None:
        """From where the tool stands to ``end``, in pecks of so much or in one go; begun ``start`` deep."""
        word = f"F{plain(feed, 6)}"
        self.write("G95")
        if peck:
            back = self.z(self.setting.near / 2.0, "R") if start else ""
            self.write(f"G83{self.z(end)}{self.z(peck, 'K')}{word}{back}")
        else:
            self.write(f"G81{self.z(end)}{word}")
        self.forget()

    def tap(self, tool: float, tap: Tap) -> None:
        """In at the pitch, the spindle turned back, out at the pitch."""
        self.begin(tool, tap.rpm, 0.0, tap.start, tap.into)
        self.cut(z=tap.end, feed=tap.pitch)
        self.write("M03" if tap.into == "M04" else "M04")
        self.dwell(tap.dwell)
        self.cut(z=tap.start)

    # --- spindle

    def surface_speed(self, surface: float, most: float) -> None:
        """Constant surface speed up to ``most`` rpm."""
        self.write(f"G96S{plain(surface, 0)}", f"G77S{plain(most, 0)}")

    def constant_speed(self) -> None:
        """Back to rpm, before another tool."""
        self.write("G97")


def _feed(value: float) -> str:
    return f"{value:.6f}".rstrip("0").replace("0.", ".", 1) if value < 1 else f"{value:g}"


_STEPS = {False: 0.00005, True: 0.0005}  # by metric: what a word is rounded to; a diameter twice of it
_NUMBER = re.compile(r"(M?)(\d+)(?:P(\d+))?(?:MM)?")
_NO_ZERO = re.compile(r"(?<![\d.])\.(?=\d)")
_NAME = str.maketrans({"/": "S", "-": "A", ".": "P", "#": "N"})
_BACK = str.maketrans({"S": "/", "A": "-", "P": ".", "N": "#"})


def plain(value: float, places: int = 5) -> str:
    """``value`` as programs have it: no zero before the point nor behind it: .5, -.035, 2."""
    text = f"{value:.{places}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    if text in {"-0", "-", ""}:
        return "0"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def figure(value: float, places: int = 5) -> str:
    """``value`` as SINUMERIK programs have it: 0.5, -0.035, 2."""
    return with_zero(plain(value, places))


def with_zero(word: str) -> str:
    """A word of ``plain`` with the zero before its point."""
    return _NO_ZERO.sub("0.", word)


def rounded(value: float, *, metric: bool, twice: bool = False) -> float:
    """A length on the step of the control; ``twice``: on that of a diameter."""
    step = _STEPS[metric] * (2.0 if twice else 1.0)
    return round(value / step) * step


def rounded_up(radius: float, *, metric: bool) -> float:
    """A depth on the step of the control or above it: in passes of equal chip a hair less is a pass more."""
    step = _STEPS[metric]
    return math.ceil(radius / step - 1e-6) * step


def in_comment(value: float, places: int = 5) -> str:
    """A number of a comment: P stands for the point, a leading M for minus: 0P5, M0P035."""
    text = f"{abs(value):.{places}f}".rstrip("0").rstrip(".")
    sign = "M" if value < 0 and text.strip("0.") else ""
    return sign + text.replace(".", "P")


def from_comment(text: str) -> float | None:
    """The number of ``in_comment``; None where it is none."""
    found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    value = float(f"{found[2]}.{found[3] or 0}")
    return -value if found[1] else value


def name_in_comment(name: str) -> str:
    """The name of a size in letters and digits: 1/2 is 1S2, 1-1/8 is 1A1S8, M10X1.25 is M10X1P25."""
    return name.translate(_NAME)


def name_from_comment(text: str) -> str:
    """The name that was written so."""
    return text.translate(_BACK)

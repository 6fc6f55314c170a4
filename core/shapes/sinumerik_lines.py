"""The lines of a shape in SINUMERIK: words apart, zeros before the point, CYCLE95, CYCLE81 and CYCLE83.

Grooves are cut by G1: CYCLE93 takes the width of the blade from a second cutting edge, which has to be set,
and knows no walls that lean.
"""

from __future__ import annotations

import re

from core.shapes.code_lines import Along, Code
from core.shapes.contour import points
from core.shapes.number_words import plain
from core.shapes.shape_setting import Setting

_NO_ZERO = re.compile(r"(?<![\d.])\.(?=\d)")
_TURNS = {"M03": "M3", "M04": "M4"}


def figure(value: float, places: int = 5) -> str:
    """A number as this control's programs have it: 0.5, -0.035, 2."""
    return _NO_ZERO.sub("0.", plain(value, places))


class SinumerikCode(Code):
    """Lines under G18, G90 and G95; the motion in force is not written again, but in each contour."""

    loops = False

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self._motion = ""

    def forget(self) -> None:
        """Behind lines that were written as they are."""
        super().forget()
        self._motion = ""

    def noted(self, comment: str) -> list[str]:
        """The lines, the first with this comment."""
        return [f"{self.lines[0]} ; {comment}", *self.lines[1:]]

    # --- words

    def x(self, radius: float, letter: str = "X") -> str:
        """The word of a radius, as the program has X."""
        return _NO_ZERO.sub("0.", super().x(radius, letter))

    def z(self, value: float, letter: str = "Z") -> str:
        """The word of a length along Z."""
        return _NO_ZERO.sub("0.", super().z(value, letter))

    def point(self, x: float | None, z: float | None) -> str:
        """X and Z of a move; what is None is not written."""
        return " ".join(([] if x is None else [self.x(x)]) + ([] if z is None else [self.z(z)]))

    def _move(self, motion: str, *words: str) -> None:
        begin = [] if self._motion == motion else [motion]
        self._motion = motion
        self.write(" ".join([*begin, *(word for word in words if word)]))

    # --- moves

    def begin(self, tool: float, rpm: float, x: float, z: float | None, turns: str = "M03") -> None:
        """Tool and cutting edge, spindle, and rapids to ``x`` at the clear Z and from there to ``z``."""
        self.write(f"T{tool:.0f} D{self.edge:.0f}")
        if rpm:
            self.write(f"G95 S{figure(rpm, 0)} {_TURNS[turns]}")
        self.forget()
        self.rapid(x, self.setting.clear)
        if z is not None:
            self.rapid(z=z)

    def rapid(self, x: float | None = None, z: float | None = None) -> None:
        """A rapid."""
        self._move("G0", self.point(x, z))

    def cut(self, x: float | None = None, z: float | None = None, feed: float = 0.0, more: str = "") -> None:
        """A feed move; ``feed`` 0 is the one before. ``more``: words behind the point."""
        self._move("G1", self.point(x, z), more, self._fresh(feed))

    def _fresh(self, feed: float) -> str:
        """The word of a feed; none where it is in force."""
        word = f"F{figure(feed, 6)}" if feed else self._feed
        said, self._feed = ("" if word == self._feed else word), word
        return said

    def line(self, x: float | None, z: float | None, chamfer: float, radius: float) -> None:
        """A line of a contour, with the corner to the next."""
        corner = self.z(chamfer, "CHR=") if chamfer else self.z(radius, "RND=") if radius else ""
        self._move("G1", self.point(x, z), corner)

    def arc(self, x: float, z: float, radius: float, *, convex: bool) -> None:
        """An arc from the last point, convex as the shoulder of a shaft or concave as a fillet."""
        self._motion = ""
        self._move("G3" if convex else "G2", self.point(x, z), self.z(radius, "CR="))
        self._motion = ""

    def dwell(self, seconds: float) -> None:
        """A wait; of no seconds none."""
        if seconds:
            self.write(f"G4 F{figure(seconds)}")

    # --- along a contour, holes

    def along(self, way: Along) -> None:
        """CYCLE95 on the contour between two labels where it is roughed; then the contour once."""
        there, name = points(way.rows), f"CONTOUR_{way.label or 1.0:.0f}"
        (z, x), feed = there[0], self._fresh(way.feed)
        if way.rough:
            fast = figure(way.rough_feed, 6)
            words = f"{figure(way.rough)}, , , {figure(way.leave)}, {fast}, {fast}"
            self.write(f'CYCLE95("{name}:{name}_END", {words}, , {3 if way.inside else 1})')
            self.forget()
            self.rapid(x, z + self.setting.near)
        if way.offset:
            self.write("G41" if way.inside else "G42")
        if way.rough:
            self.write(f"{name}:")
        self._motion = ""
        self._move("G1", self.point(x, z), feed or f"F{figure(way.feed, 6)}")
        self.contour(way.rows)
        if way.rough:
            self.write(f"{name}_END:")
        off = "G40" if way.offset else ""
        self._motion = ""
        if abs(way.beside - there[-1][1]) > 1e-9:
            self.write(" ".join(word for word in (off, "G1", self.x(way.beside)) if word))
        elif off:
            self.write(f"{off} G0 {self.z(self.setting.clear)}")

    def let_go(self, offset: float) -> None:
        """Compensation is off: the move away from the contour has done it."""

    def drill(self, end: float, peck: float, feed: float, start: float) -> None:
        """CYCLE81 or CYCLE83 under G17, which drills along Z."""
        near = self.setting.near
        planes = f"{figure(near)}, {figure(-start)}, {figure(near / 2.0)}, {figure(end)}"
        self.write(f"G17 {self._fresh(feed)}".rstrip())
        if peck:
            self.write(f"CYCLE83({planes}, , , {figure(peck)}, 0, 0, 0, 1, 1)")
        else:
            self.write(f"CYCLE81({planes})")
        self.write("G18")
        self.forget()

    # --- spindle

    def surface_speed(self, surface: float, most: float) -> None:
        """Constant surface speed up to ``most`` rpm."""
        self.write(f"G96 S{figure(surface, 0)} LIMS={figure(most, 0)}")

    def constant_speed(self) -> None:
        """Back to rpm, before another tool."""
        self.write("G97")

"""The lines of a shape: rapids, cuts and feeds as a programmer of this control writes them."""

from __future__ import annotations

from core.shapes.number_words import plain, rounded
from core.shapes.shape_setting import Setting


class Code:
    """Lines in the modes of a program. X is given as a radius; what is in force is not written again."""

    loops = True  # a group of lines is repeated by LS … LF

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

    # --- spindle

    def surface_speed(self, surface: float, most: float) -> None:
        """Constant surface speed up to ``most`` rpm."""
        self.write(f"G96S{plain(surface, 0)}", f"G77S{plain(most, 0)}")

    def constant_speed(self) -> None:
        """Back to rpm, before another tool."""
        self.write("G97")

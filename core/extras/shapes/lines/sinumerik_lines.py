"""Program lines of a shape in SINUMERIK: separated words, leading zeros, CYCLE95, CYCLE81 and CYCLE83.

Grooves use G1, or CYCLE93 if the form specifies the second cutting edge of the blade.
"""

from __future__ import annotations

from core.extras.shapes.contour import points
from core.extras.shapes.lines.code_lines import Along, Code, Tap, figure, with_zero
from core.extras.shapes.shape_fields import Setting
from core.message import Message

_TURNS = {"M03": "M3", "M04": "M4"}


class SinumerikCode(Code):
    """Writer of lines under G18, G90 and G95 that repeats the motion word only in contours."""

    loops = False

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        self._motion = ""

    def forget(self) -> None:
        """Clear the tracked modal state, after lines that were added unchanged."""
        super().forget()
        self._motion = ""

    def noted(self, comment: str) -> list[str]:
        """Return the lines with a comment on the first line."""
        return [f"{self.lines[0]} ; {comment}", *self.lines[1:]]

    # --- Words

    def x(self, radius: float, letter: str = "X") -> str:
        """Return the word of a radius, as a diameter if the program uses diameters."""
        return with_zero(super().x(radius, letter))

    def z(self, value: float, letter: str = "Z") -> str:
        """Return the word of a length along Z."""
        return with_zero(super().z(value, letter))

    def point(self, x: float | None, z: float | None) -> str:
        """Return the X and Z words of a move; None omits a word."""
        return " ".join(([] if x is None else [self.x(x)]) + ([] if z is None else [self.z(z)]))

    def _move(self, motion: str, *words: str) -> None:
        begin = [] if self._motion == motion else [motion]
        self._motion = motion
        self.write(" ".join([*begin, *(word for word in words if word)]))

    # --- Moves

    def begin(self, tool: float, rpm: float, x: float, z: float | None, turns: str = "M03") -> None:
        """Write tool, cutting edge, spindle and rapids to ``x`` at the tool change Z, and then to ``z``."""
        self.write(f"T{tool:.0f} D{self.edge:.0f}")
        if rpm:
            self.write(f"G95 S{figure(rpm, 0)} {_TURNS[turns]}")
        self.forget()
        self.rapid(x, self.setting.clear)
        if z is not None:
            self.rapid(z=z)

    def rapid(self, x: float | None = None, z: float | None = None) -> None:
        """Write a rapid."""
        self._move("G0", self.point(x, z))

    def cut(self, x: float | None = None, z: float | None = None, feed: float = 0.0, more: str = "") -> None:
        """Write a feed move; 0 as ``feed`` retains the feed rate, and ``more`` follows the point."""
        self._move("G1", self.point(x, z), more, self._fresh(feed))

    def _fresh(self, feed: float) -> str:
        """Return the word of a feed; empty if the feed is in force."""
        word = f"F{figure(feed, 6)}" if feed else self._feed
        said, self._feed = ("" if word == self._feed else word), word
        return said

    def set_feed(self, feed: float) -> None:
        """Write a line with only a feed, for the following cycle."""
        self.write(self._fresh(feed) or f"F{figure(feed, 6)}")

    def line(self, x: float | None, z: float | None, chamfer: float, radius: float) -> None:
        """Write a line of a contour, with the corner to the next line."""
        corner = self.z(chamfer, "CHR=") if chamfer else self.z(radius, "RND=") if radius else ""
        self._move("G1", self.point(x, z), corner)

    def arc(self, x: float, z: float, radius: float, *, convex: bool) -> None:
        """Write an arc from the last point: convex like a shoulder of a shaft, or concave like a fillet."""
        self._motion = ""
        self._move("G3" if convex else "G2", self.point(x, z), self.z(radius, "CR="))
        self._motion = ""

    def dwell(self, seconds: float) -> None:
        """Write a dwell; 0 s writes nothing."""
        if seconds:
            self.write(f"G4 F{figure(seconds)}")

    # --- Contours and holes

    def along(self, way: Along) -> None:
        """Write CYCLE95 for the contour between two labels if it is roughed, then one pass along the contour.

        The cycle removes material up to the outermost point of its contour, so the contour includes the move
        away from the part.
        """
        there, name = points(way.rows), f"CONTOUR_{way.label or 1.0:.0f}"
        (z, x), feed = there[0], self._fresh(way.feed)
        if way.rough:
            fast = figure(way.rough_feed, 6)
            words = f"{figure(way.rough)}, , , {figure(way.leave)}, {fast}, {fast}"
            self.write(
                Message(
                    'CYCLE95("{name}:{name2}_END", {words}, , {value})',
                    name=name,
                    name2=name,
                    words=words,
                    value=3 if way.inside else 1,
                )
            )
            self.forget()
            self.rapid(x, z + self.setting.near)
        if way.offset:
            self.write("G41" if way.inside else "G42")
        if way.rough:
            self.write(f"{name}:")
        self._motion = ""
        self._move("G1", self.point(x, z), feed or f"F{figure(way.feed, 6)}")
        self.contour(way.rows)
        off, leaves = "G40" if way.offset else "", abs(way.beside - there[-1][1]) > 1e-9
        if way.rough:
            if leaves:
                self.cut(way.beside)
            self.write(f"{name}_END:")
        self._motion = ""
        if leaves and not way.rough:
            self.write(" ".join(word for word in (off, "G1", self.x(way.beside)) if word))
        elif off:
            self.write(off)

    def let_go(self, offset: float) -> None:
        """Write nothing, because the move away from the contour has canceled the compensation."""

    def drill(self, end: float, peck: float, feed: float, start: float) -> None:
        """Write CYCLE81 or CYCLE83 under G17, for drilling along Z."""
        near = self.setting.near
        planes = f"{figure(near)}, {figure(-start)}, {figure(near / 2.0)}, {figure(end)}"
        self.write(f"G17 {self._fresh(feed)}".rstrip())
        if peck:
            self.write(
                Message("CYCLE83({planes}, , , {peck}, 0, 0, 0, 1, 1)", planes=planes, peck=figure(peck))
            )
        else:
            self.write(f"CYCLE81({planes})")
        self.write("G18")
        self.forget()

    def tap(self, tool: float, tap: Tap) -> None:
        """Write CYCLE840, or CYCLE84 with the spindle as C axis, under G17."""
        self.begin(tool, 0.0 if tap.rigid else tap.rpm, 0.0, tap.start, tap.into)
        hole = f"{figure(tap.start)}, 0, {figure(tap.start)}, {figure(tap.end)}, , {figure(tap.dwell)}"
        self.write("G17")
        if tap.rigid:
            lead, speed = tap.pitch * (-1.0 if tap.into == "M04" else 1.0), figure(tap.rpm, 0)
            self.write(
                "M5",
                Message(
                    "CYCLE84({hole}, 5, , {lead}, 0, {speed}, {speed2})",
                    hole=hole,
                    lead=figure(lead, 6),
                    speed=speed,
                    speed2=speed,
                ),
            )
        else:
            self.write(Message("CYCLE840({hole}, 0, , 0, , {pitch})", hole=hole, pitch=figure(tap.pitch, 6)))
        self.write("G18")
        self.forget()

    # --- Spindle

    def surface_speed(self, surface: float, most: float) -> None:
        """Write constant surface speed, limited to ``most`` rpm."""
        self.write(
            Message("G96 S{surface} LIMS={maximum}", surface=figure(surface, 0), maximum=figure(most, 0))
        )

    def constant_speed(self) -> None:
        """Write the return to rpm, before another tool."""
        self.write("G97")

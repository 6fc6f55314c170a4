"""Program lines of the FreeCAD post-processor: words, moves, tool changes and the spindle.

FreeCAD does not show this file in its list. Copy it together with ``omniturn_post.py``.
"""

from __future__ import annotations

import argparse
import math
import re
from typing import NoReturn

MM_PER_INCH = 25.4
STEP_IN = 0.00005  # resolution of X and Z, on the radius
MAX_TOOL_NUMBER = 32
MIN_DWELL_S = 0.1
NEAR_MM = 1e-6
_ARC_TOLERANCE_MM = 0.01
_LONGEST_COMMENT = 60
_NOT_IN_COMMENTS = re.compile(r"[^ -'*-~]")


class PostError(ValueError):
    """Error raised for a command that the post-processor cannot write.

    The text contains the operation and the reason.
    """


def number(value: float, places: int = 5) -> str:
    """Format a number without unnecessary zeros, such as ``.5`` or ``-1.25``."""
    text = f"{value:.{max(places, 1)}f}".rstrip("0").rstrip(".")
    return re.sub(r"^(-?)0\.", r"\1.", "0" if text in {"-0", ""} else text)


class LineWriter:
    """Writer of the program lines, with the modal state after the last line.

    Positions are in mm, with X as a radius. ``x`` and ``z`` are None while the position is unknown.
    """

    def __init__(self, options: argparse.Namespace, clear_z: float) -> None:
        """Begin a program. ``clear_z`` is the Z of the tool change, in mm."""
        self.options = options
        self.clear_z = clear_z
        self.shift = (0.0, 0.0)  # of the zero offset, X (radius) and Z in mm
        self.has_shifts = bool(getattr(options, "shift", None))
        self.unit = MM_PER_INCH if options.inches else 1.0
        self.lines: list[str] = []
        self.comment = ""
        self.label = ""
        self.x: float | None = None
        self.z: float | None = None
        self.tool = 0
        self.speed = 0.0
        self.spindle_code = ""  # M3 or M4; empty while the spindle is stopped
        self.is_rapid = False
        self.feed_words = ""
        self.is_live = False  # the active tool is a live tool
        self.needs_both = True
        self.returns_to_start = True  # G98
        self.cut_feed = 0.0  # mm/s, of the last cut
        self.cycle_feed = 0.0
        rate = options.rapid or (300.0 if options.inches else 7620.0)
        self.add(f"G90G94F{number(rate, 3)}{'G70' if options.inches else 'G71'}G72")

    # --- lines and words

    def add(self, text: str) -> None:
        """Append a line, together with the comment that ``note`` has set for it."""
        comment = "" if self.options.no_comments else self.comment
        self.lines.append(text + (f"({comment})" if comment else ""))
        self.comment = ""

    def note(self, text: str) -> None:
        """Set the comment of the next line, with only the characters that the control accepts."""
        self.comment = _NOT_IN_COMMENTS.sub(" ", text)[:_LONGEST_COMMENT].strip()

    def reject(self, name: str, reason: str) -> NoReturn:
        """Raise PostError for a command of the current operation."""
        raise PostError(f"{self.label or 'path'}, {name}: {reason}")

    def round(self, value: float) -> float:
        """Convert a length in mm to the unit of the program, rounded to the resolution of the control."""
        if self.options.inches:
            return round(round(value / MM_PER_INCH / STEP_IN) * STEP_IN, 5) + 0.0
        return round(value, 4) + 0.0

    def word(self, letter: str, value: float) -> str:
        """Return the word of a length in mm; X is written as a diameter."""
        rounded = self.round(value)
        return letter + number(2.0 * rounded if letter == "X" else rounded)

    def position(self, x: float, z: float) -> str:
        """Return the words of the coordinates that change."""
        words = ""
        if self.needs_both or self.x is None or self.round(x) != self.round(self.x):
            words += self.word("X", x)
        if self.needs_both or self.z is None or self.round(z) != self.round(self.z):
            words += self.word("Z", z)
        return words

    def feed(self, name: str, feed: float) -> str:
        """Return the words of a feed in mm/s, or an empty string if it is already active."""
        if feed <= 0.0:
            self.reject(name, "the feed is 0; enter the feeds in the tool controller")
        per_minute = feed * 60.0 / self.unit
        words = f"G94F{number(per_minute, 4)}"
        if self.options.per_rev and not self.is_live:
            if self.speed <= 0.0:
                self.reject(name, "--per-rev needs a spindle speed in the tool controller")
            words = f"G95F{number(per_minute / self.speed, 6)}"
        if not self.is_rapid and words == self.feed_words:
            return ""
        self.is_rapid, self.feed_words = False, words
        return words

    # --- moves

    def rapid(self, x: float | None, z: float | None) -> None:
        """Write a rapid.

        If a coordinate is unknown, nothing is written until a later rapid specifies it.
        """
        if x is None or z is None:
            self.x, self.z = x, z
            return
        is_unknown = self.x is None or self.z is None
        if self.needs_both and z < self.get_clear_z() and (self.has_shifts or (is_unknown and z < 0.0)):
            z, last_z = self.get_clear_z(), z  # the line from an unknown position could cross a part
            self.add("G00" + self.word("X", x) + self.word("Z", z))
            self.is_rapid, self.needs_both = True, False
            self.x, self.z, z = x, z, last_z
        words = self.position(x, z)
        if words:
            self.add(("" if self.is_rapid else "G00") + words)
            self.is_rapid, self.needs_both = True, False
        self.x, self.z = x, z

    def cut(self, name: str, x: float | None, z: float | None, feed: float, arc: str = "") -> None:
        """Write a straight cut, or an arc with the words ``arc``."""
        if x is None or z is None or self.x is None or self.z is None or self.needs_both:
            self.reject(name, "the position before this cut is unknown; begin with a rapid in X and Z")
        self.check_spindle(name)
        words = self.word("X", x) + self.word("Z", z) if arc else self.position(x, z)
        if words:
            self.add(self.feed(name, feed) + arc[:3] + words + arc[3:])
        self.x, self.z = x, z

    def arc(self, name: str, values: dict[str, float], x: float | None, z: float | None, feed: float) -> None:
        """Write an arc of the XZ plane; an arc of more than 180° is divided at its middle.

        G02 and G03 are exchanged, because FreeCAD views the plane with X+ up, and OmniTurn with X+ down. An
        arc that ends at its start because of rounding is not written, because the control would cut a full
        circle.
        """
        if x is None or z is None or self.x is None or self.z is None:
            self.reject(name, "the position before this arc is unknown")
        if abs(values.get("J", 0.0)) > NEAR_MM:
            self.reject(name, "the arc is not in the XZ plane")
        center_x, center_z = self.x + values.get("I", 0.0), self.z + values.get("K", 0.0)
        radius = math.hypot(self.x - center_x, self.z - center_z)
        if radius < NEAR_MM or abs(math.hypot(x - center_x, z - center_z) - radius) > _ARC_TOLERANCE_MM:
            self.reject(name, "the end of the arc is not on its circle")
        if 0.0 < math.hypot(x - self.x, z - self.z) < NEAR_MM:
            return
        sign = 1.0 if name == "G3" else -1.0  # seen with Z to the right and X+ up
        begin = math.atan2(self.x - center_x, self.z - center_z)
        sweep = sign * (math.atan2(x - center_x, z - center_z) - begin) % (2.0 * math.pi) or 2.0 * math.pi
        parts = 1 if sweep <= math.pi + 1e-9 else 2
        for part in range(1, parts + 1):
            at = begin + sign * sweep * part / parts
            end_x, end_z = (
                (x, z)
                if part == parts
                else (
                    center_x + radius * math.sin(at),
                    center_z + radius * math.cos(at),
                )
            )
            words = self.word("I", center_x - self.x) + self.word("K", center_z - self.z)
            if self.position(end_x, end_z):
                self.cut(name, end_x, end_z, feed, ("G02" if name == "G3" else "G03") + words)

    # --- tools, spindle, cycles

    def change_tool(self, name: str, value: float) -> None:
        """Retract to the Z of the tool change and select a tool; the next rapid has X and Z."""
        if value != int(value) or not 1 <= value <= MAX_TOOL_NUMBER:
            self.reject(name, f"T{value:g} does not exist; use T1 to T{MAX_TOOL_NUMBER}")
        comment, self.comment = self.comment, ""
        self.retract()
        self.tool = int(value)
        self.prepare_tool()
        self.comment = comment
        self.select_offset()

    def prepare_tool(self) -> None:
        """Write the lines between the retract and T; a turning tool needs none."""

    def select_offset(self) -> None:
        """Write T, after which the position is unknown."""
        self.add(f"T{self.tool}")
        self.x = self.z = None
        self.needs_both = True
        self.forget_modes()

    def forget_modes(self) -> None:
        """Write G00 or the feed again on the next move, so that it does not depend on the lines before."""
        self.is_rapid, self.feed_words = False, ""

    def shift_zero(self, name: str, shift: tuple[float, float]) -> None:
        """Write the work shift of a zero offset in mm, with X as a radius; G10 adds to the active shift."""
        if shift == self.shift:
            return
        comment, self.comment = self.comment, ""
        self.retract()
        self.comment = comment or name
        (old_x, old_z), self.shift = self.shift, shift
        self.add("G10" + self.word("X", shift[0] - old_x) + self.word("Z", shift[1] - old_z))
        if self.tool:
            self.select_offset()

    def get_clear_z(self) -> float:
        """Return the Z of the tool change in mm, in the coordinates of the active zero offset."""
        return self.clear_z - self.shift[1]

    def retract(self) -> None:
        """Move to the Z of the tool change if a tool is active."""
        if self.tool and self.x is not None and self.z is not None and self.z < self.get_clear_z():
            self.rapid(self.x, self.get_clear_z())

    def spindle(self, name: str, speed: float) -> None:
        """Start the spindle."""
        if speed <= 0.0:
            self.reject(name, "the spindle speed is 0; enter it in the tool controller")
        self.speed, self.spindle_code = speed, name
        self.add(f"G97{'M03' if name == 'M3' else 'M04'}S{number(speed, 1)}")

    def stop_spindle(self) -> None:
        """Write M05."""
        self.add("M05")
        self.spindle_code = ""

    def check_spindle(self, name: str) -> None:
        """Reject a cut of a turning tool while the spindle is stopped."""
        if not self.is_live and not self.spindle_code:
            self.reject(name, "the spindle is stopped; start it in the tool controller")

    def dwell(self, seconds: float) -> None:
        """Write a dwell; the control needs at least 0.1 s."""
        self.add(f"G04F{number(max(seconds, MIN_DWELL_S), 3)}")

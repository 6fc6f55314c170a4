"""Writer of the program lines of shapes, and of bar feed loops.

``CodeWriter`` writes the words, rapids, cuts and feeds of the OmniTurn language.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from core.extras.shapes.contour import POINT_TOLERANCE, ContourPoint, resolve_contour_points
from core.extras.shapes.shape_fields import ProgramSettings
from core.language.source import Dialect


class BarFeedLoop(NamedTuple):
    """A loop that feeds the bar and makes ``part_count`` parts of the length ``part_length``.

    The bar is fed at ``feed_rate`` per minute against the tool ``stop_tool_number``. ``facing_stock`` is the
    stock left on the face. If ``feeds_bar_per_part`` is True, the bar is fed for each part, otherwise only
    once. ``subroutine_number`` is the number of the subroutine that machines the part.
    """

    part_count: int
    part_length: float
    feeds_bar_per_part: bool
    stop_tool_number: float
    facing_stock: float
    feed_rate: float
    subroutine_number: int

    @property
    def feed_length(self) -> float:
        """Return the length by which the bar advances at each feed."""
        return self.part_length if self.feeds_bar_per_part else self.part_count * self.part_length


def write_bar_feed_loop(code: CodeWriter, loop: BarFeedLoop) -> None:
    """Write a bar feed loop in the language of the program."""
    (_sinumerik if code.settings.dialect is Dialect.SINUMERIK else _omniturn)(code, loop)


def _omniturn(code: CodeWriter, bars: BarFeedLoop) -> None:
    """Write the loop with LS … LF, the OmniTurn loop words.

    The G97 line carries the comment of the loop, because a comment is not permitted inside the loop.
    """
    call, loop = f"P{bars.subroutine_number}", f"LS{bars.part_count}"
    code.append_lines("G97", loop) if bars.feeds_bar_per_part else code.append_lines("G97")
    code.append_lines(f"T{bars.stop_tool_number:.0f}")
    _write_stop_move(code, bars)
    code.append_lines(
        "M13", f"G94F{format_short_number(bars.feed_rate)}{code.format_z(bars.facing_stock)}", "M12"
    )
    code.clear_modal_state()
    code.write_retract()
    if bars.feeds_bar_per_part:
        code.append_lines(call, "LF")
    else:
        code.append_lines(loop, call, f"G10{code.format_point(0.0, -bars.part_length)}", "LF", "T0")


def _sinumerik(code: CodeWriter, bars: BarFeedLoop) -> None:
    """Write the loop with REPEAT between two labels.

    If the bar is fed only once, ATRANS shifts the zero along the bar.
    """
    opens, closes = code.settings.shop.chuck_codes or (0, 0)
    begin, end = f"BAR_{bars.subroutine_number}", f"BAR_{bars.subroutine_number}_END"
    code.append_lines(
        *([f"{begin}:"] if bars.feeds_bar_per_part else []), f"T{bars.stop_tool_number:.0f} D1", "M5"
    )
    code.clear_modal_state()
    _write_stop_move(code, bars)
    code.append_lines(
        f"M{opens}",
        f"G94 G1 {code.format_z(bars.facing_stock)} F{format_short_number(bars.feed_rate)}",
        f"M{closes}",
    )
    code.clear_modal_state()
    code.write_retract()
    code.append_lines(*([] if bars.feeds_bar_per_part else [f"{begin}:"]), f"PART_{bars.subroutine_number}")
    if not bars.feeds_bar_per_part:
        code.append_lines(" ".join(("ATRANS", code.format_z(-bars.part_length))))
    code.append_lines(f"{end}:")
    if bars.part_count > 1:
        code.append_lines(" ".join(("REPEAT", begin, end, f"P={bars.part_count - 1}")))
    if not bars.feeds_bar_per_part:
        code.append_lines("TRANS")


def _write_stop_move(code: CodeWriter, bars: BarFeedLoop) -> None:
    """Write the move that positions the stop tool at the end of the bar."""
    code.write_rapid(0.0, code.settings.clear)
    code.write_rapid(z=bars.facing_stock - bars.feed_length)


class ContourTurning(NamedTuple):
    """Data for turning a contour: roughing passes, then one pass along the contour.

    ``roughing_depth`` is the depth of cut of a roughing pass; 0 means no roughing. The contour ends at
    ``clear_radius``, which is clear of the stock. ``compensation_number`` is the offset number of the nose
    compensation; 0 means no compensation. ``contour_label_number`` is a number for the contour in languages
    that label contours.
    ``finish_allowance`` is left at a right angle to the contour. If ``finish_allowance_z`` is not 0, it is
    the allowance in Z, and ``finish_allowance`` is the allowance in X, as a radius.
    """

    points: Sequence[ContourPoint]
    clear_radius: float
    is_inside: bool
    feed: float
    roughing_depth: float = 0.0
    finish_allowance: float = 0.0
    roughing_feed: float = 0.0
    compensation_number: float = 0.0
    contour_label_number: float = 0.0
    finish_allowance_z: float = 0.0

    def shift_points_by_allowances(self) -> list[ContourPoint]:
        """Return the points shifted by the allowances in X (a radius) and Z, away from the finished part."""
        shift_x = -self.finish_allowance if self.is_inside else self.finish_allowance
        shifted = [
            replace(
                row,
                x=None if row.x is None else row.x + 2.0 * shift_x,
                z=None if row.z is None else row.z + self.finish_allowance_z,
            )
            for row in self.points
        ]
        z, radius = resolve_contour_points(self.points)[0]
        first = replace(shifted[0], x=2.0 * (radius + shift_x), z=z + self.finish_allowance_z)
        return [first, *shifted[1:]]


class TappingCycle(NamedTuple):
    """Data for tapping on the axis from ``start_z`` to ``end_z`` with ``pitch`` at ``rpm``.

    ``spindle_code`` is the M code that starts the spindle. If ``is_rigid`` is True and the language
    supports it, the tap is rigid (spindle synchronized with Z). Otherwise a floating holder is used.
    """

    start_z: float
    end_z: float
    pitch: float
    rpm: float
    spindle_code: str
    dwell_s: float
    is_rigid: bool = False


class CodeWriter:
    """Writer of program lines that tracks the modal state of the program.

    X is specified as a radius. Words that are already active are not repeated.
    """

    supports_loops = True  # LS … LF can repeat a group of lines
    cutting_edge = 1.0  # cutting edge of the tools, in languages with several edges per tool

    def __init__(self, settings: ProgramSettings) -> None:
        self.settings = settings
        self.lines: list[str] = []
        self._rapid = False
        self._feed = ""

    def append_lines(self, *lines: str) -> None:
        """Append lines unchanged."""
        self.lines += lines

    def clear_modal_state(self) -> None:
        """Clear the tracked modal state, so that the next line repeats all words that it needs.

        Call the method after lines were added unchanged.
        """
        self._rapid, self._feed = False, ""

    # --- Words

    def format_x(self, radius: float, letter: str = "X") -> str:
        """Return the X word for a radius, as a diameter if the program uses diameters."""
        s = self.settings
        value = 2.0 * radius if s.diameter else radius
        return letter + format_short_number(round_length(value, is_metric=s.metric, is_diameter=s.diameter))

    def format_z(self, value: float, letter: str = "Z") -> str:
        """Return the word for a length that is never a diameter, such as a position along Z."""
        return letter + format_short_number(round_length(value, is_metric=self.settings.metric))

    def format_point(self, x: float | None, z: float | None) -> str:
        """Return the X and Z words of a move. A coordinate that is None has no word."""
        return ("" if x is None else self.format_x(x)) + ("" if z is None else self.format_z(z))

    # --- Moves

    def add_comment(self, comment: str) -> list[str]:
        """Return the written lines with a comment added to the first one."""
        return [f"{self.lines[0]}({comment})", *self.lines[1:]]

    def write_tool_start(
        self, tool: float, rpm: float, x: float, z: float | None, spindle_code: str = "M03"
    ) -> None:
        """Write the tool call, the spindle start and the approach.

        The approach is a rapid to ``x`` at the tool change Z, and then a rapid to ``z``.
        """
        self.append_lines(f"T{tool:.0f}")
        if rpm:
            self.append_lines(f"{spindle_code}S{format_short_number(rpm, 0)}")
        self.clear_modal_state()
        self.write_rapid(x, self.settings.clear)
        if z is not None:
            self.write_rapid(z=z)

    def write_rapid(self, x: float | None = None, z: float | None = None) -> None:
        """Write a rapid to a point. An axis whose coordinate is None does not move."""
        self.append_lines(("" if self._rapid else "G00") + self.format_point(x, z))
        self._rapid = True

    def write_cut(
        self, x: float | None = None, z: float | None = None, feed: float = 0.0, suffix: str = ""
    ) -> None:
        """Write a feed move to a point.

        If ``feed`` is 0, the active feed is used. ``suffix`` is text that follows the point.
        """
        self.append_lines(self.format_feed(feed) + self.format_point(x, z) + suffix)

    def format_feed(self, feed: float) -> str:
        """Return the words that make the next move a cut at ``feed`` per revolution.

        The result is an empty string if these words are already active.
        """
        word = f"F{format_short_number(feed, 6)}" if feed else self._feed
        if word == self._feed:
            again = "G01" if self._rapid else ""
        else:
            again = f"G95{word}" if self._rapid or not self._feed else word
        self._feed, self._rapid = word, False
        return again

    def write_feed_line(self, feed: float) -> None:
        """Write a line that contains only a feed, for the following moves."""
        self.append_lines(self.format_feed(feed) or f"F{format_short_number(feed, 6)}")

    def write_straight_line(self, x: float | None, z: float | None, chamfer: float, radius: float) -> None:
        """Write a straight line of a contour, with the chamfer or radius at its end."""
        corner = self.format_z(chamfer, "C") if chamfer else self.format_z(radius, "R") if radius else ""
        self.append_lines(self.format_feed(0.0) + self.format_point(x, z) + corner)

    def write_arc(self, x: float, z: float, radius: float, *, is_convex: bool) -> None:
        """Write an arc that starts at the last point of the contour.

        A convex arc is like the rounded shoulder of a shaft, and a concave arc is like a fillet.
        """
        self.append_lines(
            f"{'G02' if is_convex else 'G03'}{self.format_point(x, z)}{self.format_z(radius, 'R')}"
        )

    def write_dwell(self, seconds: float) -> None:
        """Write a dwell, unless ``seconds`` is 0."""
        if seconds:
            self.append_lines(f"G04F{format_short_number(seconds)}")

    def write_retract(self) -> None:
        """Write a rapid along Z to the tool change position."""
        self.write_rapid(z=self.settings.clear)

    # --- Contours and holes

    def write_contour_turning(self, turning: ContourTurning) -> None:
        """Write the roughing passes with G75, then the pass along the contour.

        Roughing and nose compensation are written only if they are specified.
        """
        there = resolve_contour_points(turning.points)
        first = there[0]
        if turning.roughing_depth:
            self._write_roughing(turning)
            self.write_rapid(x=first[1])
        if turning.compensation_number:
            self.write_feed_line(turning.feed)
            self.append_lines(
                "G42" if turning.is_inside else "G41",
                f"{self.format_z(first[0])}D{turning.compensation_number:.0f}",
            )
        else:
            self.write_cut(z=first[0], feed=turning.feed)
        self.write_contour(turning.points)
        if abs(turning.clear_radius - there[-1][1]) > 1e-9:
            self.write_cut(x=turning.clear_radius)

    def _write_roughing(self, turning: ContourTurning) -> None:
        """Write G75 and its contour, which is shifted if the allowances in X and Z differ."""
        points, allowance = turning.points, turning.finish_allowance
        if turning.finish_allowance_z:
            points, allowance = turning.shift_points_by_allowances(), 0.0
        z, radius = resolve_contour_points(points)[0]
        self.write_feed_line(turning.roughing_feed)
        self.append_lines(
            f"G75{self.format_z(turning.roughing_depth, 'I')}"
            f"{self.format_z(allowance, 'U')}F{_feed(turning.roughing_feed)}"
        )
        self.append_lines(self.format_point(radius, z))
        self.write_contour(points)
        self.append_lines("RF")

    def write_contour(self, points: Sequence[ContourPoint]) -> None:
        """Write the lines of a contour from its first point, which the tool has already reached."""
        for (_, before), (row, here) in pairwise(zip(points, resolve_contour_points(points), strict=True)):
            x = (
                here[1]
                if row.x is not None and (row.arc or abs(here[1] - before[1]) > POINT_TOLERANCE)
                else None
            )
            z = (
                here[0]
                if row.z is not None and (row.arc or abs(here[0] - before[0]) > POINT_TOLERANCE)
                else None
            )
            if row.arc:
                self.write_arc(here[1], here[0], abs(row.arc), is_convex=row.arc > 0)
            elif x is not None or z is not None:
                self.write_straight_line(x, z, row.chamfer, row.radius)

    def cancel_compensation(self, offset: float) -> None:
        """Write the end of nose compensation, if the contour used compensation.

        ``offset`` is the offset number; 0 means that no compensation was used.
        """
        if offset:
            self.append_lines("G40")

    def write_drilling(self, end: float, peck: float, feed: float, start: float) -> None:
        """Write the drilling of a hole from the current position to ``end``, in pecks or in one pass.

        ``start`` is the depth of an existing hole.
        """
        word = f"F{format_short_number(feed, 6)}"
        self.append_lines("G95")
        if peck:
            back = self.format_z(self.settings.near / 2.0, "R") if start else ""
            self.append_lines(f"G83{self.format_z(end)}{self.format_z(peck, 'K')}{word}{back}")
        else:
            self.append_lines(f"G81{self.format_z(end)}{word}")
        self.clear_modal_state()

    def write_tapping(self, tool: float, cycle: TappingCycle) -> None:
        """Write the moves of a tap: feed in at the pitch, reverse the spindle, and feed out."""
        self.write_tool_start(tool, cycle.rpm, 0.0, cycle.start_z, cycle.spindle_code)
        self.write_cut(z=cycle.end_z, feed=cycle.pitch)
        self.append_lines("M03" if cycle.spindle_code == "M04" else "M04")
        self.write_dwell(cycle.dwell_s)
        self.write_cut(z=cycle.start_z)

    # --- Spindle

    def write_surface_speed(self, surface: float, max_rpm: float) -> None:
        """Write the start of constant surface speed, limited to ``max_rpm``."""
        self.append_lines(f"G96S{format_short_number(surface, 0)}", f"G77S{format_short_number(max_rpm, 0)}")

    def write_constant_rpm(self) -> None:
        """Write the switch back to constant rpm before the next tool call."""
        self.append_lines("G97")


def _feed(value: float) -> str:
    return f"{value:.6f}".rstrip("0").replace("0.", ".", 1) if value < 1 else f"{value:g}"


# by metric; step to which a word is rounded, twice as large for a diameter
_STEPS = {False: 0.00005, True: 0.0005}
_NUMBER = re.compile(r"(M?)(\d+)(?:P(\d+))?(?:MM)?")
_NO_ZERO = re.compile(r"(?<![\d.])\.(?=\d)")
_NAME = str.maketrans({"/": "S", "-": "A", ".": "P", "#": "N"})
_BACK = str.maketrans({"S": "/", "A": "-", "P": ".", "N": "#"})


def format_short_number(value: float, places: int = 5) -> str:
    """Format a number as programs write it, without zeros before the point or at the end: .5, -.035, 2."""
    text = f"{value:.{places}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    if text in {"-0", "-", ""}:
        return "0"
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def format_sinumerik_number(value: float, places: int = 5) -> str:
    """Format a number as SINUMERIK programs write it: 0.5, -0.035, 2."""
    return add_leading_zero(format_short_number(value, places))


def add_leading_zero(word: str) -> str:
    """Add a zero before the decimal point of a word from ``format_short_number``."""
    return _NO_ZERO.sub("0.", word)


def round_length(value: float, *, is_metric: bool, is_diameter: bool = False) -> float:
    """Return a length rounded to the resolution of the control.

    If ``is_diameter`` is True, the resolution of a diameter is used.
    """
    step = _STEPS[is_metric] * (2.0 if is_diameter else 1.0)
    return round(value / step) * step


def round_depth_up(radius: float, *, is_metric: bool) -> float:
    """Return a depth of cut rounded up to the resolution of the control.

    With passes of equal chip area, a depth that is rounded down would require one more pass.
    """
    step = _STEPS[is_metric]
    return math.ceil(radius / step - 1e-6) * step


def encode_comment_number(value: float, places: int = 5) -> str:
    """Encode a number for a comment, with P for the point and M for a minus sign: 0P5, M0P035."""
    text = f"{abs(value):.{places}f}".rstrip("0").rstrip(".")
    sign = "M" if value < 0 and text.strip("0.") else ""
    return sign + text.replace(".", "P")


def decode_comment_number(text: str) -> float | None:
    """Return the number that ``encode_comment_number`` encoded, or None for text in another format."""
    found = _NUMBER.fullmatch(text)
    if found is None:
        return None
    value = float(f"{found[2]}.{found[3] or 0}")
    return -value if found[1] else value


def encode_thread_name(name: str) -> str:
    """Encode a thread size in letters and digits for a comment.

    Examples: 1/2 is 1S2, 1-1/8 is 1A1S8, and M10X1.25 is M10X1P25.
    """
    return name.translate(_NAME)


def decode_thread_name(text: str) -> str:
    """Return the thread size that ``encode_thread_name`` encoded."""
    return text.translate(_BACK)

"""Program lines of shapes in SINUMERIK: spaces between words, leading zeros, drilling cycles.

Grooves are cut with G1, or with CYCLE93 if the form specifies the second cutting edge of the blade.
"""

from __future__ import annotations

from core.extras.shapes.contour import resolve_contour_points
from core.extras.shapes.lines.code_lines import (
    CodeWriter,
    ContourTurning,
    TappingCycle,
    add_leading_zero,
    format_sinumerik_number,
)
from core.extras.shapes.shape_fields import ProgramSettings
from core.message import Message

_TURNS = {"M03": "M3", "M04": "M4"}


class SinumerikCodeWriter(CodeWriter):
    """Writer of SINUMERIK lines for programs with G18, G90 and G95.

    A motion word that is still active is omitted. It is always written for an arc, for the move after an
    arc, for the first move of a contour, and after ``clear_modal_state``.
    """

    supports_loops = False

    def __init__(self, settings: ProgramSettings) -> None:
        super().__init__(settings)
        self._motion = ""

    def clear_modal_state(self) -> None:
        """Clear the tracked modal state, so that the next line repeats all words that it needs.

        Call the method after lines were added unchanged.
        """
        super().clear_modal_state()
        self._motion = ""

    def add_comment(self, comment: str) -> list[str]:
        """Return the written lines with a comment added to the first one."""
        return [f"{self.lines[0]} ; {comment}", *self.lines[1:]]

    # --- Words

    def format_x(self, radius: float, letter: str = "X") -> str:
        """Return the X word for a radius, as a diameter if the program uses diameters."""
        return add_leading_zero(super().format_x(radius, letter))

    def format_z(self, value: float, letter: str = "Z") -> str:
        """Return the word for a length along Z."""
        return add_leading_zero(super().format_z(value, letter))

    def format_point(self, x: float | None, z: float | None) -> str:
        """Return the X and Z words of a move. A coordinate that is None has no word."""
        return " ".join(([] if x is None else [self.format_x(x)]) + ([] if z is None else [self.format_z(z)]))

    def _move(self, motion: str, *words: str) -> None:
        begin = [] if self._motion == motion else [motion]
        self._motion = motion
        self.append_lines(" ".join([*begin, *(word for word in words if word)]))

    # --- Moves

    def write_tool_start(
        self, tool: float, rpm: float, x: float, z: float | None, spindle_code: str = "M03"
    ) -> None:
        """Write the tool call, the cutting edge, the spindle start and the approach.

        The approach is a rapid to ``x`` at the tool change Z, and then a rapid to ``z``.
        """
        self.append_lines(f"T{tool:.0f} D{self.cutting_edge:.0f}")
        if rpm:
            self.append_lines(f"G95 S{format_sinumerik_number(rpm, 0)} {_TURNS[spindle_code]}")
        self.clear_modal_state()
        self.write_rapid(x, self.settings.clear)
        if z is not None:
            self.write_rapid(z=z)

    def write_rapid(self, x: float | None = None, z: float | None = None) -> None:
        """Write a rapid to a point. An axis whose coordinate is None does not move."""
        self._move("G0", self.format_point(x, z))

    def write_cut(
        self, x: float | None = None, z: float | None = None, feed: float = 0.0, suffix: str = ""
    ) -> None:
        """Write a feed move to a point.

        If ``feed`` is 0, the active feed is used. ``suffix`` is text that follows the point.
        """
        self._move("G1", self.format_point(x, z), suffix, self._fresh(feed))

    def _fresh(self, feed: float) -> str:
        """Return the word for a feed, or an empty string if the feed is already active."""
        word = f"F{format_sinumerik_number(feed, 6)}" if feed else self._feed
        said, self._feed = ("" if word == self._feed else word), word
        return said

    def write_feed_line(self, feed: float) -> None:
        """Write a line that contains only a feed, for the following cycle."""
        self.append_lines(self._fresh(feed) or f"F{format_sinumerik_number(feed, 6)}")

    def write_straight_line(self, x: float | None, z: float | None, chamfer: float, radius: float) -> None:
        """Write a straight line of a contour, with the chamfer or radius at its end."""
        corner = (
            self.format_z(chamfer, "CHR=") if chamfer else self.format_z(radius, "RND=") if radius else ""
        )
        self._move("G1", self.format_point(x, z), corner)

    def write_arc(self, x: float, z: float, radius: float, *, is_convex: bool) -> None:
        """Write an arc that starts at the last point of the contour.

        A convex arc is like the rounded shoulder of a shaft, and a concave arc is like a fillet.
        """
        self._motion = ""
        self._move("G3" if is_convex else "G2", self.format_point(x, z), self.format_z(radius, "CR="))
        self._motion = ""

    def write_dwell(self, seconds: float) -> None:
        """Write a dwell, unless ``seconds`` is 0."""
        if seconds:
            self.append_lines(f"G4 F{format_sinumerik_number(seconds)}")

    # --- Contours and holes

    def write_contour_turning(self, turning: ContourTurning) -> None:
        """Write CYCLE95 for roughing if it is specified, then one pass along the contour.

        CYCLE95 finds the contour between two labels. The cycle removes stock only up to the outermost point
        of its contour, so the contour includes the retract move.
        """
        there, name = (
            resolve_contour_points(turning.points),
            f"CONTOUR_{turning.contour_label_number or 1.0:.0f}",
        )
        (z, x), feed = there[0], self._fresh(turning.feed)
        if turning.roughing_depth:
            fast = format_sinumerik_number(turning.roughing_feed, 6)
            words = (
                f"{format_sinumerik_number(turning.roughing_depth)}, {_format_allowances(turning)}, "
                f"{fast}, {fast}"
            )
            self.append_lines(
                Message(
                    'CYCLE95("{name}:{name2}_END", {words}, , {value})',
                    name=name,
                    name2=name,
                    words=words,
                    value=3 if turning.is_inside else 1,
                )
            )
            self.clear_modal_state()
            self.write_rapid(x, z + self.settings.near)
        if turning.compensation_number:
            self.append_lines("G41" if turning.is_inside else "G42")
        if turning.roughing_depth:
            self.append_lines(f"{name}:")
        self._motion = ""
        self._move("G1", self.format_point(x, z), feed or f"F{format_sinumerik_number(turning.feed, 6)}")
        self.write_contour(turning.points)
        off, leaves = (
            "G40" if turning.compensation_number else "",
            abs(turning.clear_radius - there[-1][1]) > 1e-9,
        )
        if turning.roughing_depth:
            if leaves:
                self.write_cut(turning.clear_radius)
            self.append_lines(f"{name}_END:")
        self._motion = ""
        if leaves and not turning.roughing_depth:
            self.append_lines(
                " ".join(word for word in (off, "G1", self.format_x(turning.clear_radius)) if word)
            )
        elif off:
            self.append_lines(off)

    def cancel_compensation(self, offset: float) -> None:
        """Write nothing, because the retract move of the contour already cancels the compensation."""

    def write_drilling(self, end: float, peck: float, feed: float, start: float) -> None:
        """Write CYCLE81 or CYCLE83 under G17, for drilling along Z."""
        near = self.settings.near
        planes = (
            f"{format_sinumerik_number(near)}, {format_sinumerik_number(-start)}, "
            f"{format_sinumerik_number(near / 2.0)}, {format_sinumerik_number(end)}"
        )
        self.append_lines(f"G17 {self._fresh(feed)}".rstrip())
        if peck:
            self.append_lines(
                Message(
                    "CYCLE83({planes}, , , {peck}, 0, 0, 0, 1, 1)",
                    planes=planes,
                    peck=format_sinumerik_number(peck),
                )
            )
        else:
            self.append_lines(f"CYCLE81({planes})")
        self.append_lines("G18")
        self.clear_modal_state()

    def write_tapping(self, tool: float, cycle: TappingCycle) -> None:
        """Write CYCLE840 for a floating holder, or CYCLE84 for rigid tapping, under G17."""
        self.write_tool_start(
            tool, 0.0 if cycle.is_rigid else cycle.rpm, 0.0, cycle.start_z, cycle.spindle_code
        )
        hole = (
            f"{format_sinumerik_number(cycle.start_z)}, 0, {format_sinumerik_number(cycle.start_z)}, "
            f"{format_sinumerik_number(cycle.end_z)}, , {format_sinumerik_number(cycle.dwell_s)}"
        )
        self.append_lines("G17")
        if cycle.is_rigid:
            lead, speed = (
                cycle.pitch * (-1.0 if cycle.spindle_code == "M04" else 1.0),
                format_sinumerik_number(cycle.rpm, 0),
            )
            self.append_lines(
                "M5",
                Message(
                    "CYCLE84({hole}, 5, , {lead}, 0, {speed}, {speed2})",
                    hole=hole,
                    lead=format_sinumerik_number(lead, 6),
                    speed=speed,
                    speed2=speed,
                ),
            )
        else:
            self.append_lines(
                Message(
                    "CYCLE840({hole}, 0, , 0, , {pitch})",
                    hole=hole,
                    pitch=format_sinumerik_number(cycle.pitch, 6),
                )
            )
        self.append_lines("G18")
        self.clear_modal_state()

    # --- Spindle

    def write_surface_speed(self, surface: float, max_rpm: float) -> None:
        """Write the start of constant surface speed, limited to ``max_rpm``."""
        self.append_lines(
            Message(
                "G96 S{surface} LIMS={maximum}",
                surface=format_sinumerik_number(surface, 0),
                maximum=format_sinumerik_number(max_rpm, 0),
            )
        )

    def write_constant_rpm(self) -> None:
        """Write the switch back to constant rpm before the next tool call."""
        self.append_lines("G97")


def _format_allowances(turning: ContourTurning) -> str:
    """Return FALZ, FALX and FAL of CYCLE95; FALZ and FALX are empty if one allowance applies to both axes."""
    leave = format_sinumerik_number(turning.finish_allowance)
    if not turning.finish_allowance_z:
        return f", , {leave}"
    return f"{format_sinumerik_number(turning.finish_allowance_z)}, {leave}, "

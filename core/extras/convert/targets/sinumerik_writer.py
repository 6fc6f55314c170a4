"""Writer of turning programs for SINUMERIK controls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import shorten
from typing import ClassVar

from core.extras.convert.omniturn_writer import number
from core.extras.convert.path_steps import PathStep, SpindleState, StepKind
from core.extras.convert.targets.program_writer import ProgramWriter

_LONGEST_MESSAGE = 120  # characters of MSG


class SinumerikWriter(ProgramWriter):
    """Writer of a SINUMERIK turning program with G54, DIAMON and the cutting edge D1 of each tool."""

    coordinate_places: ClassVar[tuple[int, int]] = (5, 4)
    feed_modes: ClassVar[tuple[str, str]] = ("G94", "G95")
    motions: ClassVar[Mapping[StepKind, str]] = {
        StepKind.RAPID: "G0",
        StepKind.FEED: "G1",
        StepKind.THREAD: "G33",
    }
    arcs: ClassVar[tuple[str, str]] = ("G2", "G3")

    is_surface_speed_active = False  # since G96 and until G97, also while the spindle is stopped

    def write_beginning(self) -> None:
        """Write the modes that the program needs."""
        self.append_raw_line(self.make_comment(self.form.title))
        x_mode = "DIAMON" if self.form.is_diameter else "DIAMOF"
        self.append_line("G18", "G710" if self.form.is_metric else "G700", "G90", x_mode, "G40", "G54")
        self.append_line("TRANS")
        self.append_line("G64", "G95")
        self.feed = ("G95", "")

    def write_tool(self, _step: PathStep) -> None:
        """Write T with the cutting edge D1."""
        self.append_line(f"T{self.tool_number}", "D1")
        self.pending_words = ()

    def write_home(self, step: PathStep) -> None:
        """Write G75, which moves to a fixed point, without the tool offset.

        The next move selects the cutting edge again.
        """
        self.warn_once("home-fixed-point")
        self.append_line("D0")
        self.append_line("G75", "X0" if step.x is not None else "", "Z0" if step.z is not None else "")
        self.pending_words = ("D1",) if self.tool_number else ()

    def write_dwell(self, seconds: float) -> None:
        """Write G4 with F in seconds."""
        self.append_line("G4", f"F{self.format_number(seconds, 6)}")

    def write_surface_speed(self, spindle: SpindleState, start: str, *, is_new: bool) -> None:
        """Write G96 and LIMS with the maximum rpm in one line, because LIMS also limits G97 before it."""
        limit = ""
        if spindle.max_rpm and spindle.max_rpm != self.limit_rpm:
            limit = f"LIMS={self.format_speed(spindle.max_rpm)}"
        if limit and not is_new:
            self.append_line(limit)
        if is_new:
            self.append_line("G96", self.format_surface_speed(spindle), limit, start)
            self.is_surface_speed_active, self.feed = True, ("G96", "")

    def write_speed(self, spindle: SpindleState, start: str) -> None:
        """Write S, with G97 if a constant surface speed is active.

        G97 selects the feed per revolution. Without a speed, G97 retains the present one. LIMS also limits
        this speed, so that a higher speed needs a higher LIMS.
        """
        limit = ""
        if 0 < self.limit_rpm < spindle.speed:
            self.limit_rpm = spindle.speed
            limit = f"LIMS={self.format_speed(spindle.speed)}"
        code = "G97" if self.is_surface_speed_active or not self.is_spindle_mode_known else ""
        speed = f"S{self.format_speed(spindle.speed)}" if spindle.speed else ""
        self.append_line(code, speed, limit, start)
        if code:
            self.is_surface_speed_active, self.feed = False, ("G95", "")

    def get_feed_mode(self, *, is_per_rev: bool) -> str:
        """Return the code of the feed mode, which also selects the constant surface speed."""
        if self.is_surface_speed_active:
            return "G96" if is_per_rev else "G961"
        return super().get_feed_mode(is_per_rev=is_per_rev)

    def format_lead(self, lead_mm: float, dx: float, dz: float) -> Sequence[str]:
        """Return K along Z, or I along X for a taper of more than 45 degrees."""
        if dx > dz > 0:
            return (f"I{self.format_number(lead_mm / self.unit_mm * dx / dz, 8)}",)
        return (f"K{self.format_number(lead_mm / self.unit_mm, 8)}",)

    def make_comment(self, text: str) -> str:
        """Return a comment, which begins with a semicolon."""
        return f"; {super().make_comment(text)[1:-1]}"

    def format_number(self, value: float, places: int) -> str:
        """Return a number with a digit before the decimal point."""
        text = number(value, places)
        return text.replace(".", "0.", 1) if text.startswith((".", "-.")) else text

    def write_stop(self, code: float, text: str) -> None:
        """Write M0 or M1 with a message for the operator, after comments with a text that is too long."""
        if len(text) > _LONGEST_MESSAGE:
            self.write_comment(text)
        if text:
            short = shorten(text.replace('"', " "), _LONGEST_MESSAGE, placeholder="...")
            self.append_line(f'MSG("{self.make_comment(short)[2:]}")')
        super().write_stop(code, "")
        if text:
            self.append_line("MSG()")

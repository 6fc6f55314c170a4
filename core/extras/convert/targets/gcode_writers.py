"""Writers of programs for the lathe controls LinuxCNC and Fanuc (G-code system A)."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from math import hypot
from typing import ClassVar

from core.extras.convert.conversion_messages import make_error, make_note, make_warning
from core.extras.convert.omniturn_writer import number
from core.extras.convert.path_steps import PathStep, SpindleState, StepKind
from core.extras.convert.targets.nose_starts import find_incomplete_starts
from core.extras.convert.targets.program_writer import ProgramWriter

_COMMENT_COMMAND = re.compile(
    r"\s*(MSG|DEBUG|PRINT|LOG|LOGOPEN|LOGAPPEND|LOGCLOSE|PROBEOPEN|PROBECLOSE|PY|PYRUN|AXIS|ABORT)\b",
    re.IGNORECASE,
)
"""Beginning of a comment that LinuxCNC executes."""
_MESSAGE_PREFIX = "MSG, "  # LinuxCNC shows the comment to the operator


class LinuxCncWriter(ProgramWriter):
    """Writer of a program for a lathe with LinuxCNC.

    M6 of LinuxCNC stops the spindle, so that the writer starts it again after a tool change.
    """

    coordinate_places: ClassVar[tuple[int, int]] = (6, 5)
    feed_modes: ClassVar[tuple[str, str]] = ("G94", "G95")
    motions: ClassVar[Mapping[StepKind, str]] = {
        StepKind.RAPID: "G0",
        StepKind.FEED: "G1",
        StepKind.THREAD: "G33",
    }
    arcs: ClassVar[tuple[str, str]] = ("G2", "G3")

    def write_program(self, steps: Sequence[PathStep]) -> None:
        """Write the program, and report the starts of nose compensation that differ from OmniTurn."""
        super().write_program(steps)
        self.findings += [make_warning(line, 0, "nose-start") for line in find_incomplete_starts(steps)]

    def write_beginning(self) -> None:
        """Write the modes that the program needs. G64 limits the rounding of corners."""
        self.append_raw_line(self.make_comment(self.form.title))
        unit, tolerance = ("G21", "P0.01") if self.form.is_metric else ("G20", "P0.0005")
        self.append_line(unit, "G18", "G7" if self.form.is_diameter else "G8", "G90", "G40", "G97", "G54")
        self.append_line("G80", "G91.1", "G92.1")
        self.append_line("G64", tolerance)

    def write_tool(self, _step: PathStep) -> None:
        """Write T, M6 and G43."""
        self.append_line(f"T{self.tool_number}", "M6", "G43")

    def report_restart(self) -> None:
        """Report that the spindle is started again."""
        note = make_note(self.line_number, 0, "spindle-restarted", number=self.tool_number)
        self.findings += [] if note in self.findings else [note]

    def write_home(self, step: PathStep) -> None:
        """Write G30, which moves to a stored point; one axis needs G91, so that it moves there directly."""
        self.warn_once("home-stored-point")
        if step.x is not None and step.z is not None:
            self.append_line("G30")
            return
        self.append_line("G91", "G30", "X0" if step.x is not None else "Z0")
        self.append_line("G90")

    def write_dwell(self, seconds: float) -> None:
        """Write G4 with P in seconds."""
        self.append_line("G4", f"P{self.format_number(seconds, 6)}")

    def write_surface_speed(self, spindle: SpindleState, start: str, *, is_new: bool) -> None:  # noqa: ARG002
        """Write G96 with the maximum rpm in D."""
        most = f"D{self.format_speed(spindle.max_rpm)}"
        self.append_line("G96", most, self.format_surface_speed(spindle), start)

    def get_feed_words(self, step: PathStep) -> tuple[str, str]:
        """Return the code of the feed mode and F; a thread ends the feed per revolution of LinuxCNC."""
        if step.kind is StepKind.THREAD:
            self.feed = None
        return super().get_feed_words(step)

    def format_lead(self, lead_mm: float, dx: float, dz: float) -> Sequence[str]:
        """Return K, which LinuxCNC measures along the path of the tool."""
        return (f"K{self.format_number(lead_mm / self.unit_mm * (hypot(dx, dz) / dz if dz else 1.0), 8)}",)

    def write_stop(self, code: float, text: str) -> None:
        """Write M0 or M1 after a line with a message for the operator."""
        for part in self.split_text(text):
            self.append_raw_line(super().make_comment(_MESSAGE_PREFIX + part))
        super().write_stop(code, "")

    def make_comment(self, text: str) -> str:
        """Return a comment. An asterisk precedes a word that would make the comment a command."""
        return super().make_comment(f"* {text}" if _COMMENT_COMMAND.match(text) else text)


_MOST_DIGITS = 8  # a Fanuc control rejects a number with more digits


class FanucWriter(ProgramWriter):
    """Writer of a program for a Fanuc lathe in G-code system A."""

    coordinate_places: ClassVar[tuple[int, int]] = (4, 3)
    feed_places: ClassVar[tuple[int, int]] = (6, 4)
    speed_places: ClassVar[int] = 0
    feed_modes: ClassVar[tuple[str, str]] = ("G98", "G99")
    motions: ClassVar[Mapping[StepKind, str]] = {
        StepKind.RAPID: "G00",
        StepKind.FEED: "G01",
        StepKind.THREAD: "G32",
    }
    arcs: ClassVar[tuple[str, str]] = ("G02", "G03")
    repeats_after_stop: ClassVar[bool] = True
    not_in_comments: ClassVar[re.Pattern[str]] = re.compile(r"[^A-Z0-9 .,+\-*/=]")

    def write_beginning(self) -> None:
        """Write the program number and the modes that the program needs."""
        self.append_raw_line("%")
        self.append_raw_line(f"O0001 {self.make_comment(self.form.title)}")
        self.append_line("G21" if self.form.is_metric else "G20")  # must be alone in its block
        self.append_line("G18", "G40", "G80", "G97", "G99", "G54")
        self.feed = ("G99", "")

    def write_ending(self) -> None:
        """Write the end of the file."""
        self.append_raw_line("%")

    def write_tool(self, _step: PathStep) -> None:
        """Write T with the tool and its offset; both have the same number."""
        self.append_line(f"T{self.tool_number:02d}{self.tool_number:02d}")

    def write_home(self, step: PathStep) -> None:
        """Write G28 with increments of 0 for the axes that move."""
        self.append_line("G28", "U0" if step.x is not None else "", "W0" if step.z is not None else "")

    def write_dwell(self, seconds: float) -> None:
        """Write G04 with U in seconds, to 0.001 s."""
        self.append_line("G04", f"U{self.format_number(seconds, 3)}")

    def write_surface_speed(self, spindle: SpindleState, start: str, *, is_new: bool) -> None:
        """Write the maximum rpm in G50, and then G96."""
        if spindle.max_rpm != self.limit_rpm:
            self.append_line("G50", f"S{self.format_speed(spindle.max_rpm)}")
        if is_new:
            self.append_line("G96", self.format_surface_speed(spindle), start)

    def format_lead(self, lead_mm: float, dx: float, dz: float) -> Sequence[str]:
        """Return F, which a Fanuc control measures along the axis with the longer travel.

        Raises ProgramError if the rounded lead moves the end of the thread by more than the resolution.
        """
        length = max(dx, dz)
        lead = lead_mm / self.unit_mm * (length / dz if dz else 1.0)
        change = abs(round(lead, self.places_of_feed) - lead)
        if change * length > lead * self.unit_mm / 10**self.places:
            raise make_error(self.line_number, 0, "lead-resolution", lead=number(lead, 8))
        return (f"F{self.format_number(lead, self.places_of_feed)}",)

    def report_rapid_of_both_axes(self) -> None:
        """Report that both axes may move at their own rates."""
        self.warn_once("rapid-path")

    def get_feed_words(self, step: PathStep) -> tuple[str, str]:
        """Return the code of the feed mode and F; a thread needs G99, so that F is its lead."""
        if step.kind is not StepKind.THREAD:
            return super().get_feed_words(step)
        before, self.feed = self.feed, ("G99", "")
        return ("" if before is not None and before[0] == "G99" else "G99"), ""

    def format_number(self, value: float, places: int) -> str:
        """Return a number of at most eight digits with a decimal point, which lengths need."""
        whole_digits = len(f"{abs(value):.0f}")
        text = number(value, min(places, max(_MOST_DIGITS - whole_digits, 0)))
        return text if "." in text else f"{text}."

    def format_speed(self, speed: float) -> str:
        """Return S as a whole number. A warning reports a rounded speed."""
        whole = round(speed)
        if abs(speed - whole) > 1e-3:
            self.findings.append(
                make_warning(self.line_number, 0, "speed-rounded", speed=number(speed, 3), whole=whole)
            )
        return str(whole)

    def format_m_code(self, code: float) -> str:
        """Return an M code with two digits."""
        return f"M{round(code):02d}"

    def make_comment(self, text: str) -> str:
        """Return a comment in capitals, with the characters of the keyboard of the control."""
        return super().make_comment(text.upper())

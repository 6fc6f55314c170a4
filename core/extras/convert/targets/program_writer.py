"""Common part of the writers for other controls: modal words, coordinates, comments and source lines."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import dist, tau
from textwrap import wrap
from typing import ClassVar

from core.accents import remove_accents
from core.extras.convert.conversion_messages import make_error, make_warning
from core.extras.convert.omniturn_writer import WrittenLine, number
from core.extras.convert.path_steps import MOVE_KINDS, PathStep, SpindleState, StepKind, has_same_speed
from core.geometry.lines_and_arcs import compute_arc_sweep
from core.interpreter.shared.units import get_surface_speed_unit
from core.language.diagnostics import Diagnostic

MM_PER_INCH = 25.4
LONGEST_COMMENT = 60
_UNKNOWN = float("nan")
_SAME = 1e-9  # mm
_MAX_FEED_CHANGE = 0.01  # of the feed
_MIN_ANGLE = 1e-7  # rad; a smaller arc may be taken for a circle
_MIN_RADIUS_MM = 0.0025  # LinuxCNC rejects arcs with a radius of .00005 in or 0.00127 mm


@dataclass(frozen=True, slots=True)
class ProgramForm:
    """Form of a written program.

    ``has_line_comments`` means that each line ends with a comment that contains its source line.
    """

    title: str
    is_metric: bool
    is_diameter: bool
    has_line_comments: bool = True


class ProgramWriter(ABC):
    """Writer of the steps of a program for another control, which tracks the modal state.

    ``lines`` and ``findings`` are the results. ``x`` and ``z`` are the written coordinates in the unit of the
    program, or NaN if they are unknown.
    """

    coordinate_places: ClassVar[tuple[int, int]]  # decimal places in inches and in mm
    feed_places: ClassVar[tuple[int, int]] = (8, 8)  # decimal places of F in inches and in mm
    speed_places: ClassVar[int] = 3  # decimal places of S
    feed_modes: ClassVar[tuple[str, str]]  # feed per minute and feed per revolution
    motions: ClassVar[Mapping[StepKind, str]]
    arcs: ClassVar[tuple[str, str]]  # clockwise and counterclockwise
    repeats_after_stop: ClassVar[bool] = False  # M00 and M01 may stop the spindle and the coolant
    not_in_comments: ClassVar[re.Pattern[str]] = re.compile(r"[^ -'*-~]")

    def __init__(self, form: ProgramForm) -> None:
        self.form = form
        self.lines: list[WrittenLine] = []
        self.findings: list[Diagnostic] = []
        self.unit_mm = 1.0 if form.is_metric else MM_PER_INCH
        self.places = self.coordinate_places[form.is_metric]
        self.places_of_feed = self.feed_places[form.is_metric]
        self.x = self.z = _UNKNOWN
        self.motion = ""
        self.feed: tuple[str, str] | None = None
        self.spindle = SpindleState()
        self.tool_number = 0
        self.line_number = 0
        self.pending_words: Sequence[str] = ()  # words at the beginning of the next move
        self.limit_rpm = 0.0  # maximum rpm that was written last
        self.is_spindle_mode_known = False  # whether G96 or G97 was written since the last tool change
        self._is_spindle_due = False  # since a tool change, until the spindle words are written again
        self._is_limit_due = False  # since a tool change, until the maximum rpm is written again
        self._has_coolant = False
        self._is_coolant_due = False  # since a tool change, until the coolant code is written again
        self._waits_for_move = False  # whether words that are due are written before the next move
        self._nose_word = ""
        self._point = (_UNKNOWN, _UNKNOWN)  # of the last move, in mm, X as a radius

    def write_program(self, steps: Sequence[PathStep]) -> None:
        """Write the program. Raises ProgramError if the control has no form for a step."""
        self.line_number = steps[0].line if steps else 0
        self.write_beginning()
        departures = _find_departures(steps)
        for index, step in enumerate(steps):
            self._repeat_spindle(step)
            self._repeat_coolant(step)
            self.line_number = step.line
            self._write_step(step, is_departure=index in departures)
        self.write_ending()

    def append_line(self, *words: str) -> None:
        """Append a line of these words, with the source line in a comment."""
        text = " ".join(filter(None, words))
        comment = self.make_comment(f"L{self.line_number}") if self.form.has_line_comments else ""
        self.append_raw_line(f"{text} {comment}".rstrip())

    def append_raw_line(self, text: str) -> None:
        """Append a line without a comment."""
        self.lines.append(WrittenLine(text, self.line_number))

    # --- forms of the control

    @abstractmethod
    def write_beginning(self) -> None:
        """Write the lines before the first step."""

    def write_ending(self) -> None:
        """Write the lines after the last step."""
        return

    @abstractmethod
    def write_tool(self, _step: PathStep) -> None:
        """Write a tool change."""

    @abstractmethod
    def write_home(self, step: PathStep) -> None:
        """Write a rapid to machine home."""

    def warn_once(self, code: str) -> None:
        """Report a difference of the control at its first line."""
        if not any(each.code == code for each in self.findings):
            self.findings.append(make_warning(self.line_number, 0, code))

    @abstractmethod
    def write_dwell(self, seconds: float) -> None:
        """Write a dwell."""

    @abstractmethod
    def write_surface_speed(self, spindle: SpindleState, start: str, *, is_new: bool) -> None:
        """Write a constant surface speed with its maximum rpm.

        ``start`` is the M code or empty. Without ``is_new``, only the maximum rpm has changed.
        """

    def write_speed(self, spindle: SpindleState, start: str) -> None:
        """Write a speed in rpm; ``start`` is the M code or empty."""
        self.append_line("G97", f"S{self.format_speed(spindle.speed)}", start)

    @abstractmethod
    def format_lead(self, lead_mm: float, dx: float, dz: float) -> Sequence[str]:
        """Return the words of a lead along Z for a thread with these travels in mm; X is a radius."""

    def make_comment(self, text: str) -> str:
        """Return a comment with the characters that the control accepts, and without accents."""
        return f"({self.not_in_comments.sub(' ', remove_accents(text)).strip()})"

    def split_text(self, text: str) -> list[str]:
        """Return a text in parts that are short enough for the screen of a control."""
        return wrap(text, LONGEST_COMMENT)

    def format_number(self, value: float, places: int) -> str:
        """Return a number in the form of the control."""
        return number(value, places)

    def format_feed(self, feed: float) -> str:
        """Return an F value in the unit of the program.

        A warning reports a rounded feed. Raises ProgramError if rounding changes it by more than 1%.
        """
        rounded = round(feed, self.places_of_feed)
        text = self.format_number(feed, self.places_of_feed)
        change = abs(rounded - feed)
        if change > _MAX_FEED_CHANGE * feed:
            raise make_error(self.line_number, 0, "feed-resolution", feed=number(feed, 8))
        if change > _SAME * max(feed, 1.0):
            self.findings.append(
                make_warning(self.line_number, 0, "feed-rounded", feed=number(feed, 8), rounded=text)
            )
        return text

    def format_speed(self, speed: float) -> str:
        """Return an S value."""
        return number(speed, self.speed_places)

    def format_surface_speed(self, spindle: SpindleState) -> str:
        """Return S with a surface speed in the unit of the program."""
        unit = get_surface_speed_unit(is_metric=self.form.is_metric)
        return f"S{self.format_speed(spindle.speed / unit)}"

    def format_m_code(self, code: float) -> str:
        """Return an M code."""
        return f"M{round(code)}"

    def write_stop(self, code: float, text: str) -> None:
        """Write M00 or M01 with the text for the operator. A long text is in the lines before."""
        parts = self.split_text(text)
        if len(parts) > 1:
            self.write_comment(text)
            parts = []
        self.append_line(self.format_m_code(code), *map(self.make_comment, parts))

    def write_comment(self, text: str) -> None:
        """Write a comment in as many lines as it needs."""
        for part in self.split_text(text):
            self.append_raw_line(self.make_comment(part))

    # --- steps

    def _write_step(self, step: PathStep, *, is_departure: bool) -> None:
        is_stop = step.kind is StepKind.M and step.number in {0, 1}
        comments = step.comment.split("\n")
        text = comments.pop() if is_stop else ""
        for each in comments:
            self.write_comment(each)
        if step.kind in MOVE_KINDS:
            self._write_move(step, is_departure=is_departure)
        elif step.kind is StepKind.NOSE:
            self._select_nose_code(step)
        elif step.kind is StepKind.TOOL:
            self.tool_number = round(step.number)
            self.write_tool(step)
            self.x = self.z = _UNKNOWN
            self.motion, self.feed = "", None
            self.is_spindle_mode_known = False
            self._require_repetition(before_move=False)
        elif step.kind is StepKind.HOME:
            self.write_home(step)
            self.motion = ""
            self.x = _UNKNOWN if step.x is not None else self.x
            self.z = _UNKNOWN if step.z is not None else self.z
        elif step.kind is StepKind.SPINDLE:
            self._change_spindle(step.spindle)
        elif step.kind is StepKind.DWELL:
            self.write_dwell(step.number)
        elif is_stop:
            self.write_stop(step.number, text)
            if self.repeats_after_stop:
                self._require_repetition(before_move=True)
        else:
            self._has_coolant = step.number == 8 if step.number in {8, 9} else self._has_coolant
            self.append_line(self.format_m_code(step.number))

    def _select_nose_code(self, step: PathStep) -> None:
        """Select the G code of nose compensation for the next move; G40 is in the departure move."""
        if step.number == 40:
            return
        # The steps see X+ toward the operator, but these controls calculate in Z and X on every lathe.
        self._nose_word = f"G{round(83 - step.number)}"

    def _require_repetition(self, *, before_move: bool) -> None:
        """Require that the spindle words and the coolant code are written again.

        With ``before_move``, they are written before the next move or dwell, and otherwise before any step.
        """
        self._is_spindle_due = self._is_limit_due = self._is_coolant_due = True
        self._waits_for_move = before_move

    def _is_repeated_before(self, step: PathStep) -> bool:
        """Return whether due spindle words and coolant codes are written again before this step."""
        if self._waits_for_move:
            return step.kind in MOVE_KINDS or step.kind is StepKind.DWELL
        return step.kind not in {StepKind.TOOL, StepKind.SPINDLE, StepKind.END}

    def _repeat_coolant(self, step: PathStep) -> None:
        """Write M08 again after a tool change or a stop, unless this step is a coolant code."""
        if not self._is_coolant_due or not self._is_repeated_before(step):
            return
        self._is_coolant_due = False
        is_coolant_code = step.kind is StepKind.M and step.number in {8, 9}
        if self._has_coolant and not is_coolant_code:
            self.append_line(self.format_m_code(8))

    def _repeat_spindle(self, step: PathStep) -> None:
        """Write the spindle words again after a tool change or a stop, unless this step writes new ones.

        A restart at the line of T then does not run with the state that the control happens to have.
        """
        if not self._is_spindle_due or not self._is_repeated_before(step):
            return
        self._is_spindle_due = False
        if self.spindle.direction:
            self.report_restart()
            self.write_spindle(SpindleState())

    def report_restart(self) -> None:
        """Report that the spindle words are repeated, if the tool change of the control stops the spindle."""
        return

    def _change_spindle(self, spindle: SpindleState) -> None:
        before, self.spindle = self.spindle, spindle
        if self._is_spindle_due:
            before, self._is_spindle_due = SpindleState(), False
        if not spindle.direction:
            self.append_line(self.format_m_code(5))
        elif spindle != before:
            self.write_spindle(before)

    def write_spindle(self, before: SpindleState) -> None:
        """Write the spindle speed, and the direction if it differs from the one before."""
        spindle = self.spindle
        start = ""
        if spindle.direction != before.direction:
            start = self.format_m_code(3 if spindle.direction > 0 else 4)
        is_new = not has_same_speed(spindle, before)
        if spindle.is_css:
            self.limit_rpm = 0.0 if self._is_limit_due else self.limit_rpm
            self._is_limit_due = False
            self.write_surface_speed(spindle, start, is_new=is_new)
            self.limit_rpm = spindle.max_rpm
        elif is_new:
            self.write_speed(spindle, start)
        self.is_spindle_mode_known = self.is_spindle_mode_known or is_new

    # --- moves

    def round_length(self, value_mm: float) -> float:
        """Return a length in the unit of the program, rounded to the resolution of the control."""
        return round(value_mm / self.unit_mm, self.places) + 0.0

    def round_x(self, x_mm: float) -> float:
        """Return X as it is written: a diameter or a radius in the unit of the program."""
        return self.round_length(x_mm * 2.0 if self.form.is_diameter else x_mm)

    def round_point(self, x_mm: float, z_mm: float) -> tuple[float, float]:
        """Return the coordinates of a point as they are written."""
        return self.round_x(x_mm), self.round_length(z_mm)

    def format_length(self, letter: str, value: float) -> str:
        """Return a word with a length in the unit of the program."""
        return letter + self.format_number(value, self.places)

    def _write_move(self, step: PathStep, *, is_departure: bool) -> None:
        x = self.x if step.x is None else self.round_x(step.x)
        z = self.z if step.z is None else self.round_length(step.z)
        if step.kind is StepKind.RAPID and x != self.x and z != self.z:
            self.report_rapid_of_both_axes()
        is_arc = step.kind is StepKind.ARC
        mode, feed = self.get_feed_words(step)
        words = [*self.pending_words, "G40" if is_departure else self._nose_word]
        words += [self._motion_word(step), mode]
        self.pending_words = ()
        if step.x is not None and (is_arc or x != self.x):
            words.append(self.format_length("X", x))
        if step.z is not None and (is_arc or z != self.z):
            words.append(self.format_length("Z", z))
        end = (_UNKNOWN if step.x is None else step.x, _UNKNOWN if step.z is None else step.z)
        if is_arc:
            words += self._center_words(step, end, (x, z))
        elif step.kind is StepKind.THREAD:
            words += self.format_lead(step.feed, abs(end[0] - self._point[0]), abs(end[1] - self._point[1]))
        self.append_line(*words, feed)
        self._nose_word = ""
        self.x, self.z, self._point = x, z, end

    def report_rapid_of_both_axes(self) -> None:
        """Report that the path of such a rapid may differ on the control."""
        return

    def get_feed_mode(self, *, is_per_rev: bool) -> str:
        """Return the G code of the feed mode that a move needs."""
        return self.feed_modes[is_per_rev]

    def _motion_word(self, step: PathStep) -> str:
        word = self.arcs[step.clockwise] if step.kind is StepKind.ARC else self.motions[step.kind]
        before, self.motion = self.motion, word
        return word if word != before or step.kind in {StepKind.ARC, StepKind.THREAD} else ""

    def get_feed_words(self, step: PathStep) -> tuple[str, str]:
        """Return the code of the feed mode and F; a word that is already active is empty."""
        if step.kind in {StepKind.RAPID, StepKind.THREAD}:
            return "", ""
        mode = self.get_feed_mode(is_per_rev=step.per_rev)
        feed = f"F{self.format_feed(step.feed / self.unit_mm)}"
        before, self.feed = self.feed, (mode, feed)
        if before == self.feed:
            return "", ""
        return ("" if before is not None and before[0] == mode else mode), feed

    def _center_words(
        self, step: PathStep, end: tuple[float, float], written: tuple[float, float]
    ) -> Sequence[str]:
        """Return I and K.

        Raises ProgramError if the control would not make the same arc of the rounded values. If its ends
        become equal or exchange their order, it would be a circle.
        """
        start, stop = self._convert_to_mm(self.x, self.z), self._convert_to_mm(*written)
        i, k = self.round_length(step.cx - start[0]), self.round_length(step.cz - start[1])
        center = start[0] + i * self.unit_mm, start[1] + k * self.unit_mm
        _, wanted = compute_arc_sweep(*self._point, *end, step.cx, step.cz, step.clockwise)
        _, made = compute_arc_sweep(*start, *stop, *center, step.clockwise)
        is_circle = dist(end, self._point) < _SAME
        is_unclear = not is_circle and not _MIN_ANGLE < abs(made) < tau - _MIN_ANGLE
        if is_unclear or abs(made - wanted) > 1.0 or dist(start, center) < _MIN_RADIUS_MM:
            raise make_error(step.line, 0, "arc-short")
        return self.format_length("I", i), self.format_length("K", k)

    def _convert_to_mm(self, x: float, z: float) -> tuple[float, float]:
        """Return the point of written coordinates in mm, with X as a radius."""
        return x * self.unit_mm * (0.5 if self.form.is_diameter else 1.0), z * self.unit_mm


def _find_departures(steps: Sequence[PathStep]) -> frozenset[int]:
    """Return the indexes of the moves that end nose compensation."""
    found = set()
    last_move = -1
    for index, step in enumerate(steps):
        if step.kind in MOVE_KINDS:
            last_move = index
        elif step.kind is StepKind.NOSE and step.number == 40:
            found.add(last_move)
    return frozenset(found)

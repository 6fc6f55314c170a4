"""Lesson, its steps, and the condition that completes each step."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple


class OffsetField(NamedTuple):
    """One value in an offset table.

    ``table`` is "tool" or "secondary", ``number`` is the number of the row, and ``name`` is a field such as
    "x".
    """

    table: str
    number: int
    name: str


class OffsetDifference(NamedTuple):
    """Required change of an offset since the start of the lesson.

    ``difference_mm`` is in mm, with X as a radius.
    """

    offset: OffsetField
    difference_mm: float


@dataclass(frozen=True, slots=True)
class StepCondition:
    """Condition that completes a step. All specified parts must be true at the same time.

    - ``page``: name of the page on the screen
    - ``state``: machine state, such as "FEED HOLD"
    - ``switch_on``, ``switch_off``: run switch that is on or off, such as "no_count"
    - ``proved_program``: name of a loaded program without errors, whose tools all have an offset
    - ``program_text``: text that the loaded program contains
    - ``finding``: code of an error that the proof of the loaded program found
    - ``min_line``: smallest line number that the running program must have reached
    - ``counted_parts``, ``finished_runs``, ``mdi_lines``: number of counted parts, of programs that ran to
      their end, or of executed MDI lines since the previous step was completed
    - ``is_interrupted``: whether an interrupted job exists
    - ``is_start_rejected``: whether the last Cycle Start was rejected
    - ``offset``: required difference of an offset
    """

    page: str = ""
    state: str = ""
    switch_on: str = ""
    switch_off: str = ""
    proved_program: str = ""
    program_text: str = ""
    finding: str = ""
    min_line: int = 0
    counted_parts: int = 0
    finished_runs: int = 0
    mdi_lines: int = 0
    is_interrupted: bool | None = None
    is_start_rejected: bool | None = None
    offset: OffsetDifference | None = None


class LessonStep(NamedTuple):
    """One step of a lesson: the instruction for the operator, and the condition that completes the step."""

    instruction: str
    condition: StepCondition


@dataclass(frozen=True, slots=True)
class Lesson:
    """Lesson with its steps.

    ``minutes`` is the usual duration. ``program`` is the name of the program that the lesson loads. If
    ``program_text`` is not empty, the lesson creates this program.
    """

    number: int
    title: str
    goal: str
    minutes: int
    program: str
    steps: tuple[LessonStep, ...]
    program_text: str = ""

    @property
    def offset_fields(self) -> frozenset[OffsetField]:
        """Return the offsets that the conditions of the steps read."""
        conditions = (step.condition for step in self.steps)
        return frozenset(each.offset.offset for each in conditions if each.offset is not None)


@dataclass(frozen=True, slots=True)
class RunCounters:
    """Number of counted parts, of programs that ran to their end, and of MDI lines since TurnDesk started."""

    counted_parts: int = 0
    finished_runs: int = 0
    mdi_lines: int = 0


@dataclass(frozen=True, slots=True)
class ScreenState:
    """State of screen, machine and program that the conditions are compared with.

    ``line`` is 0 unless a program is running. ``offsets`` contains the offsets of the lesson in mm, with X
    as a radius.
    """

    page: str = ""
    state: str = ""
    switches_on: frozenset[str] = frozenset()
    program: str = ""
    program_text: str = ""
    is_proved: bool = False
    findings: frozenset[str] = frozenset()
    line: int = 0
    counters: RunCounters = RunCounters()
    is_interrupted: bool = False
    is_start_rejected: bool = False
    offsets: Mapping[OffsetField, float] = field(default_factory=dict)

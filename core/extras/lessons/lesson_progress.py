"""Progress of the operator through the steps of a lesson."""

from __future__ import annotations

from core.extras.lessons.lesson import Lesson, LessonStep, OffsetDifference, ScreenState, StepCondition

_OFFSET_TOLERANCE_MM = 0.0005  # half of the smallest step of a metric entry


class LessonProgress:
    """Number of completed steps of a lesson.

    A completed step remains completed. ``start`` is the state when the lesson starts.
    """

    def __init__(self, lesson: Lesson, start: ScreenState) -> None:
        self.lesson = lesson
        self.completed_step_count = 0
        self._offsets_at_start = dict(start.offsets)
        self._counters = start.counters  # when the previous step was completed

    @property
    def current_step(self) -> LessonStep | None:
        """Return the step that the operator must do now, or None if the lesson is complete."""
        steps = self.lesson.steps
        return steps[self.completed_step_count] if self.completed_step_count < len(steps) else None

    def update(self, state: ScreenState) -> bool:
        """Complete all steps whose conditions the state meets, in order, and return whether none remains."""
        while (step := self.current_step) is not None and self._is_met(step.condition, state):
            self.completed_step_count += 1
            self._counters = state.counters
        return self.current_step is None

    def _is_met(self, condition: StepCondition, state: ScreenState) -> bool:
        checks = (
            not condition.page or state.page == condition.page,
            not condition.state or state.state == condition.state,
            not condition.switch_on or condition.switch_on in state.switches_on,
            not condition.switch_off or condition.switch_off not in state.switches_on,
            not condition.proved_program or (state.is_proved and state.program == condition.proved_program),
            condition.program_text in state.program_text,
            not condition.finding or condition.finding in state.findings,
            state.line >= condition.min_line,
            condition.is_interrupted in {None, state.is_interrupted},
            condition.is_start_rejected in {None, state.is_start_rejected},
            self._have_counters_advanced(condition, state),
            condition.offset is None or self._has_offset_changed(condition.offset, state),
        )
        return all(checks)

    def _have_counters_advanced(self, condition: StepCondition, state: ScreenState) -> bool:
        now, before = state.counters, self._counters
        return (
            now.counted_parts - before.counted_parts >= condition.counted_parts
            and now.finished_runs - before.finished_runs >= condition.finished_runs
            and now.mdi_lines - before.mdi_lines >= condition.mdi_lines
        )

    def _has_offset_changed(self, required: OffsetDifference, state: ScreenState) -> bool:
        now, before = state.offsets.get(required.offset), self._offsets_at_start.get(required.offset)
        if now is None or before is None:
            return False
        return abs(now - before - required.difference_mm) <= _OFFSET_TOLERANCE_MM

"""Progress through a lesson: each condition completes its step only when it is met."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.extras.lessons.lesson import (
    Lesson,
    LessonStep,
    OffsetDifference,
    OffsetField,
    RunCounters,
    ScreenState,
    StepCondition,
)
from core.extras.lessons.lesson_progress import LessonProgress

D1_X = OffsetField("secondary", 1, "x")
START = ScreenState(
    page="AUTOMATIC",
    state="DRIVES OFF",
    program="a.nc",
    program_text="M30\n",
    counters=RunCounters(3, 4, 5),
    offsets={D1_X: 0.1},
)


def begin(*conditions: StepCondition) -> LessonProgress:
    steps = tuple(LessonStep("", each) for each in conditions)
    return LessonProgress(Lesson(1, "A", "B.", 1, "a.nc", steps), START)


@pytest.mark.parametrize(
    ("condition", "state"),
    [
        (StepCondition(page="EDITOR"), replace(START, page="EDITOR")),
        (StepCondition(state="READY"), replace(START, state="READY")),
        (StepCondition(switch_on="no_count"), replace(START, switches_on=frozenset({"no_count"}))),
        (StepCondition(proved_program="a.nc"), replace(START, is_proved=True)),
        (StepCondition(program_text="G33"), replace(START, program_text="G33X1\nM30\n")),
        (StepCondition(finding="into-chuck"), replace(START, findings=frozenset({"into-chuck"}))),
        (StepCondition(min_line=22), replace(START, line=22)),
        (StepCondition(counted_parts=1), replace(START, counters=RunCounters(4, 4, 5))),
        (StepCondition(finished_runs=2), replace(START, counters=RunCounters(3, 6, 5))),
        (StepCondition(mdi_lines=1), replace(START, counters=RunCounters(3, 4, 6))),
        (StepCondition(is_interrupted=True), replace(START, is_interrupted=True)),
        (StepCondition(is_start_rejected=True), replace(START, is_start_rejected=True)),
        # .002 in smaller in diameter is 0.0254 mm smaller in radius
        (StepCondition(offset=OffsetDifference(D1_X, -0.0254)), replace(START, offsets={D1_X: 0.0746})),
    ],
)
def test_step_is_completed_only_by_its_condition(condition: StepCondition, state: ScreenState) -> None:
    progress = begin(condition)
    progress.update(START)
    assert progress.completed_step_count == 0
    progress.update(state)
    assert (progress.completed_step_count, progress.current_step) == (1, None)


@pytest.mark.parametrize(
    ("condition", "state"),
    [
        (StepCondition(page="EDITOR", state="READY"), replace(START, page="EDITOR")),
        (StepCondition(switch_off="no_count"), replace(START, switches_on=frozenset({"no_count"}))),
        (StepCondition(proved_program="a.nc"), replace(START, program="b.nc", is_proved=True)),
        (StepCondition(min_line=22), replace(START, line=21)),
        (StepCondition(counted_parts=2), replace(START, counters=RunCounters(4, 9, 9))),
        (StepCondition(is_interrupted=False), replace(START, is_interrupted=True)),
        (StepCondition(offset=OffsetDifference(D1_X, -0.0254)), replace(START, offsets={D1_X: 0.1254})),
        (StepCondition(offset=OffsetDifference(D1_X, 0.0)), replace(START, offsets={})),
    ],
)
def test_other_state_does_not_complete_step(condition: StepCondition, state: ScreenState) -> None:
    progress = begin(condition)
    progress.update(state)
    assert progress.completed_step_count == 0


def test_parts_are_counted_from_the_previous_step() -> None:
    progress = begin(StepCondition(page="EDITOR"), StepCondition(counted_parts=1))
    made_early = replace(START, counters=RunCounters(4, 5, 5))
    progress.update(made_early)
    progress.update(replace(made_early, page="EDITOR"))
    assert progress.completed_step_count == 1
    progress.update(replace(START, counters=RunCounters(5, 6, 5)))
    assert progress.completed_step_count == 2


def test_completed_step_remains_completed_and_steps_keep_their_order() -> None:
    progress = begin(StepCondition(page="EDITOR"), StepCondition(page="JOG"), StepCondition(page="MDI"))
    for page, completed in (("JOG", 0), ("EDITOR", 1), ("AUTOMATIC", 1), ("JOG", 2), ("MDI", 3), ("JOG", 3)):
        progress.update(replace(START, page=page))
        assert progress.completed_step_count == completed


def test_offset_is_compared_with_its_value_at_start_of_lesson() -> None:
    changed, restored = OffsetDifference(D1_X, -0.0254), OffsetDifference(D1_X, 0.0)
    progress = begin(StepCondition(offset=changed), StepCondition(offset=restored))
    progress.update(replace(START, offsets={D1_X: 0.0746}))
    assert progress.completed_step_count == 1
    progress.update(replace(START, offsets={D1_X: 0.1}))
    assert progress.completed_step_count == 2

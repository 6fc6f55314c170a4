"""The first job's card: it goes on by what was done, and by nothing else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

from app.desk.pages.first_job import CLOSE_KEY, FIRST_JOB_STEPS, FirstJobCard
from app.desk.programs.program_loading import LoadedProgram, LoadingPhase
from core.executor.snapshot import MachineState, Snapshot
from tests.texts import text

REST = Snapshot()


def loaded(*, errors: bool = False, missing: bool = False) -> LoadedProgram:
    """A program on the desk that calls T1."""
    proof = SimpleNamespace(unset=lambda _job: [1] if missing else [])
    job = SimpleNamespace()
    phase = LoadingPhase.REFUSED if errors else LoadingPhase.READY
    return cast("LoadedProgram", SimpleNamespace(path=Path("part.nc"), proof=proof, job=job, phase=phase))


NOTHING = cast("LoadedProgram", SimpleNamespace(path=None, proof=None, job=None, phase=LoadingPhase.READY))


def test_first_job_step_waits_for_its_condition() -> None:
    card = FirstJobCard()
    card.advance(REST, NOTHING, 0)
    assert card.step_index == 0
    card.advance(REST, loaded(missing=True), 0)
    assert card.step_index == 1  # nobody has set T1
    card.advance(REST, loaded(errors=True), 0)
    assert card.step_index == 2  # it is set, and the program does not prove
    card.advance(REST, loaded(), 0)
    assert card.step_index == 3
    running = replace(REST, state=MachineState.RUN, no_count=False)
    card.advance(running, loaded(), 0)
    card.advance(REST, loaded(), 1)
    assert card.step_index == 3  # a part that counts is no dry run
    dry = replace(running, no_count=True)
    for stopped in (MachineState.ESTOP, MachineState.FAULT):
        card.advance(dry, loaded(), 1)
        card.advance(replace(dry, state=stopped), loaded(), 1)
        card.advance(REST, loaded(), 1)
        assert card.step_index == 3  # it did not come to its end
    card.advance(dry, loaded(), 1)
    assert card.step_index == 3
    card.advance(REST, loaded(), 1)
    assert card.step_index == 4
    card.advance(REST, loaded(), 2)
    assert card.step_index == len(FIRST_JOB_STEPS)
    assert card.notice_row.text == text("desk.first-job-done")


def test_first_job_skips_touch_off_if_all_tools_are_set() -> None:
    card = FirstJobCard()
    card.advance(REST, loaded(), 0)  # as the demo begins: its store has the offsets of the samples
    assert "DRY RUN" in card.notice_row.text


def test_first_job_card_shows_step_number_and_count() -> None:
    row = FirstJobCard().notice_row
    assert row.text == text(
        "desk.first-job-step", number=1, count=f"{len(FIRST_JOB_STEPS)}: CHOOSE A PROGRAM"
    )
    assert row.keys[0][1] == "CLOSE"


def test_dry_run_offers_no_count_only_while_parts_are_counted() -> None:
    card = FirstJobCard(step_index=3)
    card.advance(REST, loaded(), 0)
    assert [key for key, _label in card.notice_row.keys] == ["P", CLOSE_KEY]
    card.advance(replace(REST, no_count=True), loaded(), 0)
    assert [key for key, _label in card.notice_row.keys] == [CLOSE_KEY]
    assert "P:" not in card.notice_row.values_text


def test_first_part_after_a_start_of_turndesk_does_not_ask_to_turn_counting_on() -> None:
    """NO COUNT is off after a start. P would then stop the count of the first part."""
    card = FirstJobCard(step_index=4)
    card.advance(REST, loaded(), 0)
    assert [key for key, _label in card.notice_row.keys] == [CLOSE_KEY]
    assert "P:" not in card.notice_row.values_text
    card.advance(replace(REST, no_count=True), loaded(), 0)
    assert card.notice_row.keys[0] == ("P", "COUNT ON")
    assert "P:" in card.notice_row.values_text

"""The first job's card: it goes on by what was done, and by nothing else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

from app.desk.pages.first_job import STEPS, FirstJob
from app.desk.programs.program_loading import Loaded, Phase
from core.executor.snapshot import Snapshot, State
from tests.texts import text

REST = Snapshot()


def loaded(*, errors: bool = False, missing: bool = False) -> Loaded:
    """A program on the desk that calls T1."""
    proof = SimpleNamespace(unset=lambda _job: [1] if missing else [])
    job = SimpleNamespace()
    phase = Phase.REFUSED if errors else Phase.READY
    return cast("Loaded", SimpleNamespace(path=Path("part.nc"), proof=proof, job=job, phase=phase))


NOTHING = cast("Loaded", SimpleNamespace(path=None, proof=None, job=None, phase=Phase.READY))


def test_each_step_waits_for_what_it_asks() -> None:
    card = FirstJob()
    card.see(REST, NOTHING, 0)
    assert card.at == 0
    card.see(REST, loaded(missing=True), 0)
    assert card.at == 1  # nobody has set T1
    card.see(REST, loaded(errors=True), 0)
    assert card.at == 2  # it is set, and the program does not prove
    card.see(REST, loaded(), 0)
    assert card.at == 3
    running = replace(REST, state=State.RUN, no_count=False)
    card.see(running, loaded(), 0)
    card.see(REST, loaded(), 1)
    assert card.at == 3  # a part that counts is no dry run
    dry = replace(running, no_count=True)
    for stopped in (State.ESTOP, State.FAULT):
        card.see(dry, loaded(), 1)
        card.see(replace(dry, state=stopped), loaded(), 1)
        card.see(REST, loaded(), 1)
        assert card.at == 3  # it did not come to its end
    card.see(dry, loaded(), 1)
    assert card.at == 3
    card.see(REST, loaded(), 1)
    assert card.at == 4
    card.see(REST, loaded(), 2)
    assert card.at == len(STEPS)
    assert card.row.text == text("desk.first-job-done")


def test_where_every_tool_is_set_nobody_is_asked_to_touch_one_off() -> None:
    card = FirstJob()
    card.see(REST, loaded(), 0)  # as the demo begins: its store has the offsets of the samples
    assert "DRY RUN" in card.row.text


def test_the_card_says_which_step_of_how_many() -> None:
    row = FirstJob().row
    assert row.text == text("desk.first-job-step", number=1, count=f"{len(STEPS)}: CHOOSE A PROGRAM")
    assert row.keys[0][1] == "CLOSE"

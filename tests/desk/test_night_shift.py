"""A night shift in small: every counter has what the slides have made, and a place stays the same place."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.desk.desk import Desk
from core.executor.snapshot import MachineState
from tests.benchmarks import night_operator
from tests.benchmarks.bench_night_shift import counted, disagreeing, drift
from tests.benchmarks.night_operator import Operator, StuckError
from tests.benchmarks.night_shift import INCH, PUSHING, TOOLS, NightShift, night_shift


@pytest.fixture
def shift(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[NightShift]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with night_shift() as shift:
        yield shift


def test_all_part_counts_agree_and_turned_sizes_do_not_drift(shift: NightShift) -> None:
    operator = Operator(shift, 1, {})
    operator.begin()
    operator.make(2)
    shift.saved()  # between two frames the desk would still show the part before
    assert disagreeing(shift, operator, counted(shift)) == []
    operator.meets("E-stop")
    operator.make(1)
    operator.meets("no count")
    operator.make(1)
    operator.meets("slide jams", after=3.0)
    operator.make(1)
    operator.finish()
    counts = counted(shift)
    assert disagreeing(shift, operator, counts) == []
    assert counts["seen at the slides"] >= 5
    assert counts["pins without count"] == 1
    assert operator.did["start"] == 3  # in the evening, behind the E-stop and the alarm
    assert shift.witness.truth.alarms == {"encoder-still": 1}  # it was sent on, and stood
    assert len(shift.witness.truth.at_stop) == 1
    assert shift.witness.truth.turned == {TOOLS[1][0] * INCH: {TOOLS[1][0] * INCH + 0.2 * INCH}}
    assert drift(shift)["turned radii with one offset, spread mm"] == 0.0


def test_wrong_part_count_is_reported(shift: NightShift) -> None:
    operator = Operator(shift, 1, {})
    operator.begin()
    operator.make(1)
    operator.finish()
    made = counted(shift)["seen at the slides"]
    shift.desk.program_runs.part_counter.correct_count(1)
    shift.saved()
    assert disagreeing(shift, operator, counted(shift)) == [
        f"desk: {made + 1} of {made}",
        f"store: {made + 1} of {made}",
    ]


def test_part_with_spindle_off_at_bar_push_is_abandoned_and_restarted(shift: NightShift) -> None:
    operator = Operator(shift, 1, {})
    operator.begin()
    shift.run(0.3)
    while shift.shot.line != PUSHING + 1:
        operator.step()
    operator.meets("spindle switch", after=0.0)
    operator.make(1)
    assert operator.did["start"] == 3  # in the evening; with the collet open, which is an alarm; behind it
    assert shift.witness.truth.alarms == {"collet-open": 1}


def test_insert_that_cannot_be_changed_is_reported_and_not_counted(
    shift: NightShift, monkeypatch: pytest.MonkeyPatch
) -> None:
    operator = Operator(shift, 1, {})
    operator.begin()
    monkeypatch.setattr(
        Desk, "confirm_question_if_unchanged", Desk.clear_prompt_line
    )  # something else is always said meanwhile
    with pytest.raises(StuckError, match="the insert cannot be changed"):
        operator.fresh_insert()
    assert operator.did["insert"] == 0


def test_simulated_operator_gives_up_if_no_part_is_made(
    shift: NightShift, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(night_operator, "STUCK", 5.0)
    operator = Operator(shift, 1, {})
    operator.begin()
    shift.lathe.spindle_fault("overvoltage")  # nobody mends it
    with pytest.raises(AssertionError, match="no part for"):
        operator.make(1)
    assert shift.shot.state is not MachineState.RUN

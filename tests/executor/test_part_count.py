"""What counts as a part: a whole piece and nothing else."""

from __future__ import annotations

import pytest

from core.executor.commands import CycleStart, PrepareCycleStart, Reset, SetSwitch
from core.executor.snapshot import MachineState, Snapshot, StartAction
from tests.executor.lines import TOOLS, mdi
from tests.executor.rig import Rig
from tests.executor.test_restart import PART, broken_off, prepare, restart, restart_job
from tests.texts import text

SHORT = "G90G94F300\nX.5\nX0\nM30\n"


def counted(rig: Rig) -> tuple[int, int]:
    """Parts, and parts in the log."""
    return rig.shot.parts, len(rig.said("part"))


def test_dry_run_counts_no_part() -> None:
    rig = Rig()
    rig.post(SetSwitch("no_count", True))
    rig.start(SHORT)
    assert rig.shot.no_count
    assert not rig.shot.counts
    rig.until(MachineState.IDLE)
    assert counted(rig) == (0, 0)
    assert rig.shot.ends == 1
    assert rig.said("uncounted")[0].startswith(text("executor.no-count"))


@pytest.mark.parametrize("at_the_end", [True, False])
def test_no_count_switch_at_program_end_decides_the_part_count(at_the_end: bool) -> None:
    """Forgotten before the start: the switch may be turned until the end."""
    rig = Rig()
    rig.post(SetSwitch("no_count", not at_the_end))
    rig.start(SHORT)
    rig.run(0.1)
    rig.post(SetSwitch("no_count", at_the_end))
    assert rig.shot.counts is not at_the_end
    rig.until(MachineState.IDLE)
    assert counted(rig) == ((0, 0) if at_the_end else (1, 1))


def test_dry_runs_repeat_without_counting() -> None:
    rig = Rig()
    rig.post(SetSwitch("no_count", True), SetSwitch("cycle_repeat", True))
    rig.start(SHORT)
    rig.until_true(lambda shot: shot.ends == 2)
    rig.post(SetSwitch("no_count", False))
    rig.until_true(lambda shot: shot.ends == 3)
    rig.post(SetSwitch("cycle_repeat", False))
    rig.until(MachineState.IDLE)
    assert counted(rig) == (2, 2)
    assert rig.shot.ends == 4


def test_single_block_run_counts_a_part() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start(SHORT)
    for _ in range(10):
        rig.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE)
        if rig.state is MachineState.IDLE:
            break
        rig.run(0.4)
        rig.post(CycleStart())
    assert counted(rig) == (1, 1)


def test_mdi_line_and_aborted_program_count_no_part() -> None:
    rig = Rig()
    rig.ready()
    mdi(rig, "G90")
    rig.post(PrepareCycleStart(StartAction.PROGRAM))
    rig.start(SHORT)
    rig.run(0.1)
    assert rig.shot.counts
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert counted(rig) == (0, 0)
    assert rig.shot.ends == 0


def test_restart_at_the_interrupted_line_counts_the_part() -> None:
    rig = Rig()
    broken_off(rig)
    restart(rig, 8)
    assert rig.shot.counts
    rig.until(MachineState.IDLE)
    assert counted(rig) == (1, 1)


def test_restart_that_skips_lines_counts_no_part() -> None:
    """Line 8 was being cut when it was broken off; from line 10 on its rest is missing."""
    rig = Rig()
    broken_off(rig)
    restart(rig, 10)
    assert not rig.shot.counts
    rig.until(MachineState.IDLE)
    assert counted(rig) == (0, 0)
    assert text("executor.left-out") in rig.said("uncounted")[0]


def test_restart_of_a_part_never_started_counts_no_part() -> None:
    rig = Rig()
    rig.ready()
    rig.load(PART, TOOLS)
    restart(rig, 8)
    rig.until(MachineState.IDLE)
    assert counted(rig) == (0, 0)


def test_aborted_wrong_restart_can_be_corrected_and_counts_the_part() -> None:
    """From line 10, given up on the way; then from line 8: nothing is left out after all."""
    rig = Rig()
    broken_off(rig)
    restart(rig, 10)
    rig.run(0.2)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    restart(rig, 8)
    rig.until(MachineState.IDLE)
    assert counted(rig) == (1, 1)


def test_part_interrupted_twice_counts_once() -> None:
    rig = Rig()
    broken_off(rig)
    restart(rig, 8)
    rig.until_true(lambda shot: shot.line == 9)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    restart(rig, 9)
    rig.until(MachineState.IDLE)
    assert counted(rig) == (1, 1)


def test_part_after_a_restart_is_counted_as_a_new_part() -> None:
    rig = Rig()
    broken_off(rig)
    rig.post(SetSwitch("cycle_repeat", True))
    restart(rig, 10)
    rig.until_true(lambda shot: shot.ends == 1)
    rig.post(SetSwitch("cycle_repeat", False))
    rig.until(MachineState.IDLE)
    assert counted(rig) == (1, 1)


def test_other_program_of_equal_length_is_another_part() -> None:
    rig = Rig()
    broken_off(rig)
    rig.start(SHORT)
    rig.until(MachineState.IDLE)
    rig.load(PART, TOOLS)
    restart(rig, 8)
    rig.until(MachineState.IDLE)
    assert counted(rig) == (1, 1)  # the short one


def test_restart_time_is_not_recorded_as_cycle_time() -> None:
    rig = Rig()
    seen: list[Snapshot] = []
    rig.start(PART, TOOLS)
    rig.until(MachineState.IDLE)
    whole, timed = rig.shot.last_cycle, rig.shot.timed_cycle_count
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.line == 8)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    rig.watch.append(seen.append)
    rig.run(0.4)
    prepare(rig, restart_job(rig, 8))
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 2
    assert (rig.shot.last_cycle, rig.shot.timed_cycle_count) == (whole, timed)

"""M codes: what each does, and on which side of its line's motion."""

from __future__ import annotations

import pytest

from core.interpreter.shared.actions import (
    Action,
    ColletSwitch,
    CoolantSwitch,
    CycleRepeatCancel,
    Dwell,
    InputWait,
    OutputSwitch,
    ProgramEnd,
    ProgramStop,
    SpindleStop,
)
from core.interpreter.shared.job_setup import ControlLimits
from tests.interpreter.programs import body, lines, passed, setup


@pytest.mark.parametrize(
    ("line", "action"),
    [
        ("M00(TURN PART)", ProgramStop(optional=False, message="TURN PART")),
        ("M00", ProgramStop(optional=False)),
        ("M01( measure Ø5 )", ProgramStop(optional=True, message="measure Ø5")),
        ("M05", SpindleStop()),
        ("M08", CoolantSwitch(on=True)),
        ("M09", CoolantSwitch(on=False)),
        ("M12", ColletSwitch(closed=True)),
        ("M13", ColletSwitch(closed=False)),
        ("M25", OutputSwitch("catcher", on=True)),
        ("M26", OutputSwitch("catcher", on=False)),
        ("M15", OutputSwitch("live", on=True)),
        ("M16", OutputSwitch("live", on=False)),
        ("M31", CycleRepeatCancel()),
        ("M91", InputWait("TB2-5", closed=False)),
        ("M92", InputWait("TB2-5", closed=True)),
        ("M93", InputWait("TB2-7", closed=False)),
        ("M94", InputWait("TB2-7", closed=True)),
        ("G04F.1", Dwell(0.1)),
    ],
)
def test_m_code_produces_its_action(line: str, action: Action) -> None:
    result = passed(lines("G90G94F300", line, "M30"))
    assert result.errors == []
    assert result.actions[0] == action


@pytest.mark.parametrize(("line", "reset"), [("M30", True), ("M02", False), ("X1M30", True)])
def test_m02_and_m30_end_the_program(line: str, reset: bool) -> None:
    result = passed(lines("G90G94F300", line))
    assert result.errors == []
    assert result.actions == [ProgramEnd(reset)]
    assert result.blocks[-1].action is not None


@pytest.mark.parametrize(("code", "before"), [
    ("M08", True), ("M12", True), ("M13", True), ("M25", True), ("M15", True), ("M92", True), ("M03", True),
    ("M05", False), ("M09", False), ("M26", False), ("M16", False), ("M00", False), ("M01", False),
    ("M31", False),
])  # fmt: skip
def test_on_codes_run_before_motion_and_off_codes_after_it(code: str, before: bool) -> None:
    result = passed(body(f"X1{code}"))
    on_line = [block.moves for block in result.blocks if block.line == 3]
    assert on_line == ([False, True] if before else [True, False])


def test_modal_state_follows_m_codes() -> None:
    result = passed(body("M08", "M13", "M25", "X1", "M09", "M12", "M26", "X2"))
    first, last = (block.modal for block in result.moves)
    assert (first.coolant, first.collet_closed, first.outputs) == (True, False, frozenset({"catcher"}))
    assert (last.coolant, last.collet_closed, last.outputs) == (False, True, frozenset())


def test_m30_resets_modal_state_and_m02_leaves_it() -> None:
    on = lines("G90G72G95F.003", "M03S800", "M08", "M25", "T1", "X1Z1")
    reset, left = passed(on + "M30\n").interpreter.modal_state, passed(on + "M02\n").interpreter.modal_state
    assert (reset.spindle, reset.coolant, reset.outputs) == (0, False, frozenset())
    assert (left.spindle, left.rpm, left.coolant, left.outputs) == (1, 800, True, frozenset({"catcher"}))
    for modal in (reset, left):
        assert (modal.absolute, modal.diameter, modal.per_rev, modal.feed) == (None, False, False, None)


def test_nothing_runs_after_the_end() -> None:
    result = passed(lines("G90F300", "LS3", "X1", "/M30", "LF", "M30"))
    assert result.errors == []
    assert [block.line for block in result.blocks] == [3, 4]


def test_metric_mode_remains_after_program_end() -> None:
    assert passed(lines("G90G71F300", "X1", "M30")).interpreter.modal_state.metric


def test_comments_last_until_the_next() -> None:
    result = passed(body("X1(rough)", "X2", "(finish)", "X3"))
    assert [block.modal.comment for block in result.moves] == ["rough", "rough", "finish"]


def test_interlocks_of_the_machine_file_can_be_lifted() -> None:
    free = ControlLimits(can_start_with_collet_open=True)
    assert passed(lines("G90F300", "M13", "M03S500", "M30"), setup(limits=free)).errors == []
    assert passed(body("M13", "X1")).errors == []

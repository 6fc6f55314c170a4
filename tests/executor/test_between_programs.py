"""What is in force between two programs, and what a hand may change then."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from core.executor.commands import (
    CycleStart,
    FeedHold,
    ForceOutput,
    PrepareCycleStart,
    Reset,
    SetSpindleLimit,
    StopSpindle,
    UseOffsetTables,
)
from core.executor.control_status import make_modal_state_after_cancel
from core.executor.snapshot import MachineState, StartAction
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.interpreter.shared.modal_state import ModalState
from tests.executor.rig import INCH, Rig
from tests.texts import text

TOOLS = {1: ToolOffset(-12.7, -50.8), 2: ToolOffset(6.35, -25.4)}


def test_power_up_state() -> None:
    rig = Rig()
    modal = rig.shot.modal
    assert (modal.metric, modal.diameter, modal.per_rev, modal.tool, modal.spindle) == (False,) * 3 + (0, 0)
    assert modal.absolute is None
    assert modal.rapid_rate == pytest.approx(100 * INCH / 60)
    assert modal.collet_closed  # its output is on from the start


def test_m30_retains_units_and_tool_offset_and_m02_also_m_functions() -> None:
    rig = Rig()
    rig.start("G90G94F300G71G72\nT1\nX10Z10M08\nM03S900\nG95F.1\nM02\n", TOOLS)
    rig.until(MachineState.IDLE)
    left = rig.shot.modal
    assert (left.metric, left.diameter, left.per_rev, left.absolute) == (True, False, False, None)
    assert (left.tool, left.tool_offset_x, left.tool_offset_z) == (1, -12.7, -50.8)
    assert (left.spindle, left.rpm, left.coolant) == (1, 900.0, True)
    assert rig.shot.offset == (-12.7, -50.8)
    assert rig.shot.requested_rpm == 900.0
    rig.start("G90G70G94F300\nX-.3\nM30\n")
    rig.until(MachineState.IDLE)
    assert (rig.shot.modal.tool, rig.shot.modal.spindle, rig.shot.modal.coolant) == (0, 0, False)
    assert rig.shot.rpm_command == 0.0


def test_reset_leaves_the_same_state_as_m30() -> None:
    rig = Rig()
    rig.start("G90G94F300G72\nT2\nG10X.2\nT1\nX1Z.5M08\nM03S500\nG01G94F10Z-2\nM30\n", TOOLS)
    rig.until_true(lambda shot: shot.line == 7)
    assert rig.shot.modal.shift_x == pytest.approx(0.1 * INCH)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    rig.tick()
    left = rig.shot.modal
    assert (left.tool, left.shift_x, left.diameter, left.spindle, left.coolant) == (1, 0.0, False, 0, False)
    assert rig.shot.offset == (-12.7, -50.8)


def test_estop_clears_spindle_and_coolant_from_the_modal_state() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM08\nM03S900\nM02\n")
    rig.until(MachineState.IDLE)
    assert (rig.shot.modal.spindle, rig.shot.modal.coolant) == (1, True)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.tick()
    assert (rig.shot.modal.spindle, rig.shot.modal.coolant, rig.shot.requested_rpm) == (0, False, 0.0)


def test_changed_offsets_count_at_once_for_the_loaded_tool() -> None:
    rig = Rig()
    rig.start("G90G94F300\nT1D3\nX1Z.5\nM02\n", TOOLS)
    rig.until(MachineState.IDLE)
    assert rig.shot.offset == (-12.7, -50.8)
    rig.post(UseOffsetTables({1: ToolOffset(-12.0, -50.0)}, {}))
    assert rig.shot.offset == (-12.0, -50.0)
    assert rig.shot.modal.tool == 1
    assert rig.said("offsets") == [text("executor.offsets-in-force")]


def test_changed_offsets_are_refused_while_a_program_is_under_way() -> None:
    rig = Rig()
    rig.start("G90G94F300\nT1\nX1Z.5\nM00\nX.5\nM30\n", TOOLS)
    rig.until(MachineState.PROGRAM_STOP)
    rig.post(UseOffsetTables({1: ToolOffset(-12.0, -50.0)}, {1: SecondaryOffset(1.0)}))
    assert rig.shot.offset == (-12.7, -50.8)
    assert rig.said("refused")[-1].startswith(text("executor.program-keeps-offsets"))


def test_requested_rpm_is_reported_before_override_and_limit() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM04S2000\nM02\n")
    rig.until(MachineState.IDLE)
    rig.post(SetSpindleLimit(1500.0))
    rig.sim.machine.set_spindle_pot(0.5)
    rig.run(1.0)
    assert rig.shot.requested_rpm == -2000.0
    assert rig.shot.rpm_command == pytest.approx(-750.0)


def test_the_spindle_is_stopped_by_hand_between_programs_only() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S900\nM00\nM02\n")
    rig.until(MachineState.PROGRAM_STOP)
    rig.post(StopSpindle())
    assert rig.shot.requested_rpm == 900.0
    assert text("executor.program-keeps-spindle") in rig.said("refused")[-1]
    rig.run(0.3)
    rig.sim.machine.press_left()
    rig.sim.machine.press_right()
    rig.until(MachineState.IDLE)
    rig.post(StopSpindle())
    rig.tick()
    assert (rig.shot.requested_rpm, rig.shot.rpm_command, rig.shot.modal.spindle) == (0.0, 0.0, 0)


def test_output_is_forced_at_rest_and_logged() -> None:
    rig = Rig()
    rig.post(ForceOutput("catcher", True))  # the drives are off
    rig.ready()
    rig.post(ForceOutput("coolant", True))
    rig.tick()
    assert {"catcher", "coolant"} <= rig.shot.outputs
    assert rig.shot.modal.coolant
    assert rig.shot.modal.outputs == frozenset({"catcher"})
    assert rig.said("force") == [
        text("executor.by-hand", output="catcher"),
        text("executor.by-hand", output="coolant"),
    ]


@pytest.mark.parametrize(
    ("name", "on", "why"),
    [
        ("laser", True, text("executor.no-output", output="laser")),
        ("coolant", True, text("executor.output-not-now", output="coolant", state="RUNNING")),
    ],
)
def test_forcing_an_output_is_rejected_during_a_program_or_if_unknown(name: str, on: bool, why: str) -> None:
    rig = Rig()
    rig.start("G90G94F1\nX1\nM30\n")
    rig.post(ForceOutput(name, on))
    assert why in rig.said("refused")[-1]
    assert name not in rig.shot.outputs


def test_collet_does_not_open_manually_while_spindle_turns() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S900\nM02\n")
    rig.until(MachineState.IDLE)
    rig.run(1.0)
    rig.post(StopSpindle())
    rig.post(ForceOutput("collet", False))  # it still runs down
    assert rig.said("refused")[-1] == text("executor.collet-spindle-turns")
    rig.run(3.0)
    rig.post(ForceOutput("collet", False))
    rig.tick()
    assert not rig.shot.modal.collet_closed


@pytest.mark.parametrize(("machine", "diameter"), [("sinumerik-modulo", True), ("gt75", False)])
def test_sinumerik_uses_diameters_at_power_up_and_after_reset(machine: str, diameter: bool) -> None:
    rig = Rig(machine=load_shipped_machine(machine))
    assert rig.shot.modal.diameter is diameter
    left = make_modal_state_after_cancel(ModalState(diameter=not diameter), rig.machine.mdi_language)
    assert left.diameter is diameter


@pytest.mark.parametrize(
    ("machine", "name", "text", "diameter"),
    [
        ("sinumerik-modulo", "part.mpf", "G90 G71\nG0 X1\nM30\n", True),
        ("gt75", "part.nc", "G90G94F300\nX.1\nM30\n", False),
    ],
)
def test_program_starts_in_the_diameter_mode_of_its_dialect(
    machine: str, name: str, text: str, diameter: bool
) -> None:
    """Before its first block has said anything: what the page shows of X must not jump for a tick."""
    rig = Rig(machine=load_shipped_machine(machine))
    shown: list[bool] = []
    rig.ready()
    rig.run(0.3)
    rig.load(text, name=name)
    rig.watch.append(lambda shot: shown.append(shot.modal.diameter))
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert set(shown) == {diameter}


G72 = "G90G94F300G72\nX.85Z.1\nM30\n"


def test_the_readout_remains_a_diameter_after_end_reset_and_estop() -> None:
    rig = Rig()
    rig.start(G72)
    rig.until(MachineState.IDLE)
    assert rig.shot.shows_diameter
    assert not rig.shot.modal.diameter
    rig.start(G72.replace("M30", "X.9\nM00\nM30"))
    rig.until(MachineState.PROGRAM_STOP)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert rig.shot.shows_diameter
    rig.start(G72.replace("M30", "X.9\nM00\nM30"))
    rig.until(MachineState.PROGRAM_STOP)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    assert rig.shot.shows_diameter


def test_another_program_or_mdi_restores_the_default_diameter_mode() -> None:
    rig = Rig()
    rig.start(G72)
    rig.until(MachineState.IDLE)
    rig.post(PrepareCycleStart(StartAction.MDI_LINE))
    assert not rig.shot.shows_diameter  # a typed X counts as a radius now
    rig = Rig()
    rig.start(G72)
    rig.until(MachineState.IDLE)
    rig.load("G90G94F300\nX1\nM30\n", name="OTHER")
    rig.tick()
    assert not rig.shot.shows_diameter


def test_comment_is_cleared_with_its_program() -> None:
    rig = Rig()
    rig.start("(FIRST PART)\nG90G94F300\nX.5\nM30\n")
    rig.until(MachineState.IDLE)
    assert rig.shot.comment == "FIRST PART"
    rig.load("G90G94F300\nX1\nM30\n", name="OTHER")
    rig.tick()
    assert rig.shot.comment == ""

"""A spindle without an encoder: turning goes on by the inverter's word, threads are refused."""

from __future__ import annotations

import dataclasses

from app.compose.machine.machine_files import load_machine
from core.executor.snapshot import MachineState
from tests.executor.rig import Rig


def rig_without_encoder() -> Rig:
    machine = load_machine()
    return Rig(
        machine=dataclasses.replace(machine, spindle=dataclasses.replace(machine.spindle, encoder_ppr=0))
    )


def test_program_with_spindle_runs_without_an_encoder() -> None:
    rig = rig_without_encoder()
    rig.start("G90G94F300\nM03S1000\nX.5Z.1\nG95F.004X.4\nM30\n")
    rig.until(MachineState.IDLE, MachineState.FAULT)
    assert rig.state is MachineState.IDLE, rig.shot.alarms
    assert not rig.shot.alarms


def test_thread_without_an_encoder_is_rejected_with_a_message() -> None:
    rig = rig_without_encoder()
    rig.start("G90G94F300\nM03S1000\nX.25Z.2\nG33X.24Z-.2I.01K.05O\nM30\n")
    rig.until(MachineState.FAULT)
    assert "encoder" in rig.shot.alarms[0].cause

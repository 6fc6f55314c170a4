"""A wire that is lost while the controller lives, and its return: Reset connects, the truth is read anew."""

from __future__ import annotations

import re

import pytest

from core.executor.commands import EnableDrives, Reset
from core.executor.snapshot import MachineState
from core.ports import ALL_UNKNOWN_PARTS
from tests.drivers.contract.grbl import HOMING
from tests.drivers.grblhal.bench import GrblBench, grbl_machine, quirky
from tests.texts import pattern

CUT = "G90G94F300\nM03S600\nM08\nX.1\nG01F30Z-2\nM30\n"


def pulled(bench: GrblBench) -> GrblBench:
    """In the middle of a cut the cable is pulled; the controller comes to rest by itself."""
    bench.start(CUT)
    bench.until_true(lambda shot: shot.actual[1] < -8.0)
    bench.wire.cut = True
    bench.until(MachineState.FAULT, limit=0.1)
    bench.run(3.0)
    bench.peer.advance()
    return bench


def test_lost_connection_makes_all_machine_states_unknown() -> None:
    bench = pulled(GrblBench())
    assert bench.shot.unknown == ALL_UNKNOWN_PARTS
    assert bench.peer.spindle.speed == pytest.approx(600.0)  # whatever the screen says
    assert bench.peer.output_states["flood"]
    assert not bench.executor._context.spindle.is_stopped


def test_reset_without_the_cable_repeats_the_alarm() -> None:
    bench = pulled(GrblBench())
    bench.post(Reset())
    bench.run(0.5)
    assert bench.state is MachineState.FAULT
    assert bench.shot.alarms[0].code == "controller-lost"
    assert bench.shot.unknown == ALL_UNKNOWN_PARTS


def test_reset_reconnects_and_switches_off_outputs_that_are_still_on() -> None:
    bench = pulled(GrblBench())
    bench.wire.cut = False
    bench.post(Reset())
    bench.run(2.0)
    assert bench.state is MachineState.DISABLED
    assert bench.peer.spindle.speed == 0.0
    assert not bench.peer.output_states["flood"]
    (said,) = [event.text for event in bench.events if event.kind == "disturbed"]
    assert re.fullmatch(pattern("executor.machine-trip", names="SPINDLE, COOLANT"), said)
    assert "3." in said
    assert bench.shot.unknown == frozenset()
    assert all(bench.shot.homed)
    assert bench.shot.actual[:2] == pytest.approx(bench.peer.motion.position, abs=0.001)


def test_part_is_made_after_reconnecting() -> None:
    bench = pulled(GrblBench())
    bench.wire.cut = False
    bench.post(Reset())
    bench.run(2.0)
    bench.start("G90G94F300\nM03S600\nX.1\nG01F100X0\nM30\n")
    bench.until(MachineState.IDLE)
    assert bench.shot.parts == 1


@pytest.mark.parametrize("homes", [False, True], ids=["counts", "homes"])
def test_a_controller_that_has_restarted_meanwhile_has_to_be_homed(homes: bool) -> None:
    """It counts from 0 where it stands, under G17: nobody may believe that place."""
    bench = GrblBench(grbl_machine(*HOMING), quirky(homing=True)) if homes else GrblBench()
    if homes:
        bench.peer.homed_axis_mask = 5
    bench.ready()
    bench.run(0.5)
    bench.wire.cut = True
    bench.run(0.5)
    bench.peer.cycle_power()
    bench.wire.cut = False
    bench.post(Reset())
    bench.run(2.0)
    assert bench.shot.homed[:2] == (False, False)
    bench.post(EnableDrives())
    bench.run(0.5)
    bench.press()
    assert re.fullmatch(pattern("executor.not-homed"), bench.shot.start_refusal_reason)


def test_controller_reset_by_its_button_retains_a_nonzero_position() -> None:
    """Its modes are gone, but a controller that restarts counts from 0: this one has not."""
    bench = pulled(GrblBench())
    bench.peer.reset()
    bench.wire.cut = False
    bench.post(Reset())
    bench.run(2.0)
    assert all(bench.shot.homed)
    assert bench.shot.actual[1] < -8.0


def test_firmware_without_a_mode_query_is_recognized_by_its_position(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bench = pulled(GrblBench())
    told = bench.peer.program.format_modes
    monkeypatch.setattr(
        bench.peer.program, "format_modes", lambda: "" if bench.wire.sent[-1:] == b"\x83" else told()
    )
    bench.wire.cut = False
    bench.post(Reset())
    bench.run(3.0)
    assert all(bench.shot.homed)
    assert bench.shot.alarms == ()

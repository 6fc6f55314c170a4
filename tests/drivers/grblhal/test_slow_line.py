"""A line that is much slower than its blocks: the firmware's simulator on a busy computer, 9600 baud."""

from __future__ import annotations

import pytest

from core.executor.snapshot import MachineState
from drivers.simulators.grblhal_firmware import GrblFirmware
from tests.drivers.grblhal.bench import GrblBench, quirky

DIAGONALS = "G90G94F300\n" + "X1Z1\nX0Z0\n" * 4 + "M30\n"


@pytest.mark.parametrize("drip", [0.012, 0.025])
def test_a_question_that_lies_behind_lines_is_no_silence(drip: float) -> None:
    """Four blocks are some 72 bytes: at 25 ms a byte a question behind them waits for two seconds."""
    bench = GrblBench()
    bench.ready()
    bench.peer.behavior.drip = drip
    bench.start(DIAGONALS)
    bench.until(MachineState.IDLE)
    assert not bench.alarms()
    assert bench.peer.motion.position == pytest.approx((0.0, 0.0))


def test_one_question_waits_for_its_report() -> None:
    """What is asked ten times a second and answered once only fills the line."""
    bench = GrblBench(quirks=quirky())
    bench.ready()
    bench.run(1.0)
    bench.peer.behavior.sends_nothing = True
    bench.wire.sent.clear()
    bench.run(0.9)
    assert 1 <= bench.wire.sent.count(0x80) + bench.wire.sent.count(0x87) <= 3


def test_one_that_answers_nothing_is_told_as_before() -> None:
    """Lines that nobody answers are no sign of life, on a slow line neither."""
    bench = GrblBench()
    bench.ready()
    bench.peer.behavior.drip = 0.012
    bench.start(DIAGONALS)
    bench.until_true(lambda shot: shot.state is MachineState.RUN)
    bench.run(1.0)
    mute(bench.peer)
    bench.until(MachineState.FAULT, limit=2.0)
    assert [alarm.code for alarm in bench.shot.alarms] == ["controller-silent"]


def mute(peer: GrblFirmware) -> None:
    """Its line back is broken."""
    peer.behavior.sends_nothing = True

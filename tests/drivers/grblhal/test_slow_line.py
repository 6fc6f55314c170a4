"""A line that is much slower than its blocks: the firmware's simulator on a busy computer, 9600 baud."""

from __future__ import annotations

import pytest

from core.executor.snapshot import MachineState
from drivers.simulators.grblhal_firmware import GrblFirmware
from tests.drivers.grblhal.bench import GrblBench, quirky

DIAGONALS = "G90G94F300\n" + "X1Z1\nX0Z0\n" * 4 + "M30\n"


@pytest.mark.parametrize("drip", [0.012, 0.025])
def test_status_query_delayed_after_queued_lines_is_not_silence(drip: float) -> None:
    """Four blocks are some 72 bytes: at 25 ms a byte a question behind them waits for two seconds."""
    bench = GrblBench()
    bench.ready()
    bench.peer.behavior.drip = drip
    bench.start(DIAGONALS)
    bench.until(MachineState.IDLE)
    assert not bench.alarms()
    assert bench.peer.motion.position == pytest.approx((0.0, 0.0))


def test_only_one_status_query_is_pending_at_a_time() -> None:
    """What is asked ten times a second and answered once only fills the line."""
    bench = GrblBench(quirks=quirky())
    bench.ready()
    bench.run(1.0)
    bench.peer.behavior.sends_nothing = True
    bench.wire.sent.clear()
    bench.run(0.9)
    assert 1 <= bench.wire.sent.count(0x80) + bench.wire.sent.count(0x87) <= 3


def test_controller_that_never_replies_is_reported_on_a_slow_connection() -> None:
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

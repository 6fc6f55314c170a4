"""A cycle under the executor: the same program, buttons and end, whatever drives the machine."""

from __future__ import annotations

import itertools
import math

import pytest

from core.executor.commands import CycleStart, FeedHold, HomeAxes, Reset, SetFeedOverride, SetSwitch
from core.executor.snapshot import MachineState
from tests.drivers.contract.control import INCH, Control
from tests.drivers.contract.rig import STILL, TICK, Rig
from tests.drivers.contract.test_stopped import cutting
from tests.texts import text

PART = (
    "G90G94F300\nM03S1000\nM08\nM25\nX1\nG01F60Z-.5\nG03X1.25Z-.75I1.25K-.5\nX1.5\nG04F.3\n"
    "M05\nM09\nM13\nM12\nM26\nG00X.5Z.25\nM30\n"
)
END = (0.5 * INCH, 0.25 * INCH)


def test_part_with_all_functions_is_made(control: Control) -> None:
    seen: set[str] = set()
    places: list[tuple[float, float]] = []
    control.watch.append(lambda _: seen.update(name for name, on in control.world.outputs().items() if on))
    control.watch.append(lambda _: places.append(control.world.place()))
    control.start(PART)
    control.until(MachineState.IDLE, MachineState.FAULT)
    assert control.shot.alarms == ()
    assert control.shot.parts == 1
    assert seen == {"coolant", "catcher", "collet"}
    assert {name for name, on in control.world.outputs().items() if on} == {"collet"}
    assert control.world.place() == pytest.approx(END, abs=0.003)
    assert control.shot.demand[:2] == pytest.approx(END, abs=1e-6)
    # the arc about X1.25 Z-.5 with a radius of a quarter of an inch was gone round, not cut off
    on_arc = [p for p in places if 1.001 < p[0] / INCH < 1.249 and p[1] / INCH < -0.5]
    assert len(on_arc) > 10
    off = max(abs(math.dist(p, (1.25 * INCH, -0.5 * INCH)) - 0.25 * INCH) for p in on_arc)
    assert off < 0.01
    control.until_true(lambda _: control.world.rpm() == 0.0, 3.0)


def test_full_queue_of_short_blocks_runs_each_exactly_once(control: Control) -> None:
    """Four hundred blocks of a thousandth of an inch, 150 a second."""
    block = 0.001 * INCH
    steps = "".join(f"Z-{0.001 * n:.3f}\n" for n in range(1, 401))
    places: list[float] = []
    blocks: list[int] = []
    control.watch.append(lambda _: places.append(control.world.place()[1]))
    control.watch.append(lambda shot: blocks.append(shot.block))
    control.start(f"G90G94F300\nX0Z0\nG01F9\n{steps}M30\n")
    control.until(MachineState.IDLE, MachineState.FAULT)
    assert control.shot.alarms == ()
    assert control.shot.underruns == 0
    assert control.shot.parts == 1
    assert all(after < before + 0.5 * block for before, after in itertools.pairwise(places))
    assert places[-1] == pytest.approx(-0.4 * INCH, abs=0.003)
    shown = [number for number in blocks if number]
    assert shown == sorted(shown)


def test_feed_hold_from_full_speed_stops_in_time_on_the_path(control: Control) -> None:
    cutting(control)
    control.until_true(lambda shot: shot.velocity == pytest.approx(127.0, rel=0.01), 0.2)  # 300 in/min
    off: list[float] = []
    control.watch.append(lambda _: off.append(off_line(control.world.place())))
    pressed = control.clock.now()
    control.post(FeedHold())
    control.rest(control.rig.hold)
    assert control.clock.now() - TICK - pressed <= control.rig.hold + 1e-9
    control.until(MachineState.HOLD, limit=0.2)
    assert max(off) < 0.005
    stood = control.world.place()
    control.run(1.0)
    assert control.world.place() == pytest.approx(stood, abs=STILL)
    assert control.state is MachineState.HOLD
    control.press()
    control.until(MachineState.IDLE)
    assert control.shot.parts == 1
    assert control.world.place() == pytest.approx((0.0, 0.0), abs=0.003)
    assert max(off) < 0.005


def off_line(place: tuple[float, float]) -> float:
    """mm off the line from X0 Z0 to X3 Z-.2."""
    return abs(0.2 * place[0] + 3.0 * place[1]) / math.hypot(0.2, 3.0)


def test_hold_button_holds_and_bars_start_while_pressed(control: Control) -> None:
    cutting(control)
    control.world.press_hold()
    control.until(MachineState.HOLD, limit=0.4)
    control.press()
    assert control.state is MachineState.HOLD
    assert control.shot.start_refusal_reason == text("executor.hold-pressed")
    control.world.release_hold()
    control.press()
    control.until(MachineState.RUN, limit=0.1)


def test_zero_override_stops_motion_and_half_override_halves_the_speed(control: Control) -> None:
    control.start("G90G94F300\nG01F60Z-3\nM30\n")
    control.until_true(lambda shot: shot.velocity > 25.0)
    control.post(SetFeedOverride(0.5))
    control.run(1.0)
    assert control.shot.velocity == pytest.approx(0.5 * INCH, rel=0.03)
    control.post(SetFeedOverride(0.0))
    control.until(MachineState.WAIT, limit=0.5)
    control.rest(0.3)
    stood = control.world.place()
    control.run(1.0)
    assert control.world.place() == pytest.approx(stood, abs=STILL)
    control.post(SetFeedOverride(1.0))
    control.until(MachineState.IDLE)
    assert control.world.place()[1] == pytest.approx(-3.0 * INCH, abs=0.003)


def test_single_block_stops_after_each_block(control: Control) -> None:
    control.post(SetSwitch("single_block", True))
    control.start("G90G94F300\nX.5\nG01F100Z-.5\nX.7\nM30\n")
    places = []
    for _ in range(3):
        control.until(MachineState.SINGLE_BLOCK_STOP, limit=5.0)
        control.run(0.1)
        places.append(control.world.place())
        control.press()
    control.until(MachineState.IDLE)
    expected = [(0.5, 0.0), (0.5, -0.5), (0.7, -0.5)]
    for place, (x, z) in zip(places, expected, strict=True):
        assert place == pytest.approx((x * INCH, z * INCH), abs=0.003)


def test_single_block_continues_past_blocks_without_motion(control: Control) -> None:
    control.post(SetSwitch("single_block", True))
    control.start("G90G94F300\nX.3Z.1\nX.3\nG01X.3F100\nX.35\nX.35\nM30\n")
    lines = []
    while control.state is not MachineState.IDLE:
        control.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE, MachineState.FAULT, limit=5.0)
        if control.state is MachineState.SINGLE_BLOCK_STOP:
            lines.append(control.shot.line)
            assert len(lines) < 12, lines
            control.press()
    assert lines == [2, 3, 4, 5, 6]
    assert control.world.place() == pytest.approx((0.35 * INCH, 0.1 * INCH), abs=0.003)
    assert control.shot.parts == 1


def test_reset_in_motion_stops_and_starts_nothing(control: Control) -> None:
    cutting(control)
    control.post(Reset())
    control.rest(0.4)
    control.until(MachineState.IDLE, limit=3.0)
    stood = control.world.place()
    control.until_true(lambda _: control.world.rpm() == 0.0, 3.0)
    control.run(1.0)
    assert control.world.place() == pytest.approx(stood, abs=STILL)
    assert not control.world.outputs()["coolant"]
    assert control.shot.parts == 0
    control.post(CycleStart())


def test_cycle_runs_after_homing(lost: Rig) -> None:
    control = Control(lost)
    control.start("G90G94F300\nX.1Z.1\nM30\n")
    assert control.state is MachineState.IDLE
    assert "homed" in control.shot.start_refusal_reason
    control.post(HomeAxes())
    control.until(MachineState.HOMING, limit=0.1)
    control.until(MachineState.IDLE)
    assert all(control.shot.homed)
    control.press()
    control.until(MachineState.IDLE)
    assert control.shot.parts == 1
    assert control.world.place() == pytest.approx((0.1 * INCH, 0.1 * INCH), abs=0.003)

"""Hold, resume, override and single block: always on the path, always to the same end."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

import pytest

from core.executor.commands import CycleStart, FeedHold, Reset, SetFeedOverride, SetSwitch
from core.executor.snapshot import MachineState
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from tests.executor.rig import INCH, TICK, Rig, off_line
from tests.texts import text

pytestmark = pytest.mark.long

RAPID = "G90G94F300\nX3Z-4\nX0Z0\nM30\n"
END = (3 * INCH, -4 * INCH)
AMAX = 120 * INCH
STEP_OFF = 0.00254  # mm, the path may be left by two counts


def moving_rig(program: str = RAPID, seconds: float = 0.4) -> Rig:
    rig = Rig()
    rig.start(program)
    rig.run(seconds)
    assert rig.state is MachineState.RUN
    return rig


def test_hold_at_full_speed_stops_in_time_and_on_the_path() -> None:
    rig = moving_rig()
    speed = 300 * INCH / 60
    assert rig.shot.velocity == pytest.approx(speed, rel=0.01)
    seen = []
    rig.watch.append(lambda shot: seen.append(off_line(shot, (0.0, 0.0), END)))
    pressed = rig.clock.now()
    rig.executor.post(FeedHold())
    rig.executor.run_tick()
    rig.until(MachineState.HOLD)
    # the slower axis share: 3-4-5, so along the path a = 120 in/s² / .8
    ramp = speed / (120 * INCH / 0.8)
    assert rig.clock.now() - pressed <= 0.03 + ramp + TICK + 1e-9
    assert max(seen) < STEP_OFF
    assert rig.numbers("stop") == [702]


def test_hold_button_of_the_station_holds() -> None:
    rig = moving_rig()
    rig.sim.machine.press_hold()
    rig.until(MachineState.HOLD)
    rig.post(CycleStart())
    assert rig.state is MachineState.HOLD
    assert rig.shot.start_refusal_reason == text("executor.hold-pressed")
    rig.sim.machine.release_hold()
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.start_refusal_reason == ""


@pytest.mark.parametrize("after", [0.001, 0.1, 0.333, 0.77, 1.01, 1.4, 1.99])
def test_resume_ends_at_the_same_place(after: float) -> None:
    rig = Rig()
    rig.start("G90G94F300\nX1\nG01F60Z-.5\nG02X1.5Z-1I1.5K-.5\nX2Z-1.2\nM30\n")
    rig.clock.advance(after)
    rig.executor.post(FeedHold())
    rig.executor.run_tick()
    rig.until(MachineState.HOLD, limit=3.0)
    rig.run(1.0)
    assert rig.state is MachineState.HOLD
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[:2] == pytest.approx((2 * INCH, -1.2 * INCH), abs=1e-6)
    assert rig.shot.parts == 1


def test_repeated_hold_and_repeated_start_have_no_effect() -> None:
    rig = moving_rig()
    rig.post(FeedHold(), FeedHold())
    rig.post(CycleStart())
    assert rig.state is MachineState.STOPPING
    rig.until(MachineState.HOLD)
    rig.run(0.4)
    rig.post(CycleStart(), CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_hold_does_not_start_anything() -> None:
    rig = Rig()
    rig.ready()
    rig.load(RAPID)
    rig.post(FeedHold())
    rig.run(1.0)
    assert rig.state is MachineState.IDLE
    assert rig.shot.actual == (0.0, 0.0, 0.0)


def test_dwell_resumes_with_its_remaining_time_after_a_hold() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG04F2\nM30\n")
    rig.run(0.5)
    rig.post(FeedHold())
    assert rig.state is MachineState.HOLD
    rig.run(10.0)
    rig.post(CycleStart())
    assert rig.until(MachineState.IDLE) == pytest.approx(1.5, abs=0.05)


def test_spindle_keeps_turning_in_hold_and_stops_after_reset() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S1000\nG01F10Z-1\nM30\n")
    rig.run(3.0)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.run(2.0)
    assert rig.shot.rpm_actual == pytest.approx(1000)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    rig.run(3.0)
    assert rig.shot.rpm_actual == 0.0
    rig.post(CycleStart())
    rig.tick()
    assert rig.shot.line <= 3


def test_resume_into_a_cut_without_the_spindle_is_refused() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S1000\nG01F10Z-1\nM30\n")
    rig.run(3.0)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.sim.machine.set_spindle_auto(False)
    rig.run(2.0)
    assert rig.shot.rpm_actual == 0.0
    rig.post(CycleStart())
    assert rig.state is MachineState.HOLD
    assert rig.shot.start_refusal_reason == text("executor.switch-off-refused")
    rig.sim.machine.set_spindle_auto(True)
    rig.run(2.0)
    assert rig.shot.announced == (text("executor.spindle-starts", rpm=1000, direction="FORWARD"),)
    at = rig.shot.actual
    rig.post(CycleStart())
    assert rig.shot.waiting_for == text("executor.at-speed")
    while rig.state is MachineState.WAIT:
        assert rig.shot.actual == at
        rig.tick()
    assert rig.state is MachineState.RUN
    assert rig.shot.rpm_actual == pytest.approx(1000.0, rel=0.1)


def test_half_override_takes_twice_as_long() -> None:
    whole = Rig()
    whole.start("G90G94F300\nG01F30Z-1\nM30\n")
    half = Rig()
    half.post(SetFeedOverride(0.5))
    half.start("G90G94F300\nG01F30Z-1\nM30\n")
    assert half.until(MachineState.IDLE) == pytest.approx(2 * whole.until(MachineState.IDLE), rel=0.03)


@pytest.mark.parametrize("program", ["G90G94F300\nG01F30Z-1\nM30\n", RAPID])
def test_zero_override_holds_and_higher_override_resumes(program: str) -> None:
    rig = moving_rig(program)
    rig.sim.machine.set_feed_pot(0.0)
    rig.run(1.0)
    assert rig.state is MachineState.WAIT
    assert rig.shot.waiting_for == text("executor.feed-override-0")
    stood = rig.shot.actual
    rig.run(5.0)
    assert rig.shot.actual == stood
    rig.sim.machine.set_feed_pot(1.0)
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_override_changes_the_speed_in_motion() -> None:
    rig = moving_rig("G90G94F300\nG01F30Z-5\nM30\n", 1.0)
    for fraction in (0.5, 1.5, 1.0, 0.3):
        rig.post(SetFeedOverride(fraction))
        rig.run(0.5)
        assert rig.shot.velocity == pytest.approx(fraction * 30 * INCH / 60, rel=0.03)


def test_override_never_makes_a_rapid_faster() -> None:
    rig = Rig()
    rig.post(SetFeedOverride(1.5))
    rig.start("G90G94F100\nX3\nM30\n")
    rig.run(1.0)
    assert rig.shot.velocity == pytest.approx(100 * INCH / 60, rel=0.02)


@pytest.mark.parametrize("fraction", [-0.1, 1.51, float("nan")])
def test_an_override_out_of_range_is_refused(fraction: float) -> None:
    rig = moving_rig()
    rig.post(SetFeedOverride(fraction))
    assert rig.shot.feed_override == 1.0
    assert rig.said("refused")


def test_single_block_stops_after_every_block() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start("G90G94F300\nX1\nG01F100Z-1\nM08\nX1.5\nM30\n")
    stops = []
    for _ in range(4):
        rig.until(MachineState.SINGLE_BLOCK_STOP)
        stops.append((rig.shot.block, rig.shot.line, tuple(round(v / INCH, 4) for v in rig.shot.demand[:2])))
        rig.run(0.5)
        assert rig.state is MachineState.SINGLE_BLOCK_STOP
        rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert stops == [(1, 2, (1, 0)), (2, 3, (1, -1)), (3, 4, (1, -1)), (4, 5, (1.5, -1))]
    assert rig.shot.parts == 1


def test_single_block_switched_on_in_motion_stops_at_the_end_of_the_block() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F60Z-1\nX1\nZ-2\nM30\n")
    rig.until_true(lambda shot: shot.actual[1] < -0.5 * INCH)
    rig.post(SetSwitch("single_block", True))
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    assert rig.shot.demand[:2] == pytest.approx((0.0, -INCH))
    rig.run(0.5)
    rig.post(SetSwitch("single_block", False), CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[:2] == pytest.approx((INCH, -2 * INCH))


def test_single_block_set_too_late_stops_after_the_next_block() -> None:
    rig = Rig()
    short = "".join(f"Z-{0.01 * k:.2f}\n" for k in range(1, 200))
    rig.start("G90G94F300\nG01F200\n" + short + "M30\n")
    rig.until_true(lambda shot: shot.actual[1] < -0.5 * INCH)
    block = rig.shot.block
    rig.post(SetSwitch("single_block", True))
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    # 30 ms commit and v²/2a = 2.4 mm at 200 in/min: some blocks of .254 mm further, and exactly at an end
    assert block < rig.shot.block < block + 30
    assert rig.shot.demand[1] == pytest.approx(-0.254 * rig.shot.block)
    rig.run(0.4)
    rig.post(CycleStart())
    before = rig.shot.block
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    assert rig.shot.block == before + 1


def test_hold_followed_by_single_block_stops_at_the_block_end() -> None:
    rig = moving_rig()
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.run(0.4)
    rig.post(SetSwitch("single_block", True), CycleStart())
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    assert rig.shot.demand[:2] == pytest.approx(END)


def test_an_unknown_switch_is_refused() -> None:
    rig = Rig()
    rig.post(SetSwitch("turbo", True))
    assert "turbo" in rig.said("refused")[0]


def test_reset_in_motion_stops_on_the_path_and_ends_the_program() -> None:
    rig = moving_rig()
    seen = []
    rig.watch.append(lambda shot: seen.append(off_line(shot, (0.0, 0.0), END)))
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert max(seen) < STEP_OFF
    assert rig.shot.parts == 0
    stood = rig.shot.demand
    rig.run(2.0)
    assert rig.shot.demand == stood
    rig.confirm()
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.block == 1)
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[:2] == pytest.approx((0.0, 0.0), abs=1e-6)


def test_override_change_is_logged_once() -> None:
    rig = Rig()
    rig.post(SetFeedOverride(0.5))
    rig.run(1.0)
    rig.sim.machine.set_feed_pot(0.0)
    rig.run(1.0)
    assert rig.said("override") == [
        text("executor.feed-percent", percent=50),
        text("executor.feed-percent", percent=0),
    ]


def test_million_block_program_does_not_delay_a_hold() -> None:
    rig = Rig()
    pulled = 0

    def many() -> Iterator[Block]:
        nonlocal pulled
        for block in endless():
            pulled += 1
            yield block

    rig.made = many()
    rig.start("G90\nM30\n")
    rig.run(1.0)
    assert rig.shot.velocity == pytest.approx(100.0, rel=0.03)
    assert pulled < 20_000  # a second done, 1.5 s planned and 1 s read, 5000 blocks each, and a tick
    rig.post(FeedHold())
    # 30 ms commit, v/a = 33 ms, a tick to see it
    assert rig.until(MachineState.HOLD) <= 0.03 + 100.0 / AMAX + 2 * TICK
    assert rig.shot.underruns == 0


def endless() -> Iterator[Block]:
    """Chords of .02 mm at 100 mm/s, up and down X."""
    x, modal = 0.0, ModalState()
    for n in count(1):
        end = x + (0.02 if (n // 4000) % 2 == 0 else -0.02)
        z0, z = -0.00001 * (n - 1), -0.00001 * n
        yield Block(n, n, BlockKind.FEED, "", x, z0, 0.0, end, z, 0.0, 0.0, 0.0, modal, feed=100.0)
        x = end

"""Programs on the simulator: what goes out, what waits, what is held, stepped, overridden and refused."""

from __future__ import annotations

import math

import pytest

from core.executor.commands import SetFeedOverride, SetSwitch
from core.executor.snapshot import MachineState
from tests.drivers.grblhal.bench import GrblBench, grbl_machine, quirky

LONG = "G90G94F300\nM03S1000\nX.5Z.2\nG01Z-2F30\nX1F30\nM30\n"  # 2.2 in and .5 in at 30 in/min: 4.4 s and 1 s


def test_small_program_is_sent_line_by_line() -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nX.5Z.2\nG01X.25F60\nG03X.5Z-.05I.5K.2F60\nM08\nX.6F300\nM30\n")
    bench.until(MachineState.IDLE)
    # .25 in at 60 in/min take .25 s: two pieces. The arc is 90 degrees about (12.7, 5.08), from X- to Z-,
    # which in the controller's plane is clockwise; its middle lies 6.35/√2 off the centre. G0 would go the
    # first way at 127·√(12.7² + 5.08²)/12.7 = 136.8 mm/s, faster than its rate.
    assert bench.wire.lines() == [
        "N1G1X12.7Z5.08F7620",
        "N2G1X9.525Z5.08F1524",
        "N3G1X6.35Z5.08F1524",
        "N4G2X8.20987Z0.58987I6.35K0F1524",
        "N5G2X12.7Z-1.27I4.49013K4.49013F1524",
        "M8",
        "N6G0X15.24Z-1.27",
        "M9",
    ]


@pytest.mark.parametrize(
    ("target", "speed"),
    [
        ("Z3", 127.0),
        ("X3Z3", 127.0),  # F300 counts along the way: G0 would go at 127·√2
        ("X3Z1", 127.0),
    ],
)
def test_rapid_takes_the_proved_time(target: str, speed: float) -> None:
    """Way / speed + speed / acceleration, X and Z 127 mm/s and 3000 mm/s²; 40 ms to see that it is over."""
    bench = GrblBench()
    bench.start(f"G90G94F300\n{target}\nM30\n")
    took = bench.until(MachineState.IDLE)
    x, z = bench.peer.motion.position
    assert took + 0.2 == pytest.approx(math.hypot(x, z) / speed + speed / 3000.0, abs=0.15)  # 0.2 s: press()
    assert all("G0" not in line for line in bench.wire.lines() if "X" in line and target != "Z3")


def test_slow_axis_limits_only_its_own_share_of_the_speed() -> None:
    """X 1 in/s by $110, Z 5: along Z at Z's speed, up and across at X's times the way over X's part of it."""
    bench = GrblBench(quirks=quirky(settings={110: 1524.0}))
    bench.start("G90G94F300\nZ3\nX1Z4\nX0Z4\nM30\n")
    bench.until(MachineState.IDLE)
    lines = bench.wire.lines()
    assert lines[0].startswith("N1G0X0Z")
    assert all("G0" in line for line in lines[:4])
    assert bench.machine.block_controller.get_max_directional_speed(0.0, 1.0) == pytest.approx(127.0)
    assert bench.machine.block_controller.get_max_directional_speed(1.0, 1.0) == pytest.approx(
        25.4 * math.sqrt(2.0)
    )


def test_faster_controller_runs_no_faster_than_proved() -> None:
    bench = GrblBench(quirks=quirky(settings={110: 12000.0, 112: 12000.0}))
    bench.start("G90G94F300\nZ3\nX1Z1\nM30\n")
    bench.until(MachineState.IDLE)
    assert all(line.endswith("F7620") for line in bench.wire.lines() if "Z" in line)


def test_arc_speed_is_limited_by_the_acceleration() -> None:
    """R 2 mm: √(0.8 · 3048 · 2) = 69.8 mm/s, though 127 are programmed and the firmware would take them."""
    bench = GrblBench()
    bench.start("G90G94F300\nX.07874Z0\nG03X0Z-.07874I0K0\nM30\n")
    bench.until(MachineState.IDLE)
    arcs = [line for line in bench.wire.lines() if "I" in line]
    assert arcs
    assert {round(float(arc.partition("F")[2]) / 60.0, 1) for arc in arcs} == {69.8}


def test_program_ends_at_its_programmed_position_and_counts_a_part() -> None:
    bench = GrblBench()
    bench.start(LONG)
    took = bench.until(MachineState.IDLE)
    assert bench.peer.motion.position == pytest.approx((25.4, -50.8))
    assert bench.shot.demand[:2] == pytest.approx((25.4, -50.8), abs=1e-9)
    assert bench.shot.parts == 1
    assert took == pytest.approx(5.4 + 0.7, abs=0.6)  # and the spindle, which reaches its speed in .7 s


def test_active_block_is_the_block_shown() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(2.0)
    assert bench.shot.block_text.startswith("G01Z-2")
    assert bench.shot.next_block_text.startswith("X1")
    bench.until_true(lambda shot: shot.line == 5)
    assert bench.peer.motion.position[1] == pytest.approx(-50.8, abs=2.0)


def test_amount_of_queued_motion_is_limited() -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.run(1.0)
    ahead = []
    for _ in range(100):
        bench.tick()
        ahead.append(sum(block.length_mm for block in bench.peer.motion.block_queue))
    # Pieces of .2 s: the one under way, and .4 s rounded up to whole pieces; 12.7 mm/s.
    assert max(ahead) <= 12.7 * (0.2 + 0.6) + 0.1
    assert min(ahead) > 12.7 * 0.2


def test_many_short_blocks_neither_starve_nor_overflow() -> None:
    bench = GrblBench()
    steps = "".join(f"X{0.5 + 0.0001 * (i % 2):.4f}Z{-0.001 * i:.3f}\n" for i in range(1, 1500))
    bench.start(f"G90G94F300\nX.5Z0\nG01F100\n{steps}M30\n")
    bench.until_true(lambda shot: shot.line > 50)
    slowest = min(_speed_of(bench) for _ in range(60))
    assert slowest > 0.5 * 100 * 25.4 / 60
    bench.until(MachineState.IDLE)
    assert bench.peer.lost_byte_count == 0
    assert bench.peer.motion.position[1] == pytest.approx(-1.499 * 25.4)


def _speed_of(bench: GrblBench) -> float:
    bench.tick()
    return bench.peer.motion.speed


def test_single_block_stops_after_each_block() -> None:
    bench = GrblBench()
    bench.ready()
    bench.post(SetSwitch("single_block", True))
    bench.start("G90G94F300\nX.5Z.2\nG01X.25F60\nX.1\nM30\n")
    places = []
    for _ in range(3):
        bench.until(MachineState.SINGLE_BLOCK_STOP)
        places.append(bench.peer.motion.position)
        bench.run(0.4)
        bench.press()
    assert places[1:] == [pytest.approx((6.35, 5.08)), pytest.approx((2.54, 5.08))] or places[:2] == [
        pytest.approx((12.7, 5.08)),
        pytest.approx((6.35, 5.08)),
    ]


@pytest.mark.parametrize("fraction", [0.83, 0.1, 1.5, 0.37])
def test_override_is_sent_as_reset_and_steps_and_verified(fraction: float) -> None:
    bench = GrblBench()
    bench.start(LONG)
    bench.until_true(lambda shot: shot.line == 4)
    bench.post(SetFeedOverride(fraction))
    bench.run(1.0)
    assert bench.peer.feed_percent == round(100 * fraction)
    assert not bench.shot.alarms


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("M19\nC90", "the C axis"),
        ("M25", "output catcher"),
        ("M13\nM12", "output collet"),
        ("M91", "input TB2-5"),
    ],
)
def test_unsupported_function_is_refused_before_the_start(text: str, expected: str) -> None:
    bench = GrblBench(
        grbl_machine(("enabled = false\nvmax", "enabled = true\nvmax")),
        quirky(encoder=False, outputs=0, inputs=0),
    )
    bench.start(f"G90G94F300\nX.5Z.2\n{text}\nM30\n")
    assert bench.state is MachineState.IDLE
    assert expected in bench.shot.start_refusal_reason
    assert bench.wire.lines() == []


def test_feed_per_rev_is_sent_as_feed_at_the_commanded_speed() -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nM03S600\nX.5\nG01G95F.005X.45\nM30\n")
    bench.until(MachineState.IDLE)
    # .005 in a turn at 600 rpm are 3 in/min, 76.2 mm/min
    assert all(line.endswith("F76.2") for line in bench.wire.lines() if "G1" in line)


def test_a_thread_with_a_pull_out_is_refused_before_the_start() -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nM03S600\nX.5Z.2\nX.25\nG33X.2Z-.5I.025K.05P\nG00Z1\nM30\n")
    assert bench.state is MachineState.IDLE
    assert "pull-out" in bench.shot.start_refusal_reason


def test_outputs_are_switched_and_inputs_are_awaited() -> None:
    bench = GrblBench()
    bench.start("G90G94F300\nX.5Z.2\nM25\nM92\nM26\nM30\n")
    bench.until(MachineState.WAIT)
    bench.run(1.0)
    assert bench.state is MachineState.WAIT
    assert bench.peer.output_states["out.1"]
    bench.peer.auxiliary_inputs[4] = True
    bench.until(MachineState.IDLE, limit=3.0)
    assert not bench.peer.output_states["out.1"]
    assert bench.shot.parts == 1

"""The simulator's planner: it comes down for what lies ahead, as a controller with ``$11`` does."""

from __future__ import annotations

import math

import pytest

from drivers.simulators.grblhal_firmware import GrblFirmware
from drivers.simulators.grblhal_motion import GrblMotion, PlannedBlock, Position, make_line_path
from drivers.simulators.grblhal_settings import SettingRegisters, SimulatorBehavior
from drivers.wakeups import ManualClock

STEP = 0.001
ACCEL = 3000.0  # $120 and $122 of the simulator, mm/s²
SPEED = 100.0  # mm/s


def way(*places: Position, speed: float = SPEED, registers: SettingRegisters | None = None) -> GrblMotion:
    """Slides that are to go through these places from (0, 0)."""
    slides = GrblMotion(registers or SettingRegisters(SimulatorBehavior()), 100)
    for start, end in zip(((0.0, 0.0), *places), places, strict=False):
        length, shape = make_line_path(start, end)
        slides.block_queue.append(PlannedBlock(0, length, speed, shape))
    return slides


def run(slides: GrblMotion) -> list[tuple[Position, float]]:
    """Place and speed after each step, to the end."""
    seen = []
    while slides.block_queue:
        slides.advance(STEP, 0.0)
        seen.append((slides.position, slides.speed))
    return seen


def test_axis_stops_at_a_reversal() -> None:
    seen = run(way((0.0, 20.0), (0.0, 0.0)))
    fastest_near_the_end = max(v for (_, z), v in seen if z > 19.9)
    assert fastest_near_the_end <= math.sqrt(2.0 * ACCEL * 0.1) + 2.0 * ACCEL * STEP
    # Each leg from rest to rest: length / speed + speed / acceleration.
    assert len(seen) * STEP == pytest.approx(2 * (20.0 / SPEED + SPEED / ACCEL), rel=0.02)


def test_collinear_blocks_are_joined_without_slowing_down() -> None:
    whole, pieces = run(way((0.0, 20.0))), run(way((0.0, 7.0), (0.0, 13.0), (0.0, 20.0)))
    assert len(whole) == len(pieces)


def test_right_angle_corner_is_limited_by_the_junction_deviation() -> None:
    seen = run(way((0.0, 20.0), (20.0, 20.0)))
    # Grbl's junction: v² = a · δ · sin(θ/2) / (1 − sin(θ/2)), δ = .01 mm, θ = 90°; a is what both slides
    # together have along the change of direction, √2 of one of them: 10.2 mm/s.
    half = math.sqrt(0.5)
    corner = math.sqrt(math.sqrt(2.0) * ACCEL * 0.01 * half / (1.0 - half))
    near = [v for (x, z), v in seen if z > 19.99 and x < 0.01]
    assert near
    assert max(near) <= corner + 2.0 * ACCEL * STEP


def test_each_axis_has_its_own_speed_limit() -> None:
    """Along Z as Z may, along X as X may, at 45 degrees √2 of the slower."""
    registers = SettingRegisters(SimulatorBehavior(settings={112: 9000.0}))  # Z 150 mm/s, X 127

    def top(corner: Position) -> float:
        return max(v for _, v in run(way(corner, speed=1e9, registers=registers)))

    assert top((0.0, 40.0)) == pytest.approx(150.0, abs=0.1)
    assert top((40.0, 0.0)) == pytest.approx(127.0, abs=0.1)
    assert top((40.0, 40.0)) == pytest.approx(127.0 * math.sqrt(2.0), abs=0.1)


def test_slower_block_starts_at_its_own_speed() -> None:
    slides = way((0.0, 20.0))
    length, shape = make_line_path((0.0, 20.0), (0.0, 30.0))
    slides.block_queue.append(PlannedBlock(0, length, 5.0, shape))
    seen = run(slides)
    assert max(v for (_, z), v in seen if z > 20.0) <= 5.0 + 2.0 * ACCEL * STEP
    assert max(v for (_, z), v in seen if z > 20.5) <= 5.0 + 1e-6


# From standstill in 0.08 s + 1000 / 1500 s, then 1000 rpm up to 2 s.
TURNS = 1000.0 / 60.0 * (0.5 * 1000.0 / 1500.0 + 2.0 - 0.08 - 1000.0 / 1500.0)


@pytest.mark.parametrize("tick", [0.002, 0.5])
@pytest.mark.parametrize(
    ("lines", "place", "turns"),
    [
        (b"G18G94\nM3S1000\n", (0.0, 0.0), TURNS),
        (b"G18G94\nG1X3Z-2F600\nG2X5Z-4I2K0\n", (5.0, -4.0), 0.0),
        (b"$J=G91Z5F300\n", (0.0, 5.0), 0.0),
        (b"G94\nG4P0.3\nG1Z1F100\n", (0.0, 1.0), 0.0),
    ],
    ids=["spindle", "arc", "jog", "dwell"],
)
def test_idle_controller_executes_lines_regardless_of_polling_interval(
    lines: bytes, place: Position, turns: float, tick: float
) -> None:
    clock = ManualClock()
    firmware = GrblFirmware(clock, SimulatorBehavior())
    clock.sleep_until(2.0)
    firmware.receive_bytes(lines)
    while clock.now() < 4.0 - 1e-9:
        clock.advance(tick)
        firmware.advance()
    assert firmware.motion.position == pytest.approx(place, abs=1e-9)
    assert firmware.spindle.revolutions == pytest.approx(turns, abs=1e-3)
    assert firmware.pop_output() == b"ok\r\n" * lines.count(b"\n")

"""What planning costs and how near its time is to the ideal: ``python -m tests.benchmarks.bench_planner``.

Half a circle of R 50 mm in 0.02 mm chords at 100 mm/s, no tolerance spent, and the same circle run through
many times; then with words rounded to a step, as programs have them. Ideal is the way at full feed with one
slide's ramp up and down; on a slant both slides ramp together, so that a path may end a little faster.
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Callable

from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits
from core.motion.motion_plan import plan_motion
from core.motion.window_planner import WindowPlanner
from tests.motion.moves import chords, rounded_chords
from tests.motion.paths import build_path

RADIUS, CHORD, FEED, PAIRS = 50.0, 0.02, 100.0, 7
LIMITS = MotionLimits()
STEPPED = MotionLimits(grain=0.00127)
GRIDS = (0.001, 0.00127, 0.00254, 0.005)  # mm; the second and third are .00005 and .0001 in


def median_ms(work: Callable[[], object], times: int) -> float:
    """Median cpu time of ``work``, ms."""
    taken = []
    for _ in range(times):
        begin = time.process_time()
        work()
        taken.append(time.process_time() - begin)
    return 1000.0 * statistics.median(taken)


def row(count: int, times: int) -> str:
    """One line of the table: pieces, planned and ideal time, and what building and planning cost."""
    angle = count * CHORD / RADIUS
    blocks = chords(RADIUS, angle, count, FEED)
    path = build_path(blocks, LIMITS)
    planned = plan_motion(path).duration_s
    ideal = path.length / FEED + FEED / LIMITS.max_plane_acceleration
    building = median_ms(lambda: build_path(blocks, LIMITS), max(times // 2, 1))
    planning = median_ms(lambda: plan_motion(path), times)
    windows = median_ms(lambda: _in_windows(blocks), 1)
    return (
        f"{count:>9} {planned:>11.4f} {ideal:>11.4f} {planned / ideal:>8.5f}"
        f" {planning:>9.1f} {building:>9.1f} {windows:>11.1f}\n"
    )


def rounded(grid: float) -> str:
    """One line of the second table: with words as written, and with joints moved by the machine's step."""
    blocks = rounded_chords(round(math.pi * RADIUS / CHORD), FEED, grid)
    ideal = math.pi * RADIUS / FEED + FEED / LIMITS.max_plane_acceleration
    written, moved = (plan_motion(build_path(blocks, limits)).duration_s for limits in (LIMITS, STEPPED))
    building = median_ms(lambda: build_path(blocks, STEPPED), PAIRS)
    return f"{grid:>9} {written / ideal:>11.4f} {moved / ideal:>11.4f} {building:>9.1f}\n"


def _in_windows(blocks: list[Block]) -> None:
    planner = WindowPlanner(LIMITS)
    for _ in planner.plan_blocks(blocks):
        pass
    for _ in planner.finish_section():
        pass


def main() -> None:
    """Print the tables."""
    sys.stdout.write("   pieces   planned s     ideal s    ratio   plan ms  build ms  windows ms\n")
    for count, times in ((round(math.pi * RADIUS / CHORD), PAIRS), (100_000, PAIRS), (1_000_000, 3)):
        sys.stdout.write(row(count, times))
    sys.stdout.write("grid, mm  as written       moved  build ms\n")
    for grid in GRIDS:
        sys.stdout.write(rounded(grid))


if __name__ == "__main__":
    main()

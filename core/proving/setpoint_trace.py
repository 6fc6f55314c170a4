"""Setpoints of a program at equal time intervals, as the drives would receive them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from core.geometry.surface_speed import find_surface_rpm
from core.interpreter.shared.elementary_blocks import Block, FloatArray, IntArray, StraightMoveSeries
from core.motion.window_planner import sample_positions
from core.proving.program_timeline import BlockGroup, MotionSpan, RestSpan, Timeline

REST_BATCH_ROWS = 10_000  # rows yielded together while the machine rests


class SetpointRows(NamedTuple):
    """Table of k rows of setpoints.

    ``times_s`` (k,) are in seconds. ``positions`` (k, axes) are machine positions in the machine's axis
    order, in mm (X of a lathe as a radius) or degrees. ``spindle_angles_deg`` is the continuous spindle
    angle in degrees from the start, and ``line_numbers`` are the source lines.
    """

    times_s: FloatArray
    positions: FloatArray
    spindle_angles_deg: FloatArray
    line_numbers: IntArray


def iter_setpoints(timeline: Timeline, interval_s: float) -> Iterator[SetpointRows]:
    """Yield rows every ``interval_s`` seconds, from time 0 to the first row after the end of the program."""
    sampler = _SpanSampler(timeline, interval_s)
    for span in timeline.iter_spans():
        if isinstance(span, MotionSpan):
            yield sampler.sample_motion(span)
        else:
            yield from sampler.sample_rest(span)
    yield sampler.make_standstill_rows(1)


class _SpanSampler:
    """A sampler of the spans of a timeline at equal intervals."""

    def __init__(self, timeline: Timeline, dt: float) -> None:
        self._spindle = timeline.spindle
        self._dt = dt
        self._row = 0  # number of the next row; its time is row times dt, so that errors do not accumulate
        self._at: tuple[float, ...] = timeline.start_position
        self._line = 0
        self._angle = 0.0
        self._rpm = 0.0  # rpm of the last row

    def sample_motion(self, span: MotionSpan) -> SetpointRows:
        """Return the setpoints of a motion span as rows with equal time steps."""
        profile = span.planned_chunk.profile
        _, positions, numbers = sample_positions(
            profile, self._dt, max(0.0, self._row * self._dt - span.start_time_s)
        )
        owners = np.searchsorted(span.planned_chunk.block_numbers, numbers)
        lines = np.concatenate([np.empty(0, np.int64), *map(_lines, span.block_groups)])[owners]
        led = _radius_following_blocks(span.block_groups)
        by_radius = {row: led[n] for row, n in enumerate(numbers.tolist()) if n in led} if led else {}
        self._line = int(lines[-1]) if len(lines) else self._line
        self._at = tuple(profile.compute_positions(profile.duration_s)[0].tolist())
        return self._rows(positions, lines, by_radius)

    def sample_rest(self, span: RestSpan) -> Iterator[SetpointRows]:
        """Yield the rows of a span at rest."""
        if span.block is not None:
            self._line = span.block.line
        count = max(0, math.ceil((span.end_time_s - self._row * self._dt) / self._dt - 1e-9))
        for done in range(0, count, REST_BATCH_ROWS):
            yield self.make_standstill_rows(min(REST_BATCH_ROWS, count - done), span.block)

    def make_standstill_rows(self, count: int, block: Block | None = None) -> SetpointRows:
        """Return ``count`` rows without motion."""
        by_radius = dict.fromkeys(range(count), block) if block is not None and _follows_radius(block) else {}
        return self._rows(np.tile(self._at, (count, 1)), np.full(count, self._line), by_radius)

    def _rows(self, at: FloatArray, lines: IntArray, by_radius: Mapping[int, Block]) -> SetpointRows:
        t: FloatArray = self._dt * np.arange(self._row, self._row + len(at), dtype=np.float64)
        turned = self._turned(self._speeds(t, at[:, 0], by_radius))
        self._row += len(at)
        return SetpointRows(t, at, turned, lines)

    def _turned(self, speeds: FloatArray) -> FloatArray:
        """Return the accumulated spindle angle in degrees at the end of each interval.

        Within an interval, the mean of the speeds at both ends is used.
        """
        before = np.concatenate([[self._rpm], speeds])
        steps = (before[:-1] + speeds) / 2 * self._dt * 6  # 1 rpm is 6 degrees/s
        if not self._row:
            steps[:1] = 0.0
        angles = np.cumsum(np.concatenate([[self._angle], steps]))
        self._angle, self._rpm = float(angles[-1]), float(before[-1])
        return angles[1:]

    def _speeds(self, t: FloatArray, machine_x: FloatArray, by_radius: Mapping[int, Block]) -> FloatArray:
        """Return the signed spindle speeds in rpm at the times of the rows.

        ``by_radius`` contains the blocks with constant surface speed, by row. The spindle forecast of the
        timeline is not changed, because the waits of the timeline must not depend on the sampling.
        """
        speeds = self._spindle.calculate_speeds_at(t)
        for row, block in by_radius.items():
            before = float(speeds[row - 1]) if row else self._rpm
            wanted = self._by_radius(block, float(machine_x[row]))
            speeds[row] = self._spindle.calculate_ramp_speed(before, wanted, self._dt)
        return speeds

    def _by_radius(self, block: Block, machine_x: float) -> float:
        """Return the signed rpm that the surface speed of the block requires at the current position."""
        modal, most = block.modal, self._spindle.max_rpm
        rpm = find_surface_rpm(
            block.css or 0.0, machine_x - block.offset_x, modal.min_css_rpm, modal.max_css_rpm or most
        )
        return math.copysign(rpm, modal.spindle)


def _lines(part: BlockGroup) -> IntArray:
    return (
        part.line
        if isinstance(part, StraightMoveSeries)
        else np.array([block.line for block in part], np.int64)
    )


def _follows_radius(block: Block) -> bool:
    """Return whether the spindle speed follows the radius in a block."""
    return block.css is not None and bool(block.modal.spindle)


def _radius_following_blocks(parts: tuple[BlockGroup, ...]) -> dict[int, Block]:
    """Return the blocks in which the spindle speed follows the radius, by block number.

    Series contain no such blocks.
    """
    alone = (block for part in parts if not isinstance(part, StraightMoveSeries) for block in part)
    return {block.n: block for block in alone if _follows_radius(block)}

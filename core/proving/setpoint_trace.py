"""The setpoints of a program, one row a sampling interval: what the drives would get."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from core.geometry.surface_speed import surface_rpm
from core.interpreter.elementary_blocks import Block
from core.motion.window_planner import sample_positions
from core.proving.program_timeline import MotionSpan, RestSpan, Timeline

Row = tuple[float, tuple[float, ...], float, int]  # t, all axes, spindle degrees, line

BATCH = 10_000  # rows handed out at a time while the machine rests


def setpoints(timeline: Timeline, dt: float) -> Iterator[list[Row]]:
    """Rows every ``dt`` seconds from 0 to the first one at which the program has ended.

    Machine coordinates in the machine's order, mm (X of a lathe a radius), degrees; the spindle angle counts
    on from the start.
    """
    sampler = _Sampler(timeline, dt)
    for span in timeline.spans():
        if isinstance(span, MotionSpan):
            yield sampler.moved(span)
        else:
            yield from sampler.rested(span)
    yield sampler.last()


class _Sampler:
    """Walks the grid of sampling times along the spans of a timeline."""

    def __init__(self, timeline: Timeline, dt: float) -> None:
        self._timeline = timeline
        self._dt = dt
        self._row = 0  # number of the next row; its time is row times dt, so that no error adds up
        self._at: tuple[float, ...] = timeline.start
        self._line = 0
        self._angle = 0.0
        self._rpm = 0.0  # at the last row

    def moved(self, span: MotionSpan) -> list[Row]:
        _, positions, numbers = sample_positions(
            span.chunk.profile, self._dt, max(0.0, self._row * self._dt - span.t0)
        )
        blocks = span.blocks
        owners = np.searchsorted([block.n for block in blocks], numbers).tolist()
        rows = []
        for at, owner in zip(positions.tolist(), owners, strict=True):
            block = blocks[owner]
            self._line = block.line
            rows.append(self._emit(tuple(at), block))
        profile = span.chunk.profile
        self._at = tuple(profile.position(profile.duration)[0].tolist())
        return rows

    def rested(self, span: RestSpan) -> Iterator[list[Row]]:
        if span.block is not None:
            self._line = span.block.line
        count = max(0, math.ceil((span.t1 - self._row * self._dt) / self._dt - 1e-9))
        for done in range(0, count, BATCH):
            yield [self._emit(self._at, span.block) for _ in range(min(BATCH, count - done))]

    def last(self) -> list[Row]:
        """The row at rest with which the table ends."""
        return [self._emit(self._at, None)]

    def _emit(self, at: tuple[float, ...], block: Block | None) -> Row:
        t = self._row * self._dt
        self._turn(t, at[0], block)
        self._row += 1
        return (t, at, self._angle, self._line)

    def _turn(self, t: float, machine_x: float, block: Block | None) -> None:
        """Turn the spindle on by one interval: the mean of the speeds at its two ends.

        The timeline's forecast is only asked: what it waits for must not depend on who looks.
        """
        spindle = self._timeline.spindle
        speed = spindle.speed(t)
        if block is not None and block.css is not None and block.modal.spindle:
            modal = block.modal
            rpm = surface_rpm(
                block.css, machine_x - block.offset_x, modal.css_min, modal.css_max or spindle.rpm_max
            )
            speed = spindle.towards(self._rpm, math.copysign(rpm, modal.spindle), self._dt)
        if self._row:
            self._angle += (self._rpm + speed) / 2 * self._dt * 6  # 1 rpm is 6 degrees a second
        self._rpm = speed

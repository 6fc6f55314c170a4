"""How many lines from here on are moves that can be made at once: a stretch of them, or passes of a loop."""

from __future__ import annotations

import numpy as np

from core.interpreter.columns import Columns, columns_of
from core.interpreter.flow import Flow
from core.interpreter.gather import series, unchanged
from core.interpreter.program import Program
from core.interpreter.series import Series
from core.interpreter.state import State
from core.interpreter.steps import MOST, LongSteps

LEAST = 48
"""Moves for which a series pays; fewer are made one by one."""


class Ahead:
    """Looks from the place in a program ahead, and takes what can be taken at once."""

    def __init__(self, state: State, program: Program, flow: Flow) -> None:
        self._state, self._flow = state, flow
        self._steps, self._texts = program.steps, program.source.lines
        self._loops = program.structure.loop_ends
        self._bodies: dict[int, Columns | None] = {}
        self._looked = -1  # index of a line from which on there was no series

    def take(self, lines: int, blocks: int) -> tuple[Series, int] | None:
        """The moves that come next and how many lines they have executed; None where they do not pay.

        ``lines`` and ``blocks`` are how many may yet be executed and made. ``state.fast`` must hold.
        """
        at = self._flow.at
        if self._looked <= at < self._looked + LEAST:
            return None
        taken = self._passes(at, lines, blocks) if at - 1 in self._loops else self._stretch(at, lines, blocks)
        if taken is None:
            self._looked = at
        return taken

    def _stretch(self, at: int, lines: int, blocks: int) -> tuple[Series, int] | None:
        """Lines one after the other."""
        if not isinstance(self._steps, LongSteps):
            return None
        end = min(self._steps.moves_until(at), self._flow.end, at + min(MOST, lines, blocks))
        columns = self._steps.columns
        if end - at < LEAST or not unchanged(self._state, columns.part(slice(at, at + LEAST))).all():
            return None
        part = columns.part(slice(at, end))
        other = np.flatnonzero(~unchanged(self._state, part))
        count = int(other[0]) if len(other) else end - at
        self._flow.at = at + count
        numbers = np.arange(at + 1, at + 1 + count)
        return series(self._state, part.part(slice(0, count)), numbers, self._texts), count

    def _passes(self, at: int, lines: int, blocks: int) -> tuple[Series, int] | None:
        """All of a loop but the last pass, as often as there is room."""
        length = self._loops[at - 1] - at
        if not length or self._flow.end <= at + length:
            return None
        left = self._flow.passes_left(at - 1)
        times = min(left, lines // (length + 1), (blocks - 1) // length, MOST // length)
        if times * length < LEAST:
            return None
        body = self._body(at, at + length)
        if body is None or not unchanged(self._state, body).all():
            return None
        index = np.tile(np.arange(length), times)
        self._flow.passed(times)
        made = series(self._state, body.part(index), at + 1 + index, self._texts)
        return made, times * (length + 1)

    def _body(self, at: int, end: int) -> Columns | None:
        """The lines of a loop, None where one of them is no plain move."""
        if at not in self._bodies:
            steps, body = self._steps, None
            if isinstance(steps, LongSteps):
                body = steps.columns.part(slice(at, end)) if steps.moves_until(at) >= end else None
            elif all(isinstance(step, tuple) for step in steps[at:end]):
                body = columns_of(steps[at:end])
            self._bodies[at] = body
        return self._bodies[at]

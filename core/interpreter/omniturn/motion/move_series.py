"""Series of straight moves from many lines: consecutive lines, or passes of a loop.

All rules are in other modules: ``in_force`` determines which words change nothing, the end points are those
of ``line_to``, and warnings are logged by the functions for single lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import numpy as np

from core.interpreter.omniturn.flow.loops_and_subroutines import Flow
from core.interpreter.omniturn.motion.feeds import SLOW_MOVE, check_move, is_free, set_feed, speed_of
from core.interpreter.omniturn.motion.plain_moves import MOST, NO_CODE, Bools, Columns, Floats, Ints
from core.interpreter.omniturn.motion.straight_moves import WHOLE, in_force, rounded, step_of
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.shared.elementary_blocks import Block, Series, with_feed


def unchanged(state: State, lines: Columns) -> Bools:
    """Return a mask (m,) of the lines with only X, Z and words that are already active."""
    answer = lines.known.copy()
    fed = ~np.isnan(lines.f)
    for g in (0, 1, NO_CODE):
        coded = lines.g == g
        if g != NO_CODE and not in_force(state, g, None):
            answer &= ~coded | fed
        for f in set(lines.f[coded & fed].tolist()):  # np.unique would first import masked arrays.
            if not in_force(state, g, f):
                answer &= ~coded | (lines.f != f)
    return answer


def plain(state: State, lines: Columns) -> Bools:
    """Return a mask (m,) of the lines that can be part of a series.

    These are the ``unchanged`` lines, and lines that only change the cutting feed to one that needs no check.
    """
    answer = unchanged(state, lines)
    if state.steady_feed is None:
        return answer
    fed = lines.known & ~answer & ~np.isnan(lines.f) & (lines.g != 0)
    for f in set(lines.f[fed].tolist()):
        if is_free(state, state.feed_word(f)):
            answer |= fed & (lines.f == f)
    return answer


def _feeds(state: State, lines: Columns) -> Floats | None:
    """Return the feed (m,) of each line in mm/s or mm/rev; None if no line changes the feed."""
    fed = ~np.isnan(lines.f)
    feeds = np.where(fed, state.feed_word(lines.f), state.feed)
    if (feeds == state.feed).all():
        return None
    last = np.maximum.accumulate(np.where(fed, np.arange(len(fed)), -1))
    return np.where(last < 0, state.feed, feeds[last])


def series(state: State, lines: Columns, line: Ints, texts: Sequence[str]) -> Series:
    """Return these lines as a series of moves; ``line`` (m,) are their numbers.

    All lines must be ``plain``. Requires ``state.fast``: a move with this state must have passed all checks.
    """
    x, x_finer = _on_step(state, "X", lines.x, lines.fine)
    z, z_finer = _on_step(state, "Z", lines.z, lines.fine)
    px, pz = _along(state, x, state.px, state.scale_x), _along(state, z, state.pz, state.scale_z)
    x1, z1 = px + state.dx, pz + state.dz
    x0, z0 = np.concatenate([[state.x], x1[:-1]]), np.concatenate([[state.z], z1[:-1]])
    n = np.arange(state.blocks + 1, state.blocks + 1 + len(line))
    feed = _feeds(state, lines)
    first = Block(
        int(n[0]), int(line[0]), state.kind, texts[line[0] - 1], state.x, state.z, state.c,
        float(x1[0]), float(z1[0]), state.c, state.offset_x, state.offset_z,
        state.modal, state.feed, state.per_rev, state.rpm,
    )  # fmt: skip
    if feed is not None:
        first = replace(first, modal=with_feed(state.modal, float(feed[0])), feed=float(feed[0]))
    made = Series(first, texts, n, line, x0=x0, z0=z0, x=x1, z=z1, feed=feed)
    _tell(state, made, lines, x_finer | z_finer)
    state.px, state.pz, state.x, state.z = float(px[-1]), float(pz[-1]), float(x1[-1]), float(z1[-1])
    state.blocks += len(line)
    if feed is not None:
        set_feed(state, float(feed[-1]))
    return made


def _along(state: State, word: Floats, at: float, scale: float) -> Floats:
    """Return the positions in mm after each word (NaN for none) from position ``at``, by G90 or G91."""
    named = ~np.isnan(word)
    if not state.absolute:
        ways = np.where(named, word, 0.0) + 0.0  # -0 as 0
        way: Floats = np.add.accumulate(np.concatenate([[at], ways * scale]))[1:]
        return way
    if named.all():
        return word * scale
    last = np.maximum.accumulate(np.where(named, np.arange(len(word)), -1))
    return np.where(last < 0, at, word[last] * scale)


def _on_step(state: State, letter: str, word: Floats, fine: Bools) -> tuple[Floats, Bools]:
    """Return the numbers rounded to the control's resolution, and a mask of the numbers that were finer.

    The rounding is that of ``straight_moves.rounded``.
    """
    if not fine.any():
        return word, fine
    step = step_of(state, letter)
    count = word / step
    whole = np.copysign(np.floor(np.abs(count) + 0.5 + WHOLE), count)
    finer = fine & (np.abs(count - whole) > np.maximum(WHOLE, np.abs(count) * 1e-12))
    return np.where(finer, whole * step, word), finer


def _tell(state: State, made: Series, lines: Columns, finer: Bools) -> None:
    """Log warnings for rounded words and slow moves, line by line, until the log is full."""
    dx, dz = made.x - made.x0, made.z - made.z0
    slow_length = state.slow_length if made.feed is None else speed_of(state, made.feed) * SLOW_MOVE
    slow = (np.abs(dx) + np.abs(dz) > slow_length) & state.cut
    for at in np.flatnonzero(finer | slow).tolist():
        if state.log.silent:
            return
        line = int(made.line[at])
        if finer[at]:
            x, z = (None if np.isnan(word) else float(word) for word in (lines.x[at], lines.z[at]))
            rounded(state, line, made.texts[line - 1], x, z)
        if slow[at]:
            if made.feed is not None:
                set_feed(state, float(made.feed[at]))
            check_move(state, line, float(made.x0[at]), float(made.x[at]), hypot(dx[at], dz[at]))


LEAST = 48
"""Moves for which a series pays; fewer are made one by one."""


class SeriesLookAhead:
    """Look-ahead that combines the next moves of a program in one series."""

    def __init__(self, state: State, program: Program, flow: Flow) -> None:
        self._state, self._flow = state, flow
        self._ready, self._texts = program.ready, program.source.lines
        self._loops = program.structure.loop_ends
        self._without = range(0)  # indices of lines at which no series starts

    def take(self, lines: int, blocks: int) -> tuple[Series, int] | None:
        """Return the next moves and the number of executed lines; None if a series is not worthwhile.

        ``lines`` and ``blocks`` are the remaining limits. Requires ``state.fast``.
        """
        at = self._flow.at
        if at in self._without:
            return None
        # This range changes if a series or another kind of line is found.
        self._without = range(at, at + LEAST)
        return (
            self._passes(at, lines, blocks) if at - 1 in self._loops else self._consecutive(at, lines, blocks)
        )

    def _consecutive(self, at: int, lines: int, blocks: int) -> tuple[Series, int] | None:
        """Return the series of consecutive lines, or None."""
        end = min(self._ready.moves_until(at), self._flow.end, at + min(MOST, lines, blocks))
        columns = self._ready.columns
        if end - at < LEAST:
            self._without = range(at, end + 1)
            return None
        if not plain(self._state, columns.part(slice(at, at + LEAST))).all():
            return None
        part = columns.part(slice(at, end))
        other = np.flatnonzero(~plain(self._state, part))
        count = int(other[0]) if len(other) else end - at
        self._flow.at, self._without = at + count, range(0)
        numbers = np.arange(at + 1, at + 1 + count)
        return series(self._state, part.part(slice(0, count)), numbers, self._texts), count

    def _passes(self, at: int, lines: int, blocks: int) -> tuple[Series, int] | None:
        """Return the series of all passes of a loop except the last one, within the limits, or None."""
        length = self._loops[at - 1] - at
        if not length or self._flow.end <= at + length:
            return None
        left = self._flow.passes_left(at - 1)
        times = min(left, lines // (length + 1), (blocks - 1) // length, MOST // length)
        if times * length < LEAST:
            return None
        body = self._ready.columns.part(slice(at, at + length))
        if not plain(self._state, body).all():
            return None
        index = np.tile(np.arange(length), times)
        self._flow.passed(at - 1, times)
        self._without = range(0)
        made = series(self._state, body.part(index), at + 1 + index, self._texts)
        return made, times * (length + 1)

"""Conversion of consecutive lines, or of the passes of a loop, to a series of straight moves.

All rules are in other modules. ``are_words_already_active`` determines which words do not change anything.
The end points agree with those of ``make_straight_move``. The functions for single lines log the warnings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import numpy as np

from core.interpreter.omniturn.flow.loops_and_subroutines import Flow
from core.interpreter.omniturn.motion.feeds import (
    SLOW_MOVE_TIME_S,
    check_move_feed,
    compute_feed_speed,
    is_feed_accepted,
    set_series_feed,
)
from core.interpreter.omniturn.motion.plain_moves import (
    MAX_RUN_LENGTH,
    NO_G_CODE,
    BoolArray,
    FloatArray,
    IntArray,
    LineColumns,
)
from core.interpreter.omniturn.motion.straight_moves import (
    ROUNDING_TOLERANCE,
    are_words_already_active,
    get_resolution,
    round_coordinates,
)
from core.interpreter.omniturn.omniturn_program import Program
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.shared.elementary_blocks import Block, StraightMoveSeries, replace_feed


def find_unchanged_lines(state: State, lines: LineColumns) -> BoolArray:
    """Return a mask, shape (m,), of the lines that contain only X, Z and already active words."""
    answer = lines.is_plain_move.copy()
    fed = ~np.isnan(lines.feeds)
    for g in (0, 1, NO_G_CODE):
        coded = lines.g_codes == g
        if g != NO_G_CODE and not are_words_already_active(state, g, None):
            answer &= ~coded | fed
        for f in set(lines.feeds[coded & fed].tolist()):  # np.unique would first import masked arrays.
            if not are_words_already_active(state, g, f):
                answer &= ~coded | (lines.feeds != f)
    return answer


def find_series_lines(state: State, lines: LineColumns) -> BoolArray:
    """Return a mask, shape (m,), of the lines that can be part of a series.

    These are the lines of ``find_unchanged_lines``, and lines that change only the cutting feed to a feed
    that needs no check.
    """
    answer = find_unchanged_lines(state, lines)
    if state.steady_feed is None:
        return answer
    fed = lines.is_plain_move & ~answer & ~np.isnan(lines.feeds) & (lines.g_codes != 0)
    for f in set(lines.feeds[fed].tolist()):
        if is_feed_accepted(state, state.convert_feed(f)):
            answer |= fed & (lines.feeds == f)
    return answer


def _feeds(state: State, lines: LineColumns) -> FloatArray | None:
    """Return the feeds of the lines in mm/s or mm/rev, shape (m,), or None if the feed is constant."""
    fed = ~np.isnan(lines.feeds)
    feeds = np.where(fed, state.convert_feed(lines.feeds), state.feed)
    if (feeds == state.feed).all():
        return None
    last = np.maximum.accumulate(np.where(fed, np.arange(len(fed)), -1))
    return np.where(last < 0, state.feed, feeds[last])


def make_move_series(
    state: State, lines: LineColumns, line_numbers: IntArray, texts: Sequence[str]
) -> StraightMoveSeries:
    """Return these lines as a series of moves.

    ``line_numbers`` (m,) are the numbers of the lines. All lines must be in ``find_series_lines``. Requires
    ``state.fast``, which means that a move with this state has passed all checks.
    """
    x, x_finer = _round_to_resolution(state, "X", lines.x, lines.has_fifth_decimal)
    z, z_finer = _round_to_resolution(state, "Z", lines.z, lines.has_fifth_decimal)
    px, pz = (
        _compute_positions(state, x, state.px, state.mm_per_x_unit),
        _compute_positions(state, z, state.pz, state.mm_per_z_unit),
    )
    x1, z1 = px + state.secondary_x, pz + state.secondary_z
    x0, z0 = np.concatenate([[state.x], x1[:-1]]), np.concatenate([[state.z], z1[:-1]])
    n = np.arange(state.blocks + 1, state.blocks + 1 + len(line_numbers))
    feed = _feeds(state, lines)
    first = Block(
        int(n[0]), int(line_numbers[0]), state.kind, texts[line_numbers[0] - 1], state.x, state.z, state.c,
        float(x1[0]), float(z1[0]), state.c, state.offset_x, state.offset_z,
        state.modal, state.feed, state.per_rev, state.rpm,
    )  # fmt: skip
    if feed is not None:
        first = replace(first, modal=replace_feed(state.modal, float(feed[0])), feed=float(feed[0]))
    made = StraightMoveSeries(first, texts, n, line_numbers, x0=x0, z0=z0, x=x1, z=z1, feed=feed)
    _tell(state, made, lines, x_finer | z_finer)
    state.px, state.pz, state.x, state.z = float(px[-1]), float(pz[-1]), float(x1[-1]), float(z1[-1])
    state.blocks += len(line_numbers)
    if feed is not None:
        set_series_feed(state, float(feed[-1]))
    return made


def _compute_positions(state: State, word: FloatArray, at: float, scale: float) -> FloatArray:
    """Return the positions in mm after each word, starting at the position ``at``, under G90 or G91.

    ``word`` is NaN for lines without the word.
    """
    named = ~np.isnan(word)
    if not state.absolute:
        increments = np.where(named, word, 0.0) + 0.0  # -0 as 0
        positions: FloatArray = np.add.accumulate(np.concatenate([[at], increments * scale]))[1:]
        return positions
    if named.all():
        return word * scale
    last = np.maximum.accumulate(np.where(named, np.arange(len(word)), -1))
    return np.where(last < 0, at, word[last] * scale)


def _round_to_resolution(
    state: State, letter: str, word: FloatArray, fine: BoolArray
) -> tuple[FloatArray, BoolArray]:
    """Return the numbers rounded to the control's resolution, and a mask of the numbers that changed.

    The result agrees with ``straight_moves.round_coordinates``.
    """
    if not fine.any():
        return word, fine
    step = get_resolution(state, letter)
    count = word / step
    whole = np.copysign(np.floor(np.abs(count) + 0.5 + ROUNDING_TOLERANCE), count)
    finer = fine & (np.abs(count - whole) > np.maximum(ROUNDING_TOLERANCE, np.abs(count) * 1e-12))
    return np.where(finer, whole * step, word), finer


def _tell(state: State, series: StraightMoveSeries, lines: LineColumns, finer: BoolArray) -> None:
    """Log warnings for rounded words and slow moves, line by line, until the log is full."""
    dx, dz = series.x - series.x0, series.z - series.z0
    slow_length = (
        state.slow_length_mm
        if series.feed is None
        else compute_feed_speed(state, series.feed) * SLOW_MOVE_TIME_S
    )
    slow = (np.abs(dx) + np.abs(dz) > slow_length) & state.cut
    for at in np.flatnonzero(finer | slow).tolist():
        if state.log.is_warning_limit_reached:
            return
        line = int(series.line[at])
        if finer[at]:
            x, z = (None if np.isnan(word) else float(word) for word in (lines.x[at], lines.z[at]))
            round_coordinates(state, line, series.texts[line - 1], x, z)
        if slow[at]:
            if series.feed is not None:
                set_series_feed(state, float(series.feed[at]))
            check_move_feed(state, line, float(series.x0[at]), float(series.x[at]), hypot(dx[at], dz[at]))


MIN_SERIES_LENGTH = 48
"""Minimum number of moves for a move series. Shorter runs are made move by move."""


class SeriesReader:
    """Reader that combines the next straight moves of a program into one series."""

    def __init__(self, state: State, program: Program, flow: Flow) -> None:
        self._state, self._flow = state, flow
        self._ready, self._texts = program.executable_lines, program.source.lines
        self._loops = program.structure.loop_ends
        self._without = range(0)  # indices of lines at which no series starts

    def read_next_series(
        self, max_line_count: int, max_block_count: int
    ) -> tuple[StraightMoveSeries, int] | None:
        """Return the next moves as a series, and the number of executed lines.

        The result is None if there are too few moves for a series. ``max_line_count`` and
        ``max_block_count`` are the remaining lines and blocks up to the limits. Requires ``state.fast``.
        """
        at = self._flow.next_index
        if at in self._without:
            return None
        # This range changes if a series or another kind of line is found.
        self._without = range(at, at + MIN_SERIES_LENGTH)
        return (
            self._passes(at, max_line_count, max_block_count)
            if at - 1 in self._loops
            else self._consecutive(at, max_line_count, max_block_count)
        )

    def _consecutive(
        self, start_index: int, lines: int, blocks: int
    ) -> tuple[StraightMoveSeries, int] | None:
        """Return the series of consecutive lines and its line count, or None if it would be too short."""
        end = min(
            self._ready.find_next_statement(start_index),
            self._flow.end_index,
            start_index + min(MAX_RUN_LENGTH, lines, blocks),
        )
        columns = self._ready.columns
        if end - start_index < MIN_SERIES_LENGTH:
            self._without = range(start_index, end + 1)
            return None
        if not find_series_lines(
            self._state, columns.select_lines(slice(start_index, start_index + MIN_SERIES_LENGTH))
        ).all():
            return None
        part = columns.select_lines(slice(start_index, end))
        other = np.flatnonzero(~find_series_lines(self._state, part))
        count = int(other[0]) if len(other) else end - start_index
        self._flow.next_index, self._without = start_index + count, range(0)
        numbers = np.arange(start_index + 1, start_index + 1 + count)
        return make_move_series(self._state, part.select_lines(slice(0, count)), numbers, self._texts), count

    def _passes(self, start_index: int, lines: int, blocks: int) -> tuple[StraightMoveSeries, int] | None:
        """Return the series of all loop executions except the last, or None if the loop is unsuitable.

        The executions must be within the limits ``lines`` and ``blocks``.
        """
        length = self._loops[start_index - 1] - start_index
        if not length or self._flow.end_index <= start_index + length:
            return None
        left = self._flow.get_remaining_repeats(start_index - 1)
        times = min(left, lines // (length + 1), (blocks - 1) // length, MAX_RUN_LENGTH // length)
        if times * length < MIN_SERIES_LENGTH:
            return None
        body = self._ready.columns.select_lines(slice(start_index, start_index + length))
        if not find_series_lines(self._state, body).all():
            return None
        index = np.tile(np.arange(length), times)
        self._flow.record_loop_executions(start_index - 1, times)
        self._without = range(0)
        made = make_move_series(self._state, body.select_lines(index), start_index + 1 + index, self._texts)
        return made, times * (length + 1)

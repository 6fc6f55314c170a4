"""Plans of many short path sections at once, such as the passes of a thread.

Each section starts and ends at rest, so its plan does not depend on the other sections. Planning a short
section alone would require many calls of array functions for little calculation. This module therefore
processes the sections as rows of a table. It applies the operations of ``plan_motion`` in the same order,
so both results are bitwise identical.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from core.motion.axis_limits import BoolArray, FloatArray, MotionError, MotionLimits
from core.motion.block_table import BlockTable, MotionBlock, build_block_table
from core.motion.motion_path import MotionPath, demand_unbroken, find_divided_blocks
from core.motion.motion_plan import FEW_PIECES, find_ramps
from core.motion.motion_profile import MotionProfile
from core.motion.path_pieces import PathPieces, find_short_chords, make_pieces
from core.motion.speed_limits import (
    depends_on_radius,
    find_block_speeds,
    find_expected_speeds,
    find_piece_limits,
    find_speed_caps,
)


class SectionPlan(NamedTuple):
    """The plan of one path section of k blocks, from rest to rest.

    ``joint_times_s`` (k+1,) contains the start time and the end times of the blocks in seconds.
    """

    profile: MotionProfile
    joint_times_s: FloatArray


def plan_sections(
    sections: Sequence[Sequence[MotionBlock]], limits: MotionLimits, rpm_max: float
) -> list[SectionPlan | None]:
    """Return the plans of path sections, in the given order.

    A section is a non-empty list of blocks. Its plan is None if it must be planned separately, because the
    section is long, its blocks are divided or smoothed, or a block is too short. All plans are None if any
    block cannot be planned. The caller finds the error when it plans the section of that block.
    """
    plans: list[SectionPlan | None] = [None] * len(sections)
    try:
        table = build_block_table([block for section in sections for block in section], rpm_max)
        demand_unbroken(table, None)
        pieces = make_pieces(table, find_block_speeds(table))
    except MotionError:
        return plans
    counts = np.array([len(section) for section in sections])
    firsts = np.cumsum(counts) - counts
    alone = np.logical_or.reduceat(_find_special_blocks(table, pieces, limits), firsts)
    for count in sorted(set(counts[~alone & (counts < FEW_PIECES)].tolist())):
        chosen = np.flatnonzero(~alone & (counts == count))
        rows = pieces[(firsts[chosen, None] + np.arange(count)).ravel()]
        for index, plan in zip(chosen.tolist(), _plan_rows(rows, count, limits), strict=True):
            plans[index] = plan
    return plans


def _find_special_blocks(table: BlockTable, pieces: PathPieces, limits: MotionLimits) -> BoolArray:
    """Return a mask (m,) of the blocks that are not exactly one piece with independent limits."""
    speeds = find_expected_speeds(pieces, find_speed_caps(pieces, limits))
    short = pieces.length <= speeds * limits.interval
    special: BoolArray = short | depends_on_radius(table) | find_divided_blocks(table)
    chords = find_short_chords(pieces, limits)
    special[1:] |= chords[1:] & chords[:-1]  # the joint between two short chords may be smoothed
    return special


def _plan_rows(pieces: PathPieces, count: int, limits: MotionLimits) -> Iterator[SectionPlan]:
    """Yield the plans of sections of ``count`` pieces each."""
    caps, accelerations, corners = find_piece_limits(pieces, limits, has_more_pieces=False)
    length, gains = pieces.length.reshape(-1, count), (2.0 * accelerations * pieces.length).reshape(-1, count)
    joint_limits = np.full((len(length), count + 1), np.inf)
    joint_limits[:, 1:-1] = corners[:-1].reshape(-1, count)[:, 1:]
    distances = np.zeros_like(joint_limits)
    np.cumsum(length, axis=1, out=distances[:, 1:])
    soft = np.minimum(caps, pieces.rate) ** 2
    squares = _find_joint_squares((caps**2).reshape(-1, count), soft.reshape(-1, count), joint_limits, gains)
    ramps = find_ramps(
        distances[:, :-1].ravel(),
        length=pieces.length,
        accelerations=accelerations,
        speed_caps=soft,
        start_squares=squares[:, :-1].ravel(),
        end_squares=squares[:, 1:].ravel(),
    )
    times = np.zeros((len(length), 3 * count + 1))
    np.cumsum(ramps.durations_s.reshape(len(length), -1), axis=1, out=times[:, 1:])
    phases = ramps.make_phases(times[:, :-1].ravel(), np.tile(np.repeat(np.arange(count), 3), len(length)))
    moving = np.count_nonzero(ramps.durations_s.reshape(len(length), -1), axis=1)
    ends, first_pieces = np.cumsum(moving).tolist(), np.arange(count + 1)
    for row, (begin, end) in enumerate(zip([0, *ends], ends, strict=False)):
        there = slice(row * count, (row + 1) * count)
        own = pieces[there]
        path = MotionPath(
            pieces=own,
            joint_distances=distances[row],
            speed_caps=caps[there],
            accelerations=accelerations[there],
            squared_speed_limits=joint_limits[row],
            block_numbers=own.block,
            first_pieces=first_pieces,
            start_position=own.start[0],
            limits=limits,
        )
        profile = MotionProfile(
            path=path,
            start_distance=0.0,
            end_distance=float(distances[row, -1]),
            duration_s=float(times[row, -1]),
            phases=phases.select_phases(slice(begin, end)),
        )
        yield SectionPlan(profile, times[row, ::3])


def _find_joint_squares(
    caps: FloatArray, soft: FloatArray, joint_limits: FloatArray, gains: FloatArray
) -> FloatArray:
    """Return the squared speeds (rows, k+1) at the joints of sections of k pieces.

    ``caps`` and ``soft`` (rows, k) are the squared speeds that the axes and the program permit. ``gains``
    (rows, k) are the changes of the squared speed within the pieces at full acceleration.
    """
    squares = joint_limits.copy()
    squares[:, [0, -1]] = 0.0
    inner = squares[:, 1:-1]
    for permitted in (caps, soft):
        np.minimum(inner, np.minimum(permitted[:, :-1], permitted[:, 1:]), out=inner)
    last = gains.shape[1]
    for joint in range(last - 1, 0, -1):
        np.minimum(squares[:, joint], squares[:, joint + 1] + gains[:, joint], out=squares[:, joint])
    for joint in range(1, last):
        np.minimum(squares[:, joint], squares[:, joint - 1] + gains[:, joint - 1], out=squares[:, joint])
    return squares

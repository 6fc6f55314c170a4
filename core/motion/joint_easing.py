"""Smoothing of the joints of short chords. A joint is the point at which two path elements meet.

The points are complex numbers, X + iZ, so that a running sum or a selection processes both axes at once.
Factors for single axes are arrays with two values for each joint, in the memory order of the points.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.motion.axis_limits import BoolArray, FloatArray, IntArray

MAX_NEIGHBOR_COUNT = (
    6  # joints on either side for a mean, four times to smooth and twice to correct excess moves
)
SUPPORT_PIECE_COUNT = 8 * MAX_NEIGHBOR_COUNT + 2  # joints on either side that affect a joint
_CORRECTIONS = 2
Points = npt.NDArray[np.complex128]


class _Window(NamedTuple):
    """The range of neighbors around each of m joints over which a mean is calculated.

    The sum over ``joint_count`` joints is the difference of two running sums, at ``last_index`` and at
    ``first_index``. ``joint_count`` (2m,) has two equal values for each joint, one per axis.
    """

    first_index: IntArray
    last_index: IntArray
    joint_count: FloatArray

    @classmethod
    def create(cls, around: IntArray) -> _Window:
        """Return the windows with ``around`` (m,) joints on either side of each joint."""
        at = np.arange(len(around))
        return cls(at - around, at + around + 1, _twice((2 * around + 1).astype(np.float64)))

    def mean(self, points: Points) -> Points:
        """Return the mean of the points in each window (m,)."""
        base = points[0]
        sums = np.zeros(len(points) + 1, dtype=np.complex128)
        np.subtract(points, base, out=sums[1:])
        np.cumsum(sums, out=sums)
        mean = sums.take(self.last_index)
        mean -= sums.take(self.first_index)
        flat = view_coordinates(mean)
        flat /= self.joint_count
        mean += base
        return mean


def view_coordinates(points: Points) -> FloatArray:
    """Return a view (2m,) of the coordinates of the points, alternating X and Z."""
    return points.view(np.float64)


def _twice(values: npt.NDArray[np.generic]) -> FloatArray:
    """Return an array (2m,) that repeats each value (m,) for both axes of its joint."""
    return np.repeat(values, 2).astype(np.float64, copy=False)


def smooth_joint_points(
    joints: Points, distances: FloatArray, is_free: BoolArray, max_shifts: FloatArray
) -> Points:
    """Return the joints (m,) of the path, each moved toward the mean of its neighbors.

    ``distances`` contains the distances of the joints along the path. Each joint moves by at most
    ``max_shifts`` along each axis. Each run of consecutive joints where ``is_free`` (m,) is True is
    smoothed separately, so that smoothing never crosses a corner.
    """
    window = _Window.create(np.minimum(_clear(is_free), MAX_NEIGHBOR_COUNT))
    last = window.last_index - 1
    span = _twice(np.maximum(distances[last] - distances[window.first_index], 1e-12))
    off = _twice(distances - window.mean(distances.astype(np.complex128)).real)

    def compute_neighbor_means(of: Points) -> Points:
        """Return the mean of each joint's neighbors, corrected for uneven distances between the joints.

        The joints of a straight line therefore remain on the line.
        """
        rise = of.take(last)
        rise -= of.take(window.first_index)
        carried = window.mean(of)
        slope = view_coordinates(rise)
        slope /= span
        slope *= off
        carried += rise
        return carried

    once = compute_neighbor_means(compute_neighbor_means(joints))
    # A mean flattens the curve by some height, and the mean of the mean flattens it by as much again.
    smooth = 2.0 * view_coordinates(once)
    smooth -= view_coordinates(compute_neighbor_means(compute_neighbor_means(once)))
    return _within(smooth, view_coordinates(joints), window, is_free, _twice(max_shifts)).view(np.complex128)


def _within(
    smooth: FloatArray, joints: FloatArray, window: _Window, free: BoolArray, allowed: FloatArray
) -> FloatArray:
    """Return the smoothed coordinates (2m,), limited to the allowed moves.

    If a move exceeds its limit, the excess is first distributed over the neighboring joints.
    """
    low, high = joints - allowed, joints + allowed
    near, movable = _Near.find_neighbors(free), _twice(free)
    for _ in range(_CORRECTIONS):
        over = np.clip(smooth, low, high)
        over -= smooth
        if not over.any():
            return smooth
        for correct, excess in ((np.add, over), (np.subtract, -over)):
            most = near.find_largest_values(np.maximum(excess, 0.0, out=excess))
            most *= movable
            correct(smooth, view_coordinates(window.mean(most.view(np.complex128))), out=smooth)
    return np.clip(smooth, low, high, out=smooth)


def _clear(free: BoolArray) -> IntArray:
    """Return the smaller number of consecutive free joints on either side of each joint (m,)."""
    at = np.arange(len(free))
    before = at - np.maximum.accumulate(np.where(free, -1, at))
    count_after = np.minimum.accumulate(np.where(free, len(free), at)[::-1])[::-1] - at
    clear: IntArray = np.minimum(before, count_after)
    return clear


class _Near(NamedTuple):
    """Neighbors of each joint in its run of free joints, at most ``MAX_NEIGHBOR_COUNT`` away.

    Each item of ``doubling_steps`` is a distance in coordinates (2 for one joint) and an array. For each
    coordinate, the array is 1.0 if the coordinate at this distance after it belongs to the same run, and
    0.0 otherwise. The array is None if there is only one run.
    """

    doubling_steps: tuple[tuple[int, FloatArray | None], ...]

    @classmethod
    def find_neighbors(cls, free: BoolArray) -> _Near:
        """Return the neighbors within the runs of ``free`` joints.

        A joint that is not free ends a run.
        """
        begins = free.copy()
        begins[1:] &= ~free[:-1]
        run = np.repeat(np.cumsum(begins), 2)
        if not len(run) or run[-1] < 2:
            return cls(tuple((2 * step, None) for step in _doublings()))
        steps = [2 * step for step in _doublings()]
        return cls(tuple((step, (run[step:] == run[:-step]).astype(np.float64)) for step in steps))

    def find_largest_values(self, values: FloatArray) -> FloatArray:
        """Return the largest value (2m,) within ``MAX_NEIGHBOR_COUNT`` joints of each joint, at least 0."""
        ahead, back = values.copy(), values.copy()
        for step, same in self.doubling_steps:
            later, earlier = ahead[step:], back[:-step]
            if same is not None:
                later, earlier = later * same, earlier * same
            np.maximum(ahead[:-step], later, out=ahead[:-step])
            np.maximum(back[step:], earlier, out=back[step:])
        return np.maximum(ahead, back, out=ahead)


def _doublings() -> Iterator[int]:
    """Yield the steps by which a window grows, doubling, to ``MAX_NEIGHBOR_COUNT`` + 1 joints."""
    reach = 1
    while reach <= MAX_NEIGHBOR_COUNT:
        step = min(reach, MAX_NEIGHBOR_COUNT + 1 - reach)
        yield step
        reach += step

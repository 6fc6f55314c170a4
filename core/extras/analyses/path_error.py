"""Path error: how far the measured path lies beside the programmed one, along the part, with the worst lines.

It is the distance to the path and no following error: a slide that is late on a straight line is on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.message import Message
from core.records.record import AnalysisError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
LEAST = 10  # samples that a path needs
UNTOLD = "the driver does not report the axis positions, so no path can be compared"
STOOD = "no axis moved in this time range; record while a program runs"
_SAME = 1e-9  # mm: points nearer than that are one


@dataclass(frozen=True, slots=True)
class PathError:
    """Of each measured sample (m,): its distance to the path, mm; of two slides positive to the left of the
    way it goes, of three without a sign.

    ``foot`` (m, 2 or 3) is the nearest point of the path, ``along`` how far along the path that lies, mm,
    ``lines`` the source line there.
    """

    distance: FloatArray
    foot: FloatArray
    along: FloatArray
    lines: IntArray
    measured: FloatArray

    @property
    def greatest(self) -> float:
        """The greatest distance on either side, mm."""
        return float(np.abs(self.distance).max())

    def magnified(self, factor: float) -> FloatArray:
        """The measured path (m, 2 or 3) with its distance from the programmed one so many times as large."""
        return self.foot + factor * (self.measured - self.foot)


@dataclass(frozen=True, slots=True)
class WorstPlace:
    """Where a line is farthest off: its distance, mm, and where on the path."""

    line: int
    distance: float
    place: tuple[float, ...]
    sample: int


def path_error(
    programmed: FloatArray, lines: IntArray, measured: FloatArray, due: IntArray, reach: int
) -> PathError:
    """Distances of ``measured`` (m, k) from the polyline ``programmed`` (n, k) of k = 2 or 3 slides.

    ``lines`` (n,) are the source lines of its points.

    ``due`` (m,) is the point of the polyline at which each sample was to be; its foot is sought ``reach``
    points to both sides of it, so that a path that crosses itself is not taken for its own neighbour.
    Raises AnalysisError.
    """
    _check(programmed, lines, measured, due)
    n = len(programmed)
    lengths = np.linalg.norm(np.diff(programmed, axis=0), axis=1)
    come = np.concatenate([[0.0], np.cumsum(lengths)])
    best = np.full(len(measured), np.inf)
    segment, share = np.zeros(len(measured), dtype=np.int64), np.zeros(len(measured))
    for step in range(-reach, reach):
        at = np.clip(due + step, 0, n - 2)
        start, way = programmed[at], programmed[at + 1] - programmed[at]
        square = (way**2).sum(axis=1)
        dot = ((measured - start) * way).sum(axis=1)
        part = np.clip(np.divide(dot, square, out=np.zeros_like(dot), where=square > _SAME**2), 0.0, 1.0)
        off = ((measured - start - part[:, None] * way) ** 2).sum(axis=1)
        nearer = off < best
        best[nearer], segment[nearer], share[nearer] = off[nearer], at[nearer], part[nearer]
    start, way = programmed[segment], programmed[segment + 1] - programmed[segment]
    foot = start + share[:, None] * way
    distance = np.sqrt(best)
    if programmed.shape[1] == 2:
        beside = measured - foot
        side = np.sign(way[:, 0] * beside[:, 1] - way[:, 1] * beside[:, 0])
        distance = np.where(side < 0.0, -1.0, 1.0) * distance
    return PathError(distance, foot, come[segment] + share * lengths[segment], lines[segment], measured)


def _check(programmed: FloatArray, lines: IntArray, measured: FloatArray, due: IntArray) -> None:
    if len(measured) < LEAST or len(programmed) < 2:
        raise AnalysisError(
            Message(
                "a path error plot needs at least {minimum} samples of a path; record while a program runs",
                minimum=LEAST,
            ),
            "too-few-samples",
        )
    if len(lines) != len(programmed) or len(due) != len(measured):
        raise AnalysisError(
            "the number of path points and the number of line numbers differ", "lengths-differ"
        )
    if not (np.isfinite(programmed).all() and np.isfinite(measured).all()):
        raise AnalysisError(UNTOLD, "no-positions")
    if not (np.ptp(programmed, axis=0) > _SAME).any():
        raise AnalysisError(STOOD, "at-rest")


def of_samples(
    demand: FloatArray, actual: FloatArray, lines: FloatArray, rate: float, late: float = 0.1
) -> PathError:
    """Of a record: the setpoints (m, 2 or 3) are the programmed path, ``actual`` what was measured.

    A sample's foot is sought within ``late`` s of the path before and behind. Raises AnalysisError.
    """
    if len(demand) < LEAST:
        raise AnalysisError(
            Message(
                "a path error plot needs at least {minimum} samples of a path; record while a program runs",
                minimum=LEAST,
            ),
            "too-few-samples",
        )
    if not (np.isfinite(demand).all() and np.isfinite(actual).all()):
        raise AnalysisError(UNTOLD, "no-positions")
    moved = np.append(True, (np.abs(np.diff(demand, axis=0)) > _SAME).any(axis=1))
    if moved.sum() < 2:
        raise AnalysisError(STOOD, "at-rest")
    due = np.cumsum(moved) - 1
    known = np.where(np.isfinite(lines), lines, 0.0).astype(np.int64)
    path = demand[moved]
    reach = max(2, round(late * rate))
    return path_error(path, known[moved], actual, due.astype(np.int64), reach)


def worst_places(error: PathError, most: int = 10) -> tuple[WorstPlace, ...]:
    """The lines that are farthest off, the worst first; samples of no line (0) are left out."""
    found = []
    for line in np.unique(error.lines[error.lines > 0]):
        of_line = np.flatnonzero(error.lines == line)
        sample = int(of_line[np.argmax(np.abs(error.distance[of_line]))])
        place = tuple(float(each) for each in error.foot[sample])
        found.append(WorstPlace(int(line), float(error.distance[sample]), place, sample))
    return tuple(sorted(found, key=lambda each: -abs(each.distance))[:most])

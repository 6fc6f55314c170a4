"""From squared speeds at the joints to phases of constant acceleration along the path."""

from __future__ import annotations

import numpy as np

from core.motion.limits import FloatArray
from core.motion.path import Path
from core.motion.profile import Profile
from core.motion.setpoints import Phases

_TINY = 1e-12  # relative: a ramp or a cruise that is smaller is rounding


def at_rest(path: Path, at: float) -> Profile:
    """No motion at all."""
    none = np.empty(0)
    phases = Phases(none, none, none, none, none, np.empty(0, dtype=np.int64))
    return Profile(path=path, start_s=at, end_s=at, duration=0.0, phases=phases)


def profile_of(
    path: Path,
    first: int,
    at: float,
    *,
    length: FloatArray,
    a: FloatArray,
    cap: FloatArray,
    speeds: FloatArray,
) -> Profile:
    """Phases of n consecutive pieces from ``first`` on, which begin at the distance ``at``.

    ``cap`` (n,) and ``speeds`` (n+1,) are squared speeds: the feed within the pieces and what the joints
    have. A piece speeds up to its cap or as far as its length allows, cruises, slows down; entered above
    its cap it slows down first.
    """
    peak = np.minimum(np.maximum(cap, speeds[1:]), 0.5 * (speeds[:-1] + speeds[1:]) + a * length)
    v0, vp, v1 = np.sqrt(speeds[:-1]), np.sqrt(peak), np.sqrt(speeds[1:])
    ends = np.stack([v0, vp, vp, v1], axis=1)
    dist = _distances(length, a, ends)
    total = ends[:, :-1] + ends[:, 1:]
    dt = np.divide(2.0 * dist, total, out=np.zeros_like(dist), where=total > 0.0)
    accel = np.divide(np.diff(ends, axis=1), dt, out=np.zeros_like(dist), where=dt > 0.0)
    s = path.s[first : first + len(length)].copy()
    s[0] = at
    starts = np.stack([s, s + dist[:, 0], s + dist[:, 0] + dist[:, 1]], axis=1)
    kept = (dt > 0.0).reshape(-1)
    dt = dt.reshape(-1)[kept]
    t = np.concatenate([[0.0], np.cumsum(dt)])
    return Profile(
        path=path,
        start_s=at,
        end_s=min(float(s[-1] + length[-1]), float(path.s[first + len(length)])),
        duration=float(t[-1]),
        phases=Phases(
            t=t[:-1],
            dt=dt,
            s=starts.reshape(-1)[kept],
            v=ends[:, :3].reshape(-1)[kept],
            a=accel.reshape(-1)[kept],
            piece=np.repeat(np.arange(first, first + len(length)), 3)[kept],
        ),
    )


def _distances(length: FloatArray, a: FloatArray, ends: FloatArray) -> FloatArray:
    """How far (n, 3) each piece speeds up, cruises and slows down between the speeds ``ends`` (n, 4)."""
    v0, peak, _, v1 = ends.T
    up = np.where(np.abs(peak - v0) > _TINY * peak, np.abs(peak - v0) * (peak + v0) / (2.0 * a), 0.0)
    down = np.where(np.abs(peak - v1) > _TINY * peak, (peak - v1) * (peak + v1) / (2.0 * a), 0.0)
    ramps = up + down
    cruise = length - ramps
    full = (cruise <= _TINY * length) & (ramps > 0.0)
    fit = np.divide(length, ramps, out=np.ones_like(length), where=full)
    return np.stack([up * fit, np.where(full, 0.0, cruise), down * fit], axis=1)

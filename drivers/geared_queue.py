"""The setpoint queue of a driver with a gear: played by time, or for a while by the turns of the spindle."""

from __future__ import annotations

from collections.abc import Sequence

from core.ports import Cam, DriverError, Geared, Segments, at_rest
from drivers.gearing import Gearing, Motion, Slides, State
from drivers.phase import Phase
from drivers.setpoint_queue import SetpointQueue


class GearedQueue(SetpointQueue):
    """As SetpointQueue, and ``mesh`` and ``play``; not thread-safe, its driver locks."""

    def __init__(self, slides: Slides, rest: Sequence[float]) -> None:
        super().__init__(slides.names, rest, slides.commit, slides.tolerance)
        self._slides = slides
        self._gearing: Gearing | None = None

    @property
    def meshed(self) -> bool:
        """Whether the slides follow the spindle; then ``play`` has to be called at the driver's rate."""
        return self._gearing is not None

    def geared(self) -> Geared | None:
        """As ``core.ports.Gear`` says."""
        gearing = self._gearing
        return None if gearing is None else Geared(gearing.turns, gearing.lag, gearing.spindle)

    def mesh(self, cam: Cam, phase: Phase, now: float) -> None:
        """Follow the spindle, whose ``phase`` is that of ``now``; raises as ``core.ports.Gear`` says."""
        gearing = self._gearing
        if gearing is not None and (gearing.begun or gearing.fits(cam)):
            gearing.load(cam)
            return
        if gearing is None and not at_rest(self.horizon(now), now):
            raise DriverError("slides have to rest before they can follow the spindle", "broken-path")
        self._gearing = Gearing(cam, phase, self._slides, self._rest)

    def play(self, t: float, read_at: float, count: float) -> Motion:
        """The setpoint for ``t`` while the slides follow the spindle, after a reading of its encoder."""
        assert self._gearing is not None
        motion = self._gearing.play(t, read_at, count)
        if self._gearing.over:
            self._leave(t, self._gearing)
        return motion

    def rest_at(self, position: Sequence[float]) -> None:
        self._gearing = None
        super().rest_at(position)

    def horizon(self, now: float) -> float:
        if self._gearing is None:
            return super().horizon(now)
        then = self._gearing.cam.then
        ends = self._gearing.ends() + (0.0 if then is None else float(then.t[-1] + then.dt[-1]))
        return max(ends, now + self.commit)  # foretold as over, and yet not played to its end

    def demand_at(self, t: float) -> State:
        return super().demand_at(t) if self._gearing is None else self._gearing.at(t)

    def splice(self, segments: Segments, now: float) -> None:
        gearing = self._gearing
        if gearing is not None and len(segments.t) and not gearing.still_at(float(segments.t[0])):
            raise DriverError(
                "the slides follow the spindle; stop them before they can move by time", "broken-path"
            )
        super().splice(segments, now)
        self._gearing = None

    def brake(self, now: float, decel: Sequence[float]) -> float:
        state = self.demand_at(now)
        if self._gearing is not None:
            self.rest_at(state[0])
        return self._brake(now, state, decel)

    def _leave(self, t: float, gearing: Gearing) -> None:
        """Behind the end of the way: rest, or what goes on by time."""
        self.rest_at(gearing.rest)
        then = gearing.cam.then
        if then is not None:
            super().splice(then._replace(t=then.t + t), t - self.commit)

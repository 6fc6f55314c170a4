"""Prediction of the spindle angle from the latest encoder readings."""

from __future__ import annotations

import math
from collections import deque

from core.executor.raised_alarm import AlarmError

_FIT_WINDOW_S = (
    0.2  # s of readings used; a longer time is less noisy, a shorter one follows speed changes better
)
_FIT_DEGREE = 3
_CURVED = 0.06  # s after the last reading for which the speed change is extrapolated
_MIN_READINGS = 8  # readings


class SpindleAnglePredictor:
    """Predictor of the spindle angle by a cubic fit to the latest encoder readings.

    Angles are in signed revolutions and times are in seconds. With 4096 counts per revolution and a reading
    every 10 ms, the error of a prediction 45 ms ahead is at most 0.25 degree. It is 0.2 degree if the speed
    varies by 2 % in 2 s.
    """

    def __init__(self) -> None:
        self._reads: deque[tuple[float, float]] = deque()
        self._fit: tuple[list[float], float] | None = None

    def add_reading(self, reading: tuple[float, float] | None) -> None:
        """Add a reading (time, revolutions).

        None means that the spindle has no encoder.
        """
        if reading is None:
            self._reads.clear()
        elif not self._reads or reading[0] > self._reads[-1][0]:
            self._reads.append(reading)
            while self._reads[0][0] < reading[0] - _FIT_WINDOW_S:
                self._reads.popleft()
        else:
            return
        self._fit = None

    @property
    def latest_revolutions(self) -> float:
        """Return the revolutions of the latest reading, or NaN if there are no readings."""
        return self._reads[-1][1] if self._reads else math.nan

    @property
    def can_predict_angle(self) -> bool:
        """Return whether enough recent readings are available for a prediction.

        The result is False immediately after an interruption of the control, and always without an encoder.
        """
        return len(self._reads) >= _MIN_READINGS

    def predict_angle(self, time_s: float) -> tuple[float, float] | None:
        """Return (revolutions, revolutions per second) at ``time_s``.

        The result is None if there are not enough readings.
        """
        if not self.can_predict_angle:
            return None
        if self._fit is None:
            self._fit = self._fit_readings()
        shape, base = self._fit
        u = time_s - self._reads[-1][0]
        near = min(u, _CURVED)
        turns = speed = 0.0
        for factor in reversed(shape):
            turns, speed = turns * near + factor, speed * near + turns
        return base + turns + speed * (u - near), speed

    def predict_turning_angle(self, time_s: float) -> tuple[float, float]:
        """Return (revolutions, revolutions per second) of a turning spindle at ``time_s``.

        Raises AlarmError if the spindle is stopped or its angle is not measured.
        """
        state = self.predict_angle(time_s)
        if state is None:
            raise AlarmError("thread-no-encoder", "the spindle encoder does not count")
        if state[1] == 0.0:
            raise AlarmError("thread-no-encoder", "the spindle does not turn")
        return state

    def _fit_readings(self) -> tuple[list[float], float]:
        """Return the coefficients of the cubic relative to the last reading, and that reading's angle."""
        last, base = self._reads[-1]
        times, turns = zip(*self._reads, strict=True)
        return _least_squares([t - last for t in times], [each - base for each in turns], _FIT_DEGREE), base


def _least_squares(u: list[float], y: list[float], degree: int) -> list[float]:
    """Return the coefficients of the least-squares polynomial for values ``y`` at points ``u``.

    The constant term is first. The method uses polynomials that are orthogonal on these points (Forsythe
    1957), each computed from the two previous ones. For 20 readings it takes a tenth of the time of a
    matrix solver, and it tolerates readings that are close together.
    """
    shape = [0.0] * (degree + 1)
    factors, factors_before = [1.0], [0.0]
    values, values_before = [1.0] * len(u), [0.0] * len(u)
    norm_before = math.inf
    for _ in shape:
        norm = sum([v * v for v in values])
        part = sum([v * each for v, each in zip(values, y, strict=True)]) / norm
        for k, factor in enumerate(factors):
            shape[k] += part * factor
        mean = sum([x * v * v for x, v in zip(u, values, strict=True)]) / norm
        ratio, norm_before = norm / norm_before, norm
        each = zip(u, values, values_before, strict=True)
        values, values_before = [(x - mean) * v - ratio * before for x, v, before in each], values
        shifted = zip([0.0, *factors], [*factors, 0.0], [*factors_before, 0.0], strict=True)
        factors, factors_before = [up - mean * f - ratio * b for up, f, b in shifted], [*factors, 0.0]
    return shape

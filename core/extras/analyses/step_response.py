"""Response of an axis to a step, ramp or sine, and following errors at other limits or speeds.

All values are measured from the samples. Only ``scale_error_to_speed`` assumes that the axis lag is
proportional to the speed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.message import Message
from core.records.record import AnalysisError

FloatArray = npt.NDArray[np.float64]
MIN_SAMPLES = 20  # samples


@dataclass(frozen=True, slots=True)
class StepResponse:
    """Response to a step, with times in seconds and lengths in mm.

    - ``rise_time_s``: time from 10 to 90 % of the step
    - ``overshoot_fraction``: overshoot as a fraction of the step; 0 if there is no overshoot
    - ``settling_time_s``: time from the end of the command until the axis stays within
      ``settling_band_mm``; NaN if it does not settle
    - ``delay_s``: delay at half of the step
    - ``final_error_mm``: error at the end of the record
    """

    step_size_mm: float
    rise_time_s: float
    overshoot_fraction: float
    settling_time_s: float
    delay_s: float
    final_error_mm: float
    settling_band_mm: float


def analyze_step(times: FloatArray, request: FloatArray, response: FloatArray, band: float) -> StepResponse:
    """Analyze the response to a step.

    The samples (n,) begin before the step and end after it. ``band`` is the in-position window in mm.
    Raises AnalysisError if the step is too small for ``band``.
    """
    _check(times, request, response)
    step_size = float(request[-1] - request[0])
    if abs(step_size) <= 2.0 * band:
        raise AnalysisError(
            Message(
                "a step of {step} is too small for the in-position window of {band}; use a larger step",
                step=f"{abs(step_size):.4f}",
                band=f"{band:.4f}",
            ),
            "step-too-small",
        )
    asked = (request - request[0]) / step_size
    done = (response - response[0]) / step_size
    half, tenth, most = (_crossing(times, done, share) for share in (0.5, 0.1, 0.9))
    end = float(times[np.argmax(asked >= 1.0 - 1e-9)])
    outside = np.flatnonzero(np.abs(response - request[-1]) > band)
    last = int(outside[-1]) if len(outside) else -1
    settling = math.nan if last == len(times) - 1 else max(float(times[last + 1]) - end, 0.0)
    return StepResponse(
        step_size,
        most - tenth,
        max(float(done.max()) - 1.0, 0.0),
        settling,
        half - _crossing(times, asked, 0.5),
        float(response[-1] - request[-1]),
        band,
    )


@dataclass(frozen=True, slots=True)
class SineResponse:
    """Response to a sine.

    ``gain`` is the amplitude of the response divided by that of the command. ``phase_lag_deg`` is the phase
    lag in degrees.
    """

    frequency_hz: float
    gain: float
    phase_lag_deg: float
    max_error_mm: float  # amplitude of the difference between request and response

    @property
    def lag_s(self) -> float:
        """Return the phase lag as a time in seconds."""
        return self.phase_lag_deg / 360.0 / self.frequency_hz


def analyze_sine(
    times: FloatArray, request: FloatArray, response: FloatArray, frequency: float
) -> SineResponse:
    """Analyze the response to a sine of ``frequency`` Hz over whole periods.

    A sine is fitted to the command and to the response. Raises AnalysisError if no full sine is found.
    """
    _check(times, request, response)
    waves = math.floor((times[-1] - times[0]) * frequency + 1e-6)
    if waves < 1:
        raise AnalysisError("the record is shorter than one sine period; record for longer", "too-short")
    cut = times <= times[0] + waves / frequency
    asked, got = (_wave(times[cut], each[cut], frequency) for each in (request, response))
    if abs(asked) < 1e-9:
        raise AnalysisError(
            Message(
                "the commanded motion contains no sine wave of {frequency} Hz", frequency=f"{frequency:g}"
            ),
            "no-sine",
        )
    ratio = got / asked
    return SineResponse(frequency, abs(ratio), -math.degrees(np.angle(ratio)), abs(asked - got))


def _wave(times: FloatArray, values: FloatArray, frequency: float) -> complex:
    """Return the amplitude and phase of the sine in the samples as a complex number.

    The fit also includes a constant and a slope, so that an offset or a drift does not affect the result.
    """
    t = times - times[0]
    turn = 2.0 * math.pi * frequency * t
    system = np.column_stack([np.cos(turn), np.sin(turn), np.ones_like(t), t])
    (a, b, *_), *_ = np.linalg.lstsq(system, values, rcond=None)
    return complex(a, -b)


@dataclass(frozen=True, slots=True)
class RampResponse:
    """Response to a ramp.

    ``speed_mm_s`` is the constant speed in mm/s, and ``lag_mm`` is the lag in mm at this speed.
    """

    speed_mm_s: float
    lag_mm: float
    overshoot_fraction: float  # mm beyond the end

    @property
    def lag_s(self) -> float:
        """Return the lag as a time in seconds."""
        return self.lag_mm / self.speed_mm_s


def analyze_ramp(times: FloatArray, request: FloatArray, response: FloatArray) -> RampResponse:
    """Analyze the response to a ramp in the second half of its constant speed.

    The lag has settled there. Raises AnalysisError if the command has no period of constant speed.
    """
    _check(times, request, response)
    speeds = np.gradient(request, times)
    top = float(speeds[np.argmax(np.abs(speeds))])
    even = np.flatnonzero(np.abs(speeds - top) <= 0.01 * abs(top))
    if abs(top) < 1e-9 or len(even) < MIN_SAMPLES:
        raise AnalysisError(
            "the commanded motion never reaches a constant speed; use a longer move", "no-ramp"
        )
    late = even[len(even) // 2 :]
    error = float(np.mean(request[late] - response[late]))
    sign = math.copysign(1.0, top)
    return RampResponse(top, error, max(float(np.max(sign * (response - request[-1]))), 0.0))


def _check(times: FloatArray, request: FloatArray, response: FloatArray) -> None:
    if len(times) < MIN_SAMPLES:
        raise AnalysisError(
            Message(
                "a response measurement needs at least {minimum} samples, but this driver supplies fewer",
                minimum=MIN_SAMPLES,
            ),
            "too-few-samples",
        )
    if not (np.isfinite(request).all() and np.isfinite(response).all()):
        raise AnalysisError(
            "the driver does not report the axis position, so no response can be shown", "no-positions"
        )


def _crossing(times: FloatArray, share: FloatArray, level: float) -> float:
    """Return the interpolated time at which ``share`` first reaches ``level``, or NaN if it never does."""
    above = np.flatnonzero(share >= level)
    if not len(above) or above[0] == 0:
        return float(times[0]) if len(above) else math.nan
    i = int(above[0])
    part = (level - share[i - 1]) / (share[i] - share[i - 1])
    return float(times[i - 1] + part * (times[i] - times[i - 1]))


@dataclass(frozen=True, slots=True)
class Bandwidth:
    """Frequencies in Hz at which the gain is -3 dB and at which the phase lag is 90 degrees.

    A frequency is None if the responses do not reach this gain or lag.
    """

    gain_bandwidth_hz: float | None
    phase_bandwidth_hz: float | None


def calculate_bandwidth(responses: Sequence[SineResponse]) -> Bandwidth:
    """Return the bandwidth from sine responses, interpolated on a logarithmic frequency scale."""

    def find_crossing_frequency(values: list[float]) -> float | None:
        for i in range(1, len(values)):
            if values[i - 1] < 0.0 <= values[i]:
                part = -values[i - 1] / (values[i] - values[i - 1])
                return float(
                    responses[i - 1].frequency_hz
                    * (responses[i].frequency_hz / responses[i - 1].frequency_hz) ** part
                )
        return None

    return Bandwidth(
        find_crossing_frequency(
            [-20.0 * math.log10(each.gain) + 20.0 * math.log10(math.sqrt(0.5)) for each in responses]
        ),
        find_crossing_frequency([each.phase_lag_deg - 90.0 for each in responses]),
    )


# --- Effect of another window or another speed ----------------------------------------------------------


def find_trip_time(times: FloatArray, error: FloatArray, limit_mm: float, duration_s: float) -> float | None:
    """Return the time at which the following error would trip the drive, or None if it would not.

    A trip occurs if the error exceeds ``limit_mm`` for ``duration_s`` seconds.
    """
    off = np.abs(error) > limit_mm
    edges = np.flatnonzero(np.diff(np.concatenate([[False], off, [False]]).astype(int)))
    for first, last in zip(edges[0::2], edges[1::2], strict=True):
        if times[last - 1] - times[first] > duration_s:
            return float(times[first]) + duration_s
    return None


def find_smallest_error_limit(times: FloatArray, error: FloatArray, duration_s: float) -> float:
    """Return the smallest error limit in mm at which this error would not cause a trip.

    A trip occurs if the error exceeds the limit for ``duration_s`` seconds. The limit is found by bisection
    to a thousandth of the largest error.
    """
    low, high = 0.0, float(np.abs(error).max(initial=0.0))
    for _ in range(10):
        middle = 0.5 * (low + high)
        low, high = (
            (middle, high) if find_trip_time(times, error, middle, duration_s) is not None else (low, middle)
        )
    return high


def find_speed_at_limit(
    lag_s: float, limit_at_rest_mm: float, limit_at_max_speed_mm: float, max_speed: float
) -> float | None:
    """Return the speed in mm/s at which the lag of an axis reaches its error limit, or None if never.

    ``lag_s`` is the lag of the axis in seconds. The limit grows linearly from ``limit_at_rest_mm`` at rest
    to ``limit_at_max_speed_mm`` at ``max_speed``.
    """
    steeper = lag_s - (limit_at_max_speed_mm - limit_at_rest_mm) / max_speed
    speed = limit_at_rest_mm / steeper if steeper > 0.0 else math.inf
    return speed if speed <= max_speed else None


def fit_lag(velocity: FloatArray, error: FloatArray) -> float:
    """Return the lag in seconds from the best-fit line error = lag · velocity.

    The result is NaN if the axis does not move.
    """
    known = np.isfinite(velocity) & np.isfinite(error)
    square = float((velocity[known] ** 2).sum())
    return float((velocity[known] * error[known]).sum()) / square if square > 0.0 else math.nan


def scale_error_to_speed(velocity: FloatArray, error: FloatArray, speed_factor: float) -> FloatArray:
    """Return the expected following error (n,) in mm at ``speed_factor`` times the speed.

    The component on the best-fit line error = k · velocity grows with speed. The rest, which is caused by
    friction, weight and cutting force, remains unchanged.
    """
    lag = np.nan_to_num(fit_lag(velocity, error))
    return np.asarray(error + (speed_factor - 1.0) * lag * np.where(np.isfinite(velocity), velocity, 0.0))

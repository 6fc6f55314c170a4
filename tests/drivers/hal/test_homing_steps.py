"""Homing on HAL, step by step, before slides that are played here: each way it may end, and each refusal."""

from __future__ import annotations

import math

import pytest

from core.ports import DriverError, MotionSegments
from drivers.hal.hal_config import HalAxis
from drivers.hal.hal_homing import HalHoming
from drivers.hal.hal_table import HalAxisPins
from tests.coded import raises_code

PINS = HalAxisPins("cmd", "fb", home="h", limit_low="l", limit_high="u", index_enable="i")
OFFSET = 2.5  # mm from the mark to zero


class Slides:
    """One axis that is where it was sent as soon as anybody looks, if it is not held."""

    commit = 0.03

    def __init__(self) -> None:
        self.t, self.place, self.until = 0.0, 0.0, 0.0
        self.ways: list[tuple[float, float]] = []  # to where, and how fast
        self.halts = 0
        self.limits: list[bool] = []  # whether its limit switch is let by
        self.asked: list[bool] = []
        self.index, self.index_at = False, 0.0
        self.zero: float | None = None

    def now(self) -> float:
        return self.t

    def horizon(self) -> float:
        return self.until

    def demand_at(self, _t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        return (self.place - (self.zero or 0.0),), (0.0,)

    def read_bit_pin(self, _name: str) -> bool:
        return self.index

    def read_number_pin(self, _name: str) -> float:
        return self.index_at

    def splice_homing_move(self, segments: MotionSegments) -> None:
        dt, p, v, a = (
            each[-1]
            for each in (
                segments.durations_s,
                segments.positions[:, 0],
                segments.velocities[:, 0],
                segments.accelerations[:, 0],
            )
        )
        ends = p + (v + 0.5 * a * dt) * dt
        self.ways.append((float(ends), float(abs(segments.velocities).max())))
        self.until = float(segments.start_times_s[-1] + segments.durations_s[-1])

    def brake_axes(self) -> None:
        self.halts += 1
        self.until = self.t

    def request_encoder_index(self, _pin: str, enabled: bool) -> None:
        self.asked.append(enabled)
        self.index = enabled

    def set_limit_switch_ignored(self, _axis: str, ignored: bool) -> None:
        self.limits.append(ignored)

    def read_hal_position(self, _index: int) -> float:
        return self.place

    def set_home_position(self, _index: int, hal_position: float) -> None:
        self.zero = hal_position


def homing(method: int, latch: float = 0.0) -> tuple[HalHoming, Slides]:
    """An axis of 100 mm that searches with 20 mm/s."""
    axis = HalAxis(
        "X", 100.0, 1000.0, 0.001, 1.0, 0.02, (-50.0, 50.0), False, 20.0,
        pins=PINS, home_method=method, home_latch_speed=latch, home_offset=OFFSET,
    )  # fmt: skip
    slides = Slides()
    return HalHoming(axis, 0, slides), slides


def steps(order: HalHoming, slides: Slides, seconds: float) -> None:
    """Rounds of 10 ms."""
    for _ in range(round(seconds / 0.01)):
        slides.t += 0.01
        order.continue_homing(slides.t)


def rests(order: HalHoming, slides: Slides) -> None:
    """Until all that was queued is over, and what comes behind it."""
    slides.t = max(slides.t, slides.until)
    steps(order, slides, 0.25)


@pytest.mark.parametrize(("method", "way"), [(19, 1.0), (21, -1.0), (18, 1.0), (17, -1.0)])
def test_homing_finds_the_switch_and_backs_off_slowly(method: int, way: float) -> None:
    """1.2 times its travel at the search's speed, back with a tenth; zero lies OFFSET beside the mark."""
    order, slides = homing(method)
    order.add_switch_sample(0.0, False)
    order.continue_homing(0.0)
    assert slides.ways[-1] == pytest.approx((way * 120.0, 20.0))
    slides.place = way * 30.0
    order.add_switch_sample(slides.place, True)
    steps(order, slides, 0.01)
    assert slides.halts == 1
    rests(order, slides)
    assert slides.ways[-1] == pytest.approx((slides.place - way * 120.0, 2.0))
    slides.place = way * 29.0
    order.add_switch_sample(slides.place, False)
    slides.place = way * 28.5  # it brakes behind its mark
    order.add_switch_sample(slides.place, False)
    steps(order, slides, 0.01)
    assert slides.halts == 2
    rests(order, slides)
    assert slides.zero == pytest.approx(way * 29.0 + OFFSET)
    assert slides.ways[-1][1] == pytest.approx(20.0)  # to its home
    assert not order.is_done
    rests(order, slides)
    assert order.is_done
    assert slides.limits == [True, False]


def test_homing_that_starts_on_the_switch_backs_off_at_latch_speed() -> None:
    order, slides = homing(19, latch=3.0)
    order.add_switch_sample(0.0, True)
    order.continue_homing(0.0)
    assert slides.ways == [pytest.approx((-120.0, 3.0))]


@pytest.mark.parametrize("method", [35, 37])
def test_homing_at_the_present_position_is_done_immediately(method: int) -> None:
    order, slides = homing(method)
    slides.place = 7.0
    order.continue_homing(0.0)
    rests(order, slides)
    assert order.is_done
    assert (slides.zero, slides.ways) == (7.0 + OFFSET, [])


def test_home_is_the_index_after_the_switch() -> None:
    order, slides = homing(3)
    order.add_switch_sample(0.0, True)
    order.continue_homing(0.0)
    order.add_switch_sample(-1.0, False)
    steps(order, slides, 0.05)
    assert slides.asked == [True]
    slides.index, slides.index_at = False, -3.25
    steps(order, slides, 0.05)
    assert slides.halts == 0  # a bit that has not risen yet is none that has fallen
    steps(order, slides, 0.05)
    assert slides.halts == 1
    rests(order, slides)
    assert slides.zero == pytest.approx(-3.25 + OFFSET)


@pytest.mark.parametrize(("method", "way"), [(33, -1.0), (34, 1.0)])
def test_index_only_homing_searches_thirty_millimeters_at_most(method: int, way: float) -> None:
    order, slides = homing(method)
    order.continue_homing(0.0)
    assert slides.ways == [pytest.approx((way * 30.0, 2.0))]
    steps(order, slides, 0.2)
    slides.t = slides.until
    with raises_code(DriverError, "homing", "X: ") as told:
        rests(order, slides)
    assert told.value.reason == "no-index"
    assert (slides.asked, slides.limits) == ([True, False], [True, False])


def test_switch_without_samples_is_reported_after_one_second() -> None:
    order, slides = homing(19)
    steps(order, slides, 1.0)
    with raises_code(DriverError, "homing", "X: ") as told:
        steps(order, slides, 0.05)
    assert told.value.reason == "not-sampled"
    assert slides.ways == []


def test_homing_without_a_switch_within_the_travel_fails() -> None:
    order, slides = homing(19)
    order.add_switch_sample(0.0, False)
    order.continue_homing(0.0)
    steps(order, slides, 1.0)
    with raises_code(DriverError, "homing", "X: ") as told:
        rests(order, slides)
    assert told.value.reason == "no-switch"
    assert slides.limits == [True, False]


def test_homing_that_overruns_its_switch_fails() -> None:
    order, slides = homing(19)
    order.add_switch_sample(0.0, False)
    order.continue_homing(0.0)
    order.add_switch_sample(30.0, True)
    steps(order, slides, 0.01)
    order.add_switch_sample(31.0, False)
    with raises_code(DriverError, "homing", "X: ") as told:
        rests(order, slides)
    assert told.value.reason == "ran-over"


def test_homing_fails_if_the_switch_stays_on() -> None:
    order, slides = homing(19)
    order.add_switch_sample(0.0, True)
    order.continue_homing(0.0)
    steps(order, slides, 1.0)
    with raises_code(DriverError, "homing", "X: ") as told:
        rests(order, slides)
    assert told.value.reason == "stays-on"
    assert math.isfinite(slides.until)

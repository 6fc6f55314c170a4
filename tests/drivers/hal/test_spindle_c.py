"""C on the spindle's drive behind HAL, taken beside its index: the way from there is a motion at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

import pytest

import resources
from app.compose.hal_backend import hal_config
from app.compose.machine_files import parse_machine
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_link import HalLink
from drivers.hal.hal_spindle_c import HalSpindleC, Step
from drivers.hal.hal_terminals import HalSpindle
from tests.drivers.hal.lathes import PATIENT, changed

Z, C = 1, 2
STANDS, LAGS = 17.0, 0.02  # degrees beside the index; mm by which Z is off its setpoint
OF_C = (
    (
        "[spindle]\n",
        "[axis.C]\nenabled = true\nvmax = 200\namax = 600\ncount = 0.02\nabsolute = true\n\n"
        "[c_axis]\nfeedback = false\n\n[spindle]\n",
    ),
    (
        "[hal.spindle]\n",
        '[hal.axes.C]\ncommand = "c-pos-cmd"\nfeedback = "c-pos-fb"\n\n'
        '[hal.spindle]\nposition_mode = "spindle-is-c"\n',
    ),
)


class Link:
    """A bridge that has done what it was told; ``rows`` are samples of time, X, Z, C, turns and speed."""

    def __init__(self) -> None:
        self.told = {"powered": True, "on": True, "c_at": STANDS}
        self.lost = self.trouble = ""
        self.blind = False
        self.rows: list[Sequence[float]] = []

    def say(self, *_what: object, **_values: object) -> int:
        return 0

    def say_pieces(self, *_what: object, **_values: object) -> None:
        """Taken."""

    def done(self, _order: int) -> bool:
        return True

    def wait(self, *_what: object) -> bool:
        return True

    def take_rows(self) -> Iterator[Sequence[float]]:
        rows, self.rows = self.rows, []
        yield from rows


class Spindle:
    """It stands, and its index is known."""

    ordered = 0.0
    lent = False
    known = True

    @property
    def index(self) -> Spindle:
        return self

    def measured(self) -> float:
        return 0.0

    def angle(self) -> tuple[float, float]:
        return 0.0, STANDS / 360.0


class Stand:
    """Axes and C on a clock of its own."""

    def __init__(self) -> None:
        text = changed(resources.machine_file("gt75-hal.toml"), (*PATIENT, *OF_C))
        self.t, self.link, self.z = 0.0, Link(), 0.0
        self.axes = HalAxes(
            hal_config(parse_machine(text, "gt75-hal.toml")), cast(HalLink, self.link), lambda: self.t
        )
        self.c = HalSpindleC(self.axes, cast(HalSpindle, Spindle()), cast(HalLink, self.link), C, "")
        pins = self.axes.config.spindle.pins
        self.spindle = (STANDS / 360.0,) * bool(pins.position) + (0.0,) * bool(pins.velocity)
        self.axes.enable(True)

    def run(self, seconds: float) -> None:
        """Rounds of 10 ms in which HAL plays what is queued, and Z lags."""
        for _ in range(round(seconds / 0.01)):
            self.t += 0.01
            place = self.axes.demand_at(self.t)[0]
            x, z, c = (p + zero for p, zero in zip(place, self.axes.zero, strict=True))
            self.link.rows.append((self.t, x, z, c, x, z - self.z, c, *self.spindle))
            self.axes.tick()
            self.c.tick()


def test_its_way_to_its_place_is_a_motion_before_its_first_setpoint_is_played() -> None:
    stand = Stand()
    stand.run(0.5)
    assert not stand.axes.sample().moving
    stand.c.hold(True, orient=True)
    stand.run(0.02)
    assert stand.c.step is Step.TURN
    while stand.c.step is Step.TURN:
        assert stand.axes.sample().moving, stand.axes.sample()
        stand.run(0.01)
    stand.run(0.5)
    assert stand.c.held()
    assert not stand.axes.sample().moving
    assert stand.axes.sample().actual[C] == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("orient", [False, True])
def test_a_slide_that_lags_keeps_its_setpoint_while_c_is_taken_and_let_go(orient: bool) -> None:
    stand = Stand()
    stand.run(0.5)
    stand.z = LAGS
    stand.run(0.5)
    stand.c.hold(True, orient=orient)
    stand.run(2.0)
    assert stand.c.held()
    assert stand.axes.demand_at(stand.t)[0][Z] == 0.0
    stand.c.hold(False)
    stand.run(0.1)
    assert stand.axes.demand_at(stand.t)[0][Z] == 0.0

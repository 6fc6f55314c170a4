"""C on the spindle's drive behind HAL, taken beside its index: the way from there is a motion at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import cast

import pytest

import resources
from app.compose.backends.hal_backend import create_hal_config
from app.compose.machine.machine_files import parse_machine
from core.faults import get_fault_code
from core.ports import DriverError
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_link import HalLink
from drivers.hal.hal_spindle import HalCAxisChangeStep, HalSpindle, HalSpindleCAxis
from tests.coded import raises_code
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
    """A bridge that has done what it was told; ``sample_rows`` are samples of time, X, Z, C, turns and
    speed.
    """

    def __init__(self) -> None:
        self.last_report = {"powered": True, "on": True, "c_at": STANDS}
        self.failure = self.failure_reason = ""
        self.is_state_unknown = self.is_c = False
        self.said: list[tuple[str, object]] = []
        self.sample_rows: list[Sequence[float]] = []

    def send_command(self, command: str, **values: object) -> int:
        self.said.append((command, values.get("on")))
        return 0

    def read_bit_pin(self, _name: str) -> bool:
        return self.is_c

    def send_setpoint_pieces(self, *_what: object, **_values: object) -> None:
        """Taken."""

    def is_command_executed(self, _order: int) -> bool:
        return True

    def wait_until_ready(self, *_what: object) -> bool:
        return True

    def pop_sample_rows(self) -> Iterator[Sequence[float]]:
        rows, self.sample_rows = self.sample_rows, []
        yield from rows


class Spindle:
    """It stands, and its index is known."""

    def __init__(self) -> None:
        self.commanded_rpm = self.rpm = 0.0
        self.is_used_as_c = False
        self.is_known = True

    def set_speed(self, rpm: float) -> None:
        self.commanded_rpm = rpm

    @property
    def spindle_index(self) -> Spindle:
        return self

    def get_encoder_rpm(self) -> float:
        return self.rpm

    def read_angle(self) -> tuple[float, float]:
        return 0.0, STANDS / 360.0


class Stand:
    """Axes and C on a clock of its own."""

    def __init__(self, *, tells: bool = False) -> None:
        text = changed(resources.read_machine_file("gt75-hal.toml"), (*PATIENT, *OF_C))
        self.t, self.link, self.z = 0.0, Link(), 0.0
        self.axes = HalAxes(
            create_hal_config(parse_machine(text, "gt75-hal.toml")), cast(HalLink, self.link), lambda: self.t
        )
        self.turning = Spindle()
        told = "spindle.in_position_mode" if tells else ""
        self.c = HalSpindleCAxis(self.axes, cast(HalSpindle, self.turning), cast(HalLink, self.link), C, told)
        pins = self.axes.config.spindle.pins
        self.spindle = (STANDS / 360.0,) * bool(pins.position) + (0.0,) * bool(pins.velocity)
        self.axes.enable(True)

    def run(self, seconds: float) -> None:
        """Rounds of 10 ms in which HAL plays what is queued, and Z lags."""
        for _ in range(round(seconds / 0.01)):
            self.t += 0.01
            place = self.axes.demand_at(self.t)[0]
            x, z, c = (p + zero for p, zero in zip(place, self.axes.home_positions, strict=True))
            self.link.sample_rows.append((self.t, x, z, c, x, z - self.z, c, *self.spindle))
            self.axes.run_cycle()
            self.c.continue_mode_change()


def test_axes_report_motion_while_c_turns_to_its_position() -> None:
    stand = Stand()
    stand.run(0.5)
    assert not stand.axes.sample().moving
    stand.c.set_c_mode(True, should_orient=True)
    stand.run(0.02)
    assert stand.c.step is HalCAxisChangeStep.TURN_TO_POSITION
    while stand.c.step is HalCAxisChangeStep.TURN_TO_POSITION:
        assert stand.axes.sample().moving, stand.axes.sample()
        stand.run(0.01)
    stand.run(0.5)
    assert stand.c.is_c_ready()
    assert not stand.axes.sample().moving
    assert stand.axes.sample().actual[C] == pytest.approx(0.0, abs=0.02)


@pytest.mark.parametrize("orient", [False, True])
def test_lagging_axis_retains_its_setpoint_when_c_engages_and_disengages(orient: bool) -> None:
    stand = Stand()
    stand.run(0.5)
    stand.z = LAGS
    stand.run(0.5)
    stand.c.set_c_mode(True, should_orient=orient)
    stand.run(2.0)
    assert stand.c.is_c_ready()
    assert stand.axes.demand_at(stand.t)[0][Z] == 0.0
    stand.c.set_c_mode(False)
    stand.run(0.1)
    assert stand.axes.demand_at(stand.t)[0][Z] == 0.0


# --- what is refused, and what fails ------------------------------------------------------------------------


def test_c_is_rejected_with_drives_off_or_the_spindle_turning() -> None:
    stand = Stand()
    stand.run(0.2)
    for ordered, rpm in ((100.0, 0.0), (0.0, 2.0), (0.0, -2.5)):
        stand.turning.commanded_rpm, stand.turning.rpm = ordered, rpm
        with raises_code(DriverError, "c-coupling") as told:
            stand.c.set_c_mode(True)
        assert told.value.reason == "spindle-turns"
    stand.turning.rpm = 1.9
    stand.link.last_report["powered"] = False
    stand.run(0.05)
    with raises_code(DriverError, "c-coupling") as told:
        stand.c.set_c_mode(True)
    assert told.value.reason == "drives-off"
    assert stand.c.step is HalCAxisChangeStep.SPINDLE_MODE
    assert not [each for each in stand.link.said if each[0] == "c"]


def test_c_finds_its_index_at_60_rpm_and_brakes_before_it_engages() -> None:
    stand = Stand()
    stand.run(0.2)
    stand.turning.is_known = False
    stand.c.set_c_mode(True, should_orient=True)
    assert (stand.c.step, stand.turning.commanded_rpm, stand.turning.is_used_as_c) == (
        HalCAxisChangeStep.FIND_INDEX,
        60.0,
        True,
    )
    stand.c.set_c_mode(True, should_orient=True)  # asked again, it goes on
    stand.turning.rpm = 60.0
    stand.run(1.0)
    assert stand.c.step is HalCAxisChangeStep.FIND_INDEX
    stand.turning.is_known = True
    stand.run(0.1)
    assert (stand.c.step, stand.turning.commanded_rpm) == (HalCAxisChangeStep.STOP, 0.0)
    stand.turning.rpm = 1.0
    stand.run(0.01)
    assert stand.c.step is HalCAxisChangeStep.CHANGE_MODE
    assert stand.link.said[-1] == ("c", True)


@pytest.mark.parametrize(
    ("known", "rpm", "seconds", "named"),
    [
        (False, 60.0, 15.0, "index"),
        (True, 60.0, 15.0, "stop"),
        (True, 0.0, 2.0, "hal.spindle.in_position_mode"),
    ],
)
def test_c_engagement_that_times_out_is_a_fault_and_frees_the_spindle(
    known: bool, rpm: float, seconds: float, named: str
) -> None:
    stand = Stand(tells=True)
    stand.run(0.2)
    stand.turning.is_known = False
    stand.c.set_c_mode(True, should_orient=True)
    stand.turning.is_known, stand.turning.rpm = known, rpm
    stand.run(0.02)  # and what it waits for begins
    stand.run(seconds - 0.05)
    assert stand.axes.fault == ""
    stand.run(0.1)
    assert get_fault_code(stand.axes.fault, "driver") == "c-coupling"
    assert stand.axes.fault.startswith("C: ")
    assert named in stand.axes.fault
    assert (stand.c.step, stand.turning.commanded_rpm, stand.turning.is_used_as_c) == (
        HalCAxisChangeStep.SPINDLE_MODE,
        0.0,
        False,
    )
    assert stand.link.said[-1] == ("c", False)


@pytest.mark.parametrize("lost", ["", "the bridge to HAL has ended"])
def test_c_is_released_on_an_unknown_state_but_not_over_a_lost_link(lost: str) -> None:
    stand = Stand()
    stand.run(0.2)
    stand.turning.is_known = False
    stand.c.set_c_mode(True, should_orient=True)
    stand.link.is_state_unknown, stand.link.failure = True, lost
    stand.c.continue_mode_change()
    assert stand.c.step is HalCAxisChangeStep.SPINDLE_MODE
    assert stand.turning.commanded_rpm == (60.0 if lost else 0.0)
    assert (("c", False) in stand.link.said) is not bool(lost)


def test_c_engagement_waits_for_the_drive_to_confirm_position_mode() -> None:
    stand = Stand(tells=True)
    stand.run(0.2)
    stand.c.set_c_mode(True)
    stand.run(1.0)
    assert not stand.c.is_c_ready()
    stand.link.is_c = True
    stand.run(0.1)
    assert stand.c.is_c_ready()
    assert stand.axes.fault == ""

"""The handwheel on the executor: clicks become ways, and everything that must keep them from it."""

from __future__ import annotations

import dataclasses
import math
import re

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import (
    CycleStart,
    DeselectHandwheel,
    EnableDrives,
    FeedHold,
    Jog,
    JogByStep,
    Reset,
    SelectHandwheel,
    StopJog,
)
from core.executor.hand_motion.handwheel import ClickCounter
from core.executor.snapshot import MachineState
from core.machine.hardware_model import AnalogInputModel
from core.machine.machine_model import InputModel, Machine
from tests.executor.rig import FINE, INCH, Rig
from tests.texts import pattern, text

THOU = 0.001 * INCH
LEASE = 0.25
AMAX = 120 * INCH
RAPID = 100 * INCH / 60


def wheeled(*inputs: str, per: int = 1) -> Machine:
    """The shipped lathe with a handwheel and these inputs beside it."""
    machine = load_machine()
    wheel = AnalogInputModel("handwheel", "wheel", (0.0, 1.0), counts_per_click=per)
    wired = {name: InputModel(name, f"test {name}") for name in inputs}
    return dataclasses.replace(
        machine,
        inputs={**machine.inputs, **wired},
        hardware=dataclasses.replace(machine.hardware, analog_inputs={"handwheel": wheel}),
    )


class WheelRig(Rig):
    """Its page renews the lease as long as ``page`` is set."""

    page: SelectHandwheel | None = None

    def __post_init__(self) -> None:
        self.every = FINE
        super().__post_init__()

    def tick(self, dt: float | None = None) -> None:
        if self.page is not None:
            self.executor.post(self.page)
        super().tick(dt)

    def select(self, axis: str = "X", step: float = THOU) -> None:
        """The page selects the wheel; it has stood still."""
        self.page = SelectHandwheel(axis, step, LEASE)
        self.run(0.2)
        assert self.shot.wheel == axis, self.said("refused")

    def drop(self) -> None:
        """The page lets it go."""
        self.page = None
        self.post(DeselectHandwheel())

    def spin(self, clicks: int, each: int = 1, ticks: int = 1) -> None:
        """``each`` clicks at a time, so many ticks apart, until there were ``clicks``."""
        for _ in range(abs(clicks) // each):
            self.sim.machine.turn_handwheel(int(math.copysign(each, clicks)))
            self.run(ticks * FINE)

    def rests(self) -> float:
        took = self.until(MachineState.IDLE, limit=5.0)
        self.run(0.3)
        assert self.state is MachineState.IDLE
        return took


def ready(*inputs: str, per: int = 1) -> WheelRig:
    rig = WheelRig(wheeled(*inputs, per=per))
    rig.ready()
    return rig


# --- clicks become ways -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("axis", "index"), [("X", 0), ("Z", 1)])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("step", [0.0001 * INCH, THOU, 0.01 * INCH])
def test_handwheel_click_moves_exactly_one_step(axis: str, index: int, sign: int, step: float) -> None:
    rig = ready()
    rig.select(axis, step)
    rig.spin(sign)
    assert rig.state is MachineState.JOG
    rig.rests()
    assert rig.shot.demand[index] == pytest.approx(sign * step, abs=1e-9)
    assert rig.shot.demand[1 - index] == 0.0


def test_fifty_clicks_forward_and_twenty_back_move_thirty_steps() -> None:
    rig = ready()
    rig.select("Z")
    rig.spin(-50, ticks=2)
    rig.spin(20, ticks=2)
    rig.rests()
    assert rig.shot.demand[1] == pytest.approx(-30 * THOU, abs=1e-9)
    assert rig.said("refused") == []


def test_fast_reversal_stays_within_the_handwheel_travel() -> None:
    rig = ready()
    rig.select("X", 0.01 * INCH)
    places = []
    rig.watch.append(lambda shot: places.append(shot.demand[0]))
    rig.spin(60)
    rig.spin(-60)
    rig.rests()
    assert rig.shot.demand[0] == pytest.approx(0.0, abs=1e-6)
    assert max(places) <= 60 * 0.01 * INCH + 1e-6
    assert min(places) >= -1e-6


def test_axis_lags_the_handwheel_by_100_ms_and_stops_with_it() -> None:
    rig = ready()
    rig.select("Z")
    rig.spin(200)  # 100 clicks a second: .1 in/s
    behind = 200 * THOU - rig.shot.demand[1]
    speed = 100 * THOU
    assert 0.0 < behind < speed * 0.2
    assert rig.rests() < 0.25
    assert rig.shot.demand[1] == pytest.approx(200 * THOU, abs=1e-9)


def test_four_count_detent_is_one_click_and_jitter_is_ignored() -> None:
    rig = ready(per=4)
    rig.select()
    for counts in (3, -3, 2, -2, 3, -3):
        rig.sim.machine.turn_handwheel(counts)
        rig.run(0.05)
    assert rig.shot.demand[0] == 0.0
    rig.sim.machine.turn_handwheel(4)
    rig.run(0.5)
    assert rig.shot.demand[0] == pytest.approx(THOU, abs=1e-9)


def test_reversed_handwheel_moves_the_axis_in_the_opposite_direction() -> None:
    rig = ready(per=-4)
    rig.select()
    rig.spin(4, each=4)
    rig.rests()
    assert rig.shot.demand[0] == pytest.approx(-THOU, abs=1e-9)


# --- no backlog -------------------------------------------------------------------------------------------


def test_clicks_faster_than_the_axis_are_dropped_and_not_played_later() -> None:
    rig = ready()
    rig.select("Z", 0.01 * INCH)
    rig.spin(1000, each=10)  # ten inches in a second; the slide makes 1.67
    stopped_at = rig.shot.demand[1]
    took = rig.rests()
    run_on = rig.shot.demand[1] - stopped_at
    assert run_on <= RAPID * 0.1 + RAPID**2 / AMAX + 0.03 * RAPID + 0.254
    assert took < 0.3
    assert rig.shot.demand[1] < 1.2 * RAPID
    assert rig.said("refused") == [text("executor.handwheel", why=text("executor.wheel-too-fast", axis="Z"))]


def test_unhomed_axis_follows_at_a_tenth_of_the_speed() -> None:
    machine = wheeled()
    x, z, *rest = machine.axes
    lost = dataclasses.replace(z, is_position_absolute=False, home_speed=20.0, home_order=1)
    rig = WheelRig(dataclasses.replace(machine, axes=(x, lost, *rest)))
    rig.ready()
    rig.select("Z", 0.01 * INCH)
    rig.spin(500, each=5)
    rig.rests()
    assert rig.shot.demand[1] < 0.13 * RAPID


def test_clicks_beyond_the_soft_limit_are_dropped() -> None:
    rig = ready()
    rig.select("X", 0.01 * INCH)
    rig.spin(900, each=2)  # nine inches; the travel is four
    rig.rests()
    limit = 4.0 * INCH - 0.01
    assert rig.shot.demand[0] == pytest.approx(limit, abs=0.002)
    assert text("executor.handwheel", why=text("executor.travel-end", axis="X", sign="+")) in rig.said(
        "refused"
    )
    rig.spin(-1)
    rig.rests()
    assert rig.shot.demand[0] == pytest.approx(limit - 0.01 * INCH, abs=0.002)


# --- nothing old ------------------------------------------------------------------------------------------


def test_clicks_before_selection_move_nothing() -> None:
    rig = ready()
    rig.spin(100, each=5)
    rig.select()
    rig.run(0.5)
    assert rig.shot.demand == (0.0, 0.0, 0.0)


def test_turning_handwheel_must_stop_before_it_is_accepted() -> None:
    rig = ready()
    rig.page = SelectHandwheel("X", THOU, LEASE)
    rig.spin(50)
    assert rig.shot.demand == (0.0, 0.0, 0.0)
    rig.run(0.15)
    rig.spin(1)
    rig.rests()
    assert rig.shot.demand[0] == pytest.approx(THOU, abs=1e-9)


def test_clicks_while_the_host_was_away_move_nothing() -> None:
    rig = ready()
    rig.select()
    rig.sim.machine.turn_handwheel(30)
    rig.page = None
    rig.tick(0.15)
    rig.run(0.3)
    assert rig.shot.demand[0] == 0.0


def test_changing_step_or_axis_drops_pending_clicks() -> None:
    rig = ready()
    rig.select("Z", 0.01 * INCH)
    rig.spin(30)
    moving = rig.shot.demand[1]
    rig.page = SelectHandwheel("Z", THOU, LEASE)
    rig.spin(10)
    rig.rests()
    assert rig.shot.demand[1] < 30 * 0.01 * INCH
    assert rig.shot.demand[1] - moving < 2.0


# --- ends -------------------------------------------------------------------------------------------------


def ended(rig: WheelRig, why: str) -> None:
    """It was taken away, stays so, and further clicks move nothing until it is selected anew."""
    assert (rig.shot.wheel, rig.shot.wheel_ended) == ("", why)
    rig.until_true(lambda shot: shot.state is not MachineState.JOG, limit=1.0)
    at = rig.shot.demand
    rig.run(0.3)
    rig.spin(20)
    rig.run(0.5)
    assert rig.shot.demand == at
    assert rig.shot.wheel == ""


def test_silent_page_releases_the_handwheel_within_its_lease() -> None:
    rig = ready()
    rig.select()
    rig.page = None
    rig.spin(int(LEASE / FINE) + 5)
    ended(rig, text("executor.page-silent"))


def test_leaving_the_page_stops_the_axis_immediately() -> None:
    rig = ready()
    rig.select("Z", 0.01 * INCH)
    rig.spin(30)
    rig.drop()
    assert rig.shot.wheel == ""
    assert rig.rests() < 0.1
    assert rig.shot.demand[1] < 30 * 0.01 * INCH


def test_hold_button_deselects_the_handwheel() -> None:
    rig = ready()
    rig.select()
    rig.spin(20)
    rig.sim.machine.press_hold()
    rig.spin(5)
    rig.sim.machine.release_hold()
    ended(rig, "feed hold")


@pytest.mark.parametrize("command", [FeedHold(), Reset()])
def test_screen_hold_and_reset_deselect_the_handwheel(command: FeedHold | Reset) -> None:
    rig = ready()
    rig.select()
    rig.spin(20)
    rig.post(command)
    ended(rig, "feed hold" if isinstance(command, FeedHold) else "reset")


def test_estop_deselects_the_handwheel_and_release_does_not_restore_it() -> None:
    rig = ready()
    rig.select()
    rig.spin(20)
    rig.sim.machine.press_estop()
    rig.spin(5)
    assert rig.state is MachineState.ESTOP
    rig.sim.machine.release_estop()
    rig.run(0.5)
    rig.post(EnableDrives())
    ended(rig, text("executor.moves-nothing", state="E-STOP"))


def test_silent_station_stops_the_axis() -> None:
    rig = ready()
    rig.select()
    rig.spin(20)
    rig.sim.machine.station_silent()
    rig.run(0.4)
    ended(rig, text("executor.station-silent-refused"))


def test_counter_jump_deselects_the_handwheel() -> None:
    rig = ready()
    rig.select()
    rig.sim.machine.turn_handwheel(4000)
    rig.run(0.05)
    ended(rig, text("executor.counts-leap"))


def test_jog_key_while_the_handwheel_turns_stops_both() -> None:
    rig = ready()
    rig.select("Z", 0.01 * INCH)
    rig.spin(20)
    for _ in range(60):  # the key stays down, its jog is renewed
        rig.executor.post(Jog("Z", 10.0, 0.2))
        rig.sim.machine.turn_handwheel(1)
        rig.tick()
    at = rig.shot.demand
    assert rig.state is MachineState.IDLE
    assert rig.shot.wheel_ended == text("executor.key-while-turned")
    rig.run(0.6)
    assert rig.shot.demand == at
    rig.post(Jog("Z", 10.0, 0.2))
    assert rig.state is MachineState.JOG


def test_handwheel_while_a_jog_key_is_held_down_stops_both() -> None:
    rig = ready()
    rig.select("Z")
    for turn in range(60):
        rig.executor.post(Jog("Z", 10.0, 0.2))
        if turn > 30:
            rig.sim.machine.turn_handwheel(1)
        rig.tick()
    assert rig.state is MachineState.IDLE
    assert rig.shot.wheel_ended == text("executor.turned-while-held")
    assert text("executor.jog", why=text("executor.key-and-wheel")) in rig.said("refused")


def test_jog_step_while_the_handwheel_turns_is_rejected_and_stops_it() -> None:
    rig = ready()
    rig.select("Z", 0.01 * INCH)
    rig.spin(20)
    at = rig.shot.demand[1]
    rig.post(JogByStep("Z", 2.54, 8.0))
    rig.rests()
    assert rig.shot.demand[1] - at < 1.0


def test_clicks_after_a_jog_key_release_are_dropped_until_rest() -> None:
    rig = ready()
    rig.select("Z")
    rig.post(Jog("Z", RAPID, 0.2))
    rig.run(0.1)
    rig.post(StopJog())
    rig.spin(2)
    rig.rests()
    assert rig.shot.wheel == "Z"


def test_cycle_start_deselects_the_handwheel() -> None:
    rig = ready()
    rig.select()
    rig.load("G90G94F50\nG01X.1F50\nM30")
    rig.post(CycleStart())
    rig.run(0.1)
    assert rig.shot.wheel == ""
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[0] == pytest.approx(0.1 * INCH)
    ended(rig, text("executor.moves-nothing", state="RUNNING"))


@pytest.mark.parametrize(
    ("wheel", "why"),
    [
        (SelectHandwheel("B", THOU, LEASE), pattern("executor.no-jog-axis", axis="B")),
        (SelectHandwheel("X", 0.0, LEASE), pattern("executor.click-length", limit="0.254")),
        (SelectHandwheel("X", 2.54, LEASE), pattern("executor.click-length", limit="0.254", length="2.54")),
        (SelectHandwheel("X", math.nan, LEASE), pattern("executor.click-length", limit="0.254")),
        (SelectHandwheel("C", 1.0, LEASE), pattern("executor.click-length", limit="0.5")),
        (SelectHandwheel("X", THOU, 0.0), pattern("executor.wheel-lease")),
        (SelectHandwheel("X", THOU, math.nan), pattern("executor.wheel-lease")),
    ],
)
def test_invalid_handwheel_selection_is_rejected(wheel: SelectHandwheel, why: str) -> None:
    rig = ready()
    rig.page = wheel
    rig.run(0.2)
    assert re.search(why, rig.shot.wheel_ended)
    rig.spin(5)
    assert rig.shot.demand == (0.0, 0.0, 0.0)


def test_handwheel_selection_with_drives_off_is_rejected() -> None:
    rig = WheelRig(wheeled())
    rig.page = SelectHandwheel("X", THOU, LEASE)
    rig.run(0.2)
    assert rig.shot.wheel_ended == text("executor.moves-nothing", state="DRIVES OFF")


def test_machine_without_a_handwheel_rejects_selection() -> None:
    rig = WheelRig()
    rig.ready()
    rig.post(SelectHandwheel("X", THOU, LEASE))
    assert rig.shot.wheel_ended == text("executor.no-wheel")


def test_handwheel_does_not_turn_c_while_the_spindle_turns() -> None:
    rig = ready()
    rig.select("C", 0.02)
    rig.spin(10)
    rig.rests()
    assert rig.shot.demand[2] == pytest.approx(0.2, abs=1e-9)
    rig.drop()
    rig.start("G90G94F50\nM03S500\nG04F1\nM02")
    rig.until(MachineState.IDLE)
    rig.page = SelectHandwheel("C", 0.02, LEASE)
    rig.run(0.2)
    assert text("executor.c-is-spindle") in rig.shot.wheel_ended


# --- switches of the station ------------------------------------------------------------------------------


def test_handwheel_requires_the_enabling_switch() -> None:
    rig = ready("wheel_enable")
    rig.page = SelectHandwheel("X", THOU, LEASE)
    rig.run(0.2)
    assert rig.shot.wheel_ended == text("executor.wheel-switch")
    rig.drop()
    rig.sim.machine.set_input("wheel_enable", True)
    rig.select("Z", 0.01 * INCH)
    rig.spin(20)
    rig.sim.machine.set_input("wheel_enable", False)
    rig.run(0.05)
    ended(rig, text("executor.wheel-switch"))


def test_handwheel_axis_must_match_the_selector_switch() -> None:
    rig = ready("wheel_x", "wheel_z")
    rig.sim.machine.set_input("wheel_z", True)
    rig.page = SelectHandwheel("X", THOU, LEASE)
    rig.run(0.1)
    assert rig.shot.wheel_ended == text("executor.wheel-axis", axis="X")
    rig.drop()
    rig.select("Z")
    rig.spin(5)
    rig.sim.machine.set_input("wheel_z", False)
    rig.run(0.05)
    ended(rig, text("executor.wheel-axis", axis="Z"))


# --- counts -----------------------------------------------------------------------------------------------


def test_initial_counter_reading_gives_zero_clicks() -> None:
    clicks = ClickCounter(4)
    assert clicks.read_clicks(123456, 1.0) == 0
    assert clicks.read_clicks(123464, 1.01) == 2
    assert clicks.read_clicks(123463, 1.02) == 0
    assert clicks.read_clicks(123460, 1.03) == -1


def test_counter_jump_and_stale_reading_give_zero_clicks() -> None:
    clicks = ClickCounter(1)
    clicks.read_clicks(0, 1.0)
    assert clicks.read_clicks(21, 1.01) == 0  # 20 in 10 ms is what a hand may
    assert clicks.has_jumped
    assert clicks.read_clicks(22, 1.02) == 1
    assert not clicks.has_jumped
    assert clicks.read_clicks(30, 1.2) == 0
    assert clicks.read_clicks(31, 1.21) == 1

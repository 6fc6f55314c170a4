"""The simulated slides, spindle, terminals and station: what they do, and what they refuse."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import pytest

from core.faults import get_fault_code
from core.ports import DriverError, StopMode
from tests.coded import raises_code
from tests.drivers.machines import CONFIG, play, ramp, simulation

ZERO = (0.0, 0.0, 0.0)


def test_axis_follows_with_a_following_error_and_arrives() -> None:
    sim, clock = simulation()
    sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.2))
    play(sim, clock, 0.2)
    cruising = sim.ports.axes.sample()
    assert cruising.moving
    # 2(1 - .9)v/wn with wn = 2*pi*40: 0.0955 mm
    assert cruising.following_error[0] == pytest.approx(0.0955, abs=0.003)
    play(sim, clock, 0.4)
    arrived = sim.ports.axes.sample()
    assert not arrived.moving
    assert arrived.actual[0] == pytest.approx(120.0 * 0.24, abs=0.00127)
    assert arrived.fault == ""


@pytest.mark.parametrize("tick", [0.0013, 0.01, 0.37])
def test_simulation_does_not_depend_on_polling_interval(tick: float) -> None:
    sim, clock = simulation()
    sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.2))
    play(sim, clock, 0.185, tick)
    clock.sleep_until(0.5)
    looked = sim.machine.get_true_positions()
    other, clock2 = simulation()
    other.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.2))
    clock2.sleep_until(0.5)
    assert other.machine.get_true_positions() == looked


def test_jammed_axis_trips_and_disables_the_others() -> None:
    sim, clock = simulation()
    sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.6))
    play(sim, clock, 0.2)
    sim.machine.jam("X")
    play(sim, clock, 0.15)
    sample = sim.ports.axes.sample()
    assert get_fault_code(sample.fault, "driver") == "following"
    assert sample.fault.startswith("X: ")
    assert not sample.enabled
    with raises_code(DriverError, "no-power", "X: "):
        sim.ports.axes.enable(True)
    sim.machine.jam("X", False)
    sim.ports.axes.clear_fault()
    assert not sim.ports.axes.sample().enabled
    sim.ports.axes.enable(True)
    play(sim, clock, 0.1)
    assert sim.ports.axes.sample().fault == ""


def test_stuck_encoder_trips_its_axis() -> None:
    sim, clock = simulation()
    sim.ports.axes.splice(ramp(0.03, ZERO, 60.0, 0.6))
    play(sim, clock, 0.2)
    sim.machine.encoder_stuck("X")
    play(sim, clock, 0.2)
    fault = sim.ports.axes.sample().fault
    assert get_fault_code(fault, "driver") == "following"
    assert fault.startswith("X: ")


@pytest.mark.parametrize("how", [StopMode.RAMP_OFF, StopMode.RAMP_HOLD, StopMode.OFF])
def test_each_stop_mode_brakes_as_specified(how: StopMode) -> None:
    sim, clock = simulation()
    sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.6))
    play(sim, clock, 0.2)
    before = sim.machine.get_true_positions()[0]
    sim.ports.axes.stop(how)
    play(sim, clock, 0.3)
    sample = sim.ports.axes.sample()
    assert not sample.moving
    assert sample.enabled == (how is StopMode.RAMP_HOLD)
    # v²/2a = 2.36 mm braked and the following error; friction alone takes 4.7 mm
    assert sim.machine.get_true_positions()[0] - before < (2.6 if how is not StopMode.OFF else 4.8)


def test_drives_refuse_setpoints_when_off_faulted_or_outside() -> None:
    sim, clock = simulation(powered=False)
    with raises_code(DriverError, "power-lost"):
        sim.ports.axes.splice(ramp(0.03, ZERO, 60.0, 0.1))
    sim.ports.axes.enable(True)
    with raises_code(DriverError, "drive-limits", "X: ") as told:
        sim.ports.axes.splice(ramp(0.03, ZERO, 128.0, 0.1))
    assert told.value.reason == "too-fast"
    with raises_code(DriverError, "drive-limits", "X: ") as told:
        sim.ports.axes.splice(ramp(0.03, ZERO, 100.0, 1.2))
    assert told.value.reason == "leaves-travel"
    sim.machine.drive_fault("Z", "overtemperature")
    with raises_code(DriverError, "axis", "Z: overtemperature"):
        sim.ports.axes.splice(ramp(0.03, ZERO, 60.0, 0.1))
    assert sim.machine.get_true_positions() == ZERO
    assert clock.now() == 0.0


def test_estop_acts_in_hardware() -> None:
    sim, clock = simulation()
    sim.ports.spindle.set_speed(1000.0)
    sim.ports.axes.splice(ramp(0.03, ZERO, 120.0, 0.6))
    play(sim, clock, 0.2)
    sim.machine.press_estop()
    play(sim, clock, 0.1)
    assert sim.ports.station.read_state().estop
    assert not sim.ports.axes.sample().enabled
    assert not sim.ports.axes.sample().moving
    with raises_code(DriverError, "no-power", "E-stop"):
        sim.ports.axes.enable(True)
    with raises_code(DriverError, "spindle-off", "E-stop"):
        sim.ports.spindle.set_speed(500.0)
    play(sim, clock, 3.0)
    assert sim.machine.get_spindle_rpm() == 0.0
    sim.machine.release_estop()
    play(sim, clock, 1.0)
    assert not sim.ports.axes.sample().enabled
    assert sim.machine.get_spindle_rpm() == 0.0


def test_homing_finds_the_switch_and_power_loss_loses_home() -> None:
    lost = dataclasses.replace(CONFIG.axes[1], absolute=False, power_up_position=-12.0, home_speed=20.0)
    config = dataclasses.replace(CONFIG, axes=(CONFIG.axes[0], lost, CONFIG.axes[2]))
    sim, clock = simulation(config)
    assert sim.ports.axes.sample().homed == (True, False, True)
    assert sim.ports.axes.sample().actual[1] == 0.0
    sim.ports.axes.home("Z")
    with raises_code(DriverError, "driver", "Z") as told:
        sim.ports.axes.splice(ramp(clock.now() + 0.03, ZERO, 60.0, 0.1))
    assert told.value.reason == "homing"
    play(sim, clock, 1.5)
    assert sim.ports.axes.sample().homed == (True, True, True)
    assert sim.ports.axes.sample().actual[1] == pytest.approx(0.0, abs=0.00127)
    sim.machine.press_estop()
    play(sim, clock, 0.1)
    assert sim.ports.axes.sample().homed == (True, False, True)


def test_homing_is_rejected_in_motion_and_for_an_unknown_axis() -> None:
    lost = dataclasses.replace(CONFIG.axes[1], absolute=False)
    sim, clock = simulation(dataclasses.replace(CONFIG, axes=(CONFIG.axes[0], lost, CONFIG.axes[2])))
    sim.ports.axes.splice(ramp(0.03, ZERO, 60.0, 0.6))
    play(sim, clock, 0.2)
    with raises_code(DriverError, "driver", "Z") as told:
        sim.ports.axes.home("Z")
    assert told.value.reason == "axis-moves"
    with raises_code(DriverError, "driver", "'B'") as told:
        sim.ports.axes.home("B")
    assert told.value.reason == "no-axis"


def test_spindle_ramps_after_its_latency() -> None:
    sim, clock = simulation()
    sim.ports.spindle.set_speed(1500.0)
    clock.sleep_until(0.08)
    assert sim.ports.spindle.speed() == pytest.approx(0.0)
    clock.sleep_until(0.58)
    assert sim.ports.spindle.speed() == pytest.approx(750.0)
    clock.sleep_until(2.08)
    assert sim.ports.spindle.speed() == 1500.0
    angle = sim.ports.spindle.read_angle()
    assert angle is not None
    # half of 1500/min for 1 s, then 1500/min for 1 s
    assert angle[1] == pytest.approx(12.5 + 25.0, abs=0.0003)
    sim.ports.spindle.set_speed(-1500.0)
    clock.sleep_until(2.16 + 0.6)
    assert sim.ports.spindle.speed() == pytest.approx(0.0, abs=1e-6)
    clock.sleep_until(2.76 + 0.5)
    assert sim.ports.spindle.speed() == pytest.approx(-750.0)


@pytest.mark.parametrize("coast", [False, True])
def test_spindle_stopped_within_its_start_latency_never_turns(coast: bool) -> None:
    sim, clock = simulation()
    spindle = sim.ports.spindle
    spindle.set_speed(1500.0)
    clock.advance(0.01)
    spindle.start_coasting() if coast else spindle.set_speed(0.0)
    for _ in range(30):
        clock.advance(0.005)
        assert spindle.speed() == 0.0


def test_repeated_stop_uses_the_latency_of_the_first() -> None:
    sim, clock = simulation()
    spindle = sim.ports.spindle
    spindle.set_speed(600.0)
    clock.advance(2.0)
    for _ in range(20):  # as the watchdog does
        spindle.set_speed(0.0)
        clock.advance(0.01)
    assert spindle.speed() == pytest.approx(600.0 - 2500.0 * (0.2 - 0.08))


def test_simulated_spindle_faults_are_reported() -> None:
    sim, clock = simulation()
    sim.ports.spindle.set_speed(9000.0)
    clock.sleep_until(5.0)
    assert sim.ports.spindle.speed() == 3500.0
    sim.machine.spindle_bog(0.6)
    clock.sleep_until(7.0)
    assert sim.ports.spindle.speed() == pytest.approx(2100.0)
    sim.machine.spindle_bog(1.0)
    sim.machine.spindle_ignores_stop()
    sim.ports.spindle.set_speed(0.0)
    clock.sleep_until(12.0)
    assert sim.ports.spindle.speed() == 3500.0
    sim.machine.spindle_fault("overcurrent")
    assert sim.ports.spindle.read_fault() == "overcurrent"
    with raises_code(DriverError, "spindle-off", "overcurrent"):
        sim.ports.spindle.set_speed(100.0)
    clock.sleep_until(20.0)
    assert sim.ports.spindle.speed() == 0.0


def test_collet_needs_time_to_open_and_close() -> None:
    sim, clock = simulation()
    assert sim.ports.io.inputs()["collet_closed"]
    sim.ports.io.write("collet", False)
    clock.sleep_until(0.31)  # 0.25 s and 20 %
    assert not sim.ports.io.inputs()["collet_closed"]
    sim.ports.io.write("collet", True)
    clock.sleep_until(0.31 + 0.23)  # 0.30 s less 20 %, less a little
    assert not sim.ports.io.inputs()["collet_closed"]
    clock.sleep_until(0.31 + 0.37)
    assert sim.ports.io.inputs()["collet_closed"]
    sim.machine.collet_sensor_stuck()
    sim.ports.io.write("collet", False)
    clock.sleep_until(2.0)
    assert sim.ports.io.inputs()["collet_closed"]


def test_safe_state_leaves_the_collet_unchanged() -> None:
    sim, _ = simulation()
    sim.ports.io.write("coolant", True)
    sim.ports.io.switch_to_safe_state()
    assert sim.ports.io.get_outputs() == {"collet": True, "coolant": False, "catcher": False}


def test_terminals_refuse_unknown_names() -> None:
    sim, _ = simulation()
    with raises_code(DriverError, "output", "'laser'"):
        sim.ports.io.write("laser", True)
    with raises_code(DriverError, "driver", "'77'"):
        sim.machine.set_input("77", True)


def test_c_is_not_positioned_by_a_spindle_that_turns() -> None:
    sim, clock = simulation()
    turn = ramp(0.03, ZERO, 100.0, 0.2)
    turn = turn._replace(
        positions=turn.positions[:, [1, 2, 0]],
        velocities=turn.velocities[:, [1, 2, 0]],
        accelerations=turn.accelerations[:, [1, 2, 0]],
    )
    sim.ports.spindle.set_speed(500.0)
    play(sim, clock, 1.0)
    with raises_code(DriverError, "drive-limits", "C axis", "500 rpm"):
        sim.ports.axes.splice(turn._replace(start_times_s=turn.start_times_s + 1.0))
    sim.ports.spindle.set_speed(0.0)
    play(sim, clock, 1.0)
    sim.ports.axes.splice(turn._replace(start_times_s=turn.start_times_s + 2.0))
    play(sim, clock, 1.0)
    assert sim.ports.axes.sample().actual[2] == pytest.approx(100.0 * 0.2333, abs=0.05)


def test_the_station_is_read_again_only_after_a_change() -> None:
    sim, clock = simulation()
    station = sim.ports.station
    play(sim, clock, 1.0)
    first = station.read_state()
    play(sim, clock, 1.0)
    assert station.read_state() is first
    sim.machine.set_feed_pot(0.5)
    assert station.read_state().feed_pot == pytest.approx(0.5)
    sim.ports.io.write("coolant", True)
    assert station.read_state() is not first


@pytest.mark.parametrize("act", ["start", "noise", "silence"])
def test_station_that_changes_with_time_is_read_each_time(act: str) -> None:
    sim, clock = simulation()
    acts: dict[str, Callable[[], None]] = {
        "start": sim.machine.press_start,  # its contact opens again after a pulse
        "noise": lambda: sim.machine.pot_noise(0.1),
        "silence": sim.machine.station_silent,
    }
    acts[act]()
    clock.advance(0.05)
    before = sim.ports.station.read_state()
    clock.advance(0.2)
    assert sim.ports.station.read_state() != before

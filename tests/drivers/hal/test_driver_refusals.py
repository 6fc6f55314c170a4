"""What the driver of a lathe behind HAL refuses, in words that say what to do; nothing moves by it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.faults import get_fault_code
from core.ports import DriverError, StopMode
from drivers.hal.bridge.packets import BridgeConfig
from drivers.hal.hal_link import HalLink
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.hal.played import Bench, powered
from tests.drivers.hal.test_whom_it_blames import Bridge

NO_TURNS = ('position = "spindle.position-fb" ', "# ")
NO_INDEX = ('index_enable = "spindle.index-enable" ', "# ")
NO_SPEED = ('velocity = "spindle-rps.out" ', "# ")
NO_PPR = ("encoder_ppr = ", "encoder_ppr = 0  # ")


@pytest.fixture
def bench() -> Iterator[Bench]:
    with powered() as made:
        yield made


# --- axes -------------------------------------------------------------------------------------------------


def test_axis_cannot_home_while_another_moves(bench: Bench) -> None:
    bench.axes.home("Z")
    bench.run(0.1)
    with raises_code(DriverError, "homing", "Z") as told:
        bench.axes.home("Z")
    assert told.value.reason == "axis-moves"
    bench.axes.stop(StopMode.RAMP_HOLD)
    bench.run(0.5)
    with raises_code(DriverError, "driver", "'Q'") as told:
        bench.axes.home("Q")
    assert told.value.reason == "no-axis"


def test_axis_with_a_known_position_homes_without_motion(bench: Bench) -> None:
    bench.axes.home("X")
    bench.run(0.5)
    sample = bench.axes.sample()
    assert (sample.homed[0], sample.moving, bench.x) == (True, False, pytest.approx(0.0, abs=1e-6))


def test_enabling_enabled_drives_does_not_disturb_the_motion(bench: Bench) -> None:
    """It would forget where the queue is: what moves would jump."""
    bench.x_goes(5.0)
    bench.run(0.3)
    before = bench.far.bridge._handled
    bench.axes.enable(True)
    bench.run(0.02)
    assert bench.far.bridge.fault == ""
    assert bench.axes.sample().enabled
    assert bench.far.bridge._handled - before <= 2  # beats
    bench.run(0.3)
    assert bench.x == pytest.approx(5.0 * 0.6, abs=0.3)


# --- spindle and outputs ----------------------------------------------------------------------------------


def test_spindle_start_is_rejected_while_a_drive_has_a_fault(bench: Bench) -> None:
    bench.far.plant_controls.drive_fault("X")
    bench.run(0.5)
    with raises_code(DriverError, "spindle-off", "the X axis drive"):
        bench.driver.ports.spindle.set_speed(500.0)
    bench.driver.ports.spindle.set_speed(0.0)  # to stop is never refused
    bench.run(1.0)
    assert bench.far.plant_controls.get_spindle_rpm() == 0.0


def test_outputs_are_rejected_while_the_bridge_is_silent(bench: Bench) -> None:
    bench.far.is_bridge_suspended = True
    bench.run(0.3)
    with raises_code(DriverError, "output", "coolant", "HAL", "0.30 s"):
        bench.driver.ports.io.write("coolant", True)
    with raises_code(DriverError, "output", "'laser'", "[io.out]"):
        bench.driver.ports.io.write("laser", True)


def test_speed_without_an_encoder_is_the_commanded_speed_once_at_speed() -> None:
    at_speed = ("[hal.spindle]\n", '[hal.spindle]\nat_speed = "spindle-at-speed"\n')
    with powered(NO_TURNS, NO_INDEX, NO_SPEED, NO_PPR, at_speed) as bench:
        spindle = bench.driver.ports.spindle
        spindle.set_speed(500.0)
        bench.run(0.2)
        assert (spindle.speed(), spindle.read_angle()) == (0.0, None)
        bench.wire("spindle-at-speed", True)
        bench.run(0.1)
        assert spindle.speed() == 500.0


def test_speed_without_a_speed_signal_is_derived_from_revolutions() -> None:
    with powered(NO_SPEED) as bench:
        bench.driver.ports.spindle.set_speed(600.0)
        bench.run(3.0)
        turning = bench.far.plant_controls.get_spindle_rpm()
        assert turning > 500.0
        assert bench.driver.ports.spindle.speed() == pytest.approx(turning, rel=0.01)


# --- the link ---------------------------------------------------------------------------------------------


class Leaving(Bridge):
    """Its HAL takes its time to go down."""

    has_shut_down = False
    hung_up = 0

    def stop_bridge(self) -> None:
        self.hung_up += 1


def linked(bridge: Bridge) -> tuple[HalLink, ManualClock, list[int]]:
    clock, idle = ManualClock(), list[int]()
    return HalLink(lambda: bridge, clock, BridgeConfig((), 0.001, 0.1), lambda: idle.append(1)), clock, idle


def test_command_is_rejected_before_the_bridge_is_connected() -> None:
    link, _, _ = linked(Bridge())
    link.process_packets()
    with raises_code(DriverError, "driver") as told:
        link.send_command("enable")
    assert told.value.reason == "no-bridge"


def test_hal_shutdown_is_awaited_then_reported() -> None:
    bridge = Leaving()
    link, clock, idle = linked(bridge)
    link.connect()
    link.end_session()
    assert (bridge.hung_up, get_fault_code(link.failure, "driver")) == (1, "hal-thread")
    link.end_session()
    assert bridge.hung_up == 1  # once
    with raises_code(DriverError, "hal-thread"):
        link.send_command("enable")
    before, idle[:] = clock.now(), []
    with raises_code(DriverError, "hal-bridge"):
        link.connect()
    assert clock.now() > before + 0.5
    assert idle  # whoever waits beside it is not kept waiting
    bridge.has_shut_down = True
    link.connect()
    link.send_command("enable")


def test_bridge_that_sends_nothing_at_startup_is_reported() -> None:
    bridge = Bridge()
    bridge.silent = True
    link, clock, _ = linked(bridge)
    with raises_code(DriverError, "hal-silent"):
        link.connect()
    assert clock.now() == pytest.approx(3.0, abs=0.2)


def test_broken_pipe_ends_the_link_and_a_full_pipe_does_not() -> None:
    class Full(Bridge):
        why = DriverError("the bridge to HAL takes nothing", "hal-silent")

        def send_packet(self, data: bytes) -> None:  # noqa: ARG002
            raise self.why

    bridge = Full()
    link, _, _ = linked(bridge)
    link.connect()
    with raises_code(DriverError, "hal-silent", bridge.why):
        link.send_command("enable")
    assert link.failure == ""
    bridge.why = DriverError("the HAL bridge process has ended (broken pipe)", "hal-bridge")
    with raises_code(DriverError, "hal-bridge", bridge.why):
        link.send_command("enable")
    assert "broken pipe" in str(link.failure)

"""What the bridge to HAL does not do, and what it stops for by itself: on the step clock, wire by wire."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.ports import DriverError
from drivers.hal.bridge.packets import flatten_pieces
from drivers.hal.bridge.setpoint_player import SetpointPlayer
from drivers.setpoint_pieces import MotionPiece
from tests.coded import raises_code
from tests.drivers.hal.played import STILL, TICK, Bench, powered


@pytest.fixture
def bench() -> Iterator[Bench]:
    with powered() as made:
        yield made


# --- what stops the machine -------------------------------------------------------------------------------


def test_limit_switch_stops_x_on_its_path_and_removes_power(bench: Bench) -> None:
    bench.x_goes(5.0)
    bench.run(0.5)
    bench.wire("x-high", True)
    bench.run(0.5)
    assert bench.bridge[1] == "limit-switch"
    assert bench.bridge[0].startswith("X: ")
    assert not bench.axes.sample().enabled
    stood = bench.x
    bench.run(0.5)
    assert bench.x == pytest.approx(stood, abs=1e-6)


def test_limit_switch_is_ignored_by_the_axis_that_is_homing(bench: Bench) -> None:
    bench.told("homing", axis="X", on=True)
    bench.wire("x-high", True)
    bench.run(0.3)
    assert bench.bridge == ("", "")
    bench.told("homing", axis="X", on=False)
    assert bench.bridge[1] == "limit-switch"
    assert bench.bridge[0].startswith("X: ")


def test_limit_switch_without_power_is_not_a_fault(bench: Bench) -> None:
    """It may stand there with the drives off: only so can it be led back."""
    bench.axes.enable(False)
    bench.run(0.2)
    bench.wire("x-high", True)
    bench.run(0.3)
    assert bench.bridge == ("", "")


def test_setpoints_for_a_time_already_played_stop_the_axes(bench: Bench) -> None:
    late = MotionPiece(bench.clock.now() - 0.02, 1.0, (bench.x + 1.0, bench.z), STILL, STILL)
    bench.told("splice", tuple(flatten_pieces([late])))
    assert bench.bridge[1] == "late"
    bench.run(0.5)
    assert not bench.axes.sample().enabled
    assert bench.x == pytest.approx(0.0, abs=1e-3)


def test_late_setpoints_that_match_the_played_path_are_accepted(bench: Bench) -> None:
    """A path that goes on as it was played is played anyway."""
    bench.x_goes(5.0)
    bench.run(0.5)
    begun, x = (
        bench.clock.now() - 0.03,
        bench.far.bridge.setpoint_player.get_motion_at(bench.clock.now() - 0.03)[0][0],
    )
    same = MotionPiece(begun, 1.0, (x, bench.z), (5.0, 0.0), STILL)
    bench.told("splice", tuple(flatten_pieces([same])))
    assert bench.bridge == ("", "")
    bench.run(0.5)
    assert bench.x == pytest.approx(x + 5.0 * (bench.clock.now() - begun), abs=0.05)


def test_thread_for_revolutions_already_passed_stops_the_axes(bench: Bench) -> None:
    gone = MotionPiece(-3.0, 1.0, (bench.x, bench.z), (0.0, -1.0), STILL)  # three turns ago
    bench.told("mesh", tuple(flatten_pieces([gone])), zero=0.0, sign=1.0, way=1)
    assert bench.bridge[1] == "late"


def test_mismatch_with_the_stream_played_by_hal_stops_the_axes(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bench.far.bridge.row_streams, "finish_stream_change", lambda _plays_b: False)
    bench.run(2 * TICK)
    assert bench.bridge[1] == "late"
    assert "HAL" in bench.bridge[0]


# --- what is not done -------------------------------------------------------------------------------------


def test_fault_bars_power_until_it_is_cleared(bench: Bench) -> None:
    bench.far.plant_controls.drive_fault("X")
    bench.run(0.5)
    assert bench.bridge == ("the X axis drive reports a fault", "axis")
    bench.far.plant.faulty_axes.clear()  # the drive is whole again, and nobody has acknowledged it
    bench.told("enable")
    bench.run(0.5)
    assert bench.pin("enable") == 0.0
    with raises_code(DriverError, "no-power", "the X axis drive"):
        bench.axes.enable(True)
    bench.axes.clear_fault()
    bench.run(0.3)
    bench.axes.enable(True)
    bench.run(0.5)
    assert bench.axes.sample().enabled


def test_spindle_command_is_not_sent_while_the_estop_chain_is_open(bench: Bench) -> None:
    bench.far.plant_controls.press_estop()
    bench.run(0.3)
    bench.far.bridge.queue_packet({"do": "spindle", "rpm": 500.0, "on": True}, ())
    bench.far.bridge.run_cycle()
    assert bench.pin("spindle.speed") == 0.0  # not for a single period
    with raises_code(DriverError, "spindle-off", "E-stop"):
        bench.driver.ports.spindle.set_speed(500.0)
    bench.run(1.0)
    assert bench.far.plant_controls.get_spindle_rpm() == 0.0


def test_motion_and_thread_are_ignored_while_drives_are_off(bench: Bench) -> None:
    bench.axes.enable(False)
    bench.run(0.3)
    bench.x_goes(5.0)
    turn = MotionPiece(9.0, 1.0, (bench.x, bench.z), (0.0, -1.0), STILL)
    bench.told("mesh", tuple(flatten_pieces([turn])), zero=0.0, sign=1.0, way=1)
    bench.told("brake")
    bench.run(0.5)
    assert (bench.x, bench.bridge) == (pytest.approx(0.0, abs=1e-6), ("", ""))
    assert bench.far.bridge.setpoint_player.read_gear_state() is None


def test_first_packet_of_a_two_packet_path_moves_nothing(bench: Bench) -> None:
    """Its end, where it comes to rest, is in the other one."""
    t, x, z = bench.clock.now() + 0.3, bench.x, bench.z
    out = MotionPiece(t, 0.2, (x, z), (5.0, 0.0), STILL)
    bench.told("splice", tuple(flatten_pieces([out])), more=True)
    bench.run(0.4)
    assert bench.x == pytest.approx(x, abs=1e-6)


def test_path_sent_in_two_packets_is_played_as_one(bench: Bench) -> None:
    t, x, z = bench.clock.now() + 0.1, bench.x, bench.z
    out = MotionPiece(t, 0.2, (x, z), (5.0, 0.0), STILL)
    back = MotionPiece(t + 0.2, 0.2, (x + 1.0, z), (-5.0, 0.0), STILL)
    bench.told("splice", tuple(flatten_pieces([out])), more=True)
    bench.told("splice", tuple(flatten_pieces([back])))
    bench.run(0.26)
    assert bench.x > x + 0.5
    bench.run(0.5)
    assert bench.x == pytest.approx(x, abs=0.01)
    assert bench.bridge == ("", "")


def test_unknown_command_or_output_does_nothing(bench: Bench) -> None:
    """Of another version's driver: no pin comes to be by a name that was sent."""
    cells = set(bench.far.servo_thread.cells)
    bench.told("dance", n=77)
    bench.told("out", name="laser", on=True)
    assert not [each for each in set(bench.far.servo_thread.cells) - cells if "laser" in each]
    assert bench.bridge == ("", "")


def test_late_bridge_at_rest_is_not_a_fault(bench: Bench) -> None:
    """HAL has run out of rows while nothing moved: it has stood where it stood."""
    bench.far.is_bridge_suspended = True
    bench.run(0.13)  # longer than HAL has rows, shorter than its watchdog
    bench.far.is_bridge_suspended = False
    bench.run(0.3)
    assert bench.bridge == ("", "")
    assert bench.axes.sample().enabled


def test_number_of_unread_samples_is_limited(bench: Bench) -> None:
    """Samples of a driver that does not ask: the newest are kept, not hours of them."""
    for _ in range(40 * 300 // 2 + 600):
        bench.clock.advance(0.002)
        bench.far.plant.advance()
        bench.far._outbox.clear()
        bench.far._count = 1  # no report is made
    assert len(bench.far.bridge._samples) <= 40 * 300 * bench.far.bridge._width


def test_spindle_prediction_without_readings_starts_at_zero() -> None:
    """Before the first reading of the spindle: a thread asked for then is reckoned from 0."""
    assert SetpointPlayer(2).spindle_predictor.predict_revolutions(5.0) == 0.0

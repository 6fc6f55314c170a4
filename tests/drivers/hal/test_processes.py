"""Processes of the HAL backend that die, stand or fall silent while X moves at 100 mm/s, with a real halrun.

One lathe for all: that Reset leads back behind each of them is part of the next one. What was seen is in
``docs/integrator/hal.md``; no time is asserted but the one that HAL itself keeps.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest

from core.executor.commands import Reset
from core.executor.snapshot import MachineState
from core.ports import ALL_UNKNOWN_PARTS
from tests.drivers.hal.halrun import folder_for_all, halrun_on_path
from tests.drivers.hal.lathes import lathe
from tests.drivers.hal.live import LiveLathe, live
from tests.texts import text

pytestmark = [pytest.mark.long, pytest.mark.real_time]
SPEED = 100.0  # mm/s
PROGRAM = f"G90G94\nM03S1000\nM08\nG01X{{}}Z0F{SPEED / 25.4 * 60:.0f}\nM30\n"
FAR = 3.9  # in of X, to which it goes from the other side
AHEAD = 0.1  # s that HAL holds
RAMP = SPEED**2 / (2 * 3048.0)  # mm
BRIDGE, HAS_DRIVER_HOST, THREAD = "bridge_process.py", "app.compose.backends.driver_host_process", "rtapi_app"


@pytest.fixture(scope="module")
def lathe_behind_hal() -> Iterator[LiveLathe]:
    with folder_for_all() as folder, halrun_on_path(), live(lathe(folder)) as made:
        yield made


@pytest.fixture
def running(lathe_behind_hal: LiveLathe) -> LiveLathe:
    """X at full feed, spindle and coolant on, whatever was before."""
    made = lathe_behind_hal
    made.ready()
    made.start(PROGRAM.format(-FAR if made.shot.actual[0] > 0.0 else FAR))
    made.until(lambda shot: shot.velocity > 0.99 * SPEED)
    return made


def place(lathe: LiveLathe) -> float:
    """Of X, mm, as HAL has it."""
    found = lathe.pin("x-motor.out")
    assert found is not None, "HAL is down"
    return found


def rests(lathe: LiveLathe) -> float:
    """Look at the slide until it stands, by HAL alone; where."""
    last = place(lathe)
    while (now := lathe.pin("x-motor.out")) not in {None, last}:
        last = now or last
    return last


def off(lathe: LiveLathe) -> bool:
    """Spindle and coolant, as HAL drives them; the collet stays closed."""
    pins = [lathe.pin(each) for each in ("spindle-ramp.in", "collet-switch.in")]
    return None in pins or (pins == [0.0, 1.0] and not lathe.is_on("out-coolant"))


def told(lathe: LiveLathe, code: str) -> None:
    lathe.until(lambda shot: bool(shot.alarms))
    assert lathe.codes[0] == code, lathe.shot.alarms


def test_reset_restarts_hal_after_the_bridge_was_killed(running: LiveLathe) -> None:
    running.kill(BRIDGE)
    before = place(running)
    assert abs(rests(running) - before) < SPEED * AHEAD + RAMP
    told(running, "hal-bridge")
    assert running.shot.unknown == ALL_UNKNOWN_PARTS
    assert running.shot.alarms[0].cause == text("drivers.bridge-ended")
    while not off(running):  # HAL alone
        pass
    running.ready()  # Reset, then the drives are on


def test_ctrl_c_that_reaches_the_bridge_stops_nothing(running: LiveLathe) -> None:
    running.kill(BRIDGE, signal.SIGINT)
    before = place(running)
    running.until(lambda shot: bool(shot.alarms) or abs(place(running) - before) > 0.1 * SPEED)
    assert running.codes == []


def test_bridge_that_was_suspended_retains_the_position(running: LiveLathe) -> None:
    running.kill(BRIDGE, signal.SIGSTOP)
    before = place(running)
    stands = rests(running)
    assert abs(stands - before) < SPEED * AHEAD + RAMP
    told(running, "hal-silent")
    while not (off(running) and running.pin("x-motor.sel") == 0.0):  # the watchdog in HAL
        running.tick()
    running.kill(BRIDGE, signal.SIGCONT)
    running.ready()
    assert running.shot.actual[0] == pytest.approx(stands, abs=0.01)


def test_one_reset_recovers_from_a_killed_real_time_thread(running: LiveLathe) -> None:
    running.kill(THREAD)
    told(running, "hal-thread")
    assert running.shot.unknown == ALL_UNKNOWN_PARTS
    running.ready()


def test_silent_control_stops_on_its_path_with_spindle_and_outputs_off(running: LiveLathe) -> None:
    while not off(running):
        pass
    stands, powered = rests(running), running.pin("x-motor.sel")
    running.until(lambda shot: shot.state in {MachineState.HOLD, MachineState.FAULT})
    assert powered == 1.0
    assert running.shot.state is MachineState.HOLD
    assert running.shot.actual[0] == pytest.approx(stands, abs=0.01)
    assert running.shot.stop is not None
    assert running.shot.stop.code == "feeder-tripped"
    running.post(Reset())


def test_killed_driver_host_stops_on_its_path_with_everything_off(running: LiveLathe) -> None:
    running.kill(HAS_DRIVER_HOST)
    while not off(running) or running.pin("x-motor.sel"):  # the bridge alone
        pass
    told(running, "feeder-gone")
    running.ready()

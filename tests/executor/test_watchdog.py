"""The watchdog: threads that are killed, stuck, late; and a process that merely stood still."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable

import pytest

from core.executor.commands import EnableDrives
from core.executor.executor import Executor
from core.executor.safety.watchdog import (
    BUSY_STUCK_CHECK_COUNT,
    CHECKS_BETWEEN_HALTS,
    EXECUTOR_CHECKS_PER_THREAD_CHECK,
    STUCK_CHECK_COUNT,
    WATCHDOG_THREAD_NAME,
    ExecutorThread,
    Watchdog,
    WatchdogSupervisor,
    is_python_thread_alive,
)
from core.executor.snapshot import MachineState
from drivers.grblhal import grblhal_codes
from tests.drivers.contract.control import Control
from tests.drivers.contract.grbl import Grblhal
from tests.drivers.contract.rig import TICK, Rig
from tests.drivers.contract.rigs import make
from tests.executor.rig import Rig as Simulated
from tests.texts import text

pytestmark = pytest.mark.long

CUT = "G90G94F300\nM03S600\nM08\nX.1\nG01F30Z-2\nM30\n"


class Ticked:
    """Stands for the thread: the test ticks."""

    def __init__(self, executor: Executor) -> None:
        self.executor = executor
        self.is_alive = True


def watched(executor: Executor, halt: Callable[[], None] | None) -> tuple[Watchdog, Ticked]:
    thread = Ticked(executor)
    return Watchdog(thread, halt, (), lambda _: None), thread  # type: ignore[arg-type]


def cutting(name: str) -> tuple[Rig, Control]:
    rig = make(name)
    control = Control(rig)
    control.start(CUT)
    control.until_true(lambda _: control.world.place()[1] < -8.0)
    return rig, control


def away(rig: Rig, seconds: float, look: Callable[[], None] | None = None) -> None:
    """Nobody ticks; the watchdog looks ten times a second."""
    for n in range(round(seconds / TICK)):
        rig.alone(TICK)
        if look is not None and n % 10 == 0:
            look()


@pytest.mark.parametrize("name", ["simulated", "fed", "fed canopen", "grblhal", "delta"])
@pytest.mark.parametrize("dead", [True, False], ids=["dead", "stuck"])
def test_machine_stops_with_spindle_and_coolant_off_if_executor_dies(name: str, dead: bool) -> None:
    rig, control = cutting(name)
    dog, thread = watched(control.executor, control.executor.halt_function)
    dog.check_threads()
    thread.is_alive = not dead
    place = control.world.place()[1]
    away(rig, 6.0, dog.check_threads)
    # a second to be sure that it is stuck, what was queued meanwhile, and the ramp
    assert abs(control.world.place()[1] - place) < 12.7 * (
        0.5 if dead and not name.startswith("fed") else 3.5
    )
    stood = control.world.place()
    away(rig, 1.0)
    assert control.world.place() == pytest.approx(stood, abs=0.002)
    assert control.world.rpm() == 0.0
    assert not control.world.outputs()["coolant"]
    assert control.world.outputs()["collet"]
    assert control.shot.state is MachineState.FAULT
    (alarm,) = control.shot.alarms
    assert alarm.code == "control-silent"
    assert ("ended" if dead else "stuck") in alarm.cause
    assert text("executor.press-estop") in alarm.remedy
    assert len(control.said("alarm")) == 1
    rig.close()


def test_returning_executor_starts_with_the_alarm() -> None:
    rig, control = cutting("simulated")
    dog, _ = watched(control.executor, control.executor.halt_function)
    away(rig, 2.0, dog.check_threads)
    for _ in range(100):
        control.tick()
        dog.check_threads()
    assert control.state is MachineState.FAULT
    assert [alarm.code for alarm in control.shot.alarms] == ["control-silent"]
    assert not rig.ports.axes.sample().enabled
    assert control.nothing_moves()


def test_suspended_process_raises_no_watchdog_alarm() -> None:
    rig, control = cutting("simulated")
    dog, _ = watched(control.executor, control.executor.halt_function)
    for _ in range(5):
        away(rig, 5.0)  # both stood
        for _ in range(STUCK_CHECK_COUNT - 2):
            dog.check_threads()  # and the watchdog is the first to be woken
        control.tick()
        dog.check_threads()
    assert control.shot.alarms == ()


def test_waiting_for_drives_is_not_a_stuck_thread() -> None:
    rig = Simulated()
    dog, _ = watched(rig.executor, rig.executor.halt_function)
    enable = rig.sim.ports.axes.enable
    waited: list[bool] = []

    def slow(is_on: bool) -> None:
        for _ in range(BUSY_STUCK_CHECK_COUNT - 5):
            dog.check_threads()
        waited.append(True)
        enable(is_on)

    rig.sim.ports.axes.enable = slow  # type: ignore[method-assign]
    rig.post(EnableDrives())
    assert waited
    assert rig.state is MachineState.IDLE
    assert rig.shot.alarms == ()


def test_controller_gets_feed_hold_first_and_then_reset() -> None:
    rig, control = cutting("grblhal")
    assert isinstance(rig, Grblhal)
    sent: list[bytes] = []
    write = rig.wire.write

    def noting(data: bytes) -> None:
        sent.append(data)
        write(data)

    rig.wire.write = noting  # type: ignore[method-assign]
    dog, thread = watched(control.executor, control.executor.halt_function)
    thread.is_alive = False
    for _ in range(3 * CHECKS_BETWEEN_HALTS):
        away(rig, 0.1)
        dog.check_threads()
    assert sent[0] == bytes([grblhal_codes.JOG_CANCEL, grblhal_codes.HOLD])
    assert set(sent[1:]) == {bytes([grblhal_codes.RESET])}
    rig.close()


def kill(thread: threading.Thread, error: type[BaseException]) -> None:
    """Raise it in there, whatever it does."""
    assert thread.ident is not None
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), ctypes.py_object(error))


def thread_of(name: str) -> threading.Thread:
    return next(thread for thread in threading.enumerate() if thread.name == name)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
@pytest.mark.parametrize("error", [SystemExit, ValueError, KeyboardInterrupt])
def test_killed_executor_thread_leaves_outputs_and_drives_off(error: type[BaseException]) -> None:
    """SystemExit and mistakes it outlives, with an alarm; what ends it is the watchdog's business."""
    rig = Simulated()
    rig.start(CUT)
    rig.until_true(lambda shot: shot.actual[1] < -3.0)
    thread = ExecutorThread(rig.executor, Waiting(rig), tick=0.01)
    dog = Watchdog(thread, rig.executor.halt_function, (), lambda _: None)
    thread.start()
    kill(thread_of("executor"), error)
    for _ in range(30_000):
        if rig.executor.snapshot.alarms:
            break
        Waiting.pause()
        dog.check_threads()
    assert rig.executor.snapshot.alarms
    thread.close()
    assert not thread.is_alive
    rig.clock.advance(3.0)
    assert rig.sim.machine.get_spindle_rpm() == 0.0
    assert {name for name, on in rig.sim.ports.io.get_outputs().items() if on} == {"collet"}
    assert not rig.sim.ports.axes.sample().enabled


class Waiting:
    """Machine time, a hundredth a wait, that takes a blink."""

    def __init__(self, rig: Simulated) -> None:
        self._rig = rig

    def now(self) -> float:
        return self._rig.clock.now()

    def sleep_until(self, time_s: float) -> None:
        self._rig.clock.advance(max(time_s - self.now(), 0.0))
        self.pause()

    @staticmethod
    def pause() -> None:
        threading.Event().wait(0.002)


class Noting:
    """A clock that stands still, and until when it was slept."""

    def __init__(self) -> None:
        self.until: list[float] = []

    def now(self) -> float:
        return 5.0

    def sleep_until(self, time_s: float) -> None:
        self.until.append(time_s)


def test_executor_thread_sleeps_only_if_it_did_not_wait_at_rest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At rest the executor has slept by itself, until something rang: its tick must not come later still."""
    rig, noting, enough = Simulated(), Noting(), threading.Event()
    rested = [True, False, True]

    def rest() -> bool:
        if len(rested) == 1:
            enough.set()
        return rested.pop(0) if rested else True

    monkeypatch.setattr(rig.executor, "wait_at_rest", rest)
    thread = ExecutorThread(rig.executor, noting, tick=0.01)
    thread.start()
    assert enough.wait(60.0)
    thread.close()
    assert noting.until == [5.01]


def test_end_of_another_thread_is_reported_once() -> None:
    name = "ends-in-this-test"
    rig = Simulated()
    ending = threading.Event()
    other = threading.Thread(target=ending.wait, name=name, daemon=True)
    other.start()
    told: list[str] = []
    dog = Watchdog(Ticked(rig.executor), None, (name, "never-there"), told.append)  # type: ignore[arg-type]
    dog.check_threads()
    assert told == []
    ending.set()
    other.join()
    assert not is_python_thread_alive(name)
    for _ in range(3 * EXECUTOR_CHECKS_PER_THREAD_CHECK):
        dog.check_threads()
    assert told == [name]


def test_a_thread_that_starts_after_the_watchdog_is_supervised() -> None:
    """In whatever order they are started; one that is announced also when it ends before the next look."""
    rig, ending, told = Simulated(), threading.Event(), list[str]()
    dog = Watchdog(Ticked(rig.executor), None, ("late-in-this-test",), told.append)  # type: ignore[arg-type]
    for _ in range(EXECUTOR_CHECKS_PER_THREAD_CHECK):
        dog.check_threads()
    late = threading.Thread(target=ending.wait, name="late-in-this-test", daemon=True)
    late.start()
    for _ in range(EXECUTOR_CHECKS_PER_THREAD_CHECK):
        dog.check_threads()
    ending.set()
    late.join()
    dog.watch_thread("gone-before-the-next-look")
    for _ in range(EXECUTOR_CHECKS_PER_THREAD_CHECK):
        dog.check_threads()
    assert sorted(told) == ["gone-before-the-next-look", "late-in-this-test"]


def test_drivers_that_block_during_halt_do_not_delay_the_alarm() -> None:
    rig, control = cutting("simulated")
    released, calls = threading.Event(), list[int]()

    def blocks() -> None:
        calls.append(1)
        released.wait()

    dog, thread = watched(control.executor, blocks)
    thread.is_alive = False

    def look() -> None:
        for _ in range(3 * CHECKS_BETWEEN_HALTS):
            dog.check_threads()

    looking = threading.Thread(target=look, daemon=True)
    looking.start()
    looking.join(10.0)
    returned, alarms = not looking.is_alive(), control.shot.alarms
    released.set()
    assert returned
    assert [alarm.code for alarm in alarms] == ["control-silent"]
    assert len(calls) == 1  # another call of drivers that block would block as well
    rig.close()


@pytest.mark.parametrize("looks", [True, False], ids=["looks", "hangs"])
def test_executor_reports_a_watchdog_that_stops_checking(looks: bool) -> None:
    rig, told = Simulated(), list[str]()
    dog, _ = watched(rig.executor, None)
    watch = WatchdogSupervisor(dog, told.append)
    for tick in range(1000):
        if looks and tick % 10 == 0:
            dog.check_threads()
        watch.check_watchdog(tick * TICK)
    assert told == ([] if looks else [WATCHDOG_THREAD_NAME])


def test_late_computer_is_not_reported_as_a_dead_watchdog() -> None:
    rig, told = Simulated(), list[str]()
    dog, _ = watched(rig.executor, None)
    watch = WatchdogSupervisor(dog, told.append)
    for minute in range(10):
        watch.check_watchdog(minute * 60.0)
    assert told == []


def test_close_does_not_wait_for_a_hung_executor_and_halts_the_machine() -> None:
    """The thread hangs in a driver: it is left, and the drivers stop the machine in their own way."""
    rig, hangs, released = Simulated(), threading.Event(), threading.Event()

    def hang() -> None:
        hangs.set()
        released.wait()

    rig.start(CUT)
    rig.until_true(lambda shot: shot.actual[1] < -3.0)
    thread = ExecutorThread(rig.executor, Waiting(rig), tick=0.01)
    rig.executor.run_tick = hang  # type: ignore[method-assign]
    thread.start()
    assert hangs.wait(60.0)
    thread.close(timeout_s=0.0)
    rig.clock.advance(3.0)
    alive, rpm = thread.is_alive, rig.sim.machine.get_spindle_rpm()
    released.set()
    assert alive
    assert rpm == 0.0
    assert not rig.sim.ports.axes.sample().enabled


def test_close_does_not_wait_for_a_hung_watchdog() -> None:
    rig, released, hangs = Simulated(), threading.Event(), threading.Event()

    def hang(_name: str) -> None:
        hangs.set()
        released.wait()

    dog = Watchdog(Ticked(rig.executor), None, (), hang)  # type: ignore[arg-type]
    dog.watch_thread("not-there")
    dog.start()
    assert hangs.wait(60.0)
    dog.stop_checks()
    dog.close(timeout_s=0.0)
    alive = dog.is_alive
    released.set()
    assert alive


def test_watchdog_raises_the_alarm_even_if_its_driver_fails() -> None:
    rig, control = cutting("simulated")

    def broken() -> None:
        raise ValueError("no way")

    dog, thread = watched(control.executor, broken)
    thread.is_alive = False
    for _ in range(20):
        dog.check_threads()
    assert control.shot.alarms[0].code == "control-silent"
    rig.close()

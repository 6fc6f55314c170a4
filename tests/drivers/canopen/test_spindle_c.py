"""C on the spindle's own drive: changed over at standstill, turned to its place, and given back."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from app.compose.backends.connection import connect_machine
from core.executor.commands import CycleStart, EnableDrives, FeedHold, Jog, Reset
from core.executor.snapshot import MachineState
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.canopen.canopen_spindle import CanopenCAxis, CAxisModeStep
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine
from tests.drivers.canopen.test_executor import BusRig
from tests.texts import text

CHANGES = (
    ("two_hand_start = true", "two_hand_start = false"),
    ("spindle = { id = 3 }", "spindle = { id = 3, counts_per_rev = 18000 }"),
    ("in rpm, amax in rpm/s\nenabled = false", "in rpm, amax in rpm/s\nenabled = true"),
)


def c_machine(*changes: tuple[str, str]) -> Machine:
    """The shipped machine whose spindle's drive is C."""
    return can_machine(*CHANGES, *changes)


class CBench(CanBench):
    """Drives on."""

    @property
    def c(self) -> CanopenCAxis:
        assert self.machine.spindle_c is not None
        return self.machine.spindle_c

    def degrees(self) -> float:
        """Where the spindle really is from its index, 0…360."""
        return self.peers.plant.spindle.revolutions * 360.0 % 360.0

    def hold(self, *, orient: bool) -> None:
        self.c.set_c_mode(True, orient)
        self.until(self.c.is_c_ready, 20.0)


@pytest.fixture
def stand() -> Iterator[CBench]:
    made = CBench(c_machine())
    made.machine.axes.enable(True)
    yield made
    made.close()


def stopped_somewhere(stand: CBench, rpm: float = 700.0) -> float:
    """It has turned as the spindle; where it stands."""
    stand.machine.ports.spindle.set_speed(rpm)
    stand.run(1.13)
    stand.machine.ports.spindle.set_speed(0.0)
    stand.run(2.0)
    return stand.degrees()


def test_spindle_engaged_as_c_without_orienting_does_not_turn(stand: CBench) -> None:
    at = stopped_somewhere(stand)
    stand.hold(orient=False)
    assert stand.degrees() == pytest.approx(at, abs=0.1)
    assert stand.machine.axes.sample().actual[2] == pytest.approx(0.0, abs=0.1)
    assert stand.peers.plant.spindle_drive is not None
    assert stand.peers.plant.spindle_drive.power_states.is_powered  # it holds


def test_spindle_engaged_as_c_with_orienting_turns_to_its_index(stand: CBench) -> None:
    stopped_somewhere(stand)
    stand.hold(orient=True)
    off = (stand.degrees() + 180.0) % 360.0 - 180.0
    assert off == pytest.approx(0.0, abs=0.1)
    assert stand.machine.axes.sample().actual[2] == pytest.approx(0.0, abs=0.1)


def test_orientation_works_with_a_clock_that_advances_on_every_read(
    stand: CBench, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = ManualClock.now

    def creeping(clock: ManualClock) -> float:
        clock.advance(2e-6)
        return plain(clock)

    monkeypatch.setattr(ManualClock, "now", creeping)
    stopped_somewhere(stand)
    stand.hold(orient=True)
    assert (stand.degrees() + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.1)


def test_index_is_searched_only_once(stand: CBench) -> None:
    stand.hold(orient=True)
    stand.c.set_c_mode(False)
    stand.until(lambda: stand.c.step is CAxisModeStep.SPINDLE_MODE, 5.0)
    seen: list[CAxisModeStep] = []
    stopped_somewhere(stand, -1234.0)
    stand.c.set_c_mode(True, True)
    for _ in range(1000):
        stand.tick()
        if stand.c.step not in seen:
            seen.append(stand.c.step)
    assert CAxisModeStep.FIND_INDEX not in seen
    assert stand.c.is_c_ready()
    off = (stand.degrees() + 180.0) % 360.0 - 180.0
    assert off == pytest.approx(0.0, abs=0.15)


def test_spindle_turns_again_only_after_c_mode_ends(stand: CBench) -> None:
    stand.hold(orient=False)
    with raises_code(DriverError, "spindle-off") as told:
        stand.machine.ports.spindle.set_speed(500.0)
    assert told.value.reason == "held-as-c"
    stand.c.set_c_mode(False)
    stand.machine.ports.spindle.set_speed(500.0)
    stand.run(0.02)
    assert stand.peers.machine.get_spindle_rpm() == 0.0
    stand.until(lambda: stand.c.step is CAxisModeStep.SPINDLE_MODE, 5.0)
    stand.run(1.5)
    assert stand.peers.machine.get_spindle_rpm() == pytest.approx(500.0, abs=2.0)


def test_c_mode_is_rejected_while_the_spindle_turns(stand: CBench) -> None:
    stand.machine.ports.spindle.set_speed(300.0)
    stand.run(1.0)
    with raises_code(DriverError, "c-coupling") as told:
        stand.c.set_c_mode(True)
    assert told.value.reason == "spindle-turns"
    stand.machine.ports.spindle.set_speed(0.0)
    stand.run(0.05)
    with raises_code(DriverError, "c-coupling") as told:
        stand.c.set_c_mode(True)
    assert told.value.reason == "spindle-turns"


def test_c_mode_is_rejected_without_power() -> None:
    stand = CBench(c_machine())
    with raises_code(DriverError, "c-coupling") as told:
        stand.c.set_c_mode(True)
    assert told.value.reason == "drives-off"
    stand.close()


def test_estop_ends_c_mode_and_nothing_turns_on_release(stand: CBench) -> None:
    stand.hold(orient=False)
    stand.peers.machine.press_estop()
    stand.machine.ports.spindle.start_coasting()
    stand.run(2.0)
    assert not stand.c.is_c_ready()
    stand.peers.machine.release_estop()
    stand.run(2.0)
    assert stand.c.step is CAxisModeStep.SPINDLE_MODE
    assert stand.peers.plant.spindle_drive is not None
    assert not stand.peers.plant.spindle_drive.power_states.is_powered


@pytest.mark.parametrize(
    "step", [CAxisModeStep.FIND_INDEX, CAxisModeStep.SET_POSITION, CAxisModeStep.ENGAGED]
)
def test_closing_in_any_step_of_c_mode_disables_the_spindle_drive(stand: CBench, step: CAxisModeStep) -> None:
    drive = stand.peers.plant.spindle_drive
    assert drive is not None
    stand.c.set_c_mode(True, True)
    stand.until(lambda: stand.c.step is step, 20.0)
    stand.machine.close()
    for _ in range(200):
        stand.clock.advance(0.005)
        stand.peers.process_frames()
    assert not drive.power_states.is_powered


def test_spindle_drive_without_the_c_modes_is_rejected_at_connection() -> None:
    stand = CBench(c_machine())
    assert stand.peers.plant.spindle_drive is not None
    stand.peers.plant.spindle_drive.can_position = False
    assert stand.machine.spindle is not None
    with raises_code(DriverError, "drive-setup", "spindle: ", "homing", "interpolated position"):
        stand.machine.spindle.connect()
    stand.close()


# --- through the executor ---------------------------------------------------------------------------------


@pytest.fixture
def rig() -> Iterator[BusRig]:
    made = BusRig(c_machine())
    yield made
    made.bench.close()


def degrees(rig: BusRig) -> float:
    return rig.bench.peers.plant.spindle.revolutions * 360.0 % 360.0


def test_a_program_turns_then_positions_then_turns_again(rig: BusRig) -> None:
    rig.start(
        "G90G94F300\nM03S900\nG04F1\nM05\nM19\nC90S60\nG04F1\nX.1Z-.1C180\nG04F1\nM05\nM03S600\nG04F2\nM05\nM30"
    )
    at: dict[str, float] = {}

    def note(shot: object) -> None:
        del shot
        if rig.shot.waiting_for == "DWELL":
            at[rig.shot.block_text + str(rig.shot.line)] = degrees(rig)

    rig.watch.append(note)
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=90.0)
    assert rig.shot.alarms == ()
    angles = list(at.values())
    assert any(abs(angle - 90.0) < 0.2 for angle in angles), at
    assert any(abs(angle - 180.0) < 0.2 for angle in angles), at


def test_axes_move_while_c_is_stationary(rig: BusRig) -> None:
    rig.start("G90G94F300\nM19\nG01X.2Z-.5F60\nX0Z0\nM05\nM30")
    turned: list[float] = []
    rig.watch.append(lambda shot: turned.append(degrees(rig)) if shot.velocity > 5.0 else None)
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    assert rig.shot.alarms == ()
    assert len(turned) > 20
    assert max((t + 180.0) % 360.0 for t in turned) - min((t + 180.0) % 360.0 for t in turned) < 0.1


def test_x_and_c_together_follow_their_path(rig: BusRig) -> None:
    rig.start("G90G94F300\nM19\nG04F1\nG01X.5C360F30\nG04F1\nM05\nM30")
    off: list[float] = []

    def note(_shot: object) -> None:
        x = rig.bench.peers.machine.get_true_positions()[0]
        if rig.state is MachineState.RUN and 0.5 < x < 12.0:
            off.append(((degrees(rig) - x / 12.7 * 360.0) + 180.0) % 360.0 - 180.0)

    rig.watch.append(note)
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    assert rig.shot.alarms == ()
    assert len(off) > 50
    # X trails its setpoint by the servo's lag, C does not: 12.7 mm/s times 8 ms is .1 mm, 3 degrees
    assert max(off) - min(off) < 0.6


def test_feed_hold_and_reset_stop_a_c_move(rig: BusRig) -> None:
    rig.start("G90G94F300\nM19\nC3600S100\nM05\nM30")
    rig.until_true(lambda shot: shot.demand[2] > 200.0, limit=40.0)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD, limit=1.0)
    rig.run(0.3)
    at = degrees(rig)
    rig.run(1.0)
    assert degrees(rig) == pytest.approx(at, abs=0.01)
    rig.post(Reset())
    rig.until(MachineState.IDLE, limit=3.0)
    rig.run(3.0)
    assert rig.bench.machine.spindle_c is not None
    assert rig.bench.machine.spindle_c.step is CAxisModeStep.SPINDLE_MODE
    assert rig.shot.alarms == ()


def once_in(rig: BusRig, c: CanopenCAxis, step: CAxisModeStep, do: Callable[[], None]) -> None:
    """Do this as the step begins: between two ticks it may have begun and ended."""
    begun: list[CAxisModeStep] = []
    enter = c._enter

    def entered(new: CAxisModeStep, now: float) -> None:
        enter(new, now)
        if new is step and not begun:
            begun.append(new)
            do()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(c, "_enter", entered)
        rig.until_true(lambda _: bool(begun), limit=60.0)


@pytest.mark.parametrize(
    "step", [CAxisModeStep.FIND_INDEX, CAxisModeStep.SET_POSITION, CAxisModeStep.TURN_TO_POSITION]
)
def test_hold_during_c_engagement_stops_it_and_cycle_start_repeats_it(
    rig: BusRig, step: CAxisModeStep
) -> None:
    c = rig.bench.machine.spindle_c
    assert c is not None
    rig.start("G90G94F300\nM03S777\nG04F1\nM05\nM19\nC90S60\nG04F2\nM05\nM30")
    once_in(rig, c, step, lambda: rig.post(FeedHold()))
    rig.until(MachineState.HOLD, limit=1.0)
    rig.run(0.3)
    at = degrees(rig)
    rig.run(2.0)
    assert degrees(rig) == pytest.approx(at, abs=0.01)
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.waiting_for == "DWELL", limit=60.0)
    rig.run(0.2)
    assert degrees(rig) == pytest.approx(90.0, abs=0.2)
    rig.until(MachineState.IDLE, limit=30.0)
    assert rig.shot.alarms == ()


def test_missing_spindle_index_raises_an_alarm(rig: BusRig, monkeypatch: pytest.MonkeyPatch) -> None:
    drive = rig.bench.peers.plant.spindle_drive
    assert drive is not None
    monkeypatch.setattr(
        drive.spindle_servo,
        "set_home_position",
        lambda _method: setattr(drive.spindle_servo, "switch", 1e9),
    )
    rig.start("G90G94F300\nM19\nC90S60\nM05\nM30")
    rig.until(MachineState.FAULT, limit=30.0)
    assert rig.shot.alarms[-1].code == "c-coupling"
    assert "index" in rig.shot.alarms[-1].cause
    rig.run(3.0)
    assert not drive.power_states.is_powered


def test_spindle_revolutions_do_not_jump_with_the_drive_counter(rig: BusRig) -> None:
    rig.start("G90G94F300\nM19\nM05\nM03S777\nG04F1\nM05\nM89\nG04F1\nM05\nM30")
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    angle = rig.bench.machine.ports.spindle.read_angle()
    assert angle is not None
    assert rig.shot.alarms == ()
    assert angle[1] == pytest.approx(
        rig.bench.peers.plant.spindle.revolutions, abs=1.01
    )  # the search is not counted


def test_m89_locks_the_spindle_at_its_present_angle(rig: BusRig) -> None:
    rig.start("G90G94F300\nM03S777\nG04F1\nM05\nG04F1\nM89\nG04F1\nG91C90S60\nG04F2\nM05\nM30")
    seen: list[float] = []
    rig.watch.append(lambda shot: seen.append(degrees(rig)) if shot.waiting_for == "DWELL" else None)
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    assert rig.shot.alarms == ()
    assert (seen[-1] - seen[-250]) % 360.0 == pytest.approx(90.0, abs=0.2)


def test_c_mode_works_through_the_driver_host() -> None:
    clock = ManualClock()
    machine = c_machine()
    connected = connect_machine(machine, clock)
    lock, axes = connected.ports.lock, connected.ports.axes
    assert lock is not None
    link = connected.ports.spindle
    axes.enable(True)

    def run(seconds: float) -> None:
        end = clock.now() + seconds
        while clock.now() < end:
            clock.advance(0.005)
            axes.sample()

    lock.set_c_mode(True, should_orient=True)
    run(8.0)
    assert lock.is_c_ready()
    with raises_code(DriverError, "spindle-off") as told:
        link.set_speed(100.0)
    assert told.value.reason == "held-as-c"
    lock.set_c_mode(False)
    run(3.0)
    assert not lock.is_c_ready()
    link.set_speed(100.0)
    run(1.5)
    assert link.speed() == pytest.approx(100.0, abs=2.0)
    connected.close()


def test_fault_of_the_spindle_drive_as_c_stops_all_axes(rig: BusRig) -> None:
    rig.start("G90G94F300\nM19\nG01X.5C3600F10\nM05\nM30")
    rig.until_true(lambda shot: shot.demand[2] > 200.0, limit=40.0)
    rig.bench.peers.machine.spindle_fault("blocked")
    rig.until(MachineState.FAULT, limit=0.3)
    rig.run(2.0)
    assert not any(drive.power_states.is_powered for drive in rig.bench.peers.plant.axis_drives.values())
    rig.bench.peers.machine.spindle_fault("")
    rig.post(Reset())
    rig.until(MachineState.DISABLED, limit=2.0)
    rig.post(EnableDrives())
    rig.until(MachineState.IDLE, limit=2.0)
    rig.run(1.0)
    assert rig.shot.alarms == ()


def test_c_jog_waits_for_c_engagement(rig: BusRig) -> None:
    rig.ready()
    rig.post(Jog("C", 60.0, 0.2))
    assert text("executor.becomes-c") in rig.said("refused")[-1]
    rig.run(2.0)
    rig.post(Jog("C", 60.0, 0.2))
    rig.until(MachineState.JOG)
    rig.until(MachineState.IDLE, limit=2.0)
    assert 2.0 < rig.shot.demand[2] < 20.0
    rig.run(0.3)
    assert degrees(rig) == pytest.approx(rig.shot.demand[2], abs=0.1)


def test_drive_that_restarts_as_c_returns_to_spindle_mode_without_index(rig: BusRig) -> None:
    rig.start("G90G94F300\nM19\nG04F60\nM05\nM30")
    c = rig.bench.machine.spindle_c
    assert c is not None
    rig.until_true(lambda _: c.is_c_ready(), limit=30.0)
    rig.bench.peers.nodes["spindle"].boot_up()
    rig.until(MachineState.FAULT, limit=0.5)
    assert rig.shot.alarms[-1].code == "spindle"
    assert rig.shot.alarms[-1].cause.startswith("spindle: ")
    rig.run(3.0)
    rig.post(Reset())
    rig.until(MachineState.DISABLED, limit=5.0)
    rig.run(1.0)
    assert c.step is CAxisModeStep.SPINDLE_MODE
    seen: list[CAxisModeStep] = []
    rig.watch.append(lambda _shot: seen.append(c.step))
    rig.start("G90G94F300\nM03S600\nG04F1\nM05\nM19\nG04F1\nM05\nM30")
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=60.0)
    assert rig.shot.alarms == ()
    assert CAxisModeStep.FIND_INDEX in seen


@pytest.mark.parametrize(
    "step",
    [
        CAxisModeStep.FIND_INDEX,
        CAxisModeStep.SET_POSITION,
        CAxisModeStep.POWER_ON,
        CAxisModeStep.TURN_TO_POSITION,
        CAxisModeStep.ENGAGED,
    ],
)
def test_estop_in_every_step_of_c_engagement_is_recoverable(rig: BusRig, step: CAxisModeStep) -> None:
    c, drive = rig.bench.machine.spindle_c, rig.bench.peers.plant.spindle_drive
    assert c is not None
    assert drive is not None
    rig.start("G90G94F300\nM03S777\nG04F1\nM05\nM19\nG04F60\nM05\nM30")
    rig.watch.append(lambda _shot: None)
    once_in(rig, c, step, rig.bench.peers.machine.press_estop)
    rig.until(MachineState.ESTOP, limit=0.2)
    rig.run(3.0)
    assert not drive.power_states.is_powered
    assert c.step is CAxisModeStep.SPINDLE_MODE
    rig.bench.peers.machine.release_estop()
    rig.run(1.0)
    rig.post(EnableDrives())
    rig.until(MachineState.IDLE, limit=2.0)
    at = degrees(rig)
    rig.run(2.0)
    assert degrees(rig) == at
    assert not drive.power_states.is_powered
    rig.start("G90G94F300\nM03S600\nG04F1\nM05\nM30")
    rig.until(MachineState.IDLE, MachineState.FAULT, limit=30.0)
    assert rig.shot.alarms == ()

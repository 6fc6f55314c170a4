"""The operator station on the bus, through the executor: buttons, pots, switch, handwheel, failures."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from core.executor.commands import CycleStart, DeselectHandwheel, EnableDrives, SelectHandwheel
from core.executor.snapshot import MachineState
from tests.drivers.canopen.bench import can_machine
from tests.drivers.canopen.test_executor import OVER, BusRig, under_way
from tests.executor.rig import INCH
from tests.texts import text

ONE_HAND = ("two_hand_start = true", "two_hand_start = false")
THOU = 0.001 * INCH
LEASE = 0.25


@pytest.fixture
def make() -> Iterator[Callable[..., BusRig]]:
    """Rigs that are closed at the end."""
    made: list[BusRig] = []

    def build(*changes: tuple[str, str]) -> BusRig:
        made.append(BusRig(can_machine(*changes)))
        return made[-1]

    yield build
    for rig in made:
        rig.bench.close()


# --- start and hold ---------------------------------------------------------------------------------------


def test_start_signal_present_at_power_up_is_not_a_press(make: Callable[..., BusRig]) -> None:
    rig = make()
    rig.bench.peers.machine.press_left()
    rig.bench.peers.machine.press_right()
    rig.bench.run(0.1)
    rig.executor = type(rig.executor)(rig.machine, rig.bench.machine.ports, rig.events.append)
    rig.ready()
    rig.load(OVER)
    rig.run(0.5)
    assert rig.state is MachineState.IDLE
    rig.bench.peers.machine.release_left()
    rig.bench.peers.machine.release_right()
    rig.run(0.4)
    rig.bench.peers.machine.press_start()
    rig.until(MachineState.RUN, limit=0.5)


def test_palm_button_tied_down_allows_only_one_cycle(make: Callable[..., BusRig]) -> None:
    rig = make()
    rig.ready()
    rig.load("G90G94F300\nX.05\nM30")
    rig.bench.peers.machine.press_left()
    rig.bench.peers.machine.press_right()
    rig.until(MachineState.RUN, limit=0.5)
    rig.until(MachineState.IDLE, limit=5.0)
    rig.bench.peers.machine.release_right()
    rig.run(0.4)
    rig.bench.peers.machine.press_right()
    rig.run(0.5)
    assert rig.state is MachineState.IDLE
    assert rig.shot.parts == 1


def test_palms_pressed_more_than_half_a_second_apart_do_not_start(make: Callable[..., BusRig]) -> None:
    rig = make()
    rig.ready()
    rig.load(OVER)
    rig.bench.peers.machine.press_left()
    rig.run(0.55)
    rig.bench.peers.machine.press_right()
    rig.run(0.5)
    assert rig.state is MachineState.IDLE


def test_hold_button_stops_on_the_path_and_bars_start_while_pressed(make: Callable[..., BusRig]) -> None:
    rig = make(ONE_HAND)
    under_way(rig)
    rig.bench.peers.machine.press_hold()
    assert rig.until(MachineState.HOLD) < 0.3
    rig.bench.peers.machine.press_start()
    rig.run(0.5)
    assert rig.state is MachineState.HOLD
    assert rig.shot.start_refusal_reason == text("executor.hold-pressed")
    rig.bench.peers.machine.release_hold()
    rig.run(0.5)
    rig.bench.peers.machine.press_start()
    rig.until(MachineState.RUN, limit=0.5)


def test_a_broken_estop_wire_is_an_estop(
    make: Callable[..., BusRig], monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = make(ONE_HAND)
    under_way(rig)
    board = rig.bench.peers.nodes["io"].device
    whole = board.read

    def broken(index: int, sub: int) -> int | None:
        value = whole(index, sub)
        return value & ~1 if value is not None and (index, sub) == (0x6000, 1) else value

    monkeypatch.setattr(board, "read", broken)
    rig.until(MachineState.ESTOP, limit=0.1)
    rig.run(1.0)
    assert not any(drive.power_states.is_powered for drive in rig.bench.peers.plant.axis_drives.values())
    monkeypatch.undo()
    rig.run(0.5)
    assert rig.state is MachineState.DISABLED


# --- pots and switch --------------------------------------------------------------------------------------


def test_lower_feed_pot_acts_immediately_and_higher_after_settling(
    make: Callable[..., BusRig],
) -> None:
    rig = make(ONE_HAND)
    under_way(rig, 0.2)
    rig.bench.peers.machine.set_feed_pot(0.5)
    rig.run(0.02)
    assert rig.shot.feed_override == pytest.approx(0.5, abs=0.01)
    rig.bench.peers.machine.set_feed_pot(1.0)
    rig.run(0.2)
    assert rig.shot.feed_override == pytest.approx(0.5, abs=0.01)
    rig.run(0.2)
    assert rig.shot.feed_override == pytest.approx(1.0, abs=0.01)
    assert rig.state is MachineState.RUN


def test_jumping_pot_signal_causes_a_feed_hold(make: Callable[..., BusRig]) -> None:
    rig = make(ONE_HAND)
    under_way(rig, 0.2)
    rig.bench.peers.machine.pot_noise(0.6)
    rig.until(MachineState.HOLD, limit=2.0)
    assert text("executor.pot-jumps") in " ".join(event.text for event in rig.events)
    assert rig.shot.alarms == ()


def test_a_module_that_is_silent_stops_everything(make: Callable[..., BusRig]) -> None:
    rig = make(ONE_HAND)
    under_way(rig, 0.2)
    rig.bench.peers.nodes["io"].is_silent = True
    rig.until(MachineState.FAULT, limit=0.6)
    assert "io: " in rig.shot.alarms[-1].cause
    rig.run(1.0)
    assert not rig.bench.peers.plant.terminals.output_states["coolant"]


def test_spindle_switch_and_pot_control_the_spindle(make: Callable[..., BusRig]) -> None:
    rig = make(ONE_HAND)
    rig.start("G90G94F50\nM03S2000\nG04F60\nM30")
    rig.until_true(lambda shot: abs(shot.rpm_actual - 2000.0) < 20.0, limit=5.0)
    rig.bench.peers.machine.set_spindle_pot(0.25)
    rig.until_true(lambda shot: abs(shot.rpm_actual - 500.0) < 10.0, limit=3.0)
    rig.bench.peers.machine.set_spindle_auto(False)
    rig.until_true(lambda shot: abs(shot.rpm_actual) < 5.0, limit=3.0)
    assert not rig.shot.spindle_auto
    rig.bench.peers.machine.set_spindle_auto(True)
    rig.until_true(lambda shot: bool(shot.announced), limit=3.0)  # the switch alone starts nothing
    rig.run(0.5)
    assert abs(rig.shot.rpm_actual) < 5.0
    rig.post(CycleStart())
    rig.until_true(lambda shot: abs(shot.rpm_actual - 500.0) < 10.0, limit=3.0)
    rig.bench.peers.machine.set_spindle_auto(False)
    rig.until_true(lambda shot: abs(shot.rpm_actual) < 5.0, limit=3.0)
    rig.bench.peers.machine.press_estop()
    rig.run(0.3)
    rig.bench.peers.machine.release_estop()
    rig.bench.peers.machine.set_spindle_auto(True)  # what E-stop took does not come back by a switch
    rig.post(EnableDrives())
    rig.run(2.0)
    assert abs(rig.shot.rpm_actual) < 5.0


# --- handwheel --------------------------------------------------------------------------------------------


WHEEL = ("spindle_pot = {", 'handwheel = { at = "401.6401.3", counts_per_click = 4 }\nspindle_pot = {')


class Turned(BusRig):
    """Its page holds the wheel on Z."""

    page: SelectHandwheel | None = None

    def tick(self, dt: float | None = None) -> None:
        if self.page is not None:
            self.executor.post(self.page)
        super().tick(dt)

    def spin(self, clicks: int) -> None:
        for _ in range(abs(clicks)):
            self.bench.peers.machine.turn_handwheel(4 if clicks > 0 else -4)
            self.tick()


@pytest.fixture
def turned() -> Iterator[Turned]:
    rig = Turned(can_machine(WHEEL, ONE_HAND))
    rig.ready()
    rig.page = SelectHandwheel("Z", THOU, LEASE)
    rig.run(0.3)
    assert rig.shot.wheel == "Z"
    yield rig
    rig.bench.close()


def test_handwheel_clicks_over_the_bus_are_thousandths_of_an_inch(turned: Turned) -> None:
    turned.spin(25)
    turned.until(MachineState.IDLE, limit=2.0)
    turned.run(0.3)
    assert turned.shot.demand[1] == pytest.approx(25 * THOU, abs=1e-6)
    assert turned.bench.peers.machine.get_true_positions()[1] == pytest.approx(25 * THOU, abs=0.00254)
    turned.spin(-25)
    turned.until(MachineState.IDLE, limit=2.0)
    turned.run(0.3)
    assert turned.shot.demand[1] == pytest.approx(0.0, abs=1e-6)


def test_handwheel_continues_when_its_counter_wraps(turned: Turned) -> None:
    turned.page = None
    turned.run(0.5)
    turned.bench.peers.machine.turn_handwheel(32766)
    turned.run(0.2)
    turned.post(EnableDrives())
    turned.post(DeselectHandwheel())
    turned.page = SelectHandwheel("Z", THOU, LEASE)
    turned.run(0.3)
    turned.spin(10)
    turned.run(1.0)
    assert turned.shot.demand[1] == pytest.approx(10 * THOU, abs=1e-6)


def test_disconnected_handwheel_module_stops_the_axis(turned: Turned) -> None:
    turned.spin(50)
    turned.bench.peers.cable(is_disconnected=True)
    turned.spin(100)
    turned.until(MachineState.FAULT, limit=1.0)
    assert turned.shot.wheel == ""
    turned.run(0.5)
    assert turned.bench.peers.machine.get_true_positions()[1] < 100 * THOU


def test_restarted_handwheel_module_moves_nothing(turned: Turned) -> None:
    turned.spin(50)
    turned.until(MachineState.IDLE, limit=2.0)
    at = turned.bench.peers.machine.get_true_positions()[1]
    turned.bench.peers.nodes["io"].boot_up()
    turned.bench.peers.machine.turn_handwheel(-200)  # back to 0
    turned.run(1.0)
    assert turned.state is MachineState.FAULT
    assert turned.bench.peers.machine.get_true_positions()[1] == pytest.approx(at, abs=1e-3)

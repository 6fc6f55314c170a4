"""A spindle that its driver brings to an angle: nothing moves before it is held there, whatever breaks."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

import resources
from app.compose.machine.machine_files import load_shipped_machine, parse_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import create_proof
from core.executor.commands import LoadJob
from core.executor.job import make_job
from core.executor.snapshot import MachineState
from core.faults import SPINDLE_TURNS
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.ports import DriverError
from core.proving.prove_program import prove
from core.table_schema import MachineFileError
from tests.coded import raises_code
from tests.drivers.contract import hal
from tests.drivers.contract.control import Control
from tests.drivers.contract.hal import Hal
from tests.drivers.contract.rig import STILL, Rig
from tests.drivers.contract.rigs import RIGS
from tests.drivers.contract.simulated import Fed, Simulated
from tests.texts import text

LATHE = load_shipped_machine("sinumerik-modulo")
ABLE: dict[str, Callable[[], Simulated | Fed | Hal]] = {
    "simulated": lambda: Simulated(LATHE),
    "fed": lambda: Fed(LATHE),
    "hal": lambda: Hal(orients=True),
}
PROGRAM = "T1 D1\nG90 G94 G18 G71\nS600 M3\nG0 Z-10\nSPOS=90\nG1 Z-30 F1200\nM30\n"
ROUND = 360.0


@pytest.fixture(params=ABLE)
def control(request: pytest.FixtureRequest) -> Iterator[Control]:
    rig = ABLE[request.param]()
    yield Control(rig)
    rig.close()


def start(control: Control) -> None:
    """The program proved, and begun; until the spindle is asked for its angle."""
    control.ready()
    machine = control.rig.machine
    job = make_job(
        ProgramSource("PART.MPF", PROGRAM),
        create_power_up_setup(machine, tool_offsets={1: ToolOffset(quadrant=3)}, secondary_offsets={}),
    )
    proof = create_proof(job, prove(job.source, job.setup, machine))
    assert not proof.errors, proof.errors
    control.post(LoadJob(job, proof))
    control.press()
    control.until_true(lambda shot: shot.waiting_for == text("executor.spindle-orient"))


def at(rig: Rig) -> float:
    """Degrees from the index, in truth."""
    return rig.slides.spindle_turns() % 1.0 * ROUND


def test_feed_starts_after_the_spindle_is_oriented(control: Control) -> None:
    start(control)
    feeding: list[tuple[float, float]] = []

    def watch(_: object) -> None:
        if control.world.place()[1] < -10.5:
            feeding.append((at(control.rig), control.world.rpm()))

    control.watch.append(watch)
    control.until(MachineState.IDLE)
    assert control.world.place()[1] == pytest.approx(-30.0, abs=0.01)
    assert len(feeding) > 50
    assert all(abs(angle - 90.0) < 0.1 and rpm == 0.0 for angle, rpm in feeding[:50])


def test_orientation_that_never_completes_is_one_alarm_without_motion(control: Control) -> None:
    control.rig.slides.spindle_never_oriented()
    start(control)
    place = control.world.place()
    control.until(MachineState.FAULT)
    assert [alarm.code for alarm in control.shot.alarms] == ["spindle-orient"]
    control.run(0.5)
    assert control.world.place() == pytest.approx(place, abs=STILL)


def test_drive_that_loses_its_angle_stops_the_axes(control: Control) -> None:
    start(control)
    control.until_true(lambda _: control.world.place()[1] < -12.0)
    control.rig.slides.spindle_never_oriented()
    control.until(MachineState.FAULT, limit=0.5)
    assert [alarm.code for alarm in control.shot.alarms] == ["spindle-orient"]
    control.run(0.5)
    assert control.world.place()[1] > -25.0


def test_estop_during_orientation_stops_the_spindle_where_it_is(control: Control) -> None:
    start(control)
    control.until_true(lambda _: control.rig.slides.get_spindle_rpm() != 0.0)
    control.world.press_estop()
    control.until(MachineState.ESTOP, limit=0.5)
    control.run(0.3)
    assert control.nothing_moves()


@pytest.mark.parametrize("fault", ["silence", "dead reader", "garbage"])
def test_connection_lost_during_orientation_raises_one_alarm(control: Control, fault: str) -> None:
    if fault not in control.rig.faults:
        pytest.skip("the simulated machine is in this process: there is no wire")
    start(control)
    place = control.world.place()
    control.rig.acts()[fault]()
    control.until(MachineState.FAULT, limit=1.0)
    codes = [alarm.code for alarm in control.shot.alarms]
    assert len(codes) == 1
    assert codes != ["spindle-orient"]
    control.run(1.5)
    assert control.world.place() == pytest.approx(place, abs=STILL)
    assert control.world.rpm() == 0.0


@pytest.mark.parametrize("held", [True, False], ids=["held", "on its way"])
def test_short_control_pause_does_not_interrupt_orientation(control: Control, held: bool) -> None:
    """What is held stays so, with the tool in the cut; a way that has been cut short is begun again."""
    start(control)
    if held:
        control.until_true(lambda _: control.world.place()[1] < -12.0)
    for _ in range(300 if held else 60):  # a queue is played to its end before anything is switched off
        control.rig.alone(0.01)
    if held:
        assert at(control.rig) == pytest.approx(90.0, abs=0.1)
    control.until(MachineState.HOLD, MachineState.IDLE)
    if control.state is MachineState.HOLD:
        control.run(0.5)
        control.press()
        control.until(MachineState.IDLE)
    assert control.shot.alarms == ()
    assert control.world.place()[1] == pytest.approx(-30.0, abs=0.01)


def test_late_replies_only_delay_orientation(control: Control) -> None:
    if "late answers" not in control.rig.harmless:
        pytest.skip("the simulated machine is in this process: there is no wire")
    control.rig.acts()["late answers"]()
    start(control)
    control.until(MachineState.IDLE)
    assert at(control.rig) == pytest.approx(90.0, abs=0.1)


def test_orientation_follows_its_direction_and_ends_with_a_speed_command(control: Control) -> None:
    """At the port: as M04 turns, then as M03, each less than a turn; a speed ends it."""
    rig, port = control.rig, control.rig.ports.orientation
    control.ready()
    assert port is not None
    rig.until(lambda: not rig.ports.spindle.read_fault())
    port.orient_spindle(90.0, -1)
    rig.until(port.is_oriented)
    assert rig.slides.spindle_turns() == pytest.approx(-0.75, abs=1e-3)
    port.orient_spindle(0.0, 1)
    assert not port.is_oriented()
    rig.until(port.is_oriented)
    assert rig.slides.spindle_turns() == pytest.approx(0.0, abs=1e-3)
    rig.ports.spindle.set_speed(300.0)
    rig.run(0.3)
    assert not port.is_oriented()


def test_drive_with_a_lower_standstill_limit_than_the_machine_file_is_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """HAL orients below 2 rpm; from 20 rpm, the limit of this file, to 2 rpm the spindle takes 60 ms."""
    text_of = hal.hal_text
    slow = ("stop_below = 5", "stop_below = 20"), ("decel_rpm_s = 2500", "decel_rpm_s = 300")

    def slow_text(*, homing: bool = False, lamps: str = "", orients: bool = False) -> str:
        made = text_of(homing=homing, lamps=lamps, orients=orients)
        for old, new in slow:
            assert old in made
            made = made.replace(old, new)
        return made

    monkeypatch.setattr(hal, "hal_text", slow_text)
    control = Control(Hal(orients=True))
    start(control)
    control.until(MachineState.IDLE)
    assert control.shot.alarms == ()
    control.rig.close()


def test_orientation_is_rejected_while_the_spindle_turns(control: Control) -> None:
    """From the speed command on, and until the spindle has stopped."""
    rig, port = control.rig, control.rig.ports.orientation
    control.ready()
    assert port is not None
    rig.ports.spindle.set_speed(600.0)
    with raises_code(DriverError, "spindle-off", "turning") as told:
        port.orient_spindle(90.0)
    assert told.value.reason == SPINDLE_TURNS
    rig.until(lambda: rig.ports.spindle.speed() > 500.0)
    rig.ports.spindle.set_speed(0.0)
    with raises_code(DriverError, "spindle-off", "turning"):
        port.orient_spindle(90.0)
    assert not port.is_oriented()
    rig.until(lambda: rig.ports.spindle.speed() == 0.0)
    port.orient_spindle(90.0)
    rig.until(port.is_oriented)


def test_orientation_is_rejected_in_estop(control: Control) -> None:
    control.ready()
    control.world.press_estop()
    control.until(MachineState.ESTOP, limit=0.5)
    assert control.rig.ports.orientation is not None
    with raises_code(DriverError, "spindle-off", "E-stop"):
        control.rig.ports.orientation.orient_spindle(90.0)


@pytest.mark.parametrize("name", sorted(RIGS.keys() - ABLE.keys()))
def test_driver_without_orientation_has_no_orientation_port(name: str) -> None:
    rig = RIGS[name]()
    assert rig.ports.orientation is None
    rig.close()


@pytest.mark.parametrize("name", ["gt75-canopen", "gt75-grblhal", "gt75-vfd"])
def test_orientation_is_rejected_if_the_driver_does_not_support_it(name: str) -> None:
    text = resources.read_machine_file(f"{name}.toml").replace(
        "[spindle]\n", "[spindle]\noriented = true\n", 1
    )
    with pytest.raises(MachineFileError, match=r"spindle\.oriented = true: .*spindle\.driver"):
        parse_machine(text, name)


def test_lathe_with_spindle_as_c_rejects_separate_orientation() -> None:
    text = resources.read_machine_file("gt75.toml").replace("[spindle]\n", "[spindle]\noriented = true\n", 1)
    with pytest.raises(MachineFileError, match=r"spindle\.oriented = true: .*axis\.C\.own_drive"):
        parse_machine(text, "gt75")


def test_hal_orientation_requires_its_four_pins() -> None:
    text = resources.read_machine_file("gt75-hal.toml").replace(
        "[spindle]\n", "[spindle]\noriented = true\n", 1
    )
    with pytest.raises(MachineFileError) as refused:
        parse_machine(text, "gt75-hal")
    for pin in ("orient", "orient_angle", "orient_mode", "is_oriented"):
        assert f"hal.spindle.{pin}: missing" in str(refused.value)

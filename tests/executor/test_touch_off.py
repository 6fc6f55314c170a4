"""A tool is touched off at the tool setter: what it finds, how near, and everything that must stop it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import EnableDrives, Jog, JogByStep, Reset, SelectHandwheel, StopJog, TouchOffTool
from core.executor.snapshot import MachineState, TouchPhase
from core.machine.hardware_model import AnalogInputModel
from core.machine.machine_model import InputModel, Machine
from core.machine.setter_table import ToolSetterModel, compute_stopping_distance
from drivers.simulated.simulated_table import SimulatedTable
from tests.executor.rig import FINE, INCH, Rig
from tests.texts import text

LEASE = 0.25
SETTER = ToolSetterModel(
    x=10.0, z=20.0, width=6.0, overtravel=3.0, speed=8.0, slow=0.25, search=12.0, back_off=1.0
)
TIP = (3.7, -41.3)  # where the slides stand when the tip is on part zero


def with_setter(setter: ToolSetterModel = SETTER, *inputs: str, tip: tuple[float, float] = TIP) -> Machine:
    """The shipped lathe with a tool setter, and one tool whose tip is where only the simulation knows."""
    machine = load_machine()
    wired = {name: InputModel(name, f"test {name}") for name in ("probe", *inputs)}
    tables = {**machine.hardware.tables, "setter": setter, "sim": SimulatedTable(tips=(tip,))}
    hardware = dataclasses.replace(machine.hardware, tables=tables)
    return dataclasses.replace(machine, inputs={**machine.inputs, **wired}, hardware=hardware)


def wheeled(machine: Machine) -> Machine:
    """With a handwheel."""
    analog = {"handwheel": AnalogInputModel("handwheel", "wheel", (0.0, 1.0))}
    return dataclasses.replace(machine, hardware=dataclasses.replace(machine.hardware, analog_inputs=analog))


class TouchRig(Rig):
    """``held`` is what the key that is held asks for; ``deepest`` how far the stylus was pushed."""

    held: TouchOffTool | None = None
    presses = 0

    def __post_init__(self) -> None:
        self.every = FINE
        super().__post_init__()

    def tick(self, dt: float | None = None) -> None:
        if self.held is not None:
            self.executor.post(self.held)
        super().tick(dt)

    def hold(self, axis: str = "X", sign: int = -1, while_on: str = "") -> None:
        self.presses += 1
        self.held = TouchOffTool(axis, sign, LEASE, self.presses, while_on)
        self.tick()

    def let_go(self) -> None:
        self.held = None
        self.post(StopJog())

    def put(self, x: float, z: float) -> None:
        """The slides stand there, the tip so far from part zero."""
        for name, want in zip("XZ", (x + TIP[0], z + TIP[1]), strict=True):
            index = self.shot.axes.index(name)
            while abs(way := want - self.shot.demand[index]) > 1e-6:
                step = max(-2.5, min(2.5, way))
                self.post(JogByStep(name, step, 40.0))
                self.until(MachineState.IDLE)

    @property
    def deepest(self) -> float:
        setter = self.sim.ports.axes._plant.terminals.setter  # type: ignore[attr-defined]
        return float(setter.max_penetration_mm)


def ready(machine: Machine | None = None, *, x: float = 20.0, z: float = 20.0) -> TouchRig:
    rig = TouchRig(machine or with_setter())
    rig.ready()
    rig.put(x, z)
    return rig


@pytest.mark.parametrize(
    ("x", "z", "axis", "sign", "face"),
    [
        (20.0, 20.0, "X", -1, 13.0),
        (1.0, 20.0, "X", 1, 7.0),
        (10.0, 30.0, "Z", -1, 23.0),
        (10.0, 11.0, "Z", 1, 17.0),
    ],
)
def test_touch_position_is_measured(x: float, z: float, axis: str, sign: int, face: float) -> None:
    rig = ready(x=x, z=z)
    rig.hold(axis, sign)
    assert rig.shot.touch_phase is TouchPhase.SEARCH
    rig.until(MachineState.IDLE)
    touched = rig.shot.touched
    assert touched is not None
    assert touched.why == ""
    assert touched.touch_position_mm is not None
    index = "XZ".index(axis)
    assert touched.touch_position_mm == pytest.approx(
        face + TIP[index], abs=0.0013 + 0.0003
    )  # a count, and 1 ms of way
    assert SETTER.compute_touch_position(axis, sign) == face
    assert touched.uncertainty_mm == pytest.approx(0.25 * 0.001 / 2 + 0.00127 / 2)  # .00005 in is a count
    assert abs(rig.shot.actual[index] - (touched.touch_position_mm - sign * 1.0)) < 0.005  # it stands off
    assert rig.deepest < SETTER.overtravel
    assert "probe" not in rig.shot.inputs


def test_touch_phases_follow_in_order_and_end_slowly() -> None:
    rig = ready()
    seen: list[TouchPhase] = []
    slow: list[float] = []

    def note(shot: object) -> None:
        phase = rig.shot.touch_phase
        if phase is not None and (not seen or seen[-1] is not phase):
            seen.append(phase)
        if phase is TouchPhase.SLOW_TOUCH and "probe" in rig.shot.inputs:
            slow.append(rig.shot.velocity)

    rig.watch.append(note)
    rig.hold()
    rig.until(MachineState.IDLE)
    assert seen == [TouchPhase.SEARCH, TouchPhase.BACK_OFF, TouchPhase.SLOW_TOUCH, TouchPhase.RETREAT]
    assert max(slow) == pytest.approx(0.25, rel=0.6)  # in counts a tick


def test_uncertainty_includes_a_tick_if_the_driver_latches_no_position() -> None:
    rig = ready()
    context = rig.executor._context
    context.ports = dataclasses.replace(context.ports, touch=None)
    rig.hold()
    rig.until(MachineState.IDLE)
    touched = rig.shot.touched
    assert touched is not None
    assert touched.uncertainty_mm == pytest.approx(0.25 * 0.01 / 2 + 0.00127 / 2)
    assert touched.touch_position_mm == pytest.approx(13.0 + TIP[0], abs=touched.uncertainty_mm + 0.0013)


# --- what stops it ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("phase", list(TouchPhase)[:4])
def test_key_release_stops_the_touch_off_in_every_phase(phase: TouchPhase) -> None:
    rig = ready()
    rig.hold()
    rig.until_true(lambda shot: shot.touch_phase is phase)
    rig.run(0.05)
    before = rig.shot.actual[0]
    rig.let_go()
    rig.until(MachineState.IDLE)
    assert abs(rig.shot.actual[0] - before) < compute_stopping_distance(8.0, 120 * INCH, 0.03)
    touched = rig.shot.touched
    assert touched is not None
    assert (touched.touch_position_mm, touched.why) == (None, text("executor.let-go"))


def test_dead_screen_stops_the_touch_off_within_the_lease() -> None:
    rig = ready()
    rig.hold()
    rig.run(0.3)
    before = rig.shot.actual[0]
    rig.held = None  # no word more
    rig.until(MachineState.IDLE)
    assert before - rig.shot.actual[0] < 8.0 * (LEASE + 0.05)
    assert rig.shot.touched is not None
    assert rig.shot.touched.touch_position_mm is None


def test_held_down_key_starts_no_second_touch_off() -> None:
    rig = ready()
    rig.hold()
    rig.until(MachineState.IDLE)
    rig.run(1.0)
    assert rig.state is MachineState.IDLE
    assert rig.shot.touched is not None
    assert rig.shot.touched.number == 1
    rig.hold()  # pressed anew: from where it stands now
    rig.until(MachineState.IDLE)
    assert rig.shot.touched.number == 2
    assert rig.shot.touched.why == ""


def test_missing_setter_is_reported_and_the_axis_returns() -> None:
    rig = ready(z=60.0)  # beside the setter
    begin = rig.shot.actual[0]
    rig.hold()
    rig.until(MachineState.IDLE)
    assert rig.shot.touched is not None
    assert rig.shot.touched.why == text("executor.not-touched", distance="0.472 in")
    assert rig.shot.touched.touch_position_mm is None
    assert rig.shot.actual[0] == pytest.approx(begin, abs=0.005)
    assert rig.shot.alarms == ()


def test_probe_input_stuck_on_during_back_off_stops_there() -> None:
    rig = ready()
    rig.hold()
    rig.until_true(lambda shot: shot.touch_phase is TouchPhase.BACK_OFF)
    rig.sim.machine.set_input("probe", True)
    rig.until(MachineState.IDLE)
    assert rig.shot.touched is not None
    assert text("executor.input-stays", distance="0.039 in") in rig.shot.touched.why
    assert rig.shot.touched.touch_position_mm is None


def test_missing_second_touch_is_reported() -> None:
    """The second touch does not come: the stylus is loose, or it was a chip."""
    rig = ready()
    rig.hold()
    rig.until_true(lambda shot: shot.touch_phase is TouchPhase.SLOW_TOUCH)
    rig.sim.ports.axes._plant.terminals.setter = None  # type: ignore[attr-defined]
    rig.until(MachineState.IDLE)
    assert rig.shot.touched is not None
    assert text("executor.no-second-touch") in rig.shot.touched.why


def test_feed_hold_estop_and_another_key_end_the_touch_off() -> None:
    acts: tuple[tuple[Callable[[TouchRig], None], str], ...] = (
        (lambda rig: rig.sim.machine.press_hold(), "feed hold"),
        (lambda rig: rig.post(Reset()), "reset"),
        (lambda rig: rig.post(Jog("Z", 1.0, LEASE)), text("executor.something-else")),
        (lambda rig: rig.sim.machine.press_estop(), "E-STOP"),
    )
    for act, why in acts:
        rig = ready()
        rig.hold()
        rig.run(0.2)
        act(rig)
        rig.run(0.5)
        assert rig.shot.touch_phase is None
        assert rig.state in {MachineState.IDLE, MachineState.ESTOP}
        assert rig.shot.touched is not None
        assert why in rig.shot.touched.why
        assert rig.shot.velocity == 0.0


def test_button_release_ends_the_touch_off_despite_screen_requests() -> None:
    rig = ready(with_setter(SETTER, "jog_x_minus"))
    rig.sim.machine.set_input("jog_x_minus", True)
    rig.tick()
    rig.hold(while_on="jog_x_minus")
    rig.run(0.2)
    assert rig.state is MachineState.JOG
    rig.sim.machine.set_input("jog_x_minus", False)
    rig.until(MachineState.IDLE)
    assert rig.shot.touched is not None
    assert rig.shot.touched.touch_position_mm is None


def test_a_jog_into_the_setter_stops_and_the_next_leads_away() -> None:
    rig = ready(x=15.0)
    jog = Jog("X", -8.0, LEASE)
    while not rig.said("refused"):
        rig.post(jog)
    assert text("executor.setter-touched") in rig.said("refused")[0]
    rig.until(MachineState.IDLE)
    assert rig.deepest < 8.0 * 0.05 + 0.1  # a tick, what is committed, the braking
    for _ in range(30):
        rig.post(Jog("X", 8.0, LEASE))
    assert rig.shot.demand[0] > 13.0 + TIP[0]
    assert len(rig.said("refused")) == 1


def test_handwheel_is_deselected_at_the_setter() -> None:
    rig = ready(wheeled(with_setter()), x=13.5)
    wheel = SelectHandwheel("X", 0.1, LEASE)
    rig.post(wheel)
    for _ in range(12):
        rig.post(wheel)
    for _ in range(30):
        rig.sim.machine.turn_handwheel(-1)
        rig.post(wheel)
    rig.run(0.3)
    assert text("executor.setter-touched") in rig.shot.wheel_ended
    assert rig.deepest < 0.5


# --- what refuses it --------------------------------------------------------------------------------------


def test_touch_off_is_rejected_if_the_probe_input_is_already_on() -> None:
    rig = ready()
    rig.sim.machine.set_input("probe", True)
    rig.run(0.05)
    rig.hold()
    assert rig.state is MachineState.IDLE
    assert any(text("executor.setter-on") in said for said in rig.said("refused"))


def test_touch_off_without_a_setter_is_rejected() -> None:
    rig = TouchRig(load_machine())
    rig.ready()
    rig.hold()
    assert rig.state is MachineState.IDLE
    assert any(text("executor.no-setter") in said for said in rig.said("refused"))


def test_touch_off_is_rejected_while_the_spindle_turns() -> None:
    rig = ready()
    rig.start("G90G94F300\nM03S900\nM02\n")
    rig.until(MachineState.IDLE)
    rig.hold()
    assert rig.state is MachineState.IDLE
    assert any(text("executor.spindle-turns-touch") in said for said in rig.said("refused"))


def test_touch_off_of_an_unhomed_axis_is_rejected() -> None:
    machine = with_setter()
    x = dataclasses.replace(machine.find_axis("X"), is_position_absolute=False, home_order=1, home_speed=10.0)
    rig = TouchRig(dataclasses.replace(machine, axes=(x, *machine.axes[1:])))
    rig.post(EnableDrives())
    rig.hold()
    assert rig.state is MachineState.IDLE
    assert any(text("executor.position-means-nothing", axis="X") in said for said in rig.said("refused"))


def test_touch_off_search_beyond_the_travel_is_rejected() -> None:
    rig = ready()
    rig.put(-TIP[0] - 4.0 * INCH + 10.0, 60.0)  # 10 mm from the end, and it looks 12 mm far
    rig.hold()
    assert rig.state is MachineState.IDLE
    assert any(
        text("executor.search-leaves-travel", axis="X", distance="0.197 in") in said
        for said in rig.said("refused")
    )


@pytest.mark.parametrize(("axis", "sign"), [("C", 1), ("", 1), ("X", 0), ("X", 3)])
def test_touch_off_without_a_direction_is_rejected(axis: str, sign: int) -> None:
    rig = ready()
    rig.hold(axis, sign)
    assert rig.state is MachineState.IDLE
    assert any(text("executor.not-along", axis=axis or "no axis") in said for said in rig.said("refused"))


def test_touch_off_with_drives_off_or_in_feed_hold_is_rejected() -> None:
    rig = TouchRig(with_setter())
    rig.hold()
    assert any("DRIVES OFF" in said for said in rig.said("refused"))
    rig = ready()
    rig.sim.machine.press_hold()
    rig.tick()
    rig.hold()
    assert rig.state is MachineState.IDLE
    assert any(text("executor.hold-pressed") in said for said in rig.said("refused"))


def test_touch_off_is_rejected_while_the_handwheel_is_selected() -> None:
    rig = ready()
    rig.executor._control.handwheel.axis = "X"
    rig.executor._control.touch_off.handle_request(TouchOffTool("X", -1, LEASE, 9), MachineState.IDLE, "X")
    assert any(text("executor.wheel-selected") in said for said in rig.said("refused"))

"""The handwheel as the page asks for it: what is posted, and what must end it."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field

import pytest

from app.compose.machine.machine_files import load_machine
from app.jog.held_jog import CONTINUOUS_STEP_INDEX, HeldJog, JogSpeeds
from app.jog.jog_handwheel import JogHandwheel
from core.executor.commands import Command, DeselectHandwheel, Jog, SelectHandwheel, StopJog
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.modal_state import ModalState
from core.machine.hardware_model import AnalogInputModel
from core.machine.machine_model import InputModel
from tests.texts import shows, text

INCH = 25.4
THOU = 0.001 * INCH
FRAME = 0.016
LEASE = 0.2


def clicks(command: SelectHandwheel, axis: str, step: float) -> bool:
    """Whether the wheel moves the axis by so much a click, mm or degrees."""
    return command == SelectHandwheel(axis, command.step, LEASE) and command.step == pytest.approx(step)


@dataclass
class Scene:
    """A wheel, a clock, and a control that obeys."""

    switches: tuple[str, ...] = ()
    there: bool = True
    posted: list[Command] = field(default_factory=list)
    said: list[str] = field(default_factory=list)
    why: str = ""
    t: float = 100.0
    modal: ModalState = field(default_factory=ModalState)
    on: frozenset[str] = frozenset()
    taken: bool = False  # the control has taken it away

    def __post_init__(self) -> None:
        machine = load_machine()
        wheel = {"handwheel": AnalogInputModel("handwheel", "w", (0.0, 1.0), counts_per_click=4)}
        machine = dataclasses.replace(
            machine,
            inputs={**machine.inputs, **{name: InputModel(name, f"t {name}") for name in self.switches}},
            hardware=dataclasses.replace(machine.hardware, analog_inputs=wheel if self.there else {}),
        )
        post, say, clock = self.posted.append, self.said.append, lambda: self.t
        self.hold = HeldJog(JogSpeeds(machine), LEASE, post, say, lambda: None, clock, lambda: self.why)
        self.wheel = JogHandwheel(machine, self.hold, ("X", "Z", "C"), lambda: self.why)
        self.frames(0.1)

    def frames(self, seconds: float) -> None:
        end = self.t + seconds
        while self.t < end - 1e-9:
            self.t += FRAME
            axis = self.wheel.wheel_choice[0] if self.wheel.wheel_choice and not self.taken else ""
            shot = Snapshot(state=MachineState.IDLE, modal=self.modal, wheel=axis, inputs=self.on)
            self.hold.update(shot)
            self.wheel.update(shot)

    @property
    def wheels(self) -> list[SelectHandwheel]:
        return [command for command in self.posted if isinstance(command, SelectHandwheel)]

    def nothing_more(self) -> bool:
        count = len(self.wheels)
        self.frames(1.0)
        return len(self.wheels) == count


def chosen(scene: Scene, axis: str = "X") -> Scene:
    scene.wheel.select_axis(axis)
    scene.frames(0.1)
    assert scene.wheel.wheel_choice is not None
    return scene


def test_handwheel_key_cycles_axes_and_then_deselects() -> None:
    scene, seen = Scene(), []
    for _ in range(4):
        scene.wheel.select_next_axis()
        scene.frames(0.1)
        seen.append(scene.wheel.wheel_choice[0] if scene.wheel.wheel_choice else "")
    assert seen == ["X", "Z", "C", ""]
    assert scene.posted[-1] == DeselectHandwheel()
    assert scene.nothing_more()


def test_handwheel_selection_is_renewed_before_lease_ends() -> None:
    scene = chosen(Scene())
    scene.frames(1.0)
    assert set(scene.wheels) == {SelectHandwheel("X", THOU, LEASE)}  # continuous: a thousandth
    assert len(scene.wheels) >= 1.0 / LEASE * 3


@pytest.mark.parametrize(
    ("step", "metric", "diameter", "axis", "way"),
    [
        (1, False, False, "X", 0.01 * INCH),
        (2, False, True, "X", 0.5 * THOU),
        (2, False, True, "Z", THOU),
        (3, False, False, "Z", 0.1 * THOU),
        (1, True, False, "Z", 0.1),
        (3, True, False, "Z", 0.001),
        (3, False, False, "C", 0.02),
    ],
)
def test_handwheel_click_is_step_of_page(
    step: int, metric: bool, diameter: bool, axis: str, way: float
) -> None:
    scene = Scene(modal=ModalState(metric=metric, diameter=diameter))
    scene.hold.jog_speeds.step_index = step
    chosen(scene, axis)
    assert clicks(scene.wheels[-1], axis, way)


def test_step_change_deselects_handwheel_first() -> None:
    scene = chosen(Scene())
    scene.hold.jog_speeds.step_index = 3
    scene.frames(0.1)
    off = scene.posted.index(DeselectHandwheel())
    assert all(isinstance(c, SelectHandwheel) and clicks(c, "X", 0.1 * THOU) for c in scene.posted[off + 1 :])
    assert len(scene.posted) > off + 1


@pytest.mark.parametrize("step", [CONTINUOUS_STEP_INDEX, 0])
def test_step_not_valid_for_handwheel_deselects_it_permanently(step: int) -> None:
    scene = chosen(Scene())
    scene.hold.jog_speeds.step_index = step
    scene.frames(0.1)
    assert scene.posted[-1] == DeselectHandwheel()
    scene.hold.jog_speeds.step_index = 2
    assert scene.nothing_more()


def test_handwheel_selection_stops_active_jog() -> None:
    scene = Scene()
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)
    assert isinstance(scene.posted[-1], Jog)
    scene.wheel.select_axis("X")
    assert StopJog() in scene.posted


def test_handwheel_is_blocked_and_ended_by_jog_interlock() -> None:
    scene = Scene(why="THE DRIVES ARE OFF")
    scene.wheel.select_axis("X")
    assert scene.said == ["THE DRIVES ARE OFF"]
    assert scene.nothing_more()
    scene.why = ""
    chosen(scene)
    scene.why = "A PROGRAM IS UNDER WAY"
    scene.frames(0.1)
    assert scene.posted[-1] == DeselectHandwheel()
    scene.why = ""
    assert scene.nothing_more()


def test_handwheel_deselected_by_control_is_not_selected_again() -> None:
    scene = chosen(Scene())
    scene.frames(0.5)
    scene.taken = True
    scene.frames(0.1)
    assert scene.posted[-1] == DeselectHandwheel()
    scene.taken = False
    assert scene.nothing_more()


def test_blocked_screen_deselects_handwheel() -> None:
    scene = chosen(Scene())
    scene.t += 0.3
    scene.frames(0.05)
    assert scene.posted[-1] == DeselectHandwheel()
    assert set(scene.said) == {text("jog.screen-away")}
    assert scene.nothing_more()


def test_handwheel_key_without_handwheel_shows_message() -> None:
    scene = Scene(there=False)
    scene.wheel.select_next_axis()
    assert scene.said == [text("jog.no-wheel")]
    assert scene.nothing_more()


# --- switches of the station --------------------------------------------------------------------------------


SWITCHES = ("wheel_x", "wheel_z", "wheel_x1", "wheel_x10", "wheel_x100")


def switched(*on: str) -> Scene:
    scene = Scene(SWITCHES)
    scene.on = frozenset(on)
    scene.frames(0.1)
    return scene


def test_switches_select_handwheel_axis_and_step() -> None:
    scene = switched("wheel_z", "wheel_x100")
    assert clicks(scene.wheels[-1], "Z", 10 * THOU)
    scene.on = frozenset({"wheel_x", "wheel_x1"})
    scene.frames(0.1)
    assert clicks(scene.wheels[-1], "X", 0.1 * THOU)
    assert DeselectHandwheel() in scene.posted


@pytest.mark.parametrize(
    "on", [(), ("wheel_x",), ("wheel_x10",), ("wheel_x", "wheel_z", "wheel_x1"), ("wheel_x", *SWITCHES[2:])]
)
def test_switches_between_positions_select_nothing(on: tuple[str, ...]) -> None:
    scene = switched(*on)
    assert scene.wheels == []
    scene.wheel.select_axis("X")
    assert shows(scene.said[0], "jog.station-chooses-axis")
    assert scene.nothing_more()


def test_handwheel_deselected_by_control_needs_switch_change() -> None:
    scene = switched("wheel_x", "wheel_x10")
    scene.frames(0.5)
    scene.taken = True
    scene.frames(0.1)
    scene.taken = False
    assert scene.nothing_more()
    scene.on = frozenset({"wheel_x10"})
    scene.frames(0.1)
    scene.on = frozenset({"wheel_x", "wheel_x10"})
    scene.frames(0.1)
    assert scene.wheel.wheel_choice == ("X", 2)


def test_preset_switch_applies_after_drives_are_on() -> None:
    scene = Scene(SWITCHES, why="THE DRIVES ARE OFF")
    scene.on = frozenset({"wheel_x", "wheel_x10"})
    assert scene.nothing_more()
    assert scene.said == []
    scene.why = ""
    scene.frames(0.1)
    assert scene.wheel.wheel_choice == ("X", 2)

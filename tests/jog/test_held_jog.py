"""The known accidents of hand moves, one test each: what is posted when a key is not what it seems."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from app.compose.machine.machine_files import load_machine
from app.jog.held_jog import CONTINUOUS_STEP_INDEX, HeldJog, JogSpeeds
from core.executor.commands import Command, Jog, JogByStep, StopJog
from core.executor.snapshot import MachineState, Snapshot
from core.interpreter.shared.modal_state import ModalState
from tests.texts import shows, text

INCH = 25.4
FRAME = 0.016
SLOW = 5 * INCH / 60
LEASE = 0.2


@dataclass
class Scene:
    """A hold, a clock, and a machine that begins to move as soon as it is asked."""

    posted: list[Command] = field(default_factory=list)
    said: list[str] = field(default_factory=list)
    why: str = ""
    t: float = 100.0
    modal: ModalState = field(default_factory=ModalState)
    state: MachineState = MachineState.IDLE

    def __post_init__(self) -> None:
        speeds = JogSpeeds(load_machine())
        self.hold = HeldJog(
            speeds,
            LEASE,
            self.posted.append,
            self.said.append,
            lambda: None,
            lambda: self.t,
            lambda: self.why,
        )

    def frames(self, seconds: float, state: MachineState = MachineState.JOG) -> None:
        """So much time, a look every frame."""
        end = self.t + seconds
        while self.t < end - 1e-9:
            self.t += FRAME
            self.hold.update(Snapshot(state=state, modal=self.modal))

    @property
    def jogs(self) -> list[Jog]:
        return [command for command in self.posted if isinstance(command, Jog)]

    @property
    def stopped(self) -> bool:
        """The last word is a stop, and nothing is held any more."""
        return self.posted[-1] == StopJog() and self.hold.active_jog is None

    def nothing_more(self) -> bool:
        """However long one waits, nothing else is posted."""
        count = len(self.posted)
        self.frames(2.0, MachineState.IDLE)
        return len(self.posted) == count


@pytest.fixture
def scene() -> Scene:
    return Scene()


def held(scene: Scene) -> Scene:
    scene.hold.press_direction("Left", "Z", -1, is_rapid=False)
    scene.frames(0.5)
    assert scene.hold.active_jog is not None
    return scene


def test_a_held_key_renews_its_lease_before_it_ends(scene: Scene) -> None:
    held(scene)
    assert set(scene.jogs) == {Jog("Z", -SLOW, LEASE)}
    assert len(scene.jogs) >= 0.5 / (LEASE / 2)
    assert len(scene.jogs) <= 0.5 / (LEASE / 5)


def test_the_release_ends_it(scene: Scene) -> None:
    held(scene).hold.release_key("Left")
    assert scene.stopped
    assert scene.nothing_more()


def test_a_release_that_never_arrives_is_noticed_by_the_silence_of_the_key(scene: Scene) -> None:
    scene.hold.press_direction("Left", "Z", -1, is_rapid=False)
    for _ in range(20):
        scene.frames(0.032)
        scene.hold.record_repeat("Left")
    scene.frames(0.48)
    assert scene.hold.active_jog is not None
    scene.frames(0.05)
    assert scene.stopped
    assert shows(scene.said[-1], "jog.key-silent")
    assert scene.nothing_more()


def test_the_loss_of_the_keyboard_ends_it_and_the_key_counts_as_up(scene: Scene) -> None:
    held(scene).hold.release_all("THE KEYBOARD WENT ELSEWHERE")
    assert scene.stopped
    scene.hold.release_key("Left")  # the release arrives after all
    assert scene.nothing_more()
    held(scene)


def test_a_screen_that_stood_still_does_not_go_on(scene: Scene) -> None:
    held(scene)
    renewed = len(scene.jogs)
    scene.t += 0.3  # no frame: nothing is renewed, and the lease ends by itself
    assert len(scene.jogs) == renewed
    scene.frames(FRAME)
    assert scene.stopped
    assert text("jog.screen-away-jog") in scene.said[-1]
    assert scene.nothing_more()


def test_two_keys_at_once_move_nothing_until_both_are_up(scene: Scene) -> None:
    held(scene).hold.press_direction("Up", "X", -1, is_rapid=False)
    assert scene.stopped
    scene.hold.release_key("Left")
    scene.hold.press_direction("Left", "Z", -1, is_rapid=False)  # Up is still down
    assert scene.nothing_more()
    assert shows(scene.said[-1], "jog.two-at-once")
    scene.hold.release_key("Up")
    scene.hold.release_key("Left")
    held(scene)


def test_the_other_direction_while_moving_stops_and_does_not_reverse(scene: Scene) -> None:
    held(scene).hold.press_direction("Right", "Z", 1, is_rapid=False)
    assert scene.stopped
    assert all(jog.velocity < 0 for jog in scene.jogs)
    assert scene.nothing_more()


def test_a_finger_beside_a_key_moves_nothing(scene: Scene) -> None:
    held(scene).hold.press_direction("finger Z-1", "Z", -1, is_rapid=False)
    assert scene.stopped
    assert scene.nothing_more()


def test_any_other_key_ends_it(scene: Scene) -> None:
    held(scene).hold.stop_for_other_key()
    assert scene.stopped
    assert scene.nothing_more()


def test_a_rapid_ends_with_its_shift_and_does_not_go_on_slowly(scene: Scene) -> None:
    scene.hold.press_direction("Left", "Z", -1, is_rapid=True)
    scene.frames(0.1)
    assert scene.jogs[-1].velocity == pytest.approx(-100 * INCH / 60)
    scene.hold.release_shift()
    assert scene.stopped
    assert scene.nothing_more()


def test_shift_that_comes_up_means_nothing_to_a_slow_jog(scene: Scene) -> None:
    held(scene).hold.release_shift()
    assert scene.hold.active_jog is not None


def test_the_pairs_that_a_repeating_key_makes_are_no_presses(scene: Scene) -> None:
    held(scene)
    for _ in range(10):
        scene.hold.record_repeat("Left")
        scene.frames(0.03)
    assert scene.hold.active_jog is not None
    assert StopJog() not in scene.posted


@pytest.mark.parametrize(
    "state",
    [MachineState.IDLE, MachineState.FAULT, MachineState.ESTOP, MachineState.DISABLED, MachineState.RUN],
)
def test_what_the_machine_has_ended_is_not_begun_again(scene: Scene, state: MachineState) -> None:
    held(scene)
    before = len(scene.jogs)
    scene.frames(FRAME, state)
    assert scene.hold.active_jog is None
    scene.frames(1.0, MachineState.IDLE)
    assert len(scene.jogs) == before


def test_a_machine_that_does_not_begin_is_not_asked_for_ever(scene: Scene) -> None:
    scene.hold.press_direction("Left", "Z", -1, is_rapid=False)
    scene.frames(1.0, MachineState.IDLE)
    assert len(scene.jogs) == 1
    assert scene.stopped


def test_what_is_barred_moves_nothing_and_says_why(scene: Scene) -> None:
    scene.why = "A PROGRAM IS UNDER WAY"
    scene.hold.press_direction("Left", "Z", -1, is_rapid=False)
    assert scene.posted == []
    assert scene.said == ["A PROGRAM IS UNDER WAY"]


@pytest.mark.parametrize(
    ("step", "metric", "diameter", "axis", "length"),
    [
        (0, False, False, "Z", 0.1 * INCH),
        (3, False, False, "Z", 0.0001 * INCH),
        (2, False, True, "X", 0.0005 * INCH),
        (2, False, True, "Z", 0.001 * INCH),
        (0, True, False, "Z", 1.0),
        (3, True, True, "X", 0.0005),
        (2, False, False, "C", 0.1),
    ],
)
def test_a_step_changes_the_figure_by_its_length(
    scene: Scene, step: int, metric: bool, diameter: bool, axis: str, length: float
) -> None:
    scene.modal = ModalState(metric=metric, diameter=diameter)
    scene.frames(FRAME, MachineState.IDLE)
    scene.hold.jog_speeds.step_index = step
    scene.hold.press_direction("key", axis, -1, is_rapid=False)
    (command,) = scene.posted
    assert isinstance(command, JogByStep)
    assert command.distance == pytest.approx(-length, abs=1e-12)


def test_a_step_is_not_repeated_by_holding_and_not_ended_by_the_release(scene: Scene) -> None:
    scene.hold.jog_speeds.step_index = 1
    scene.hold.press_direction("Left", "Z", -1, is_rapid=False)
    for _ in range(30):
        scene.hold.record_repeat("Left")
        scene.frames(0.03)
    scene.hold.release_key("Left")
    assert len(scene.posted) == 1
    scene.hold.press_direction("Left", "Z", -1, is_rapid=False)
    assert len(scene.posted) == 2


def test_shift_in_a_step_is_refused(scene: Scene) -> None:
    scene.hold.jog_speeds.step_index = 1
    scene.hold.press_direction("Left", "Z", -1, is_rapid=True)
    assert scene.posted == []
    assert shows(scene.said[-1], "jog.continuous-for-rapid")


def test_steps_and_speeds_go_round(scene: Scene) -> None:
    speeds = scene.hold.jog_speeds
    seen = []
    for _ in range(6):
        seen.append(speeds.step_index)
        speeds.select_next_step()
    assert seen == [CONTINUOUS_STEP_INDEX, 0, 1, 2, 3, CONTINUOUS_STEP_INDEX]
    speeds.speed_index = 3
    speeds.select_next_speed()
    assert speeds.speed_index == 0

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
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)
    scene.frames(0.5)
    assert scene.hold.active_jog is not None
    return scene


def test_jog_key_renews_lease_before_it_ends(scene: Scene) -> None:
    held(scene)
    assert set(scene.jogs) == {Jog("Z", -SLOW, LEASE)}
    assert len(scene.jogs) >= 0.5 / (LEASE / 2)
    assert len(scene.jogs) <= 0.5 / (LEASE / 5)


def test_key_release_stops_jog(scene: Scene) -> None:
    held(scene).hold.release_key("Left")
    assert scene.stopped
    assert scene.nothing_more()


def test_silent_key_stops_jog_when_release_is_lost(scene: Scene) -> None:
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)
    for _ in range(20):
        scene.frames(0.032)
        scene.hold.record_key_repeat("Left")
    scene.frames(0.48)
    assert scene.hold.active_jog is not None
    scene.frames(0.05)
    assert scene.stopped
    assert shows(scene.said[-1], "jog.key-silent")
    assert scene.nothing_more()


def test_loss_of_keyboard_focus_stops_jog_and_releases_key(scene: Scene) -> None:
    held(scene).hold.release_all_keys("THE KEYBOARD WENT ELSEWHERE")
    assert scene.stopped
    scene.hold.release_key("Left")  # the release arrives after all
    assert scene.nothing_more()
    held(scene)


def test_jog_does_not_resume_after_screen_was_blocked(scene: Scene) -> None:
    held(scene)
    renewed = len(scene.jogs)
    scene.t += 0.3  # no frame: nothing is renewed, and the lease ends by itself
    assert len(scene.jogs) == renewed
    scene.frames(FRAME)
    assert scene.stopped
    assert text("jog.screen-away-jog") in scene.said[-1]
    assert scene.nothing_more()


def test_two_jog_keys_stop_motion_until_both_are_released(scene: Scene) -> None:
    held(scene).hold.handle_direction_press("Up", "X", -1, is_rapid=False)
    assert scene.stopped
    scene.hold.release_key("Left")
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)  # Up is still down
    assert scene.nothing_more()
    assert shows(scene.said[-1], "jog.two-at-once")
    scene.hold.release_key("Up")
    scene.hold.release_key("Left")
    held(scene)


def test_opposite_key_stops_jog_without_reversing(scene: Scene) -> None:
    held(scene).hold.handle_direction_press("Right", "Z", 1, is_rapid=False)
    assert scene.stopped
    assert all(jog.velocity < 0 for jog in scene.jogs)
    assert scene.nothing_more()


def test_touch_button_and_key_together_stop_jog(scene: Scene) -> None:
    held(scene).hold.handle_direction_press("finger Z-1", "Z", -1, is_rapid=False)
    assert scene.stopped
    assert scene.nothing_more()


def test_any_other_key_stops_jog(scene: Scene) -> None:
    held(scene).hold.stop_for_other_key()
    assert scene.stopped
    assert scene.nothing_more()


def test_rapid_jog_stops_when_shift_is_released(scene: Scene) -> None:
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=True)
    scene.frames(0.1)
    assert scene.jogs[-1].velocity == pytest.approx(-100 * INCH / 60)
    scene.hold.release_shift_key()
    assert scene.stopped
    assert scene.nothing_more()


def test_shift_release_does_not_affect_slow_jog(scene: Scene) -> None:
    held(scene).hold.release_shift_key()
    assert scene.hold.active_jog is not None


def test_auto_repeat_release_and_press_pairs_are_ignored(scene: Scene) -> None:
    held(scene)
    for _ in range(10):
        scene.hold.record_key_repeat("Left")
        scene.frames(0.03)
    assert scene.hold.active_jog is not None
    assert StopJog() not in scene.posted


@pytest.mark.parametrize(
    "state",
    [MachineState.IDLE, MachineState.FAULT, MachineState.ESTOP, MachineState.DISABLED, MachineState.RUN],
)
def test_jog_ended_by_machine_is_not_restarted(scene: Scene, state: MachineState) -> None:
    held(scene)
    before = len(scene.jogs)
    scene.frames(FRAME, state)
    assert scene.hold.active_jog is None
    scene.frames(1.0, MachineState.IDLE)
    assert len(scene.jogs) == before


def test_jog_request_stops_when_machine_does_not_start(scene: Scene) -> None:
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)
    scene.frames(1.0, MachineState.IDLE)
    assert len(scene.jogs) == 1
    assert scene.stopped


def test_blocked_jog_moves_nothing_and_shows_reason(scene: Scene) -> None:
    scene.why = "A PROGRAM IS UNDER WAY"
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)
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
def test_jog_step_changes_displayed_position_by_step_length(
    scene: Scene, step: int, metric: bool, diameter: bool, axis: str, length: float
) -> None:
    scene.modal = ModalState(metric=metric, diameter=diameter)
    scene.frames(FRAME, MachineState.IDLE)
    scene.hold.jog_speeds.step_index = step
    scene.hold.handle_direction_press("key", axis, -1, is_rapid=False)
    (command,) = scene.posted
    assert isinstance(command, JogByStep)
    assert command.distance == pytest.approx(-length, abs=1e-12)


def test_key_hold_does_not_repeat_step_and_release_does_not_end_it(scene: Scene) -> None:
    scene.hold.jog_speeds.step_index = 1
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)
    for _ in range(30):
        scene.hold.record_key_repeat("Left")
        scene.frames(0.03)
    scene.hold.release_key("Left")
    assert len(scene.posted) == 1
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=False)
    assert len(scene.posted) == 2


def test_rapid_step_is_rejected(scene: Scene) -> None:
    scene.hold.jog_speeds.step_index = 1
    scene.hold.handle_direction_press("Left", "Z", -1, is_rapid=True)
    assert scene.posted == []
    assert shows(scene.said[-1], "jog.continuous-for-rapid")


def test_step_and_speed_selection_wraps_around(scene: Scene) -> None:
    speeds = scene.hold.jog_speeds
    seen = []
    for _ in range(6):
        seen.append(speeds.step_index)
        speeds.select_next_step()
    assert seen == [CONTINUOUS_STEP_INDEX, 0, 1, 2, 3, CONTINUOUS_STEP_INDEX]
    speeds.speed_index = 3
    speeds.select_next_speed()
    assert speeds.speed_index == 0

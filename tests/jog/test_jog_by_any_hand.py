"""Whatever hands do in whatever order: one axis at a time, and nothing held when nothing is pressed."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from core.executor.commands import Command, Jog, JogByStep, StopJog
from core.executor.snapshot import MachineState
from tests.jog.test_held_jog import FRAME, Scene

SOURCES = {"Left": ("Z", -1), "Right": ("Z", 1), "Up": ("X", -1), "Down": ("X", 1), "finger C1": ("C", 1)}
EVENTS = st.one_of(
    st.tuples(st.just("press"), st.sampled_from(sorted(SOURCES)), st.booleans()),
    st.tuples(st.just("release"), st.sampled_from(sorted(SOURCES)), st.none()),
    st.tuples(st.just("repeat"), st.sampled_from(sorted(SOURCES)), st.none()),
    st.tuples(st.sampled_from(["other", "shift", "step", "away", "lost", "frames"]), st.none(), st.none()),
)


def do(scene: Scene, event: tuple[str, str | None, bool | None], state: MachineState) -> None:
    what, source, rapid = event
    if what == "press" and source is not None:
        axis, sign = SOURCES[source]
        scene.hold.handle_direction_press(source, axis, sign, is_rapid=bool(rapid))
    elif what == "release" and source is not None:
        scene.hold.release_key(source)
    elif what == "repeat" and source is not None:
        scene.hold.record_key_repeat(source)
    elif what == "other":
        scene.hold.stop_for_other_key()
    elif what == "shift":
        scene.hold.release_shift_key()
    elif what == "step":
        scene.hold.release_all_keys("another step")
        scene.hold.jog_speeds.select_next_step()
    elif what == "away":
        scene.t += 1.0
    elif what == "lost":
        scene.hold.release_all_keys("the keyboard")
    else:
        scene.frames(5 * FRAME, state)


def moving_after(posted: list[Command]) -> set[tuple[str, float]]:
    """What the machine would still be asked to do, in how many directions since the last stop."""
    asked: set[tuple[str, float]] = set()
    for command in posted:
        if isinstance(command, StopJog):
            asked.clear()
        elif isinstance(command, Jog):
            asked.add((command.axis, command.velocity))
    return asked


@given(
    st.lists(EVENTS, max_size=40),
    st.sampled_from([MachineState.IDLE, MachineState.JOG, MachineState.RUN, MachineState.FAULT]),
)
@settings(max_examples=300, deadline=None)
def test_only_one_direction_moves_and_only_while_key_is_pressed(
    events: list[tuple[str, str | None, bool | None]], state: MachineState
) -> None:
    scene = Scene()
    for event in events:
        count = len(scene.posted)
        do(scene, event, state)
        assert len(moving_after(scene.posted)) <= 1
        if len(scene.hold.pressed_keys) != 1:
            assert scene.hold.active_jog is None
            assert not any(isinstance(command, Jog) for command in scene.posted[count:])
        if event[0] != "press":
            assert not any(isinstance(command, JogByStep) for command in scene.posted[count:])
    for source in SOURCES:
        scene.hold.release_key(source)
    assert scene.hold.active_jog is None
    assert moving_after(scene.posted) == set()
    count = len(scene.posted)
    scene.frames(1.0, MachineState.IDLE)
    assert len(scene.posted) == count

"""Whatever hands do in whatever order: one axis at a time, and nothing held when nothing is pressed."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from core.executor.commands import Command, Jog, JogStep, JogStop
from core.executor.snapshot import State
from tests.jog.test_held_jog import FRAME, Scene

SOURCES = {"Left": ("Z", -1), "Right": ("Z", 1), "Up": ("X", -1), "Down": ("X", 1), "finger C1": ("C", 1)}
EVENTS = st.one_of(
    st.tuples(st.just("press"), st.sampled_from(sorted(SOURCES)), st.booleans()),
    st.tuples(st.just("release"), st.sampled_from(sorted(SOURCES)), st.none()),
    st.tuples(st.just("repeat"), st.sampled_from(sorted(SOURCES)), st.none()),
    st.tuples(st.sampled_from(["other", "shift", "step", "away", "lost", "frames"]), st.none(), st.none()),
)


def do(scene: Scene, event: tuple[str, str | None, bool | None], state: State) -> None:
    what, source, rapid = event
    if what == "press" and source is not None:
        axis, sign = SOURCES[source]
        scene.hold.press(source, axis, sign, rapid=bool(rapid))
    elif what == "release" and source is not None:
        scene.hold.release(source)
    elif what == "repeat" and source is not None:
        scene.hold.repeated(source)
    elif what == "other":
        scene.hold.other_key()
    elif what == "shift":
        scene.hold.shift_released()
    elif what == "step":
        scene.hold.let_go("another step")
        scene.hold.speeds.next_step()
    elif what == "away":
        scene.t += 1.0
    elif what == "lost":
        scene.hold.let_go("the keyboard")
    else:
        scene.frames(5 * FRAME, state)


def moving_after(posted: list[Command]) -> set[tuple[str, float]]:
    """What the machine would still be asked to do, in how many directions since the last stop."""
    asked: set[tuple[str, float]] = set()
    for command in posted:
        if isinstance(command, JogStop):
            asked.clear()
        elif isinstance(command, Jog):
            asked.add((command.axis, command.velocity))
    return asked


@given(st.lists(EVENTS, max_size=40), st.sampled_from([State.IDLE, State.JOG, State.RUN, State.FAULT]))
@settings(max_examples=300, deadline=None)
def test_one_direction_at_a_time_and_nothing_without_a_hand(
    events: list[tuple[str, str | None, bool | None]], state: State
) -> None:
    scene = Scene()
    for event in events:
        count = len(scene.posted)
        do(scene, event, state)
        assert len(moving_after(scene.posted)) <= 1
        if len(scene.hold.down) != 1:
            assert scene.hold.held is None
            assert not any(isinstance(command, Jog) for command in scene.posted[count:])
        if event[0] != "press":
            assert not any(isinstance(command, JogStep) for command in scene.posted[count:])
    for source in SOURCES:
        scene.hold.release(source)
    assert scene.hold.held is None
    assert moving_after(scene.posted) == set()
    count = len(scene.posted)
    scene.frames(1.0, State.IDLE)
    assert len(scene.posted) == count

"""L: straight moves in the working plane, moves of rotary axes, M91."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.klartext import word_values
from core.interpreter.klartext.klartext_state import SAME_POINT, SLIDES, State
from core.language.klartext.klartext_faults import WRONG_AXIS, unsupported
from core.language.klartext.klartext_nodes import AxisWord, Move

AT_TARGET = 0.001  # degrees by which a table may miss its target before a cut is warned of


def move(state: State, node: Move, *, machine: bool) -> Iterator[Block]:
    """The block of an L; none where no axis is named. ``machine``: M91, coordinates of the machine."""
    if not node.axes:
        if node.feed is not None:
            _take_feed(state, node)
        return
    _demand_axes(state, node)
    _demand_no_compensation(state, node)
    goal = _slides(state, node, machine=machine) | _rotary(state, node)
    feed = _take_feed(state, node)
    if feed is not None:
        _warn(state, node)
    linear = any(abs(goal.get(name, state.at[name]) - state.at[name]) > SAME_POINT for name in SLIDES)
    rate = None if feed is None else (state.path_feed(feed) if linear else feed / 60.0)
    yield state.move(Kind.RAPID if rate is None else Kind.FEED, goal, rate)


def _demand_axes(state: State, node: Move) -> None:
    for word in node.axes:
        if word.axis not in state.at:
            text = f"This machine has no axis {word.axis}."
            raise state.refuse(word.column, WRONG_AXIS, text, "Take the word out.")


def _take_feed(state: State, node: Move) -> float | None:
    """The feed of the block, None for rapid, which holds for this block alone."""
    column = node.axes[0].column if node.axes else 1
    feed = word_values.feed_word(state, node.feed, column)
    if feed is not None and feed != state.feed:
        state.feed = feed
        state.modal = state.modal._replace(feed=state.path_feed(feed))
    return feed


def _slides(state: State, node: Move, *, machine: bool) -> dict[str, float]:
    named = {word.axis: word for word in node.axes if word.axis in SLIDES}
    if not named:
        return {}
    now = state.slides if machine else state.point
    x, y, z = (_goal(state, named.get(axis), at) for axis, at in zip(SLIDES, now, strict=True))
    goal = (x, y, z) if machine else state.place.machine((x, y, z))
    return dict(zip(SLIDES, goal, strict=True))


def _goal(state: State, word: AxisWord | None, now: float) -> float:
    if word is None:
        return now
    value = word_values.coordinate(state, word)
    return now + value if word.incremental else value


def _rotary(state: State, node: Move) -> dict[str, float]:
    """Rotary axes by the short way where they are modulo; an incremental word is the way itself."""
    goal = {}
    for axis in state.kinematics.rotaries:
        word = next((each for each in node.axes if each.axis == axis.name), None)
        if word is not None:
            value, now = word_values.coordinate(state, word), state.at[axis.name]
            state.table_known = state.table_known or not word.incremental
            goal[axis.name] = now + (value if word.incremental else axis.travel(now, value))
    return goal


def _demand_no_compensation(state: State, node: Move) -> None:
    """M128 would lead the tip along with the rotary axes; that is not built, so nothing may need it."""
    if not state.m128:
        return
    for axis in state.kinematics.rotaries:
        word = next((each for each in node.axes if each.axis == axis.name), None)
        if word is not None:
            raise unsupported(state.line, word.column, f"A move of {axis.name} with M128")
        aim = state.plane.targets[axis.name] if state.plane is not None else 0.0
        if abs(axis.travel(aim, state.at[axis.name])) > AT_TARGET:
            raise unsupported(state.line, node.axes[0].column, f"A move with M128 and {axis.name} swivelled")


def _warn(state: State, node: Move) -> None:
    """A cut with the table elsewhere than the plane asks, or with the spindle at rest: told once."""
    if all(word.axis not in SLIDES for word in node.axes):
        return
    if not state.modal.spindle and "spindle" not in state.reported:
        state.reported.add("spindle")
        text, hint = "This feed move runs with the spindle at rest.", "Start it with M3 or M4."
        state.log.warn(state.line, 0, "spindle-stopped", text, hint)
    plane = state.plane
    if plane is None or ("table", plane.line) in state.reported:
        return
    off = [
        axis.name
        for axis in state.kinematics.rotaries
        if abs(axis.travel(plane.targets[axis.name], state.at[axis.name])) > AT_TARGET
    ]
    if off:
        state.reported.add(("table", plane.line))
        text = f"{' and '.join(off)} stand elsewhere than the plane of line {plane.line} asks."
        hint = "Position them before the cut: L A+Q120 C+Q122 R0 FMAX, or TURN in the PLANE block."
        state.log.warn(state.line, 0, "table-elsewhere", text, hint)

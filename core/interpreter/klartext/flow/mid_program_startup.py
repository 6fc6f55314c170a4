"""Start of a pass from a saved state: MDI, and mid-program startup (RESTORE POS).

The modal state comes from the saved pass, and the axis positions are the present ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from core.interpreter.klartext.cycles.cycle_calls import Cycles
from core.interpreter.klartext.klartext_program import Flow
from core.interpreter.klartext.klartext_state import ORIGIN, SLIDES, State
from core.interpreter.klartext.motion.path_functions import PathRunner
from core.interpreter.klartext.setup.tool_call import measure_again
from core.interpreter.shared.actions import SpindleRun, SpindleStop
from core.interpreter.shared.checkpoint import AxesLeg, Begin, Checkpoint, FunctionStep, KeptPass, StateLine
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.klartext.klartext_nodes import KlartextLine
from core.message import Message


class Parts(NamedTuple):
    """State of an interpreter. ``taken`` is a line that was read but not yet executed."""

    state: State
    path: PathRunner
    cycles: Cycles
    flow: Flow
    taken: KlartextLine | None = None


def checkpoint_of(parts: Parts, shared: tuple[object, ...]) -> Checkpoint:
    """Return the state in which the next line begins; another pass can continue from it."""
    state = parts.state
    x, _, z = state.point
    return Checkpoint(
        state.modal,
        x=x,
        z=z,
        px=x,
        pz=z,
        blocks=state.blocks,
        kept=KeptPass(parts, shared, tuple(_lines(state))),
        at=state.there,
    )


def take_up(state: State, begin: Begin, *, inch: bool) -> None:
    """Set the present axis positions, tool, preset and machine functions in the state."""
    setup, point = state.setup, begin.checkpoint
    assert setup.kinematics is not None  # otherwise, the pass was rejected
    state.kinematics = setup.kinematics
    state.modal = point.modal._replace(absolute=True, metric=not inch)
    if state.modal.tool and not state.tool_axis:
        state.tool_axis = "Z"
    state.blocks = 0 if begin.single else point.blocks - len(begin.approach)
    state.stand(setup.start)
    measure_again(state)


def approach_blocks(state: State, begin: Begin) -> Iterator[Block]:
    """Yield the blocks of the approach.

    They are numbered so that later blocks have the same numbers as in a full run.
    """
    wanted = state.modal
    if begin.approach:
        state.modal = wanted._replace(spindle=0)
    for step in begin.approach:
        state.line, state.text = begin.line, step.text
        match step:
            case AxesLeg():
                yield state.move(Kind.RAPID if step.feed is None else Kind.FEED, dict(step.goal), step.feed)
            case FunctionStep():
                if isinstance(step.action, SpindleRun | SpindleStop):
                    turns = wanted.spindle if isinstance(step.action, SpindleRun) else 0
                    state.modal = state.modal._replace(spindle=turns)
                yield state.action(step.action)
            case _:
                raise TypeError(f"no step of a mill's way: {step}")
    state.modal = wanted


def _lines(state: State) -> Iterator[StateLine]:
    """Yield the modal state, one line for each group of functions."""
    modal, figure = state.modal, state.figure
    yield StateLine("tool", f"T{modal.tool} {state.tool_axis}".rstrip() if modal.tool else "")
    yield StateLine("length", f"L{state.tool_length:+.3f}  R{state.tool_radius:+.3f}" if modal.tool else "")
    yield StateLine("speed", f"S{modal.rpm:g}" if modal.rpm else "")
    held = f"M19 {modal.oriented:g}" if modal.oriented is not None else "M5"
    yield StateLine("spindle", {1: "M3", 0: held, -1: "M4"}[modal.spindle])
    yield StateLine("feed", f"F{state.feed_per}{state.feed:g}" if state.feed is not None else "")
    yield StateLine("preset", str(state.setup.preset))
    yield StateLine("datum", _words(SLIDES, state.origin) if state.origin != ORIGIN else "")
    yield StateLine("plane", _plane(state))
    turned = f"ROT{figure.rotation:+g}" if figure.rotation else ""
    scaled = f"SCL{figure.factor:g}" if figure.factor != 1.0 else ""
    mirrored = Message("MIRROR {mirrored}", mirrored=figure.mirrored) if figure.mirrored else ""
    yield StateLine("transform", "  ".join(each for each in (mirrored, turned, scaled) if each))
    yield StateLine("tcpm", "M128" if state.m128 else "M129")
    yield StateLine("coolant", "M8" if modal.coolant else "M9")
    yield StateLine("outputs", " ".join(sorted(name.upper() for name in modal.outputs)))


def _plane(state: State) -> str:
    """Return the displayed angles of the active plane as text."""
    if state.plane is None:
        return ""
    axes = sorted(state.kinematics.rotaries, key=lambda axis: axis.name)
    angles = ((axis.name, state.kinematics.shown(axis, state.plane.targets[axis.name])) for axis in axes)
    return "  ".join(f"{name}{angle:+.3f}" for name, angle in angles)


def _words(names: str, at: tuple[float, float, float]) -> str:
    return "  ".join(f"{name}{value:+.3f}" for name, value in zip(names, at, strict=True))

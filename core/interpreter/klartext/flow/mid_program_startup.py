"""Start of a pass from a saved state, for MDI and for mid-program startup (RESTORE POS).

The modal state comes from the saved pass. The axis positions are the current positions.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from core.interpreter.klartext.cycles.cycle_calls import ActiveCycle
from core.interpreter.klartext.klartext_program import Flow
from core.interpreter.klartext.klartext_state import LINEAR_AXES, ORIGIN_POINT, State
from core.interpreter.klartext.motion.path_functions import PathRunner
from core.interpreter.klartext.setup.tool_call import update_tool_dimensions
from core.interpreter.shared.actions import SpindleRun, SpindleStop
from core.interpreter.shared.checkpoint import (
    Checkpoint,
    FunctionStep,
    ModalStateLine,
    MultiAxisLeg,
    PassStart,
    SavedPass,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.klartext.klartext_nodes import KlartextLine
from core.message import Message


class InterpreterParts(NamedTuple):
    """The parts of an interpreter's state. ``pending_line`` was already read but not yet executed."""

    state: State
    path_runner: PathRunner
    active_cycle: ActiveCycle
    program_flow: Flow
    pending_line: KlartextLine | None = None


def make_checkpoint(parts: InterpreterParts, shared: tuple[object, ...]) -> Checkpoint:
    """Return a checkpoint at the start of the next line, from which another pass can continue."""
    state = parts.state
    x, _, z = state.tip_in_plane
    return Checkpoint(
        state.modal,
        x=x,
        z=z,
        px=x,
        pz=z,
        blocks=state.block_count,
        kept=SavedPass(parts, shared, tuple(_lines(state))),
        at=state.axis_positions,
    )


def restore_state(state: State, start: PassStart, *, is_inch: bool) -> None:
    """Update the state with the current axis positions, tool, preset and machine functions."""
    setup, point = state.setup, start.checkpoint
    assert setup.kinematics is not None  # otherwise, the pass was rejected
    state.kinematics = setup.kinematics
    state.modal = point.modal._replace(absolute=True, metric=not is_inch)
    if state.modal.tool and not state.tool_axis:
        state.tool_axis = "Z"
    state.block_count = 0 if start.is_mdi_line else point.blocks - len(start.approach_steps)
    state.set_machine_positions(setup.start)
    update_tool_dimensions(state)


def generate_mill_approach(state: State, start: PassStart) -> Iterator[Block]:
    """Yield the blocks of the approach to the start position.

    The blocks are numbered so that later blocks have the same numbers as in a full run.
    """
    wanted = state.modal
    if start.approach_steps:
        state.modal = wanted._replace(spindle=0)
    for step in start.approach_steps:
        state.line_number, state.text = start.line_number, step.text
        match step:
            case MultiAxisLeg():
                yield state.make_move_block(
                    BlockKind.RAPID if step.feed is None else BlockKind.FEED,
                    dict(step.target_positions),
                    step.feed,
                )
            case FunctionStep():
                if isinstance(step.action, SpindleRun | SpindleStop):
                    turns = wanted.spindle if isinstance(step.action, SpindleRun) else 0
                    state.modal = state.modal._replace(spindle=turns)
                yield state.make_action_block(step.action)
            case _:
                raise TypeError(f"no step of a mill's way: {step}")
    state.modal = wanted


def _lines(state: State) -> Iterator[ModalStateLine]:
    """Yield the modal state as text, with one line for each group of functions."""
    modal, figure = state.modal, state.transformation
    yield ModalStateLine("tool", f"T{modal.tool} {state.tool_axis}".rstrip() if modal.tool else "")
    yield ModalStateLine(
        "length", f"L{state.tool_length_mm:+.3f}  R{state.tool_radius_mm:+.3f}" if modal.tool else ""
    )
    yield ModalStateLine("speed", f"S{modal.rpm:g}" if modal.rpm else "")
    held = f"M19 {modal.oriented:g}" if modal.oriented is not None else "M5"
    yield ModalStateLine("spindle", {1: "M3", 0: held, -1: "M4"}[modal.spindle])
    yield ModalStateLine("feed", f"F{state.feed_base}{state.feed:g}" if state.feed is not None else "")
    yield ModalStateLine("preset", str(state.setup.preset))
    yield ModalStateLine("datum", _words(LINEAR_AXES, state.origin) if state.origin != ORIGIN_POINT else "")
    yield ModalStateLine("plane", _plane(state))
    turned = f"ROT{figure.rotation_deg:+g}" if figure.rotation_deg else ""
    scaled = f"SCL{figure.scale_factor:g}" if figure.scale_factor != 1.0 else ""
    mirrored = Message("MIRROR {mirrored}", mirrored=figure.mirrored_axes) if figure.mirrored_axes else ""
    yield ModalStateLine("transform", "  ".join(each for each in (mirrored, turned, scaled) if each))
    yield ModalStateLine("tcpm", "M128" if state.is_tcpm_active else "M129")
    yield ModalStateLine("coolant", "M8" if modal.coolant else "M9")
    yield ModalStateLine("outputs", " ".join(sorted(name.upper() for name in modal.outputs)))


def _plane(state: State) -> str:
    """Return the displayed angles of the active plane as text."""
    if state.active_plane is None:
        return ""
    axes = sorted(state.kinematics.rotary_axes, key=lambda axis: axis.name)
    angles = (
        (axis.name, state.kinematics.get_displayed_angle(axis, state.active_plane.target_angles[axis.name]))
        for axis in axes
    )
    return "  ".join(f"{name}{angle:+.3f}" for name, angle in angles)


def _words(names: str, at: tuple[float, float, float]) -> str:
    return "  ".join(f"{name}{value:+.3f}" for name, value in zip(names, at, strict=True))

"""Machine functions that a program requires in addition to straight moves.

A machine that lacks one of these functions rejects the program.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from core.interpreter.shared.actions import (
    Action,
    ColletSwitch,
    CoolantSwitch,
    InputRead,
    InputWait,
    OutputSwitch,
    SpindleLock,
    SpindlePositioning,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.message import Message

ARC_MOTION = "arc"
THREADING = "thread"
THREAD_PULLOUT = "pull-out"  # pull-out of a thread, synchronized with the spindle
THREAD_CHAIN = "thread-chain"
SURFACE_SPEED = "surface-speed"
SURFACE_SPEED_THREAD = "surface-thread"
C_AXIS = "c-axis"
SPINDLE_ORIENTATION = "orient"
PLANE_SWITCHING = "plane"
ADDITIONAL_AXES = "axes"
BUILDER_M_PREFIX = "M"
"""Prefix of the number of an M function that this machine does not implement."""

_WORDS = {
    ARC_MOTION: "arcs",
    THREADING: "threads",
    THREAD_PULLOUT: "a thread pull-out synchronized with the spindle; end the thread in a groove instead",
    THREAD_CHAIN: (
        "chained threads or threads with a variable lead; cut each thread separately "
        "with its own lead instead"
    ),
    SURFACE_SPEED: "constant surface speed; program the spindle speed in rpm with G97 instead",
    SURFACE_SPEED_THREAD: "threading with constant surface speed; program G97 before the thread",
    C_AXIS: "the C axis",
    SPINDLE_ORIENTATION: "spindle orientation to an angle",
    PLANE_SWITCHING: "milling with the plane commands (~PLXC) and (~PLZC)",
    ADDITIONAL_AXES: "axes other than X and Z",
}


class MachineRequirement(NamedTuple):
    """A machine function that a program requires, and the first line that requires it."""

    required_function: str
    first_line: int

    @property
    def missing_m_code(self) -> int:
        """Return the number of the machine builder's M function that this machine lacks.

        Returns 0 if the requirement is not an M function.
        """
        number = self.required_function.removeprefix(BUILDER_M_PREFIX)
        return int(number) if self.required_function != number and number.isdigit() else 0

    @property
    def description(self) -> str:
        """Return the description of the requirement for the operator."""
        if self.missing_m_code:
            return Message(
                "{what}; {builders_m}",
                what=self.required_function,
                builders_m=format_m_code_instruction(self.missing_m_code),
            )
        return _WORDS.get(self.required_function, self.required_function)


def format_m_code_instruction(code: int) -> Message:
    """Return the machine file lines that assign a function to a machine builder's M code."""
    return Message(
        'write {code} = {{ output = "NAME", on = true }} under [m_codes] in the machine '
        "file, where NAME is an output under [io.out], or {code2} = {{ ignored = true }} if "
        "the code does nothing on this machine",
        code=code,
        code2=code,
    )


def list_requirements(
    blocks: Iterable[Block], previous_block: Block | None = None
) -> Iterator[MachineRequirement]:
    """Yield the requirements of these blocks; ``previous_block`` precedes the first block."""
    for block in blocks:
        yield from (MachineRequirement(what, block.line) for what in _needs(block, previous_block))
        previous_block = block


def remove_repeated_requirements(
    requirements: Iterable[MachineRequirement],
) -> tuple[MachineRequirement, ...]:
    """Return each requirement once, with the first line that needs it."""
    first: dict[str, MachineRequirement] = {}
    for need in requirements:
        first.setdefault(need.required_function, need)
    return tuple(first.values())


def _needs(block: Block, before: Block | None) -> Iterator[str]:
    if block.action is not None:
        yield from _action_requirements(block.action)
        return
    if block.c != block.c0:
        yield C_AXIS
    if block.travel is not None or block.kind is BlockKind.PLANE:
        yield ADDITIONAL_AXES
    elif block.plane is not None:
        yield PLANE_SWITCHING
    if block.kind is BlockKind.ARC:
        yield ARC_MOTION
    if block.kind is BlockKind.THREAD:
        if block.continues or block.growth:
            yield THREAD_CHAIN
        else:
            yield THREAD_PULLOUT if before is not None and before.kind is BlockKind.THREAD else THREADING
    if block.css is not None and block.rpm != 0.0:
        yield SURFACE_SPEED
        if block.kind is BlockKind.THREAD:
            yield SURFACE_SPEED_THREAD


def _action_requirements(action: Action) -> Iterator[str]:
    """Yield the inputs, outputs and spindle functions that an action requires."""
    match action:
        case SpindleLock():
            yield C_AXIS
        case SpindlePositioning():
            yield SPINDLE_ORIENTATION
        case OutputSwitch(name=name):
            yield Message("output {name}", name=name)
        case ColletSwitch():
            yield "output collet"
        case CoolantSwitch():
            yield "output coolant"
        case InputWait(terminal=terminal) | InputRead(terminal=terminal):
            yield Message("input {name}", name=terminal)
        case _:
            return

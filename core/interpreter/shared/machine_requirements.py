"""Functions other than straight moves that a program requires. A machine without them rejects the program."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from core.interpreter.shared.actions import (
    Action,
    AskInput,
    Collet,
    Coolant,
    Output,
    SpindleLock,
    SpindleOrient,
    WaitInput,
)
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.message import Message

ARC = "arc"
THREAD = "thread"
PULL_OUT = "pull-out"  # pull-out of a thread, synchronized with the spindle
THREAD_CHAIN = "thread-chain"
SURFACE = "surface-speed"
SURFACE_THREAD = "surface-thread"
C_AXIS = "c-axis"
ORIENT = "orient"
PLANE = "plane"
AXES = "axes"
BUILDERS_M = "M"
"""Before the number of an M function that nothing on this machine answers."""

_WORDS = {
    ARC: "arcs",
    THREAD: "threads",
    PULL_OUT: "a thread pull-out synchronized with the spindle; end the thread in a groove instead",
    THREAD_CHAIN: (
        "chained threads or threads with a variable lead; cut each thread separately "
        "with its own lead instead"
    ),
    SURFACE: "constant surface speed; program the spindle speed in rpm with G97 instead",
    SURFACE_THREAD: "threading with constant surface speed; program G97 before the thread",
    C_AXIS: "the C axis",
    ORIENT: "spindle orientation to an angle",
    PLANE: "milling with the plane commands (~PLXC) and (~PLZC)",
    AXES: "axes other than X and Z",
}


class Need(NamedTuple):
    """A machine function that a program needs, and the first line that needs it."""

    what: str
    line: int

    @property
    def builders_m(self) -> int:
        """Number of the M function that this machine does not have; 0 for other needs."""
        number = self.what.removeprefix(BUILDERS_M)
        return int(number) if self.what != number and number.isdigit() else 0

    @property
    def words(self) -> str:
        """Description of the need for the operator."""
        if self.builders_m:
            return Message("{what}; {builders_m}", what=self.what, builders_m=how_bound(self.builders_m))
        return _WORDS.get(self.what, self.what)


def how_bound(code: int) -> Message:
    """Return the lines of a machine file that assign a function to a builder's M code."""
    return Message(
        'write {code} = {{ output = "NAME", on = true }} under [m_codes] in the machine '
        "file, where NAME is an output under [io.out], or {code2} = {{ ignored = true }} if "
        "the code does nothing on this machine",
        code=code,
        code2=code,
    )


def needs_of(blocks: Iterable[Block], before: Block | None = None) -> Iterator[Need]:
    """Yield the needs of these blocks; ``before`` is the block that precedes the first one."""
    for block in blocks:
        yield from (Need(what, block.line) for what in _needs(block, before))
        before = block


def first_needs(needs: Iterable[Need]) -> tuple[Need, ...]:
    """Return each need once, with the first line that needs it."""
    first: dict[str, Need] = {}
    for need in needs:
        first.setdefault(need.what, need)
    return tuple(first.values())


def _needs(block: Block, before: Block | None) -> Iterator[str]:
    if block.action is not None:
        yield from _of_action(block.action)
        return
    if block.c != block.c0:
        yield C_AXIS
    if block.travel is not None or block.kind is Kind.PLANE:
        yield AXES
    elif block.plane is not None:
        yield PLANE
    if block.kind is Kind.ARC:
        yield ARC
    if block.kind is Kind.THREAD:
        if block.continues or block.growth:
            yield THREAD_CHAIN
        else:
            yield PULL_OUT if before is not None and before.kind is Kind.THREAD else THREAD
    if block.css is not None and block.rpm != 0.0:
        yield SURFACE
        if block.kind is Kind.THREAD:
            yield SURFACE_THREAD


def _of_action(action: Action) -> Iterator[str]:
    """Yield the inputs, outputs and spindle functions that an action needs."""
    match action:
        case SpindleLock():
            yield C_AXIS
        case SpindleOrient():
            yield ORIENT
        case Output(name=name):
            yield Message("output {name}", name=name)
        case Collet():
            yield "output collet"
        case Coolant():
            yield "output coolant"
        case WaitInput(terminal=terminal) | AskInput(terminal=terminal):
            yield Message("input {name}", name=terminal)
        case _:
            return

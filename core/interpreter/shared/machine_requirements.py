"""What a program asks of a machine beyond straight lines; one that cannot do it refuses before the start."""

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
PULL_OUT = "pull-out"  # of a thread, in step with the spindle
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
    """Something that a program needs, and the first line that needs it."""

    what: str
    line: int

    @property
    def builders_m(self) -> int:
        """The number of the M function that nothing answers; 0 for another need."""
        number = self.what.removeprefix(BUILDERS_M)
        return int(number) if self.what != number and number.isdigit() else 0

    @property
    def words(self) -> str:
        """The need in words for the operator, where it has any."""
        if self.builders_m:
            return Message("{what}; {builders_m}", what=self.what, builders_m=how_bound(self.builders_m))
        return _WORDS.get(self.what, self.what)


def how_bound(code: int) -> Message:
    """The lines of a machine file that give a builder's M function its meaning."""
    return Message(
        'write {code} = {{ output = "NAME", on = true }} under [m_codes] in the machine '
        "file, where NAME is an output under [io.out], or {code2} = {{ ignored = true }} if "
        "the code does nothing on this machine",
        code=code,
        code2=code,
    )


def needs_of(blocks: Iterable[Block], before: Block | None = None) -> Iterator[Need]:
    """What these blocks need, once for each that needs it; ``before`` is the block in front of them."""
    for block in blocks:
        yield from (Need(what, block.line) for what in _needs(block, before))
        before = block


def first_needs(needs: Iterable[Need]) -> tuple[Need, ...]:
    """Each need once, with its first line."""
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
    """Terminals, by name, and the spindle as an axis."""
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

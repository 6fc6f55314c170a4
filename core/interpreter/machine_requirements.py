"""What a program asks of a machine beyond straight lines; one that cannot do it refuses before the start."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from core.interpreter.actions import Action, AskInput, Collet, Coolant, Output, SpindleLock, WaitInput
from core.interpreter.elementary_blocks import Block, Kind

ARC = "arc"
THREAD = "thread"
PULL_OUT = "pull-out"  # of a thread, in step with the spindle
SURFACE = "surface-speed"
C_AXIS = "c-axis"
PLANE = "plane"
AXES = "axes"

_WORDS = {
    ARC: "arcs",
    THREAD: "threads",
    PULL_OUT: "a thread that pulls out in step with the spindle; end it in a groove",
    SURFACE: "constant surface speed; program the spindle in rpm with G97",
    C_AXIS: "the C axis",
    PLANE: "milling in a switched plane",
    AXES: "more axes than X and Z",
}


class Need(NamedTuple):
    """Something that a program needs, and the first line that needs it."""

    what: str
    line: int

    @property
    def words(self) -> str:
        """The need in words for the operator, where it has any."""
        return _WORDS.get(self.what, self.what)


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
        yield PULL_OUT if before is not None and before.kind is Kind.THREAD else THREAD
    if block.css is not None and block.rpm != 0.0:
        yield SURFACE


def _of_action(action: Action) -> Iterator[str]:
    """Terminals, by name, and the spindle as an axis."""
    match action:
        case SpindleLock():
            yield C_AXIS
        case Output(name=name):
            yield f"output {name}"
        case Collet():
            yield "output collet"
        case Coolant():
            yield "output coolant"
        case WaitInput(terminal=terminal) | AskInput(terminal=terminal):
            yield f"input {terminal}"
        case _:
            return

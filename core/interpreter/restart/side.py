"""Whether a tool works inside of a bore: told by how the program itself takes it off the work next."""

from __future__ import annotations

from collections.abc import Iterable

from core.interpreter.blocks import Block

_LEAST = 1e-4  # mm
_ON_CENTRE = 0.05  # mm of radius; a tool there drills, and comes out along Z
_LOOKED = 400  # blocks


def works_inside(x: float, blocks: Iterable[Block]) -> bool:
    """``x`` (mm, radius, part frame) is where the tool stands; ``blocks`` come next.

    The first move along X alone with a move to Z+ behind it is how the tool is taken off: towards the centre
    line inside a bore, away from it outside. Without one it works outside, unless it stands on the centre.
    """
    before: Block | None = None
    tool: int | None = None
    for count, block in enumerate(blocks):
        if not block.moves:
            continue
        tool = block.modal.tool if tool is None else tool
        if block.modal.tool != tool or count > _LOOKED:
            break
        if before is not None and block.z - block.z0 > _LEAST and _along_x(before):
            return abs(before.x) < abs(before.x0)
        before = block
    return abs(x) < _ON_CENTRE


def _along_x(block: Block) -> bool:
    return abs(block.x - block.x0) > _LEAST and abs(block.z - block.z0) <= _LEAST

"""Whether a tool works inside of a bore: told by how the program itself takes it off the work next."""

from __future__ import annotations

from collections.abc import Iterable

from core.interpreter.blocks import Block, Kind

_LEAST = 1e-4  # mm
_ON_CENTRE = 0.05  # mm of radius; a tool there drills, and comes out along Z
_LOOKED = 400  # blocks


def works_inside(x: float, blocks: Iterable[Block]) -> bool:
    """``x`` (mm, radius, part frame) is where the tool stands; ``blocks`` come next.

    The last change of radius up to the first rapid towards Z+ is how the tool is taken off: away from the
    centre line outside; towards it, or not at all, inside a bore and on a face, where the way in along Z is
    the way out the other way round. Where no rapid follows it works outside, unless it stands on the centre.
    """
    off = 0.0
    tool: int | None = None
    for count, block in enumerate(blocks):
        if not block.moves:
            continue
        tool = block.modal.tool if tool is None else tool
        if block.modal.tool != tool or count > _LOOKED:
            break
        change = abs(block.x) - abs(block.x0)
        off = change if abs(change) > _LEAST else off
        if block.kind is Kind.RAPID and block.z - block.z0 > _LEAST:
            return off <= 0.0
    return abs(x) < _ON_CENTRE

"""Moves of a block: G0 and G1, C with X and Z or alone; what all of them share."""

from __future__ import annotations

from core.interpreter.blocks import Block, Kind
from core.interpreter.sinumerik.feeds import check_feed
from core.interpreter.sinumerik.state import State
from core.interpreter.sinumerik.statement import Statement
from core.interpreter.sinumerik.travel import Way, way_of
from core.language.sinumerik.vocabulary import ARC


def straight(state: State, made: Statement) -> Block:
    """G0 or G1 to where the words lead. Raises ProgramError."""
    for name in sorted(ARC & made.words.keys()):
        text = f"{made.words[name].text} belongs to an arc, and G{state.motion} is in force."
        raise made.refuse(made.words[name], "word-unused", text, "Write G2 or G3, or take it out.")
    way = way_of(state, made)
    offset = way.offset_x
    if state.motion == 0:
        speeds = state.setup.limits.speeds
        return block_of(state, made, way, Kind.RAPID, way.rapid_rate(speeds))
    feed = check_feed(state, made, way.x0 - offset, way.x - offset)
    kind = Kind.ROTATE if way.turn and not way.length else Kind.FEED
    return block_of(state, made, way, kind, feed)


def block_of(state: State, made: Statement, way: Way, kind: Kind, feed: float) -> Block:
    """The block of a way; the state then stands at its end."""
    state.x, state.z, state.c = way.x, way.z, way.c
    modal = way.modal
    dx, dz, dc = way.offset_x, way.offset_z, modal.offset_c
    return Block(
        n=0, line=made.line.number, kind=kind, text=made.line.text,
        x0=way.x0 - dx, z0=way.z0 - dz, c0=way.c0 - dc, x=way.x - dx, z=way.z - dz, c=way.c - dc,
        offset_x=dx, offset_z=dz, modal=modal, feed=feed, per_rev=modal.per_rev and kind is not Kind.RAPID,
        rpm=state.rpm_at(way.x - dx), css=state.css,
    )  # fmt: skip

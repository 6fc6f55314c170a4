"""Elementary blocks as rows of a table: what Klartext and SINUMERIK goldens are held against.

A row is ``line what …``: mm, degrees and mm/min, in the program's own system::

    5 feed 15 0 -5 F 300
    6 arc 20 5 -5 way 7.853982 F 300
    5 arc 15 -15 centre 15 -10 F 100

Klartext tells X Y Z of the working plane, and the length of an arc; a corner of RND and CHF is told by the
element behind it. SINUMERIK tells X (a radius) Z and the centre of an arc, and C where it turns. A feed per
revolution is ``F 0.2 rev``, a thread has its lead, a constant surface speed its m/min and the rpm.
With ``axes`` rotary axes stand behind; a PLANE block tells these alone.
"""

from __future__ import annotations

import math

from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block, BlockKind

NEAR = 6e-7
Row = list[str | float]


def row(block: Block, *, axes: bool, machine: bool = False) -> Row:
    """A block as its row of the table; ``machine``: X Y Z of a mill's machine instead of the plane's."""
    if block.action is not None:
        return [block.line, *_action(block.action)]
    return [
        block.line,
        *(_on_lathe(block) if block.swivel is None else _on_mill(block, axes=axes, machine=machine)),
    ]


def _action(action: actions.Action) -> Row:
    words: Row = []
    match action:
        case actions.ToolChange(tool):
            words = ["tool", tool]
        case actions.SpindleRun(rpm, None):
            words = ["spindle", rpm]
        case actions.SpindleRun(rpm, float(surface)):
            words = ["surface", 0.06 * surface, rpm]
        case actions.SpindleStop():
            words = ["spindle-off"]
        case actions.Dwell(seconds):
            words = ["dwell", seconds]
        case actions.ProgramEnd():
            words = ["end"]
    return words or switch_words(action) or flow_words(action)


def _feed(block: Block) -> Row:
    if block.kind is BlockKind.THREAD:
        return ["lead", block.feed]
    if block.per_rev:
        return ["F", block.feed, "rev"]
    return [] if block.rapid else ["F", 60.0 * block.feed]


def _on_lathe(block: Block) -> Row:
    centre: Row = ["centre", block.cx, block.cz] if block.kind is BlockKind.ARC else []
    turned: Row = ["C", block.c] if block.c != block.c0 else []
    return [str(block.kind), block.x, block.z, *centre, *turned, *_feed(block)]


def _on_mill(block: Block, *, axes: bool, machine: bool) -> Row:
    assert block.swivel is not None
    assert block.travel is not None
    stands = zip("ABC", block.swivel.rotary_angles, strict=True)
    rotary: Row = [word for name, at in stands if at is not None for word in (name, at)]
    if block.kind is BlockKind.PLANE:
        return ["plane", *rotary]
    arc = block.kind is BlockKind.PLANE_ARC
    way: Row = ["way", block.travel.length] if arc else []
    place: Row = [*(block.travel.end[:3] if machine else block.swivel.end)]
    return ["arc" if arc else str(block.kind), *place, *way, *_feed(block), *(rotary if axes else [])]


def _figure(word: str) -> float:
    """A figure of a table; one that is none is as far from any other as can be."""
    try:
        return float(word)
    except ValueError:
        return math.inf


def same(found: Row, expected: list[str]) -> bool:
    """Whether a row says what the table says."""
    if len(found) != len(expected):
        return False
    return all(
        want == "*" or (have == want if isinstance(have, str) else abs(have - _figure(want)) < NEAR)
        for have, want in zip(found, expected, strict=True)
    )


def switch_words(action: actions.Action) -> Row:
    """M functions that switch something; nothing for any other."""
    words: Row = []
    match action:
        case actions.CoolantSwitch(on):
            words = ["coolant", "on" if on else "off"]
        case actions.ColletSwitch(closed):
            words = ["collet", "closed" if closed else "open"]
        case actions.OutputSwitch(name, on):
            words = ["output", name, "on" if on else "off"]
        case actions.SpindleLock(orient):
            words = ["lock", "orient"] if orient else ["lock"]
        case actions.SpindlePositioning(angle, sense):
            words = ["oriented", angle, *(["as", "M3" if sense > 0 else "M4"] if sense else [])]
    return words


def flow_words(action: actions.Action) -> Row:
    """Stops, ends and inputs; nothing for any other."""
    words: Row = []
    match action:
        case actions.ProgramStop(optional, message):
            words = ["optional-stop" if optional else "stop", *message.split()]
        case actions.ProgramEnd(reset):
            words = ["end", "reset"] if reset else ["end"]
        case actions.InputWait(terminal, closed):
            words = ["wait", terminal, "closed" if closed else "open"]
        case actions.InputRead(terminal):
            words = ["ask", terminal]
    return words

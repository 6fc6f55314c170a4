"""Checks of the size of a cut: depth and feed against insert, boring bar, blade and drill."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from core.interpreter.elementary_blocks import Kind
from core.message import Message
from core.part.cutter import Cutter
from core.part.insert_codes import Insert, InsertCodeError, decoded, insert_of
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Cut
from core.proving.assumed_tools import GROOVERS
from core.proving.thread_checks import Found
from core.proving.tip_moves import TipMove
from core.tool_edges import edge_name

# Largest usual depth of cut in lengths of the cutting edge (a round insert: diameters), for medium
# geometries: Widia, "Selection of insert", the column -LM of its table of effective lengths.
USUAL: Mapping[str, float] = {"S": 0.5, "C": 0.5, "W": 0.4, "T": 0.3, "D": 0.3, "V": 0.2, "R": 0.3}
_OTHER_SHAPE = 0.5
# The largest share that makers allow for roughing geometries.
LARGEST: Mapping[str, float] = {"S": 2 / 3, "C": 2 / 3, "W": 0.5, "T": 0.5, "D": 0.5, "V": 0.25, "R": 0.4}
_OF_BAR = 0.5  # of a boring bar's diameter
_USUAL = insert_of("C", 12.7, 0.8)  # CNMG432, the largest that a small lathe usually has

_COARSE = 0.8  # of the nose radius: the usual limit of a turned face
_OF_WIDTH = 0.12  # of a grooving edge; Ingersoll's catalog of 2011 has .075
_OF_DRILL = 0.04  # of the diameter of a drill: twice the usual .02
_OF_REAMER = 0.1
_BREAKS = 5.0  # times one of these; drills and blades are made for feeds that differ by so much
_BREAKS_INSERT = 2.5
_NEVER_BREAKS = 0.15  # mm of feed of an insert, however sharp its nose
_TURNS_WIDE = 0.8  # of the width, by a grooving edge along Z: the same catalog
_BLADE_FINISH = 0.25  # mm along Z that a parting blade may take off

_DRILLS = frozenset({ToolKind.DRILL, ToolKind.CENTRE_DRILL, ToolKind.REAMER})
INSERTS = frozenset({ToolKind.TURNING, ToolKind.BORING})


def size_faults(
    move: TipMove, met: Cut, shape: ToolShape, cutter: Cutter, tool: int, *, stock_given: bool
) -> Iterator[Found]:
    """Yield what is too large in a feed that has just cut ``met``."""
    yield from _feed(move, shape, tool, held=cutter.held)
    if move.kind is Kind.THREAD:
        return
    if shape.kind in GROOVERS:
        yield from _blade_turns(move, met, shape, tool)
    elif shape.kind in INSERTS:
        yield from _depth(move, met, shape, cutter, tool, stock_given=stock_given)


def _feed(move: TipMove, shape: ToolShape, tool: int, *, held: bool) -> Iterator[Found]:
    """Feed per revolution against nose radius, width of a groover or diameter of a drill."""
    feed = move.per_rev or (move.speed * 60.0 / abs(move.rpm) if move.rpm else 0.0)
    if not feed or move.kind is Kind.THREAD or shape.kind is ToolKind.TAP:
        return
    name, text = edge_name(tool), move.modal.length_text
    shown, limit, words = move.modal.feed_text(feed, per_rev=True), 0.0, ""
    breaks, least = _BREAKS, 0.0
    if shape.kind in _DRILLS and held:
        limit = (_OF_REAMER if shape.kind is ToolKind.REAMER else _OF_DRILL) * shape.diameter
        words = Message(
            "{name} feeds at {value}, which is too high for a diameter of {diameter}.",
            name=name,
            value=shown,
            diameter=text(shape.diameter),
        )
    elif shape.kind in GROOVERS and held:
        limit = _OF_WIDTH * shape.width
        words = Message(
            "{name} feeds at {value}, which is too high for a cutting edge {width} wide.",
            name=name,
            value=shown,
            width=text(shape.width),
        )
    elif shape.kind in INSERTS:
        limit, breaks, least = _COARSE * shape.nose_radius, _BREAKS_INSERT, _NEVER_BREAKS
        words = Message(
            "{name} feeds at {value}, which is too high for a nose radius of {nose_radius}.",
            name=name,
            value=shown,
            nose_radius=text(shape.nose_radius),
        )
    if feed > max(breaks * limit, least) and limit:
        yield Found("feed-breaks-tool", words)
    elif feed > limit > 0.0:
        yield Found("chip-load", words)


def _is_along(move: TipMove) -> bool:
    """Return whether a move goes along Z rather than across it."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    return abs(z1 - z0) > abs(r1 - r0)


def _blade_turns(move: TipMove, met: Cut, shape: ToolShape, tool: int) -> Iterator[Found]:
    """A blade that turns further along Z than it is wide, and deeper than it can bend.

    A chamfer at 45° is not such a move, nor the last shaving off the wall of a groove.
    """
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    if abs(z1 - z0) <= 2.0 * abs(r1 - r0):
        return
    limit = _BLADE_FINISH if shape.kind is ToolKind.PARTING else _TURNS_WIDE * shape.width
    if met.depth > limit > 0.0 and met.width > shape.width:
        text = move.modal.length_text
        words = Message(
            "{tool} turns {depth} deep along Z; this type of blade allows at most {limit}.",
            tool=edge_name(tool),
            depth=text(met.depth),
            limit=text(limit),
        )
        yield Found("blade-turns", words)


def _depth(
    move: TipMove, met: Cut, shape: ToolShape, cutter: Cutter, tool: int, *, stock_given: bool
) -> Iterator[Found]:
    """Depth of a cut against the length of the edge, and against the bar of a boring tool.

    It is the mean depth: a finishing pass that ends in a shoulder shaves all of it for a moment. Across it is
    the mean of Z. A pass that is deeper anywhere than its edge is long is an error, and so is one that is
    deeper on the average than any insert of this shape, or the bar of a boring tool, can take.
    """
    along, text = _is_along(move), move.modal.length_text
    deep = _mean(met, along=along)
    if along and cutter.held and met.depth > cutter.height:
        words = Message(
            "{tool} cuts {depth} deep, but its cutting edge is only {height} long.",
            tool=edge_name(tool),
            depth=text(met.depth),
            height=text(cutter.height),
        )
        yield Found("feed-into-holder", words)
        return
    if not stock_given:
        return
    if not cutter.held:  # the insert is assumed with its holder
        shape = replace(shape, insert="", diameter=0.0)
    largest, usual = _largest(shape), depth_limit(shape)
    if deep > largest and move.rpm:  # a spindle that is switched by hand may stand
        words = Message(
            "{tool} cuts {depth} deep in one pass, but its maximum depth of cut is {largest}.",
            tool=edge_name(tool),
            depth=text(deep),
            largest=text(largest),
        )
        yield Found("depth-breaks-tool", words)
    elif deep > usual:
        words = Message(
            "{tool} cuts {depth} deep in one pass; the usual maximum is {usual}.",
            tool=edge_name(tool),
            depth=text(deep),
            usual=text(usual),
        )
        yield Found("depth-of-cut", words)


def _mean(met: Cut, *, along: bool) -> float:
    """Mean depth along r, or along Z of a cut across; the pieces of an arc follow each other."""
    if along:
        return met.area / max(met.width, met.front - met.back)
    return min(met.width, met.area / met.depth)


def _largest(shape: ToolShape) -> float:
    """Return the depth of cut, mm, at which the tool breaks; what is not stated of it has no limit."""
    bar = _OF_BAR * shape.diameter if shape.kind is ToolKind.BORING and shape.diameter else math.inf
    return min(bar, depth_limit(shape, LARGEST) if shape.insert.strip() else math.inf)


def depth_limit(shape: ToolShape, shares: Mapping[str, float] = USUAL) -> float:
    """Return the largest usual depth of cut, mm: a share of the straight edge or of a round insert."""
    insert = _insert(shape)
    share = shares.get(insert.shape, _OTHER_SHAPE)
    edge = insert.edges[0] - insert.nose_radius if insert.edges else insert.inscribed_circle
    return share * edge


def is_round(shape: ToolShape) -> bool:
    """Return whether a tool has a round insert."""
    return not _insert(shape).edges


def _insert(shape: ToolShape) -> Insert:
    try:
        return decoded(shape.insert) if shape.insert.strip() else _USUAL
    except InsertCodeError:
        return _USUAL

"""Assumed shapes of tools without a specified shape, derived from comments and moves.

A comment next to the T word has priority; common shop terms are recognized. Without a comment, the shape is
derived from the moves. The proof reports all assumptions. No holder is assumed, so collisions of holders
are not checked.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.message import Message
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.proving.tip_moves import FAST_FEED_MM_S, LiveToolStep, TipMove
from core.tool_edges import format_edge_name

_MOVES_EXPLANATION = "based on the tool moves"
_ON_AXIS = 0.05  # mm; a tool that feeds along Z within this distance of the axis is a drill
_SQUARE = 0.02  # mm of Z in a plunge
_NAMES = {
    ToolKind.TURNING: "a turning tool",
    ToolKind.BORING: "a boring tool",
    ToolKind.GROOVING: "a grooving tool",
    ToolKind.PARTING: "a parting tool",
    ToolKind.THREADING: "a threading tool",
    ToolKind.DRILL: "a drill",
    ToolKind.CENTER_DRILL: "a center drill",
    ToolKind.REAMER: "a reamer",
    ToolKind.TAP: "a tap",
    ToolKind.END_MILL: "an end mill",
    ToolKind.FORM: "a form tool",
}
_GROOVE = 2.0  # mm; assumed width of a grooving or parting tool
_MAX_GROOVE_WIDTH_MM = 8.0  # mm, largest assumed width of a grooving tool
_USUAL, _SMALLEST, _ALLOWANCE = 6.35, 1.0, 0.5  # mm; assumed diameters of a drill
_BAR = 5.0  # mm; assumed bar of a grooving or threading tool in a bore
_SLIM = "VNMG160404"  # a slim insert that reaches most contours, so that an unknown insert gives no finding
_MILL = 3.175  # mm; assumed diameter of a mill
_WIDTH = r"(\d+\.\d*|\.\d+|\d{3}|\d+(?=\s*MM))\s*(MM)?\s*(?:IN\b\.?|INCH)?\s*WIDE\b"
_AT_FACE = 0.1  # mm
_WIDE = 1.6  # widths; a tool that feeds further along Z is a turning tool

HOLE_TOOLS = frozenset({ToolKind.DRILL, ToolKind.REAMER})
GROOVING_TOOLS = frozenset({ToolKind.GROOVING, ToolKind.PARTING})

# Words of shop comments, the most specific first. They are not compiled, because few programs need them.
_WORDS = (
    (r"\b(WORK|BAR)? ?STOP(PER)?\b|\bGRIPPER\b|\bPULLER\b|\bTOPE\b", None),
    (r"\bCENT(ER|RE)[ -]?DRILL|\bSPOT|\bBROCA DE (CENTROS?|CENTRAR|PUNTO)|\bPUNTEAR", ToolKind.CENTER_DRILL),
    (r"\bREAM|\bESCARIA", ToolKind.REAMER),
    (r"\bTAP(PING)?\b|\bMACHO\b|\bMACHUEL", ToolKind.TAP),
    (r"\bTHREAD|\bROSCA", ToolKind.THREADING),
    (r"\bPART(ING|[ -]?OFF)?\b|\bCUT[ -]?OFF\b|\bTRONZA|\bSEGAR\b", ToolKind.PARTING),
    (r"\bGROOV|\bRANURA", ToolKind.GROOVING),
    (r"\bBOR(E|ING)\b|\bMANDRINA|\bBARRA DE INTERIOR", ToolKind.BORING),
    (r"\bDRILL|\bBROCA|\bTALADR", ToolKind.DRILL),
    (r"\bEND ?MILL|\bMILL|\bFRESA", ToolKind.END_MILL),
    (r"\bTURN|\bFAC(E|ING)\b|\bCUCHILLA|\bCILINDRA|\bREFRENTA|\bDESBAST", ToolKind.TURNING),
)
_SIZE = r"(?:(\d+)/(\d+)|(\d*\.\d+))\s*(?:IN(?:CH)?\b|\")?(?=[^/]*\bDRILL|\s*DIA)"
_MILLIMETERS = r"(\d+(?:\.\d+)?)\s*MM\b"
_TAP_NUMBER = r"(?:^|[^\d/.])#?(\d{1,2})(?:\s*-\s*|\s+)(\d{2})\b(?!\s*TPI)"  # 10-32, or 10 32
_TAP_INCH = r"(?:(\d+)[/ ](\d+)|(\d*\.\d+))\s*[- ]\s*(\d{1,2})\b"  # 1/4-20, or 1 4 20
_TAP_TPI = r"\b(\d{1,2})\s*TPI\b"  # 20 TPI
_TAP_METRIC = r"\bM(\d+(?:\.\d+)?)(?:\s*X\s*(\d*\.?\d+))?"  # M6X1
_METRIC_COARSE = {
    **{2.0: 0.4, 2.5: 0.45, 3.0: 0.5, 4.0: 0.7, 5.0: 0.8, 6.0: 1.0, 8.0: 1.25, 10.0: 1.5, 12.0: 1.75},
    **{14.0: 2.0, 16.0: 2.0, 20.0: 2.5, 24.0: 3.0},
}  # ISO 261, mm
_POINT_SIGN = re.compile(r"(?<=\d)P(?=\d)")  # 0P062 WIDE: comments of this control cannot contain a point
_RELEASES = r"TAPMATIC|REVERSING|RELEAS|COLLAPS|DIE\s?HEAD|SELF[\s-]?REV"
_LEFT_HAND = r"\bL\.?H\b|\bLEFT[ -]?HAND"


@dataclass(slots=True)
class ToolUse:
    """The comments and moves of one tool in a program."""

    tool_number: int
    comments: list[str] = field(default_factory=list)
    moves: list[TipMove] = field(default_factory=list)
    nose_radius: float = 0.0
    is_bar_stop: bool = False  # the tool fed while the collet was open
    has_pause: bool = False  # the program waits or switches an output while the tool is at the part
    # blocks with C engaged or in a plane of the virtual mill
    live_tool_steps: list[LiveToolStep] = field(default_factory=list)

    @property
    def is_metric(self) -> bool:
        """Return whether the program uses mm while it uses this tool."""
        modals = [
            *(move.modal for move in self.moves[:1]),
            *(block.modal for block, _ in self.live_tool_steps[:1]),
        ]
        return any(modal.metric for modal in modals)

    @property
    def live_tool_blocks(self) -> list[Block]:
        """Return the blocks of a live tool that move X, Z or the virtual mill.

        Blocks that only index C are left out.
        """
        return [b for b, _ in self.live_tool_steps if b.plane is not None or (b.x, b.z) != (b.x0, b.z0)]

    @property
    def first_rapid_position(self) -> TipMove | Block | None:
        """Return the first position at the part, for a tool that makes only rapid moves.

        The position is the end of a rapid while the spindle or C is active. The result is None if the tool
        makes a feed move, or if its rapids have another purpose.
        """
        if self.is_bar_stop:
            return None
        if blocks := self.live_tool_blocks:
            fed = any(not (b.rapid or b.feed >= FAST_FEED_MM_S) for b in blocks) or not all(
                m.is_fast for m in self.moves
            )
            return None if fed else blocks[0]
        if self.has_pause:
            return None
        first = [m for m in self.moves if m.points[-1][0] < -_SQUARE][:1]
        drawn = any(m.block_kind is BlockKind.ARC and not m.modal.rapid for m in self.moves)
        if drawn and first and not first[0].modal.rapid and any(m.modal.rapid for m in self.moves):
            return None  # the tool cuts at the F of the first line and also makes rapids with G00
        there = [m for m in self.moves if m.rpm and m.points[-1][0] < _AT_FACE]
        return there[0] if there and all(m.is_fast for m in self.moves) else None

    @property
    def is_radial(self) -> bool:
        """Return whether a live tool enters the part along X instead of Z, such as in the plane ZC."""
        if any(b.plane is not None and b.plane.is_on_side_plane for b, _ in self.live_tool_steps):
            return True
        feeds = [
            b for b, _ in self.live_tool_steps if b.plane is None and not b.rapid and b.feed < FAST_FEED_MM_S
        ]
        along = sum(max(b.z0 - b.z, 0.0) for b in feeds)
        return sum(max(abs(b.x0) - abs(b.x), 0.0) for b in feeds) > along


@dataclass(frozen=True, slots=True)
class AssumedTool:
    """The assumed shape of a tool, with a sentence that explains the assumption.

    The shape is None for a bar stop. ``is_kind_named`` is True if a comment names the kind of tool.
    """

    tool_shape: ToolShape | None
    explanation: str
    is_kind_named: bool = False
    is_diameter_assumed: bool = False  # the diameter is assumed

    def add_assumed_diameter(self, tool_use: ToolUse, bore_moves: Sequence[TipMove]) -> AssumedTool:
        """Return the tool; add an assumed diameter to a round tool without a diameter.

        The assumed diameter of a drill is slightly less than the smallest diameter that the later
        ``bore_moves`` cut.
        """
        shape = self.tool_shape
        if shape is None or not shape.is_rotating or shape.diameter:
            return self
        bore_moves = bore_moves if shape.kind in HOLE_TOOLS else ()
        inside = [abs(r) for m in bore_moves if not m.is_fast for z, r in m.points if z < -_SQUARE]
        diameter = max(2.0 * min(inside) - _ALLOWANCE, _SMALLEST) if inside else _USUAL
        words = Message(
            "{words}, assumed diameter {diameter}",
            words=self.explanation,
            diameter=_format_length(diameter, tool_use),
        )
        return replace(
            self, tool_shape=replace(shape, diameter=diameter), explanation=words, is_diameter_assumed=True
        )

    def add_assumed_width(self, tool_use: ToolUse, thread_moves: Sequence[TipMove]) -> AssumedTool:
        """Return the tool; add an assumed width to a grooving or parting tool without a width.

        See ``find_groove_width``.
        """
        shape = self.tool_shape
        if shape is None or shape.kind not in GROOVING_TOOLS or shape.width:
            return self
        width = find_groove_width(shape, tool_use.moves, thread_moves)
        words = Message(
            "{words}, assumed width {width}", words=self.explanation, width=_format_length(width, tool_use)
        )
        return replace(self, tool_shape=replace(shape, width=width), explanation=words)


def find_groove_width(shape: ToolShape, moves: Iterable[TipMove], thread_moves: Iterable[TipMove]) -> float:
    """Return the assumed width in mm of a cutting edge without a specified width.

    The width is 2 mm, or more if a screw thread starts in the groove and leads out of the part. The groove
    must then be wide enough for the threading tool. The edge of a threading tool is assumed to be at most
    as wide as the lead, with half of the width on either side of the control point.
    """
    forward = shape.direction[0]  # direction of the corner that is set; the edge extends back from it
    plunged = {m.points[-1][0] for m in moves if not m.is_fast and _square(m)}
    needed = [0.0]
    for z0, lead in {
        (m.points[0][0], m.feed_per_rev_mm) for m in thread_moves if m.points[-1][0] > m.points[0][0]
    }:
        reaches = [(z - z0) * forward if forward else abs(z0 - z) for z in plunged]
        needed += [each + lead / 2.0 for each in reaches if 0.0 <= each <= _MAX_GROOVE_WIDTH_MM]
    return max(_GROOVE, max(needed) * (1.0 if forward else 2.0))


def assume_tool(tool_use: ToolUse, specified: ToolShape | None = None) -> AssumedTool:
    """Return the assumed shape of a tool.

    ``specified`` is the incomplete shape of the tool, or None if the tool has no shape.
    """
    kind, why = (specified.kind, "based on the tool shape") if specified is not None else _kind(tool_use)
    if kind is None:
        return AssumedTool(
            None, Message("{number} is treated as a bar stop", number=format_edge_name(tool_use.tool_number))
        )
    shape = specified or _shape(kind, tool_use)
    words = Message(
        "{number} is treated as {kind} ({why})",
        number=format_edge_name(tool_use.tool_number),
        kind=_names(kind, shape, tool_use),
        why=why,
    )
    return AssumedTool(shape, words, why != _MOVES_EXPLANATION)


def _kind(use: ToolUse) -> tuple[ToolKind | None, str]:
    text = " ".join(use.comments).upper()
    for words, kind in _WORDS if text.strip() else ():
        if re.search(words, text):
            return kind, "based on the tool comment"
    if use.is_bar_stop:
        return None, _MOVES_EXPLANATION
    if use.live_tool_steps:
        return ToolKind.END_MILL, _MOVES_EXPLANATION
    return _by_moves(use.moves), _MOVES_EXPLANATION


def _by_moves(moves: Sequence[TipMove]) -> ToolKind:
    cuts = [move for move in moves if not move.is_fast]
    if any(move.block_kind is BlockKind.THREAD for move in cuts):
        return ToolKind.TAP if _on_axis(cuts) else ToolKind.THREADING
    if cuts and _on_axis(cuts):
        return ToolKind.DRILL
    if _has_plunge(cuts):
        back = min(z for move in cuts for z, _ in move.points)
        return ToolKind.PARTING if _to_centre(cuts) and back < -_GROOVE else ToolKind.GROOVING
    return ToolKind.BORING if works_in_bore(moves) else ToolKind.TURNING


def _on_axis(cuts: Iterable[TipMove]) -> bool:
    return all(abs(r) <= _ON_AXIS for move in cuts for _, r in move.points)


def _has_plunge(cuts: Sequence[TipMove]) -> bool:
    """Return whether a tool cuts perpendicular to the axis inside the part, as a grooving tool does.

    The result is False if a cut along Z is longer than a cut that cleans the bottom of a groove.
    """
    if not cuts or any(move.block_kind is BlockKind.ARC for move in cuts):
        return False
    along = [abs(move.points[-1][0] - move.points[0][0]) for move in cuts]
    plunged = [move for move, z in zip(cuts, along, strict=True) if z <= _SQUARE]
    return bool(plunged) and max(along) <= _WIDE * _GROOVE and min(m.points[0][0] for m in plunged) < -_GROOVE


def _to_centre(cuts: Iterable[TipMove]) -> bool:
    return min(r for move in cuts for _, r in move.points) <= 0.25


def works_in_bore(moves: Sequence[TipMove]) -> bool:
    """Return whether a tool works in a bore.

    The retract directions decide: a tool in a bore retracts toward the axis more often than away from it.
    If they are not conclusive, the contour decides.
    """
    votes = 0
    for before, move in pairwise(moves):
        inside = move.points[0][0] < 0.0
        if move.is_fast and not before.is_fast and inside:
            away = abs(move.points[-1][1]) - abs(move.points[0][1])
            votes += (away < 0.0) - (away > 0.0)
    feeds = [move for move in moves if not move.is_fast and move.block_kind is not BlockKind.THREAD]
    return votes > 0 or (votes == 0 and _enters_before_cutting(feeds, moves))


def _enters_before_cutting(feeds: Sequence[TipMove], moves: Sequence[TipMove]) -> bool:
    """Return whether the contour is that of a bore, with radii that decrease from face to chuck.

    This rule applies if the retract directions do not show whether the tool works in a bore.
    """
    feeds_toward_chuck = [m for m in feeds if m.points[-1][0] < m.points[0][0] - _SQUARE]
    falls = sum(abs(m.points[-1][1]) - abs(m.points[0][1]) for m in feeds if m.points[-1][0] < -_SQUARE)
    return len(feeds_toward_chuck) > 1 and falls < -1.0 and bool(moves) and not _to_centre(feeds)


def _shape(kind: ToolKind, use: ToolUse) -> ToolShape:
    nose, rear = use.nose_radius, _is_at_rear(use.moves)
    if kind is ToolKind.TURNING:
        left = _cuts_away_from_chuck(use.moves)
        tip = (1 if rear else 4) if left else (2 if rear else 3)
        hand = ToolHand.LEFT if left else ToolHand.RIGHT
        return ToolShape(kind, hand, tip=tip, nose_radius=nose, insert=_SLIM, rear=rear)
    if kind is ToolKind.BORING:
        return ToolShape(kind, tip=3 if rear else 2, nose_radius=nose, insert=_SLIM, rear=rear)
    if kind in {ToolKind.GROOVING, ToolKind.PARTING}:
        return _groover(kind, use, rear=rear)
    if kind is ToolKind.THREADING:
        inside = works_in_bore(use.moves)
        tip, bar = 6 if inside is not rear else 8, _BAR if inside else 0.0
        return ToolShape(kind, tip=tip, nose_radius=nose, diameter=bar, rear=rear)
    return _round_tool(kind, use)


def _groover(kind: ToolKind, use: ToolUse, *, rear: bool) -> ToolShape:
    width = parse_edge_width(" ".join(use.comments))
    if kind is ToolKind.GROOVING and _plunges_outward(use.moves):
        return ToolShape(kind, tip=3 if rear else 2, width=width, diameter=_BAR, rear=rear)
    return ToolShape(kind, tip=_find_tip_quadrant(use, rear=rear), width=width, rear=rear)


def _normalize_comment(comment: str) -> str:
    """Return the comment in capital letters, with a decimal point for each P between digits.

    For example, 3P5 becomes 3.5.
    """
    return _POINT_SIGN.sub(".", comment.upper())


def parse_edge_width(comment: str) -> float:
    """Return the width in mm that a comment specifies, or 0 if the comment specifies no width.

    Examples are .045 WIDE, 045 WIDE (thousandths of an inch) and 3MM WIDE.
    """
    found = re.search(_WIDTH, _normalize_comment(comment))
    if found is None:
        return 0.0
    figure = float(found[1])
    if found[2]:
        return figure
    return (figure if "." in found[1] else figure / 1000.0) * 25.4


def _round_tool(kind: ToolKind, use: ToolUse) -> ToolShape:
    comment = " ".join(use.comments).upper()
    diameter, hand = (
        _parse_diameter(comment),
        ToolHand.LEFT if re.search(_LEFT_HAND, comment) else ToolHand.RIGHT,
    )
    if kind is ToolKind.TAP:
        across, pitch = parse_tap_size(comment)
        return ToolShape(kind, hand, diameter=across or diameter, pitch=pitch)
    if use.live_tool_steps and not _on_axis(use.moves):
        return ToolShape(kind, tip=8 if use.is_radial else 7, diameter=diameter or _MILL, point=118.0)
    return ToolShape(kind, hand, diameter=diameter, point=118.0)


def parse_tap_size(comment: str) -> tuple[float, float]:
    """Return the diameter and pitch in mm of a tap named in a comment, with 0 for a missing value.

    Examples are 1/4-20, 10-32 and M6X1. The forms 1 4 20, 10 32 and 20 TPI use only characters that the
    control accepts in comments.
    """
    text = _normalize_comment(comment)
    if found := re.search(_TAP_METRIC, text):
        across = float(found[1])
        return across, float(found[2]) if found[2] else _METRIC_COARSE.get(across, 0.0)
    if found := re.search(_TAP_INCH, text):
        inches = float(found[3]) if found[3] else int(found[1]) / max(int(found[2]), 1)
        return inches * 25.4, 25.4 / max(int(found[4]), 1)
    if found := re.search(_TAP_TPI, text):
        return 0.0, 25.4 / max(int(found[1]), 1)
    if found := re.search(_TAP_NUMBER, text):  # ASME B1.1: .060 and .013 for each number
        return (0.060 + 0.013 * int(found[1])) * 25.4, 25.4 / max(int(found[2]), 1)
    return 0.0, 0.0


def has_releasing_tap_holder(tool_use: ToolUse) -> bool:
    """Return whether a comment names a tap holder that reverses or releases the tap automatically."""
    return re.search(_RELEASES, " ".join(tool_use.comments).upper()) is not None


def _is_at_rear(moves: Sequence[TipMove]) -> bool:
    """Return whether a tool works at negative X.

    A face cut that ends slightly past the axis does not count.
    """
    cuts = [move for move in moves if not move.is_fast]
    radii_past_face = [r for move in cuts for z, r in move.points if z < -_SQUARE]
    radii = radii_past_face or [r for move in cuts for _, r in move.points]
    return bool(radii) and -min(radii) > max(radii)


def _cuts_away_from_chuck(moves: Iterable[TipMove]) -> bool:
    """Return whether a tool cuts along Z from the chuck toward the face, as a left-hand tool does.

    A move that ends in front of the face is a retract at feed.
    """
    cuts = [move for move in moves if not move.is_fast]
    along = [m.points[-1][0] - m.points[0][0] for m in cuts if max(z for z, _ in m.points) < 0.0]
    return sum(along) > _SQUARE and max(along) > 2.0 * max(-min(along), 0.0)


def _square(move: TipMove) -> bool:
    return abs(move.points[-1][0] - move.points[0][0]) <= _SQUARE


def _plunges_outward(moves: Iterable[TipMove]) -> bool:
    """Return whether the cuts perpendicular to the axis lead away from it, as for a groove in a bore."""
    square = [m for m in moves if not m.is_fast and _square(m)]
    return bool(square) and abs(square[0].points[-1][1]) > abs(square[0].points[0][1])


def _find_tip_quadrant(use: ToolUse, *, rear: bool) -> int:
    """Return the tip quadrant of the edge corner that is the tool's set point.

    This is the left corner unless a comment names the right corner.
    """
    text = " ".join(use.comments).upper()
    if "RIGHT EDGE" in text or "RIGHT SIDE" in text:
        return 1 if rear else 4
    return 2 if rear else 3


def _parse_diameter(comment: str) -> float:
    """Return the diameter in mm that a comment specifies, or 0 if the comment specifies none.

    Examples are 1/4 DRILL and DRILL .250 DIA.
    """
    text = _normalize_comment(comment)
    if found := re.search(_MILLIMETERS, text):
        return float(found[1])
    if found := re.search(_SIZE, text):
        inches = float(found[3]) if found[3] else int(found[1]) / max(int(found[2]), 1)
        return inches * 25.4
    return 0.0


def _format_length(mm: float, use: ToolUse) -> str:
    """Return a length as text, in the unit of the program."""
    return (
        Message("{unit} mm", unit=f"{mm:.2f}") if use.is_metric else Message("{mm} in", mm=f"{mm / 25.4:.3f}")
    )


def _names(kind: ToolKind, shape: ToolShape, use: ToolUse) -> str:
    size = (
        Message(", {diameter}", diameter=_format_length(shape.diameter, use))
        if shape.diameter and shape.is_rotating
        else ""
    )
    if shape.width:
        size = Message(", {width} wide", width=_format_length(shape.width, use))
    return f"{_NAMES[kind]}{size}"

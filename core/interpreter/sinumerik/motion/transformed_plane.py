"""Milling on the face (TRANSMIT) and on the side (TRACYL) with X, Y and Z, executed by X, Z and C.

The words of the program have a plane (abscissa and ordinate) and a depth perpendicular to it. Lines, arcs,
corners and compensation are calculated in the plane like X and Z on the lathe. The output are moves of the
virtual mill (``core.geometry.virtual_mill``), as in plane switching.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import copysign, degrees, hypot, radians
from typing import NamedTuple, TypedDict

import numpy as np

from core.geometry.virtual_mill import Face, PlaneMove, Side, Spot
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import Mill, Modal
from core.interpreter.shared.turn_at_axis import turns_at_axis
from core.interpreter.sinumerik.motion.chamfers_and_rounds import Corner, Corners, corner_of
from core.interpreter.sinumerik.motion.linear_moves import AxisTravel, block_of, straight
from core.interpreter.sinumerik.motion.radius_compensation import Compensation
from core.interpreter.sinumerik.motion.sinumerik_arcs import arc
from core.interpreter.sinumerik.motion.sinumerik_feeds import check_feed
from core.interpreter.sinumerik.setup.modes_and_offsets import frame_block, programmed_frame
from core.interpreter.sinumerik.sinumerik_state import ARCS, NO_FRAME, TAPS, THREADS, Motion, State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import AXES, PLACES, Form, Word
from core.language.sinumerik.word_table import BLOCKWISE, MOTION, SUPPRESSION
from core.message import Message

_SAME = 1e-9
_FOLLOWED = (
    *("motion", "override", "rounding", "corner_feed", "rounded", "round_ends", "exact", "feed_in_inches"),
    *("distance_is_radius", "master", "live_rpm"),
)
_FLAT = frozenset({"ANG", "RP", "AP", "CR", "AR"})


class _Zero(TypedDict):
    offset_x: float
    offset_z: float
    modal: Modal


class _Names(NamedTuple):
    """Mapping of the letters to the lathe's code, in which Z is the abscissa and X the ordinate."""

    word: str
    plane: int
    places: Mapping[str, str]  # X, Z, or C for the depth
    centres: Mapping[str, str]


_FACE = _Names("TRANSMIT", 17, {"X": "Z", "Y": "X", "Z": "C"}, {"I": "K", "J": "I"})
_SIDE = _Names("TRACYL", 19, {"Y": "Z", "Z": "X", "X": "C"}, {"J": "K", "K": "I"})


class Transformation:
    """An active transformation: state, corners and compensation of its plane, and the position of the mill.

    The plane is in mm: X, Y and lathe Z on the face; Y, lathe Z and X as a radius on the side.
    """

    def __init__(self, state: State, log: Log, frame: Face | Side) -> None:
        self._state, self._log, self._frame = state, log, frame
        self._names = _FACE if isinstance(frame, Face) else _SIDE
        self._plane = copy.copy(state)
        self._plane.transformation = None
        self._plane.programmed, self._plane.pole, self._plane.polar = NO_FRAME, (0.0, 0.0), None
        self._plane.direction, self._plane.moved_by_tool, self._plane.area = None, set(), {}
        self._corners = Corners(self._plane, log)
        self._compensation = Compensation(self._plane, log, in_plane=True)
        self._theta, self._at = 0.0, (0.0, 0.0, 0.0)
        self._offset = (0.0, 0.0)
        self._depth = 0.0
        self._statement: Statement | None = None
        self.offn = 0.0  # OFFN, mm
        self.stand()

    @property
    def name(self) -> str:
        """Word that started the transformation."""
        return self._names.word

    @property
    def along_z(self) -> bool:
        """Whether the depth is along Z, so that drilling cycles are allowed."""
        return isinstance(self._frame, Face)

    @property
    def plane(self) -> int:
        """Plane of its arcs and compensation: 17 or 19, for G17 or G19."""
        return self._names.plane

    @property
    def holds(self) -> bool:
        """Whether a corner or a contour is unfinished."""
        return self._corners.holds or self._compensation.holds

    @property
    def depth(self) -> float:
        """Position of the tool perpendicular to the plane in the program frame, in mm."""
        return self._depth - self._plane.programmed.c

    def stand(self) -> None:
        """Set the position of the mill from the axes, at the start and after a change of tool or zero."""
        state, modal = self._state, self._state.modal
        self._offset = modal.base_x, modal.base_z
        x, z, c = state.x - modal.base_x, state.z - modal.base_z, state.c - modal.offset_c
        (at,) = self._frame.mill(np.array([[x, z, c]])).tolist()
        self._at = at[0], at[1], at[2]
        self._theta = radians(self._frame.c0 - c)
        self._plane.z, self._plane.x, self._depth = _of_plane(self._frame, self._at)

    # --- words

    def taken(self, statement: Statement) -> Statement:
        """Return the statement with its words converted to the ZX plane of the lathe, as numbers.

        Raises ProgramError for a word that is not allowed in the plane.
        """
        names, words = self._names, {}
        for name, word in statement.words.items():
            if name == "C" or name in {"X1", "Z1", "I1", "K1", "SF"}:
                text = Message("{word}: {word2} already controls C.", word=word.text, word2=names.word)
                if name != "C":
                    text = Message("{word} has no meaning in {word2}.", word=word.text, word2=names.word)
                raise statement.refuse(word, "transformation", text, "Write TRAFOOF before this block.")
            if name in names.places:
                made = self._resolved(statement, word)
                words[names.places[name]] = made._replace(name=names.places[name])
            elif name in names.centres:
                made = self._resolved(statement, word)
                words[names.centres[name]] = made._replace(name=names.centres[name])
            elif name in {"I", "J", "K"}:
                what = "{word} is not an arc center word in G{plane}."
                hint = "Use the arc center words for this plane."
                raise statement.refuse(word, "word-unused", what, hint, word=word.text, plane=names.plane)
            else:
                words[name] = word
        return replace(statement, words=words)

    def _resolved(self, statement: Statement, word: Word) -> Word:
        """Return the word with its value as a number, with X as a radius."""
        modal, value = self._state.modal, self._state.number(statement, word)
        relative = word.form is Form.IC or (word.form is Form.PLAIN and modal.absolute is False)
        centre = word.name == "I"
        diameter = modal.diameter and (word.form is Form.AC if centre else True)
        if word.name in {"X", "I"} and diameter and not (relative and self._state.distance_is_radius):
            value /= 2.0
        if word.form in {Form.DC, Form.ACP, Form.ACN}:
            text = "{word}: {form} needs a rotary axis."
            hint = "Write {name}=AC( ) or {name2}=IC( )."
            raise statement.refuse(
                word, 16800, text, hint, word=word.text, form=word.form, name=word.name, name2=word.name
            )
        return word._replace(value=value, formula=None)

    def _follow_state(self) -> None:
        """Copy changes of the lathe's state to the state of the plane."""
        state, plane = self._state, self._plane
        for name in _FOLLOWED:
            setattr(plane, name, getattr(state, name))
        plane.plane = 18 if state.plane == self._names.plane else 0
        nose = replace(state.edge, quadrant=9, nose_radius=state.edge.nose_radius + self.offn)
        plane.edge = nose if state.edge.nose_radius or self.offn else ToolOffset(quadrant=9)
        self._derive()
        if self._offset != (state.modal.base_x, state.modal.base_z):
            self.stand()

    def _derive(self) -> None:
        frame = self._plane.programmed
        self._plane.adopt(
            self._state.modal._replace(
                tool_x=0.0, tool_z=0.0, settable_x=0.0, settable_z=0.0, zero_x=frame.x, zero_z=frame.z,
                offset_c=0.0, diameter=False,
            )
        )  # fmt: skip

    # --- frames and moves

    def frame(self, statement: Statement) -> None:
        """Execute TRANS, ROT, SCALE and MIRROR in the plane. Raises ProgramError."""
        self._follow_state()
        if key := statement.frame_key:
            turned = {name: word for name, word in statement.words.items() if name in AXES}
            if key.name.removeprefix("A") == "TRANS":  # TRANS does not have diameters
                modal = self._state.modal
                self._state.modal = modal._replace(diameter=False)
                taken = self.taken(replace(statement, words=turned))
                self._state.modal = modal
                if "C" in taken.words and not modal.metric:
                    depth = taken.words["C"]
                    taken.words["C"] = depth._replace(value=(depth.value or 0.0) * 25.4)
            else:
                taken = self.taken(statement)
            programmed_frame(self._plane, taken)
            self._derive()

    def moves(self, statement: Statement) -> Iterator[Block]:
        """Yield the move of a statement in the plane, before its corners. Raises ProgramError."""
        self._check(statement)
        if word := statement.words.get("OFFN"):
            self._allow(statement, word)
        self._follow_state()
        taken = self.taken(statement)
        if frame_block(self._plane, taken):
            return
        if not (PLACES | {"I", "J", "K"}) & statement.words.keys():
            return
        self._statement = taken
        depth = self._depth_of(taken)
        taken.words.pop("C", None)
        state = self._plane
        before = state.x, state.z
        flat = bool({"X", "Z", "I", "K", *_FLAT} & taken.words.keys())
        if state.motion in ARCS:
            made = arc(state, taken)
        elif flat:
            made = straight(state, taken)
        else:
            made = self._plunge(taken)
        made = replace(made, kind=Kind.FEED if made.kind is Kind.ROTATE else made.kind)
        if made.kind is not Kind.ARC and (state.x, state.z) == before and depth == self._depth:
            return
        made.c0, made.c, self._depth = self._depth, depth, depth
        self._stand_at_end(made)
        yield made

    def down_to(self, statement: Statement, depth: float, feed: float | None, text: str) -> Block:
        """Return a move to a depth in the program frame, in mm; without a feed, it is a rapid."""
        self._follow_state()
        state, goal = self._plane, depth + self._plane.programmed.c
        kind = Kind.RAPID if feed is None else Kind.FEED
        made = block_of(state, statement, self._still(), kind, feed or 0.0)
        made.text, made.c0, made.c = text, self._depth, goal
        self._depth = goal
        self._stand_at_end(made)
        return made

    def over(self, statement: Statement, x: float, y: float, text: str) -> Block:
        """Return a rapid to a point of the plane, in mm, for a hole pattern."""
        self._follow_state()
        state = self._plane
        z, ordinate = (y, x) if not self.along_z else (x, y)
        there = self._still().placed(ordinate, z)
        travel = self._still()._replace(x=there[0], z=there[1])
        made = block_of(state, statement, travel, Kind.RAPID, 0.0)
        made.text, made.c0, made.c = text, self._depth, self._depth
        self._stand_at_end(made)
        return made

    def _allow(self, statement: Statement, word: Word) -> None:
        """Set OFFN, the allowance of the contour. Raises ProgramError while a contour is active."""
        value = self._state.length(statement, word)
        if self._compensation.holds or (value and not self.along_z):
            text = Message("{word} cannot change a contour that is not finished yet.", word=word.text)
            if not self._compensation.holds:
                text = Message(
                    "{word} is half the groove width in TRACYL, but TurnDesk does not machine the groove "
                    "walls from this value.",
                    word=word.text,
                )
            hint = "Program the groove walls as contours after G40."
            raise statement.refuse(word, "not-in-subset", text, hint)
        self.offn = value

    def _check(self, statement: Statement) -> None:
        """Raise ProgramError for a statement that is not allowed in the plane."""
        state, names = self._state, self._names
        if self.holds and self._offset != (state.modal.base_x, state.modal.base_z):
            text = "the tool or the zero point changes between two moves of a corner or a contour."
            hint = "Change the tool or the zero point before the corner or after G40."
            raise statement.refuse(None, "comp-with", text, hint)
        if (code := statement.code(BLOCKWISE)) in {25, 26, 74, 75} or SUPPRESSION in statement.g:
            word = statement.g.get(SUPPRESSION) or statement.g[BLOCKWISE]
            if code not in {25, 26} or {"X", "Y", "Z"} & statement.words.keys():
                text = "{word} moves the machine axes and cannot be used while {word2} is active."
                hint = "Write TRAFOOF before this block."
                raise statement.refuse(word, "transformation", text, hint, word=word.text, word2=names.word)
        if not PLACES & statement.words.keys():
            return
        word = statement.g.get(MOTION) or next(iter(statement.words.values()))
        if state.motion in THREADS | TAPS:
            text = "a thread along Z needs the spindle running, but {word} uses the spindle as C."
            hint = "Write TRAFOOF before this block."
            raise statement.refuse(word, "transformation", text, hint, word=names.word)
        needs = (
            state.motion in ARCS
            or state.modal.nose_comp != 40
            or statement.corner
            or "ANG" in statement.words
        )
        if needs and state.plane != names.plane:
            text = "arcs, corners and radius compensation in {word} need G{plane}."
            hint = "Write G{plane} before this block."
            raise statement.refuse(word, "arc-plane", text, hint, word=names.word, plane=names.plane)

    def _depth_of(self, taken: Statement) -> float:
        """Return the target depth of a statement, in mm from the zero of the frame."""
        word = taken.words.get("C")
        if word is None:
            return self._depth
        value = (word.value or 0.0) * (1.0 if self._state.modal.metric else 25.4)
        relative = word.form is Form.IC or (word.form is Form.PLAIN and self._state.modal.absolute is False)
        return value + (self._depth if relative else self._plane.programmed.c)

    def _plunge(self, taken: Statement) -> Block:
        """Return a move only in depth."""
        state = self._plane
        if state.motion is Motion.RAPID:
            return block_of(state, taken, self._still(), Kind.RAPID, 0.0)
        return block_of(state, taken, self._still(), Kind.FEED, check_feed(state, taken, 0.0, 0.0))

    def _still(self) -> AxisTravel:
        state, modal = self._plane, self._plane.modal
        return AxisTravel(
            state.x, state.z, 0.0, state.x, state.z, 0.0,
            modal, modal.offset_x, modal.offset_z, state.programmed,
        )  # fmt: skip

    def _stand_at_end(self, made: Block) -> None:
        """Set the lathe's state to the programmed end point, before compensation."""
        state, frame = self._state, self._frame
        end = _spot(frame, made.x + made.offset_x, made.z + made.offset_z, made.c)
        if isinstance(frame, Face):
            x = hypot(end[0], end[1])
            lathe = (x if frame.far else -x), end[2]
        else:
            lathe = (end[2] if frame.far else -end[2]), -end[0]
        state.x, state.z = lathe[0] + self._offset[0], lathe[1] + self._offset[1]

    # --- output

    def corner(self, block: Block) -> Corner | None:
        """Return the corner of the statement of this block, or None. Raises ProgramError."""
        if self._statement is None or not block.moves:
            return None
        return corner_of(self._plane, self._statement, block)

    def take(self, block: Block, corner: Corner | None) -> Iterator[Block]:
        """Accept a block, and yield the lathe blocks that no later block can change. Raises ProgramError."""
        for cut in self._corners.take(block, corner):
            for beside in self._compensation.take(cut):
                yield from self._out(beside)

    def settle(self) -> Iterator[Block]:
        """Yield the buffered blocks, because no move follows for their corner. Raises ProgramError."""
        for cut in self._corners.end():
            for beside in self._compensation.take(cut):
                yield from self._out(beside)

    def end(self) -> Iterator[Block]:
        """Yield the last blocks. Raises ProgramError if a corner or a contour is unfinished."""
        yield from self.settle()
        for beside in self._compensation.end():
            yield from self._out(beside)

    def drop(self) -> None:
        """Discard buffered blocks after an error."""
        self._corners.drop()
        self._compensation.drop()

    def _out(self, block: Block) -> Iterator[Block]:
        """Yield the lathe blocks of one block of the plane."""
        if not block.moves:
            x, z, c = self._lathe(self._at)
            yield replace(block, x0=x, z0=z, c0=c, x=x, z=z, c=c, **self._zero(block))
            return
        start = self._at
        end = _spot(self._frame, block.x + block.offset_x, block.z + block.offset_z, block.c)
        centre = None
        if block.kind is Kind.ARC:
            middle = _spot(self._frame, block.cx + block.offset_x, block.cz + block.offset_z, 0.0)
            centre = middle[0], middle[1]
        elif all(abs(a - b) < _SAME for a, b in zip(start, end, strict=True)):
            return
        whole = PlaneMove(self._frame, start, end, self._theta, centre, not block.clockwise)
        for part in whole.parts():
            yield from self._turned(block, part)
            yield self._made(block, part)

    def _turned(self, block: Block, part: PlaneMove) -> Iterator[Block]:
        """Yield a turn of C if the tool is on the axis, until the path leads out along X."""
        state, turn = self._state, replace(part, theta=self._theta).turn_at_start()
        if not turns_at_axis(self._log, block.line, turn):
            return
        x, z, c = self._lathe(self._at)
        self._theta += turn
        speed, way = state.setup.limits.speeds[2], -degrees(turn)
        yield replace(
            block, kind=Kind.ROTATE, x0=x, z0=z, c0=c, x=x, z=z, c=c + way, feed=speed, per_rev=False,
            rpm=copysign(speed / 6.0, way), **self._zero(block),
        )  # fmt: skip

    def _made(self, block: Block, part: PlaneMove) -> Block:
        part = replace(part, theta=self._theta)
        x0, z0, c0 = self._lathe(self._at)
        both = np.array([0.0, 1.0])
        if isinstance(self._frame, Face):
            self._theta = float(part.thetas(part.points(both), both)[1])
        else:
            self._theta = part.end[1] * 2.0 / self._frame.diameter
        self._at = part.end
        x, z, c = self._lathe(part.end)
        self._state.c = c + self._state.modal.offset_c
        kind = Kind.PLANE_LINE if part.centre is None else Kind.PLANE_ARC
        rapid = block.kind is Kind.RAPID
        feed = max(self._state.setup.limits.speeds[:2]) if rapid else block.feed
        made = replace(
            block, kind=kind, x0=x0, z0=z0, c0=c0, x=x, z=z, c=c, feed=feed, per_rev=False, rpm=0.0, css=None,
            clockwise=part.clockwise, cx=0.0, cz=0.0, plane=part, **self._zero(block),
        )  # fmt: skip
        made.modal = made.modal._replace(rapid=rapid)
        return made

    def _lathe(self, at: Spot) -> Spot:
        """Return lathe X, Z and continuous C of a point of the mill, without offsets."""
        frame = self._frame
        c = frame.c0 - degrees(self._theta)
        if isinstance(frame, Face):
            x = hypot(at[0], at[1])
            return (x if frame.far else -x), at[2], c
        return (at[2] if frame.far else -at[2]), -at[0], c

    def _zero(self, block: Block) -> _Zero:
        """Return offsets and modal state of the lathe for a block.

        The end of the program ends the transformation.
        """
        own = self._state.modal
        ends = isinstance(block.action, ProgramEnd)
        modal = block.modal._replace(
            tool_x=own.tool_x, tool_z=own.tool_z, settable_x=own.settable_x, settable_z=own.settable_z,
            zero_x=0.0, zero_z=0.0, offset_c=own.offset_c, diameter=own.diameter, c_locked=True,
            mill=None if ends else Mill(self._frame, *self._at, self._theta, False),
        )  # fmt: skip
        return _Zero(offset_x=self._offset[0], offset_z=self._offset[1], modal=modal)


def _spot(frame: Face | Side, ordinate: float, abscissa: float, depth: float) -> Spot:
    """Return a point of the plane in the frame of the mill."""
    return (abscissa, ordinate, depth) if isinstance(frame, Face) else (-ordinate, abscissa, depth)


def _of_plane(frame: Face | Side, at: Spot) -> Spot:
    """Return abscissa, ordinate and depth of a point in the frame of the mill."""
    return (at[0], at[1], at[2]) if isinstance(frame, Face) else (at[1], -at[0], at[2])

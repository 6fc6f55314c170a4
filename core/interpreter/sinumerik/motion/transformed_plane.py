"""Milling on the face (TRANSMIT) and side (TRACYL) in X, Y and Z with the axes X, Z and C.

The program words define positions in a plane (abscissa and ordinate) and a depth perpendicular to the
plane. Lines, arcs, corners and compensation are calculated in the plane as they are in X and Z on the
lathe. The results are moves of the virtual mill (``core.geometry.virtual_mill``).
"""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import replace
from math import copysign, degrees, hypot, radians
from typing import TypedDict

import numpy as np

from core.geometry.virtual_mill import FacePlane, MillPoint, PlaneMove, SidePlane
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.centerline_rotation import needs_centerline_rotation
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState, VirtualMill
from core.interpreter.sinumerik.motion.chamfers_and_roundings import Corner, SinumerikCornerStage, make_corner
from core.interpreter.sinumerik.motion.linear_moves import AxisTravel, make_straight_block, make_travel_block
from core.interpreter.sinumerik.motion.radius_compensation import CompensationStage
from core.interpreter.sinumerik.motion.sinumerik_arcs import make_arc_block
from core.interpreter.sinumerik.motion.sinumerik_feeds import check_block_feed
from core.interpreter.sinumerik.motion.transformed_words import FACE_LETTERS, SIDE_LETTERS, check_statement
from core.interpreter.sinumerik.setup.modes_and_offsets import execute_frame_words, execute_pole_and_limits
from core.interpreter.sinumerik.sinumerik_state import ARC_MOTIONS, IDENTITY_FRAME, MotionKind, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import AXIS_NAMES, POSITION_WORDS, PositionMode, Word
from core.message import Message

_SAME = 1e-9
_COPIED_ATTRIBUTES = (
    *("motion", "override", "rounding", "corner_feed", "rounded", "round_ends", "exact", "feed_in_inches"),
    *("distance_is_radius", "master", "live_rpm"),
)
_PLANE_WORDS = frozenset({"ANG", "RP", "AP", "CR", "AR"})


class _Zero(TypedDict):
    offset_x: float
    offset_z: float
    modal: ModalState


class ActiveTransformation:
    """An active transformation, with its plane and the position of the virtual mill.

    The plane has its own state, corners and compensation. Positions in the plane are in mm. On the face,
    they are X, Y and lathe Z. On the side, they are Y, lathe Z, and X as a radius.
    """

    def __init__(self, state: SinumerikState, log: DiagnosticLog, frame: FacePlane | SidePlane) -> None:
        self._state, self._log, self._frame = state, log, frame
        self._names = FACE_LETTERS if isinstance(frame, FacePlane) else SIDE_LETTERS
        self._plane = copy.copy(state)
        self._plane.transformation = None
        self._plane.programmed_frame, self._plane.pole, self._plane.last_polar_point = (
            IDENTITY_FRAME,
            (0.0, 0.0),
            None,
        )
        self._plane.direction, self._plane.moved_by_tool, self._plane.area = None, set(), {}
        self._corners = SinumerikCornerStage(self._plane, log)
        self._compensation = CompensationStage(self._plane, log, is_in_transformed_plane=True)
        self._theta, self._at = 0.0, (0.0, 0.0, 0.0)
        self._offset = (0.0, 0.0)
        self._depth = 0.0
        self._statement: Statement | None = None
        self.offn_mm = 0.0  # OFFN, mm
        self.update_position()

    @property
    def name(self) -> str:
        """Return the word that activated the transformation."""
        return self._names.transformation_word

    @property
    def is_depth_along_z(self) -> bool:
        """Return whether the depth is along Z, so that drilling cycles are allowed."""
        return isinstance(self._frame, FacePlane)

    @property
    def plane_code(self) -> int:
        """Return the G code of the plane for arcs and compensation, which is 17 or 19."""
        return self._names.plane_code

    @property
    def has_open_contour(self) -> bool:
        """Return whether a corner or a contour is unfinished."""
        return self._corners.has_buffered_move or self._compensation.has_open_contour

    @property
    def depth_mm(self) -> float:
        """Return the tool position perpendicular to the plane in the program frame, in mm."""
        return self._depth - self._plane.programmed_frame.shift_c

    def update_position(self) -> None:
        """Set the position of the virtual mill from the axis positions.

        This is necessary at the start of the transformation and after a change of the tool or zero offset.
        """
        state, modal = self._state, self._state.modal
        self._offset = modal.drawing_zero_x, modal.drawing_zero_z
        x, z, c = state.x - modal.drawing_zero_x, state.z - modal.drawing_zero_z, state.c - modal.offset_c
        (at,) = self._frame.convert_to_mill(np.array([[x, z, c]])).tolist()
        self._at = at[0], at[1], at[2]
        self._theta = radians(self._frame.c_start_deg - c)
        self._plane.z, self._plane.x, self._depth = _to_plane(self._frame, self._at)

    # --- words

    def convert_statement(self, statement: Statement, *, x_is_radius: bool = False) -> Statement:
        """Return the statement with its words converted to numbers in the ZX plane of the lathe.

        With ``x_is_radius``, X and I are radii also under DIAMON. Raises ProgramError for a word that is not
        allowed in the plane.
        """
        names, words = self._names, {}
        for name, word in statement.words.items():
            if name == "C" or name in {"X1", "Z1", "I1", "K1", "SF"}:
                text = Message(
                    "{word}: {word2} already controls C.", word=word.text, word2=names.transformation_word
                )
                if name != "C":
                    text = Message(
                        "{word} has no meaning in {word2}.", word=word.text, word2=names.transformation_word
                    )
                raise statement.make_error(word, "transformation", text, "Write TRAFOOF before this block.")
            if name in names.axis_letters:
                made = self._resolve_word(statement, word, x_is_radius=x_is_radius)
                words[names.axis_letters[name]] = made._replace(name=names.axis_letters[name])
            elif name in names.center_letters:
                made = self._resolve_word(statement, word, x_is_radius=x_is_radius)
                words[names.center_letters[name]] = made._replace(name=names.center_letters[name])
            elif name in {"I", "J", "K"}:
                what = "{word} is not an arc center word in G{plane}."
                hint = "Use the arc center words for this plane."
                raise statement.make_error(
                    word, "word-unused", what, hint, word=word.text, plane=names.plane_code
                )
            else:
                words[name] = word
        return replace(statement, words=words)

    def _resolve_word(self, statement: Statement, word: Word, *, x_is_radius: bool) -> Word:
        """Return the word with its value as a number, with X as a radius."""
        modal, value = self._state.modal, self._state.number(statement, word)
        relative = word.position_mode is PositionMode.IC or (
            word.position_mode is PositionMode.PLAIN and modal.absolute is False
        )
        centre = word.name == "I"
        is_center_distance = centre and word.position_mode is not PositionMode.AC
        diameter = modal.diameter and not x_is_radius and not is_center_distance
        if word.name in {"X", "I"} and diameter and not (relative and self._state.distance_is_radius):
            value /= 2.0
        if word.position_mode in {PositionMode.DC, PositionMode.ACP, PositionMode.ACN}:
            text = "{word}: {form} needs a rotary axis."
            hint = "Write {name}=AC( ) or {name2}=IC( )."
            raise statement.make_error(
                word,
                16800,
                text,
                hint,
                word=word.text,
                form=word.position_mode,
                name=word.name,
                name2=word.name,
            )
        return word._replace(value=value, formula=None)

    def _follow_state(self) -> None:
        """Copy changes of the lathe's state to the state of the plane."""
        state, plane = self._state, self._plane
        for name in _COPIED_ATTRIBUTES:
            setattr(plane, name, getattr(state, name))
        plane.plane = 18 if state.plane == self._names.plane_code else 0
        nose = replace(state.edge, quadrant=9, nose_radius=state.edge.nose_radius + self.offn_mm)
        plane.edge = nose if state.edge.nose_radius or self.offn_mm else ToolOffset(quadrant=9)
        self._derive()
        if self._offset != (state.modal.drawing_zero_x, state.modal.drawing_zero_z):
            self.update_position()

    def _derive(self) -> None:
        frame = self._plane.programmed_frame
        self._plane.set_modal_state(
            self._state.modal._replace(
                tool_offset_x=0.0,
                tool_offset_z=0.0,
                zero_offset_x=0.0,
                zero_offset_z=0.0,
                frame_shift_x=frame.shift_x,
                frame_shift_z=frame.shift_z,
                offset_c=0.0,
                diameter=False,
            )
        )

    # --- frames and moves

    def execute_frame_words(self, statement: Statement) -> None:
        """Execute TRANS, ROT, SCALE and MIRROR in the plane. Raises ProgramError for invalid words."""
        self._follow_state()
        if key := statement.frame_word:
            turned = {name: word for name, word in statement.words.items() if name in AXIS_NAMES}
            if key.name.removeprefix("A") == "TRANS":  # TRANS does not have diameters
                taken = self.convert_statement(replace(statement, words=turned), x_is_radius=True)
                if "C" in taken.words and not self._state.modal.metric:
                    depth = taken.words["C"]
                    taken.words["C"] = depth._replace(value=(depth.value or 0.0) * 25.4)
            else:
                taken = self.convert_statement(statement)
            execute_frame_words(self._plane, taken)
            self._derive()

    def make_moves(self, statement: Statement) -> Iterator[Block]:
        """Yield the move of a statement in the plane, before corners are inserted.

        Raises ProgramError for an invalid move.
        """
        modal = self._state.modal
        has_moved = self._offset != (modal.drawing_zero_x, modal.drawing_zero_z)
        check_statement(
            self._state, self._names, statement, has_moved_in_contour=self.has_open_contour and has_moved
        )
        if word := statement.words.get("OFFN"):
            self._set_allowance(statement, word)
        self._follow_state()
        taken = self.convert_statement(statement)
        if execute_pole_and_limits(self._plane, taken):
            return
        if not (POSITION_WORDS | {"I", "J", "K"}) & statement.words.keys():
            return
        self._statement = taken
        depth = self._target_depth(taken)
        taken.words.pop("C", None)
        state = self._plane
        before = state.x, state.z
        flat = bool({"X", "Z", "I", "K", *_PLANE_WORDS} & taken.words.keys())
        if state.motion in ARC_MOTIONS:
            made = make_arc_block(state, taken)
        elif flat:
            made = make_straight_block(state, taken)
        else:
            made = self._plunge(taken)
        made = replace(made, kind=BlockKind.FEED if made.kind is BlockKind.ROTATE else made.kind)
        if made.kind is not BlockKind.ARC and (state.x, state.z) == before and depth == self._depth:
            return
        made.c0, made.c, self._depth = self._depth, depth, depth
        self._set_end_position(made)
        yield made

    def make_depth_move(self, statement: Statement, depth: float, feed: float | None, text: str) -> Block:
        """Return a move to a depth in the program frame, in mm, which is a rapid if ``feed`` is None."""
        self._follow_state()
        state, goal = self._plane, depth + self._plane.programmed_frame.shift_c
        kind = BlockKind.RAPID if feed is None else BlockKind.FEED
        made = make_travel_block(state, statement, self._still(), kind, feed or 0.0)
        made.text, made.c0, made.c = text, self._depth, goal
        self._depth = goal
        self._set_end_position(made)
        return made

    def make_rapid_to_hole(self, statement: Statement, x: float, y: float, text: str) -> Block:
        """Return a rapid to a point of the plane for a hole pattern, in mm."""
        self._follow_state()
        state = self._plane
        z, ordinate = (y, x) if not self.is_depth_along_z else (x, y)
        there = self._still().convert_to_machine_point(ordinate, z)
        travel = self._still()._replace(x=there[0], z=there[1])
        made = make_travel_block(state, statement, travel, BlockKind.RAPID, 0.0)
        made.text, made.c0, made.c = text, self._depth, self._depth
        self._set_end_position(made)
        return made

    def _set_allowance(self, statement: Statement, word: Word) -> None:
        """Set OFFN, the allowance of the contour.

        Raises ProgramError if a contour is active, and for a value other than 0 in TRACYL.
        """
        value = self._state.length(statement, word)
        if self._compensation.has_open_contour or (value and not self.is_depth_along_z):
            text = Message("{word} cannot change a contour that is not finished yet.", word=word.text)
            if not self._compensation.has_open_contour:
                text = Message(
                    "{word} is half the groove width in TRACYL, but TurnDesk does not machine the groove "
                    "walls from this value.",
                    word=word.text,
                )
            hint = "Program the groove walls as contours after G40."
            raise statement.make_error(word, "not-in-subset", text, hint)
        self.offn_mm = value

    def _target_depth(self, statement: Statement) -> float:
        """Return the target depth of a statement in mm, relative to the zero of the frame."""
        word = statement.words.get("C")
        if word is None:
            return self._depth
        value = (word.value or 0.0) * (1.0 if self._state.modal.metric else 25.4)
        relative = word.position_mode is PositionMode.IC or (
            word.position_mode is PositionMode.PLAIN and self._state.modal.absolute is False
        )
        return value + (self._depth if relative else self._plane.programmed_frame.shift_c)

    def _plunge(self, statement: Statement) -> Block:
        """Return a move that changes only the depth."""
        state = self._plane
        if state.motion is MotionKind.RAPID:
            return make_travel_block(state, statement, self._still(), BlockKind.RAPID, 0.0)
        return make_travel_block(
            state, statement, self._still(), BlockKind.FEED, check_block_feed(state, statement, 0.0, 0.0)
        )

    def _still(self) -> AxisTravel:
        state, modal = self._plane, self._plane.modal
        return AxisTravel(
            state.x, state.z, 0.0, state.x, state.z, 0.0,
            modal, modal.offset_x, modal.offset_z, state.programmed_frame,
        )  # fmt: skip

    def _set_end_position(self, block: Block) -> None:
        """Set the lathe's state to the programmed end point of a block, ignoring nose compensation."""
        state, frame = self._state, self._frame
        end = _spot(frame, block.x + block.offset_x, block.z + block.offset_z, block.c)
        if isinstance(frame, FacePlane):
            x = hypot(end[0], end[1])
            lathe = (x if frame.is_far_side else -x), end[2]
        else:
            lathe = (end[2] if frame.is_far_side else -end[2]), -end[0]
        state.x, state.z = lathe[0] + self._offset[0], lathe[1] + self._offset[1]

    # --- output

    def make_corner(self, block: Block) -> Corner | None:
        """Return the corner that the statement of this block programs, or None if it programs no corner.

        Raises ProgramError if the corner is invalid.
        """
        if self._statement is None or not block.moves:
            return None
        return make_corner(self._plane, self._statement, block)

    def accept_block(self, block: Block, corner: Corner | None) -> Iterator[Block]:
        """Accept a block, and yield the lathe blocks that no later block can change.

        Raises ProgramError if a corner or the compensation is not possible.
        """
        for cut in self._corners.accept_item(block, corner):
            for compensated_block in self._compensation.accept_block(cut):
                yield from self._to_lathe_blocks(compensated_block)

    def flush_corner(self) -> Iterator[Block]:
        """Yield the blocks that are buffered for a corner if no further move can follow.

        Raises ProgramError if the corner needs a following move.
        """
        for cut in self._corners.flush_at_program_end():
            for compensated_block in self._compensation.accept_block(cut):
                yield from self._to_lathe_blocks(compensated_block)

    def flush_at_program_end(self) -> Iterator[Block]:
        """Yield the remaining blocks at the end of the program.

        Raises ProgramError if a corner or a contour is unfinished.
        """
        yield from self.flush_corner()
        for compensated_block in self._compensation.check_program_end():
            yield from self._to_lathe_blocks(compensated_block)

    def discard_blocks(self) -> None:
        """Discard buffered blocks after an error."""
        self._corners.discard_move()
        self._compensation.discard_contour()

    def _to_lathe_blocks(self, block: Block) -> Iterator[Block]:
        """Yield the lathe blocks of one block of the plane."""
        if not block.moves:
            x, z, c = self._to_lathe(self._at)
            yield replace(block, x0=x, z0=z, c0=c, x=x, z=z, c=c, **self._zero(block))
            return
        start = self._at
        end = _spot(self._frame, block.x + block.offset_x, block.z + block.offset_z, block.c)
        centre = None
        if block.kind is BlockKind.ARC:
            middle = _spot(self._frame, block.cx + block.offset_x, block.cz + block.offset_z, 0.0)
            centre = middle[0], middle[1]
        elif all(abs(a - b) < _SAME for a, b in zip(start, end, strict=True)):
            return
        whole = PlaneMove(self._frame, start, end, self._theta, centre, not block.clockwise)
        for part in whole.split_at_axis():
            yield from self._turn_at_axis(block, part)
            yield self._made(block, part)

    def _turn_at_axis(self, block: Block, part: PlaneMove) -> Iterator[Block]:
        """Yield a rotation of C if the tool is on the spindle axis.

        C rotates until the path leads outward along X.
        """
        state, turn = self._state, replace(part, start_angle_rad=self._theta).find_start_rotation()
        if not needs_centerline_rotation(self._log, block.line, turn):
            return
        x, z, c = self._to_lathe(self._at)
        self._theta += turn
        speed, c_turn = state.setup.limits.max_axis_speeds[2], -degrees(turn)
        yield replace(
            block, kind=BlockKind.ROTATE, x0=x, z0=z, c0=c, x=x, z=z, c=c + c_turn, feed=speed, per_rev=False,
            rpm=copysign(speed / 6.0, c_turn), **self._zero(block),
        )  # fmt: skip

    def _made(self, block: Block, part: PlaneMove) -> Block:
        part = replace(part, start_angle_rad=self._theta)
        x0, z0, c0 = self._to_lathe(self._at)
        both = np.array([0.0, 1.0])
        if isinstance(self._frame, FacePlane):
            self._theta = float(part.compute_polar_angles(part.compute_mill_points(both), both)[1])
        else:
            self._theta = part.end[1] * 2.0 / self._frame.diameter_mm
        self._at = part.end
        x, z, c = self._to_lathe(part.end)
        self._state.c = c + self._state.modal.offset_c
        kind = BlockKind.PLANE_LINE if part.center is None else BlockKind.PLANE_ARC
        rapid = block.kind is BlockKind.RAPID
        feed = max(self._state.setup.limits.max_axis_speeds[:2]) if rapid else block.feed
        made = replace(
            block, kind=kind, x0=x0, z0=z0, c0=c0, x=x, z=z, c=c, feed=feed, per_rev=False, rpm=0.0, css=None,
            clockwise=part.clockwise, cx=0.0, cz=0.0, plane=part, **self._zero(block),
        )  # fmt: skip
        made.modal = made.modal._replace(rapid=rapid)
        return made

    def _to_lathe(self, point: MillPoint) -> MillPoint:
        """Convert a point of the mill to lathe X, Z and continuous C, without offsets."""
        frame = self._frame
        c = frame.c_start_deg - degrees(self._theta)
        if isinstance(frame, FacePlane):
            x = hypot(point[0], point[1])
            return (x if frame.is_far_side else -x), point[2], c
        return (point[2] if frame.is_far_side else -point[2]), -point[0], c

    def _zero(self, block: Block) -> _Zero:
        """Return the offsets and the modal state of the lathe for a block.

        In the block that ends the program, the transformation is no longer active.
        """
        own = self._state.modal
        ends = isinstance(block.action, ProgramEnd)
        modal = block.modal._replace(
            tool_offset_x=own.tool_offset_x,
            tool_offset_z=own.tool_offset_z,
            zero_offset_x=own.zero_offset_x,
            zero_offset_z=own.zero_offset_z,
            frame_shift_x=0.0,
            frame_shift_z=0.0,
            offset_c=own.offset_c,
            diameter=own.diameter,
            c_locked=True,
            mill=None if ends else VirtualMill(self._frame, *self._at, self._theta, False),
        )
        return _Zero(offset_x=self._offset[0], offset_z=self._offset[1], modal=modal)


def _spot(frame: FacePlane | SidePlane, ordinate: float, abscissa: float, depth: float) -> MillPoint:
    """Convert a point of the plane to the frame of the mill."""
    return (abscissa, ordinate, depth) if isinstance(frame, FacePlane) else (-ordinate, abscissa, depth)


def _to_plane(frame: FacePlane | SidePlane, point: MillPoint) -> MillPoint:
    """Return the abscissa, the ordinate and the depth of a point in the frame of the mill."""
    return (point[0], point[1], point[2]) if isinstance(frame, FacePlane) else (point[1], -point[0], point[2])

"""State of the machine, the workpiece and the modal functions during a pass through a Klartext program."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from core.geometry.rotary_axes import FrameTransform, Kinematics, RotaryAxis
from core.geometry.rotation_frames import (
    IDENTITY,
    Matrix,
    Vector,
    add_vectors,
    apply_matrix,
    multiply_matrices,
    transpose_matrix,
)
from core.geometry.working_plane import XY_ORDER, AxisMove, AxisOrder, CurvedMove, ProgramTransform
from core.interpreter.shared.actions import Action, Dwell, ProgramStop
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.interpreter.shared.units import MM_PER_INCH
from core.interpreter.shared.working_plane import (
    BlankCorners,
    PlaneCoordinateSystem,
    PlanePosition,
    RotaryAngles,
)
from core.language.diagnostics import (
    PROGRAM_STOP_ASSUMPTION,
    Diagnostic,
    ProgramError,
    Severity,
    add_assumptions,
)
from core.language.klartext.klartext_faults import make_klartext_error
from core.language.klartext.named_files import TableRow
from core.message import Message, fill_template

ORIGIN_POINT: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ActivePlane:
    """The active working plane.

    ``frame`` is the orientation of the plane with all table axes at 0. ``target_angles`` are machine angles
    by axis name, in degrees from 0 to 360 on a modulo axis. ``line_number`` is the line of the PLANE block.
    """

    frame: Matrix
    target_angles: Mapping[str, float]
    line_number: int


class ToolDeltas(NamedTuple):
    """The oversizes DL, DR and DR2 of a TOOL CALL, in mm."""

    length: float = 0.0
    radius: float = 0.0
    corner_radius: float = 0.0


LINEAR_AXES = "XYZ"
ROTARY_AXES = "ABC"
TARGET_ANGLE_PARAMETERS = (120, 121, 122)
POINT_TOLERANCE = 1e-7  # mm or degrees; closer points count as equal


class State:
    """The state of an interpreter pass through a Klartext program.

    - ``position_by_axis``: all axis positions by name, in mm or degrees; rotary axes are continuous.
    - ``axis_positions``: the same positions in the machine's axis order.
    - ``datum``: workpiece datum in the workpiece system.
    - ``shift``: TRANS DATUM within the active plane.
    - ``frame``, ``origin``: axes and origin of the working plane in the workpiece system.
    - ``plane_transform``: conversion of points of the plane to machine positions of the linear axes.
    - ``tip_in_plane``: position of the tool tip in the plane, in mm.
    - ``line_number``, ``text``: number and displayed text of the active block.
    """

    def __init__(
        self, setup: InterpreterSetup, kinematics: Kinematics, log: DiagnosticLog, *, is_inch: bool
    ) -> None:
        self.line_number, self.text = 0, ""
        self.kinematics = kinematics
        self.axis_names = kinematics.axis_names
        self.rotary_axis_names = tuple(axis.name for axis in kinematics.rotary_axes)
        self.position_by_axis = dict(zip(self.axis_names, setup.start, strict=True))
        self.axis_positions = tuple(setup.start)
        self.active_plane: ActivePlane | None = None
        self.datum = self.shift = self.origin = ORIGIN_POINT
        self.frame = IDENTITY
        self.tool_length_mm = 0.0
        self.is_tcpm_active = False
        # M126: modulo rotary axes move the shorter distance; M127: by the difference of the displayed angles
        self.uses_shorter_rotation = True
        self._shown: RotaryAngles | None = None  # recalculated after a move of a rotary axis
        self.plane_transform = self._place()
        self.tip_in_plane = self.plane_transform.convert_to_frame_point(self.linear_position)
        self.setup = setup
        self.log = log
        self.mm_per_unit = MM_PER_INCH if is_inch else 1.0
        self.block_count = 0
        self.tool_axis = ""
        self.feed: float | None = None  # active F, as programmed
        self.feed_base = ""  # base of the feed: U per revolution, Z per tooth, otherwise per minute
        self.tool_feed: float | None = None  # F of the last TOOL CALL
        self.tool_feed_base = ""
        self.is_feed_per_revolution = False  # M136: F is per revolution
        # M116: F of moves of only rotary axes is in mm of the tip on the workpiece
        self.is_rotary_feed_at_tip = False
        self.plunging_feed_factor: float | None = (
            None  # M103: fraction of F that applies to downward Z motion
        )
        self.spindle_angle_deg = 0.0  # angle of cycle 13 for M19
        self.q_values: dict[int, float] = {}
        self.ql_and_qr_values: dict[tuple[str, int], float] = {}  # QL and QR
        self.global_def_values: dict[int, float] = {}  # values of GLOBAL DEF for PREDEF
        self.transformation = ProgramTransform()
        self.pole: tuple[float, float] | None = None  # pole of CC, in the axes of its plane
        self.pole_plane: AxisOrder = XY_ORDER
        self.rotation_direction = ""  # active DR, + or -
        self.tool_radius_mm = 0.0
        self.tool_deltas_mm = ToolDeltas()  # of the last TOOL CALL
        self.tool_definitions: dict[int | str, tuple[float, float]] = {}  # length and radius of TOOL DEF, mm
        # values of FN 17 by tool and column, which FN 18 returns
        self.system_written_values: dict[tuple[int, int], float] = {}
        self.datum_table_rows: dict[int, TableRow] | None = None  # table of SEL TABLE
        self.selected_program = ""  # program of SEL PGM
        self.is_table_positioned = (
            False  # the program has positioned the table, so its start position has no effect
        )
        self.blank_corners: BlankCorners | None = None
        # a position was read after a program stop, at which the operator may move the axes
        self.is_after_program_stop = self.is_position_assumed = False
        self.reported_findings: set[object] = set()  # warnings that would otherwise be repeated
        self.modal = ModalState(absolute=True, metric=not is_inch, rapid_rate=setup.last_rapid)
        self._c = self.axis_names.index("C") if "C" in self.position_by_axis else -1
        self._shared: PlaneCoordinateSystem | None = None

    # --- position -----------------------------------------------------------------------------------------

    @property
    def programmed_position(self) -> Vector:
        """Return the tip position in program coordinates, in mm."""
        return self.transformation.convert_to_program(self.tip_in_plane)

    def convert_to_machine_position(self, program_point: Vector) -> Vector:
        """Return the machine positions of X, Y and Z in mm at which the tip is at a program point."""
        return self.plane_transform.convert_to_machine_position(
            self.transformation.convert_to_plane(program_point)
        )

    def set_axis_positions(self, goal: dict[str, float]) -> None:
        """Set the positions of all axes from ``goal``, by axis name, in mm or degrees."""
        if any(goal[name] != self.position_by_axis[name] for name in self.rotary_axis_names):
            self._shown = None
        turned = self._shown is None
        self.position_by_axis, self.axis_positions = goal, tuple([goal[name] for name in self.axis_names])
        if turned and self.is_tcpm_active:
            self.update_derived_values()
        self.tip_in_plane = self.plane_transform.convert_to_frame_point(self.linear_position)

    def set_machine_positions(self, positions: Sequence[float]) -> None:
        """Set the positions of all axes from machine positions in the machine's axis order."""
        self.position_by_axis, self.axis_positions = (
            dict(zip(self.axis_names, positions, strict=True)),
            tuple(positions),
        )
        self._shown = None
        self.update_derived_values()

    @property
    def displayed_angles(self) -> RotaryAngles:
        """Return the displayed angles of A, B and C in degrees.

        The angle is None for each axis that the machine lacks.
        """
        if self._shown is None:
            axes = {axis.name: self.get_displayed_angle(axis) for axis in self.kinematics.rotary_axes}
            self._shown = (axes.get("A"), axes.get("B"), axes.get("C"))
        return self._shown

    def get_displayed_angle(self, axis: RotaryAxis) -> float:
        """Return the displayed angle of a rotary axis, in degrees."""
        return self.kinematics.get_displayed_angle(axis, self.position_by_axis[axis.name])

    @property
    def linear_position(self) -> Vector:
        """Return the machine positions of X, Y and Z in mm."""
        return self.position_by_axis["X"], self.position_by_axis["Y"], self.position_by_axis["Z"]

    @property
    def rotary_angles(self) -> dict[str, float]:
        """Return the continuous angles of the rotary axes by axis name, in degrees."""
        return {axis.name: self.position_by_axis[axis.name] for axis in self.kinematics.rotary_axes}

    @property
    def target_angles(self) -> dict[str, float]:
        """Return the angles at which the rotary axes must be for the active plane, in degrees.

        Without an active plane, they are the current angles.
        """
        if self.active_plane is not None:
            return dict(self.active_plane.target_angles)
        return {
            axis.name: axis.get_displayed_angle(self.position_by_axis[axis.name])
            for axis in self.kinematics.rotary_axes
        }

    def update_derived_values(self) -> None:
        """Recalculate the values that depend on the plane, the datum and the tool."""
        self.frame = IDENTITY
        if self.active_plane is not None:
            self.frame = multiply_matrices(
                transpose_matrix(self.kinematics.workpiece_rotation), self.active_plane.frame
            )
        self.origin = add_vectors(self.datum, apply_matrix(self.frame, self.shift))
        self.plane_transform = self._place()
        self.tip_in_plane = self.plane_transform.convert_to_frame_point(self.linear_position)
        self._shared = None

    def reset_transformations(self) -> None:
        """Reset datum shift, mirroring, rotation and scaling after another preset is activated."""
        self.datum = self.shift = ORIGIN_POINT
        self.transformation = ProgramTransform()
        self.update_derived_values()

    def set_plane(self, plane: ActivePlane | None) -> None:
        """Set the active working plane; None clears it.

        The datum remains at the same point of the workpiece.
        """
        self.datum, self.shift = self.origin, ORIGIN_POINT
        self.active_plane = plane
        self.update_derived_values()

    def _place(self) -> FrameTransform:
        angles = (
            self.active_plane.target_angles if self.active_plane is not None else self.kinematics.zero_angles
        )
        if self.is_tcpm_active:
            angles = self.rotary_angles
        frame = (
            self.active_plane.frame if self.active_plane is not None else self.kinematics.workpiece_rotation
        )
        datum = apply_matrix(self.kinematics.workpiece_rotation, self.origin)
        return self.kinematics.make_transform(angles, frame, datum, self.tool_length_mm)

    # --- numbers ------------------------------------------------------------------------------------------

    def convert_feed_to_mm_s(self, feed: float) -> float:
        """Convert an F value to mm/s.

        F is in mm/min, or in tenths of an inch per minute in an INCH program.
        """
        return feed / 60.0 if self.mm_per_unit == 1.0 else feed * 0.1 * MM_PER_INCH / 60.0

    def make_error(
        self, column: int, code: str, text: str, hint: str, line: int = 0, /, **values: object
    ) -> ProgramError:
        """Return an error at this column of the active line, or of ``line`` if it is not 0.

        ``values`` contains the values for the placeholders of ``text`` and ``hint``.
        """
        return make_klartext_error(
            line or self.line_number, column, code, fill_template(text, values), fill_template(hint, values)
        )

    def check_condition(
        self, condition: object, column: int, code: str, text: str, hint: str, /, **values: object
    ) -> None:
        """Raise the ProgramError that ``make_error`` returns, unless ``condition`` is true."""
        if not condition:
            raise self.make_error(column, code, text, hint, **values)

    def record_position_read(self) -> None:
        """Record that the program reads an axis position.

        After a program stop, the operator may have jogged the axes. The position is then only an
        assumption, and errors that depend on it are marked as uncertain.
        """
        self.is_position_assumed = self.is_position_assumed or self.is_after_program_stop

    def mark_position_error(self, error: ProgramError) -> ProgramError:
        """Return the error of a formula, marked as uncertain if it depends on an assumed position."""
        return (
            ProgramError(add_assumptions(error.diagnostic, PROGRAM_STOP_ASSUMPTION))
            if self.is_position_assumed
            else error
        )

    def log_finding_once(
        self, column: int, severity: Severity, code: str, text: str, hint: str = "", /, **values: object
    ) -> None:
        """Log a finding only the first time that it occurs."""
        text = fill_template(text, values)
        if text not in self.reported_findings:
            self.reported_findings.add(text)
            self.log.add_finding(
                Diagnostic(self.line_number, column, severity, code, text, fill_template(hint, values))
            )

    def log_ignored_function(self, function: str, column: int) -> None:
        """Log a note, only once, that a function has no effect on this control."""
        self.log_finding_once(
            column, Severity.NOTE, "unheeded", Message("{what} has no effect on this control.", what=function)
        )

    # --- blocks -------------------------------------------------------------------------------------------

    def make_move_block(
        self,
        kind: BlockKind,
        end: Mapping[str, float],
        feed: float | None,
        curved_move: CurvedMove | None = None,
    ) -> Block:
        """Return the block of a move to ``end``, and update the positions of the state.

        Axes that ``end`` does not contain do not move. A ``feed`` of None is a rapid. The feed is in mm of
        the linear axes. It is in degrees if only rotary axes move, or if ``curved_move`` specifies a feed
        in degrees.
        """
        before, start, goal = self.tip_in_plane, self.position_by_axis, {**self.position_by_axis, **end}
        away = math.dist((start["X"], start["Y"], start["Z"]), (goal["X"], goal["Y"], goal["Z"]))
        if curved_move is not None and not curved_move.is_feed_in_degrees:
            away = curved_move.length
        linear = away > POINT_TOLERANCE and (curved_move is None or not curved_move.is_feed_in_degrees)
        length = away
        if not linear:
            turn = math.hypot(*(goal[name] - start[name] for name in self.rotary_axis_names))
            length = turn if turn > POINT_TOLERANCE else 0.0
        rate = (
            feed
            if feed is not None
            else self._rapid(start, goal, length, slides=linear, curved=curved_move is not None)
        )
        from_here = self.axis_positions
        self.set_axis_positions(goal)
        if self.modal.rapid != (feed is None):
            self.modal = self.modal._replace(rapid=feed is None)
        travel = AxisMove(from_here, self.axis_positions, length, curved_move, away > POINT_TOLERANCE)
        return self._block(kind, before, travel, rate)

    def make_action_block(self, action: Action) -> Block:
        """Return a block that executes an action without motion."""
        self.is_after_program_stop = self.is_after_program_stop or isinstance(action, ProgramStop)
        here = AxisMove(self.axis_positions, self.axis_positions, 0.0, slides=False)
        kind = BlockKind.DWELL if isinstance(action, Dwell) else BlockKind.ACTION
        return self._block(kind, self.tip_in_plane, here, 0.0, action)

    def _block(
        self, kind: BlockKind, before: Vector, travel: AxisMove, feed: float, action: Action | None = None
    ) -> Block:
        self.block_count += 1
        end, slides, c = self.tip_in_plane, self.linear_position, self._c
        return Block(
            n=self.block_count, line=self.line_number, kind=kind, text=self.text,
            x0=before[0], z0=before[2], c0=travel.start[c] if c >= 0 else 0.0,
            x=end[0], z=end[2], c=travel.end[c] if c >= 0 else 0.0,
            offset_x=slides[0] - end[0], offset_z=slides[2] - end[2],
            modal=self.modal, feed=feed, rpm=self.modal.rpm * self.modal.spindle,
            action=action, travel=travel,
            swivel=PlanePosition(before, end, slides, self.displayed_angles, self._system()),
        )  # fmt: skip

    def _system(self) -> PlaneCoordinateSystem:
        if self._shared is None:
            q120, q121, q122 = (self.q_values.get(q, 0.0) for q in TARGET_ANGLE_PARAMETERS)
            self._shared = PlaneCoordinateSystem(
                transform=self.plane_transform,
                kinematics=self.kinematics,
                frame=self.frame,
                datum=self.origin,
                is_tilted=self.active_plane is not None,
                target_angles=(q120, q121, q122),
                plane_block_line=self.active_plane.line_number if self.active_plane is not None else 0,
                tool_length_mm=self.tool_length_mm,
                blank_corners=self.blank_corners,
            )
        return self._shared

    def _rapid(
        self,
        start: Mapping[str, float],
        goal: Mapping[str, float],
        length: float,
        *,
        slides: bool,
        curved: bool,
    ) -> float:
        """Return the path speed of a rapid in mm/s or degrees/s.

        At this speed, the slowest axis moves at its maximum speed.
        """
        if curved and slides:
            return min(slide.vmax for slide in self.kinematics.linear_axes)
        axes = (*(self.kinematics.linear_axes if slides else ()), *self.kinematics.rotary_axes)
        seconds = max((abs(goal[axis.name] - start[axis.name]) / axis.vmax for axis in axes), default=0.0)
        return length / seconds if seconds > 0.0 and length > 0.0 else self.setup.last_rapid

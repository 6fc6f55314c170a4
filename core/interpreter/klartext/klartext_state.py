"""State of machine, workpiece and modal functions during a pass through a Klartext program."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from core.geometry.rotary_axes import Kinematics, Place, Rotary
from core.geometry.rotation_frames import IDENTITY, Matrix, Vector, applied, plus, product, transposed
from core.geometry.working_plane import XY, CurvedMove, Figure, Order, Travel
from core.interpreter.shared.actions import Action, Dwell, ProgramStop
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.modal_state import Modal
from core.interpreter.shared.units import MM_PER_INCH
from core.interpreter.shared.working_plane import Angles, Corners, PlaneSystem, Swivel
from core.language.diagnostics import AT_THE_STOP, Diagnostic, ProgramError, Severity, resting_on
from core.language.klartext.klartext_faults import fault
from core.language.klartext.named_files import Row
from core.message import Message, worded

ORIGIN: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class WorkingPlane:
    """The active plane. ``frame`` is its orientation with the tables at 0.

    ``targets`` are machine angles by axis, from 0 to 360 on a modulo axis. ``line`` is the line of the PLANE
    block.
    """

    frame: Matrix
    targets: Mapping[str, float]
    line: int


SLIDES = "XYZ"
ROTARY = "ABC"
Q_TARGETS = (120, 121, 122)
SAME_POINT = 1e-7  # mm or degrees; closer points count as equal


class State:
    """State of a pass.

    ``at`` has all axis positions by name, ``there`` in the machine's order; mm and degrees.

    Rotary axes are continuous. ``datum`` is the workpiece datum in the workpiece system, and ``shift`` is the
    TRANS DATUM within the active plane. ``frame`` and ``origin`` are the axes and origin of the working plane
    in the workpiece system. ``place`` converts its points to machine positions of the linear axes, and
    ``point`` is the tip position in it, in mm. ``line`` is the active line, and ``text`` is its block as
    displayed.
    """

    def __init__(self, setup: Setup, kinematics: Kinematics, log: Log, *, inch: bool) -> None:
        self.line, self.text = 0, ""
        self.kinematics = kinematics
        self.names = kinematics.names
        self.rotary_names = tuple(axis.name for axis in kinematics.rotaries)
        self.at = dict(zip(self.names, setup.start, strict=True))
        self.there = tuple(setup.start)
        self.plane: WorkingPlane | None = None
        self.datum = self.shift = self.origin = ORIGIN
        self.frame = IDENTITY
        self.tool_length = 0.0
        self.m128 = False
        # M126: modulo rotary axes move the shorter distance; M127: by the difference of the displayed angles
        self.short_way = True
        self._shown: Angles | None = None  # recalculated after a move of a rotary axis
        self.place = self._place()
        self.point = self.place.point(self.slides)
        self.setup = setup
        self.log = log
        self.scale = MM_PER_INCH if inch else 1.0
        self.blocks = 0
        self.tool_axis = ""
        self.feed: float | None = None  # active F, as programmed
        self.feed_per = ""  # base of the feed: U per revolution, Z per tooth, otherwise per minute
        self.tool_feed: float | None = None  # F of the last TOOL CALL
        self.tool_feed_per = ""
        self.per_revolution = False  # M136: F is per revolution
        # M116: F of moves of only rotary axes is in mm of the tip on the workpiece
        self.rotary_by_way = False
        self.plunging: float | None = None  # M103: fraction of F that applies to downward Z motion
        self.spindle_angle = 0.0  # angle of cycle 13 for M19
        self.q: dict[int, float] = {}
        self.q_beside: dict[tuple[str, int], float] = {}  # QL and QR
        self.q_global: dict[int, float] = {}  # values of GLOBAL DEF for PREDEF
        self.figure = Figure()
        self.pole: tuple[float, float] | None = None  # pole of CC, in the axes of its plane
        self.pole_plane: Order = XY
        self.turn = ""  # active DR, + or -
        self.tool_radius = 0.0
        self.oversize = (0.0, 0.0)  # DL and DR of the last TOOL CALL, mm
        self.tool_defs: dict[int | str, tuple[float, float]] = {}  # length and radius of TOOL DEF, mm
        # values of FN 17 by tool and column, which FN 18 returns
        self.tool_cells: dict[tuple[int, int], float] = {}
        self.datum_table: dict[int, Row] | None = None  # table of SEL TABLE
        self.selected_program = ""  # program of SEL PGM
        self.table_known = False  # the program has positioned the table, so its start position has no effect
        self.blank: Corners | None = None
        # a position was read after a program stop, at which the operator may move the axes
        self.behind_stop = self.place_assumed = False
        self.reported: set[object] = set()  # warnings that would otherwise be repeated
        self.modal = Modal(absolute=True, metric=not inch, rapid_rate=setup.last_rapid)
        self._c = self.names.index("C") if "C" in self.at else -1
        self._shared: PlaneSystem | None = None

    # --- position -----------------------------------------------------------------------------------------

    @property
    def programmed(self) -> Vector:
        """Tip position in program coordinates, in mm."""
        return self.figure.program(self.point)

    def machine(self, programmed: Vector) -> Vector:
        """Return machine X Y Z at which the tip is at a point of the program, in mm."""
        return self.place.machine(self.figure.plane(programmed))

    def go(self, goal: dict[str, float]) -> None:
        """Set the axis positions; ``goal`` has all axes."""
        if any(goal[name] != self.at[name] for name in self.rotary_names):
            self._shown = None
        turned = self._shown is None
        self.at, self.there = goal, tuple([goal[name] for name in self.names])
        if turned and self.m128:
            self.derive()
        self.point = self.place.point(self.slides)

    def stand(self, at: Sequence[float]) -> None:
        """Set the axes to these machine positions, in the machine's order."""
        self.at, self.there = dict(zip(self.names, at, strict=True)), tuple(at)
        self._shown = None
        self.derive()

    @property
    def displayed(self) -> Angles:
        """Displayed angles of A B C, with None for axes that the machine does not have."""
        if self._shown is None:
            axes = {axis.name: self.shown(axis) for axis in self.kinematics.rotaries}
            self._shown = (axes.get("A"), axes.get("B"), axes.get("C"))
        return self._shown

    def shown(self, axis: Rotary) -> float:
        """Return the displayed angle of a rotary axis."""
        return self.kinematics.shown(axis, self.at[axis.name])

    @property
    def slides(self) -> Vector:
        """Machine X Y Z, in mm."""
        return self.at["X"], self.at["Y"], self.at["Z"]

    @property
    def rotary(self) -> dict[str, float]:
        """Continuous angles of the rotary axes by name, in degrees."""
        return {axis.name: self.at[axis.name] for axis in self.kinematics.rotaries}

    @property
    def targets(self) -> dict[str, float]:
        """Effective angle of each rotary axis: from the active plane, otherwise its present angle."""
        if self.plane is not None:
            return dict(self.plane.targets)
        return {axis.name: axis.displayed(self.at[axis.name]) for axis in self.kinematics.rotaries}

    def derive(self) -> None:
        """Recalculate the values that depend on plane, datum and tool."""
        self.frame = IDENTITY
        if self.plane is not None:
            self.frame = product(transposed(self.kinematics.basic), self.plane.frame)
        self.origin = plus(self.datum, applied(self.frame, self.shift))
        self.place = self._place()
        self.point = self.place.point(self.slides)
        self._shared = None

    def preset(self) -> None:
        """Reset datum shift, mirroring, rotation and scaling for another preset."""
        self.datum = self.shift = ORIGIN
        self.figure = Figure()
        self.derive()

    def set_plane(self, plane: WorkingPlane | None) -> None:
        """Set another plane or None. The datum point on the workpiece does not change."""
        self.datum, self.shift = self.origin, ORIGIN
        self.plane = plane
        self.derive()

    def _place(self) -> Place:
        angles = self.plane.targets if self.plane is not None else self.kinematics.zero
        if self.m128:
            angles = self.rotary
        frame = self.plane.frame if self.plane is not None else self.kinematics.basic
        datum = applied(self.kinematics.basic, self.origin)
        return self.kinematics.place(angles, frame, datum, self.tool_length)

    # --- numbers ------------------------------------------------------------------------------------------

    def path_feed(self, word: float) -> float:
        """Return F in mm/s, from mm/min, or from tenths of an inch per minute in an INCH program."""
        return word / 60.0 if self.scale == 1.0 else word * 0.1 * MM_PER_INCH / 60.0

    def refuse(
        self, column: int, code: str, text: str, hint: str, line: int = 0, /, **values: object
    ) -> ProgramError:
        """Return an error at this column of the active line, or of ``line``.

        ``values`` are the values for the placeholders of ``text`` and ``hint``.
        """
        return fault(line or self.line, column, code, worded(text, values), worded(hint, values))

    def check(self, ok: object, column: int, code: str, text: str, hint: str, /, **values: object) -> None:
        """Raise the error of ``refuse`` unless the condition ``ok`` is true."""
        if not ok:
            raise self.refuse(column, code, text, hint, **values)

    def place_is_read(self) -> None:
        """Record that the program reads a position, which the proof can only assume after a program stop."""
        self.place_assumed = self.place_assumed or self.behind_stop

    def of_the_place(self, error: ProgramError) -> ProgramError:
        """Return an error of a formula, marked if it depends on an assumed position."""
        return ProgramError(resting_on(error.diagnostic, AT_THE_STOP)) if self.place_assumed else error

    def tell_once(
        self, column: int, severity: Severity, code: str, text: str, hint: str = "", /, **values: object
    ) -> None:
        """Log a finding only at its first location."""
        text = worded(text, values)
        if text not in self.reported:
            self.reported.add(text)
            self.log.add(Diagnostic(self.line, column, severity, code, text, worded(hint, values)))

    def unheeded(self, what: str, column: int) -> None:
        """Note once that a function has no effect."""
        self.tell_once(
            column, Severity.NOTE, "unheeded", Message("{what} has no effect on this control.", what=what)
        )

    # --- blocks -------------------------------------------------------------------------------------------

    def move(
        self, kind: Kind, end: Mapping[str, float], feed: float | None, way: CurvedMove | None = None
    ) -> Block:
        """Move to ``end`` and return the block; missing axes do not move, and a ``feed`` of None is a rapid.

        The feed is in mm of the linear axes, or in degrees if only rotary axes move or determine the move
        (``way``).
        """
        before, start, goal = self.point, self.at, {**self.at, **end}
        away = math.dist((start["X"], start["Y"], start["Z"]), (goal["X"], goal["Y"], goal["Z"]))
        if way is not None and not way.in_degrees:
            away = way.length
        linear = away > SAME_POINT and (way is None or not way.in_degrees)
        length = away
        if not linear:
            turn = math.hypot(*(goal[name] - start[name] for name in self.rotary_names))
            length = turn if turn > SAME_POINT else 0.0
        rate = (
            feed
            if feed is not None
            else self._rapid(start, goal, length, slides=linear, curved=way is not None)
        )
        from_here = self.there
        self.go(goal)
        if self.modal.rapid != (feed is None):
            self.modal = self.modal._replace(rapid=feed is None)
        travel = Travel(from_here, self.there, length, way, away > SAME_POINT)
        return self._block(kind, before, travel, rate)

    def action(self, action: Action) -> Block:
        """Return a block without motion."""
        self.behind_stop = self.behind_stop or isinstance(action, ProgramStop)
        here = Travel(self.there, self.there, 0.0, slides=False)
        kind = Kind.DWELL if isinstance(action, Dwell) else Kind.ACTION
        return self._block(kind, self.point, here, 0.0, action)

    def _block(
        self, kind: Kind, before: Vector, travel: Travel, feed: float, action: Action | None = None
    ) -> Block:
        self.blocks += 1
        end, slides, c = self.point, self.slides, self._c
        return Block(
            n=self.blocks, line=self.line, kind=kind, text=self.text,
            x0=before[0], z0=before[2], c0=travel.start[c] if c >= 0 else 0.0,
            x=end[0], z=end[2], c=travel.end[c] if c >= 0 else 0.0,
            offset_x=slides[0] - end[0], offset_z=slides[2] - end[2],
            modal=self.modal, feed=feed, rpm=self.modal.rpm * self.modal.spindle,
            action=action, travel=travel,
            swivel=Swivel(before, end, slides, self.displayed, self._system()),
        )  # fmt: skip

    def _system(self) -> PlaneSystem:
        if self._shared is None:
            q120, q121, q122 = (self.q.get(q, 0.0) for q in Q_TARGETS)
            self._shared = PlaneSystem(
                place=self.place,
                kinematics=self.kinematics,
                frame=self.frame,
                datum=self.origin,
                tilted=self.plane is not None,
                targets=(q120, q121, q122),
                line=self.plane.line if self.plane is not None else 0,
                tool_length=self.tool_length,
                blank=self.blank,
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
        """Return the path speed at which the slowest axis moves at its limit, in mm/s or degrees/s."""
        if curved and slides:
            return min(slide.vmax for slide in self.kinematics.slides)
        axes = (*(self.kinematics.slides if slides else ()), *self.kinematics.rotaries)
        seconds = max((abs(goal[axis.name] - start[axis.name]) / axis.vmax for axis in axes), default=0.0)
        return length / seconds if seconds > 0.0 and length > 0.0 else self.setup.last_rapid

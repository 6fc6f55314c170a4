"""Zero offsets G54 to G59 of a lathe, and presets of a mill, which define the workpiece position."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, degrees, hypot, remainder

from app.desk.arithmetic import EntryError, value_of
from app.desk.desk import Desk
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.cell_table import CellTable
from app.offsets.mill_touch import MillTouch
from app.offsets.offsets_in_force import zeros_of
from core.executor.snapshot import Snapshot, State
from core.geometry.rotation_frames import Vector
from core.message import Message
from core.store.store_rows import PRESETS, ZERO_CODES, Kind, PresetRow, Value

_ROTARY = {"a": "A", "b": "B", "c": "C"}
_APART = 1.0  # Millimeters: closer points of an edge do not define its direction.


class Presets(CellTable):
    """The preset table with its selected cell. ``edge`` is the first touched point for a basic rotation."""

    kind = Kind.PRESET
    numbers = PRESETS

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.edge: Vector | None = None

    @property
    def columns(self) -> tuple[str, ...]:
        """The field names of the columns, with the rotary axes of this machine only."""
        absent = {name for name, axis in _ROTARY.items() if axis not in MillTouch.of(self.desk).rotary_axes}
        return tuple(name for name in super().columns if name not in absent)

    @property
    def title(self) -> str:
        """The title of the table, with its units."""
        return tr("PRESETS  ·  WORKPIECE ZERO IN MACHINE COORDINATES, MM AND DEGREES")

    def in_force(self, _snapshot: Snapshot) -> int:
        """Return the number of the preset in force."""
        return self.book.preset

    @property
    def foot(self) -> str:
        """The hint for the keys F2, F3 and Esc, with the preset in force."""
        told = tr("F2: set the current tip position to the typed value")
        if self.name in _ROTARY:
            told = tr("F2: set the current axis position to the typed value")
        elif self.name == "rotation":
            told = tr("Press F2 at two points on an edge to set ROT so that the edge has the typed angle")
        active = self.book.preset
        now = tr(Message("active preset: {preset}", preset=active or tr("0 (from the machine file)")))
        return f"{told}        {tr('F3: activate preset')}        {now}"

    @property
    def row_now(self) -> PresetRow:
        """The selected row. Empty if it was never set."""
        return self.book.presets.get(self.number, PresetRow())

    def choose(self, row: int, column: int) -> None:
        """Select another cell, and discard the first point of an edge."""
        self.edge = None
        super().choose(row, column)

    def take_back(self) -> bool:
        """Discard the entry and the first point of an edge. Return False if there is neither."""
        begun, self.edge = self.edge is not None, None
        return super().take_back() or begun

    def here(self) -> None:
        """Handle F2: set the selected field so that the present position reads the entered value, or 0.

        A basic rotation needs two points of an edge.
        """
        if self.name in _ROTARY:
            self._touch_rotary()
        elif self.name in {"x", "y", "z"}:
            self._touch_slide()
        elif self.name == "rotation":
            self._touch_edge()
        else:
            self.desk.say(tr("SELECT X, Y, Z, A ROTARY AXIS OR ROT. F2: TOUCH OFF"))

    @property
    def _reads(self) -> str:
        return self.text.strip() or "0"

    def _touch_slide(self) -> None:
        """Set a linear axis so that the tip reads the entered value."""
        tip, reads = self._tip(), self._reads
        if tip is not None:
            at = tip["xyz".index(self.name)]
            self.save(
                lambda: self.checked(at - value_of(reads)),
                tr(Message("position set to {value}", value=reads)),
            )

    def _tip(self) -> Vector | None:
        tip = MillTouch.of(self.desk).tip(zeros_of(self.row_now))
        if isinstance(tip, str):
            self.desk.say(tip)
            return None
        return tip

    def _touch_rotary(self) -> None:
        """Set a rotary axis so that it reads the entered value.

        The workpiece zero remains on the same point of the part.
        """
        at, reads = MillTouch.of(self.desk).angle(_ROTARY[self.name]), self._reads
        if isinstance(at, str):
            self.desk.say(at)
            return
        self.save(
            lambda: self.checked(remainder(at - value_of(reads), 360.0)),
            tr(Message("position set to {value}", value=reads)),
            self._followed,
        )

    def _followed(self, zero: Value) -> Mapping[str, Value]:
        """Return X, Y and Z of the same workpiece point for another zero of the selected rotary axis."""
        row = self.row_now
        if self.stored is None:
            return {}
        after = {**zeros_of(row), _ROTARY[self.name]: float(zero)}
        spot = MillTouch.of(self.desk).moved((row.x, row.y, row.z), zeros_of(row), after)
        return dict(zip("xyz", (round(at, 10) for at in spot), strict=True))

    def _touch_edge(self) -> None:
        """Store the first point of an edge, or set the basic rotation from the second point."""
        tip, reads = self._tip(), self._reads
        if tip is None:
            return
        if self.edge is None:
            self.edge = tip
            self.desk.say(tr("POINT 1 STORED. TOUCH SAME EDGE AT ANOTHER POINT, PRESS F2"))
            return
        first = self.edge
        if self.save(
            lambda: self._turned(first, tip, value_of(reads)),
            tr(Message("edge angle set to {value}", value=reads)),
        ):
            self.edge = None

    def _turned(self, first: Vector, last: Vector, reads: float) -> float:
        """Return the basic rotation in degrees, if the edge must read ``reads`` degrees from X.

        An edge has no direction, so a half revolution is ignored. Raises EntryError if the points are too
        close.
        """
        dx, dy = last[0] - first[0], last[1] - first[1]
        if hypot(dx, dy) < _APART:
            raise EntryError(tr("POINTS LESS THAN 1 MM APART. TOUCH FARTHER ALONG THE EDGE"))
        return self.checked(remainder(degrees(atan2(dy, dx)) - reads, 180.0))

    def activate_barred(self) -> str:
        """Return why the selected preset cannot be activated now. Empty if it can."""
        if why := self.barred(self.desk.snapshot()):
            return why
        if self.stored is None:
            return tr(
                Message("PRESET {number} IS NOT SET. TOUCH IT OFF OR TYPE ITS VALUES", number=self.number)
            )
        return ""

    def here_barred(self) -> str:
        """Return why the workpiece cannot be touched off now. Empty if it can."""
        if self.name in _ROTARY:
            place: object = MillTouch.of(self.desk).angle(_ROTARY[self.name])
        elif self.name in {"x", "y", "z", "rotation"}:
            place = MillTouch.of(self.desk).tip(zeros_of(self.row_now))
        else:
            place = tr("SELECT X, Y, Z, A ROTARY AXIS OR ROT. F2: TOUCH OFF")
        return place if isinstance(place, str) else self.barred(self.desk.snapshot())

    def activate(self) -> None:
        """Handle F3: activate the selected preset, or that of the machine file if it is already active."""
        if why := self.activate_barred():
            self.desk.say(why)
            return
        number = 0 if self.book.preset == self.number else self.number
        if why := self.book.choose_preset(number):
            self.desk.say(why)


class ZeroOffsets(CellTable):
    """The table of the zero offsets with its selected cell and the entered text."""

    kind = Kind.ZERO
    own_key = "C"
    numbers = ZERO_CODES
    clears = "PRESS Y TO CLEAR G54 TO G59, N TO KEEP THEM"
    why_cleared = "all zero offsets cleared with the C key"

    @property
    def title(self) -> str:
        """The title of the table, with its units."""
        return tr("SETTABLE OFFSETS  ·  X IS A RADIUS  ·  MM AND DEGREES")

    @property
    def words(self) -> tuple[str, ...]:
        """The column heads, which are the axis names."""
        return tuple(name.upper() for name in self.columns)

    def in_force(self, snapshot: Snapshot) -> int:
        """Return the G code of the active zero offset."""
        return snapshot.modal.settable

    @property
    def code(self) -> int:
        """The G code of the selected row."""
        return self.number

    @property
    def question(self) -> str:
        """The prompt for the selected cell, with its unit."""
        words = {"x": tr("X RADIUS, MM?"), "z": tr("Z, MM?"), "c": tr("C, DEGREES?")}
        return f"G{self.code}  {words[self.name]}"

    @property
    def foot(self) -> str:
        """The hint for the keys F2, C and Esc."""
        return tr(
            "F2: set the current position to the typed value        C: clear G54 to G59        Esc: exit"
        )

    def barred(self, snapshot: Snapshot, *, correction: bool = False) -> str:
        """Return why the zero offsets cannot be changed now. They can be changed only between cycles."""
        if snapshot.state in UNDER_WAY - {State.JOG, State.HOME} and not self.book.locked:
            return tr("PROGRAM RUNNING. CHANGE G54 TO G59 ONLY BETWEEN CYCLES")
        return super().barred(snapshot, correction=correction)

    def here_barred(self) -> str:
        """Return why the machine position cannot be used now. Empty if it can."""
        snapshot, axis = self.desk.snapshot(), self.name.upper()
        if axis not in snapshot.axes:
            return tr(Message("THIS MACHINE HAS NO {axis} AXIS", axis=axis))
        if not snapshot.homed[snapshot.axes.index(axis)]:
            return tr(Message("{axis} IS NOT HOMED. HOME IT FIRST", axis=axis))
        return self.barred(snapshot)

    def here(self) -> None:
        """Handle F2: set the offset so that the present position reads the entered value, or 0."""
        if why := self.here_barred():
            self.desk.say(why)
            return
        snapshot = self.desk.snapshot()
        place = snapshot.axes.index(self.name.upper())
        reads = self.text.strip() or "0"
        words = tr(Message("position set to {value}", value=reads))
        self.save(lambda: self._touched(snapshot.actual[place], value_of(reads)), words)

    def _touched(self, at: float, reads: float) -> float:
        """Return the offset with which machine position ``at`` reads ``reads``.

        Full revolutions of C are ignored.
        """
        return self.checked(remainder(at - reads, 360.0) if self.name == "c" else at - reads)

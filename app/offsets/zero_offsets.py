"""Zero offsets G54 to G59 of a lathe, and the presets of a mill: where the workpiece is."""

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
_APART = 1.0  # mm: points of an edge that are nearer tell no direction


class Presets(CellTable):
    """The cell that is chosen, and what is typed over it. ``edge`` is the first point of a basic rotation."""

    kind = Kind.PRESET
    numbers = PRESETS

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.edge: Vector | None = None

    @property
    def columns(self) -> tuple[str, ...]:
        """The fields, and of the rotary axes those that this machine has."""
        absent = {name for name, axis in _ROTARY.items() if axis not in MillTouch.of(self.desk).rotary_axes}
        return tuple(name for name in super().columns if name not in absent)

    @property
    def title(self) -> str:
        """What the table is, and its units."""
        return tr("PRESETS  ·  WORKPIECE ZERO IN MACHINE COORDINATES, MM AND DEGREES")

    def in_force(self, _snapshot: Snapshot) -> int:
        """The preset that was chosen."""
        return self.book.preset

    @property
    def foot(self) -> str:
        """What F2, F3 and Esc do here, and which preset is in force."""
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
        """The chosen row; one that was never set is empty."""
        return self.book.presets.get(self.number, PresetRow())

    def choose(self, row: int, column: int) -> None:
        """Another cell: an edge that was begun is forgotten."""
        self.edge = None
        super().choose(row, column)

    def take_back(self) -> bool:
        """Forget what is typed, and an edge that was begun."""
        begun, self.edge = self.edge is not None, None
        return super().take_back() or begun

    def here(self) -> None:
        """F2: what stands here shall read what was typed, or 0; of a basic rotation an edge is two points."""
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
        """The tip stands where the workpiece shall read what was typed."""
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
        """The axis reads what was typed where it stands; the workpiece's zero keeps its place on the part."""
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
        """X Y Z of the same point of the part with another zero of the chosen rotary axis."""
        row = self.row_now
        if self.stored is None:
            return {}
        after = {**zeros_of(row), _ROTARY[self.name]: float(zero)}
        spot = MillTouch.of(self.desk).moved((row.x, row.y, row.z), zeros_of(row), after)
        return dict(zip("xyz", (round(at, 10) for at in spot), strict=True))

    def _touch_edge(self) -> None:
        """First one point of an edge, then another: what the edge is off by is the basic rotation."""
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
        """Of an edge that shall read so many degrees from X; it has no beginning, so a half turn is none."""
        dx, dy = last[0] - first[0], last[1] - first[1]
        if hypot(dx, dy) < _APART:
            raise EntryError(tr("POINTS LESS THAN 1 MM APART. TOUCH FARTHER ALONG THE EDGE"))
        return self.checked(remainder(degrees(atan2(dy, dx)) - reads, 180.0))

    def activate_barred(self) -> str:
        """Return why the chosen preset does not come into force now; empty when it does."""
        if why := self.barred(self.desk.snapshot()):
            return why
        if self.stored is None:
            return tr(
                Message("PRESET {number} IS NOT SET. TOUCH IT OFF OR TYPE ITS VALUES", number=self.number)
            )
        return ""

    def here_barred(self) -> str:
        """Return why the workpiece is not touched off now; empty when it is."""
        if self.name in _ROTARY:
            place: object = MillTouch.of(self.desk).angle(_ROTARY[self.name])
        elif self.name in {"x", "y", "z", "rotation"}:
            place = MillTouch.of(self.desk).tip(zeros_of(self.row_now))
        else:
            place = tr("SELECT X, Y, Z, A ROTARY AXIS OR ROT. F2: TOUCH OFF")
        return place if isinstance(place, str) else self.barred(self.desk.snapshot())

    def activate(self) -> None:
        """F3: the chosen preset is in force; that of the machine file where it is already."""
        if why := self.activate_barred():
            self.desk.say(why)
            return
        number = 0 if self.book.preset == self.number else self.number
        if why := self.book.choose_preset(number):
            self.desk.say(why)


class ZeroOffsets(CellTable):
    """The cell that is chosen, and what is typed over it."""

    kind = Kind.ZERO
    own_key = "C"
    numbers = ZERO_CODES
    clears = "PRESS Y TO CLEAR G54 TO G59, N TO KEEP THEM"
    why_cleared = "all zero offsets cleared with the C key"

    @property
    def title(self) -> str:
        """What the table is, and its units."""
        return tr("SETTABLE OFFSETS  ·  X IS A RADIUS  ·  MM AND DEGREES")

    @property
    def words(self) -> tuple[str, ...]:
        """What stands over the columns: the axes."""
        return tuple(name.upper() for name in self.columns)

    def in_force(self, snapshot: Snapshot) -> int:
        """The settable offset of the program."""
        return snapshot.modal.settable

    @property
    def code(self) -> int:
        """The G code of the chosen row."""
        return self.number

    @property
    def question(self) -> str:
        """What is asked for the chosen cell."""
        words = {"x": tr("X RADIUS, MM?"), "z": tr("Z, MM?"), "c": tr("C, DEGREES?")}
        return f"G{self.code}  {words[self.name]}"

    @property
    def foot(self) -> str:
        """What F2, C and Esc do here."""
        return tr(
            "F2: set the current position to the typed value        C: clear G54 to G59        Esc: exit"
        )

    def barred(self, snapshot: Snapshot, *, correction: bool = False) -> str:
        """Nothing here is a correction: part zero changes between cycles only."""
        if snapshot.state in UNDER_WAY - {State.JOG, State.HOME} and not self.book.locked:
            return tr("PROGRAM RUNNING. CHANGE G54 TO G59 ONLY BETWEEN CYCLES")
        return super().barred(snapshot, correction=correction)

    def here_barred(self) -> str:
        """Return why the position of the machine is not taken now; empty when it is."""
        snapshot, axis = self.desk.snapshot(), self.name.upper()
        if axis not in snapshot.axes:
            return tr(Message("THIS MACHINE HAS NO {axis} AXIS", axis=axis))
        if not snapshot.homed[snapshot.axes.index(axis)]:
            return tr(Message("{axis} IS NOT HOMED. HOME IT FIRST", axis=axis))
        return self.barred(snapshot)

    def here(self) -> None:
        """F2: the machine stands where the program shall read what was typed, or 0: the offset follows."""
        if why := self.here_barred():
            self.desk.say(why)
            return
        snapshot = self.desk.snapshot()
        place = snapshot.axes.index(self.name.upper())
        reads = self.text.strip() or "0"
        words = tr(Message("position set to {value}", value=reads))
        self.save(lambda: self._touched(snapshot.actual[place], value_of(reads)), words)

    def _touched(self, at: float, reads: float) -> float:
        """The offset with which the machine position ``at`` reads so; whole turns of C are left out."""
        return self.checked(remainder(at - reads, 360.0) if self.name == "c" else at - reads)

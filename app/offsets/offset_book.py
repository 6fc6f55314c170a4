"""The present offsets of TurnDesk, and changes that are saved without waiting."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from app.desk.access import Access
from app.offsets.change_rules import act_of
from app.offsets.offsets_in_force import PRESET, preset_of
from core.access.access_table import Act
from core.message import Message
from core.store.offsets.touch_off import Touch
from core.store.store_errors import StoreError
from core.store.store_rows import (
    Change,
    Kind,
    MillRow,
    PresetRow,
    Row,
    SecondaryRow,
    ShapeRow,
    ToolRow,
    Value,
    ZeroRow,
)

if TYPE_CHECKING:
    from core.store.store import Store

NONE_KEPT = "OFFSETS CANNOT BE SAVED: NO DATA STORE"
SAVING = "STILL SAVING THE PREVIOUS CHANGE. PRESS ENTER AGAIN"


class OffsetRows(NamedTuple):
    """All offsets of a store at one moment."""

    tools: dict[int, ToolRow]
    secondary: dict[int, SecondaryRow]
    zero: dict[int, ZeroRow]
    shapes: dict[int, ShapeRow]
    mill_tools: dict[int, MillRow]
    presets: dict[int, PresetRow]
    preset: int


def rows_of_store(store: Store) -> OffsetRows:
    """Read all offsets. Raises StoreError."""
    tables = store.offsets
    presets = tables.presets.read_rows()
    return OffsetRows(
        tables.tools.read_rows(),
        tables.secondary.read_rows(),
        tables.zero.read_rows(),
        tables.shapes.read_rows(),
        tables.mill_tools.read_rows(),
        presets,
        preset_of(store.settings.read_setting(PRESET), presets),
    )


@dataclass(slots=True)
class OffsetBook:
    """Offsets and tool shapes by number, in mm and degrees, with X as a radius.

    A change that the access level permits is posted to the store's writer. It is shown when it is on the
    disk. ``poll`` is called once a frame. Without ``store``, nothing can be changed, and ``locked`` gives the
    reason.
    """

    store: Store | None = None
    locked: str = ""
    tools: dict[int, ToolRow] = field(default_factory=dict)
    secondary: dict[int, SecondaryRow] = field(default_factory=dict)
    zero: dict[int, ZeroRow] = field(default_factory=dict)  # By the number of the G code.
    shapes: dict[int, ShapeRow] = field(default_factory=dict)
    mill_tools: dict[int, MillRow] = field(default_factory=dict)
    presets: dict[int, PresetRow] = field(default_factory=dict)
    preset: int = 0  # The preset in force on a mill; 0: the preset of the machine file.
    access: Access = field(default_factory=Access)  # The signed-in user and the permitted changes.
    unread: bool = False  # True if offsets cannot be read.
    at: int = 1  # The tool that the tool pages have selected.
    changes: int = 0  # Number of saved changes.
    _saving: Future[Any] | None = None
    # Set by another thread and read by ``poll``.
    _reopened: tuple[Store | None, str, OffsetRows | None] | None = None

    def __post_init__(self) -> None:
        self.read()

    # --- present values ------------------------------------------------------------------------------

    def of(self, kind: Kind) -> Mapping[int, Row]:
        """Return the offsets of one kind, by number."""
        tables: dict[Kind, Mapping[int, Row]] = {
            Kind.TOOL: self.tools,
            Kind.SECONDARY: self.secondary,
            Kind.ZERO: self.zero,
            Kind.SHAPE: self.shapes,
            Kind.MILL_TOOL: self.mill_tools,
            Kind.PRESET: self.presets,
        }
        return tables[kind]

    @property
    def master(self) -> int:
        """The number of the master tool, or 0 without a master."""
        return next((number for number, row in self.tools.items() if row.master), 0)

    def history(self, kind: Kind, limit: int = 200) -> tuple[Change, ...]:
        """Return the last changes, newest first. Empty without a store."""
        return () if self.store is None else self.store.offsets.table(kind).read_history(limit)

    def read(self) -> None:
        """Read the values of the store. This returns at once, even while the store is being written."""
        if self.store is not None:
            self.show(rows_of_store(self.store))

    def show(self, rows: OffsetRows) -> None:
        """Use these values. Without a store, they can be shown but not changed."""
        self.tools, self.secondary, self.zero = dict(rows.tools), dict(rows.secondary), dict(rows.zero)
        self.shapes, self.mill_tools, self.presets = (
            dict(rows.shapes),
            dict(rows.mill_tools),
            dict(rows.presets),
        )
        self.preset = rows.preset

    def _shown(self) -> OffsetRows:
        return OffsetRows(
            self.tools, self.secondary, self.zero, self.shapes, self.mill_tools, self.presets, self.preset
        )

    # --- changes: each returns why it was rejected, or an empty text ----------------------------------

    def change(self, kind: Kind, number: int, values: Mapping[str, Value], why: str) -> str:
        """Save some fields of an offset, and leave the other fields unchanged."""
        return self._post(
            act_of(kind, values),
            lambda store, who: store.offsets.table(kind).change_row(number, why, values, who=who),
        )

    def touch_off(self, number: int, touch: Touch, why: str) -> str:
        """Set a tool by a touch-off. If the tool is the master, all other tools follow."""
        return self._post(
            Act.TOOLS, lambda store, who: store.offsets.tools.touch_off(number, touch, why, who=who)
        )

    def choose_master(self, number: int, why: str) -> str:
        """Make this tool the master. 0 means that no tool is the master."""
        return self._post(
            Act.TOOLS, lambda store, who: store.offsets.tools.choose_master(number, why, who=who)
        )

    def choose_preset(self, number: int) -> str:
        """Activate another preset. 0 is the preset of the machine file."""
        before = self.preset

        def choose(store: Store, _who: str) -> Future[None]:
            self.access.persistence.note_change(
                Message("active preset: {before} → {number}", before=before, number=number)
            )
            return store.settings.save_setting(PRESET, number)

        return self._post(Act.PRESETS, choose)

    def remove_shape(self, number: int, why: str) -> str:
        """Delete the shape of a tool."""
        return self._post(
            Act.SHAPES, lambda store, who: store.offsets.shapes.remove_row(number, why, who=who)
        )

    def clear(self, kind: Kind, why: str) -> str:
        """Delete all offsets of this kind."""
        return self._post(
            act_of(kind), lambda store, who: store.offsets.table(kind).remove_all_rows(why, who=who)
        )

    def undoable(self, kind: Kind, number: int | None) -> tuple[Change, ...]:
        """Return the changes of the last step that undo would reverse. Raises StoreError.

        ``number`` is a row, or None for the last step of the whole table.
        """
        return () if self.store is None else self.store.offsets.table(kind).find_undoable(number)

    def undo(self, kind: Kind, number: int | None, step: int) -> str:
        """Undo exactly this step."""
        return self._post(
            act_of(kind), lambda store, who: store.offsets.table(kind).undo_step(number, step, who=who)
        )

    def barred(self, act: Act) -> str:
        """Return why this change cannot be posted now. Empty if it can."""
        if self.store is None or self.busy:
            return self.locked or SAVING
        return self.access.refusal(act)

    def _post(self, act: Act, write: Callable[[Store, str], Future[Any]]) -> str:
        if (why := self.barred(act)) or self.store is None:
            return why
        try:
            self._saving = write(self.store, self.access.who)
        except StoreError as error:
            return str(error)
        return ""

    # --- once a frame --------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a change is being saved."""
        return self._saving is not None

    def poll(self) -> str:
        """Check whether the change has been saved. Return the error, or an empty text."""
        if self._reopened is not None:
            return self._turn_to(*self._reopened)
        saving = self._saving
        if saving is None or not saving.done():
            return ""
        self._saving = None
        error = saving.exception()
        if error is None:
            self.changes += 1
        return self._read_or_why() or (str(error) if error is not None else "")

    def reopen(self, store: Store | None, trouble: str, rows: OffsetRows | None = None) -> None:
        """Use another store from the next poll on. Any thread may call this.

        If ``store`` is None, ``trouble`` gives the reason. ``rows`` are the offsets that another TurnDesk,
        which owns the store, has set.
        """
        self._reopened = store, trouble, rows

    def _turn_to(self, store: Store | None, trouble: str, rows: OffsetRows | None) -> str:
        self._reopened, self._saving = None, None
        if store is not self.store or (rows is not None and rows != self._shown()):
            self.changes += 1
        if rows is not None:
            self.show(rows)
        self.store, self.unread = store, self.unread and store is None and rows is None
        self.locked = (
            "" if store is not None else Message("OFFSETS CANNOT BE SAVED: {problem}", problem=trouble)
        )
        return self._read_or_why()

    def _read_or_why(self) -> str:
        try:
            self.read()
        except StoreError as error:
            return str(error)
        return ""

"""Current offsets of TurnDesk, whose changes are saved in the background."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from app.desk.access import UserAccess
from app.offsets.active_offsets import PRESET_SETTING, find_active_preset
from app.offsets.change_rules import find_required_access_right
from core.access.access_table import ProtectedChange
from core.message import Message
from core.store.offsets.touch_off import TouchPosition
from core.store.store_errors import StoreError
from core.store.store_rows import (
    FieldValue,
    MillToolRow,
    OffsetChange,
    OffsetKind,
    OffsetRow,
    PresetRow,
    SecondaryOffsetRow,
    ToolOffsetRow,
    ToolShapeRow,
    ZeroOffsetRow,
)

if TYPE_CHECKING:
    from core.store.store import Store

OFFSETS_NOT_STORED = "OFFSETS CANNOT BE SAVED: NO DATA STORE"
SAVE_IN_PROGRESS = "STILL SAVING THE PREVIOUS CHANGE. PRESS ENTER AGAIN"


class OffsetRows(NamedTuple):
    """Rows of all offset tables in a store, read at one time."""

    tool_offsets: dict[int, ToolOffsetRow]
    secondary_offsets: dict[int, SecondaryOffsetRow]
    zero_offsets: dict[int, ZeroOffsetRow]
    tool_shapes: dict[int, ToolShapeRow]
    mill_tools: dict[int, MillToolRow]
    presets: dict[int, PresetRow]
    active_preset: int


def read_store_rows(store: Store) -> OffsetRows:
    """Read the rows of all offset tables from a store.

    Raises StoreError if they cannot be read.
    """
    tables = store.offsets
    presets = tables.presets.read_rows()
    return OffsetRows(
        tables.tool_offsets.read_rows(),
        tables.secondary_offsets.read_rows(),
        tables.zero_offsets.read_rows(),
        tables.tool_shapes.read_rows(),
        tables.mill_tools.read_rows(),
        presets,
        find_active_preset(store.settings.read_setting(PRESET_SETTING), presets),
    )


@dataclass(slots=True)
class OffsetBook:
    """Offsets and tool shapes by number, in mm and degrees, with X as a radius.

    A change that the access level permits is queued for writing to the store. The new value is shown after
    it is on the disk. ``poll_saving`` must be called once per frame. Without a ``store``, the offsets
    cannot be changed, and ``lock_reason`` contains the reason.
    """

    store: Store | None = None
    lock_reason: str = ""
    tool_offsets: dict[int, ToolOffsetRow] = field(default_factory=dict)
    secondary_offsets: dict[int, SecondaryOffsetRow] = field(default_factory=dict)
    zero_offsets: dict[int, ZeroOffsetRow] = field(default_factory=dict)  # By the number of the G code.
    tool_shapes: dict[int, ToolShapeRow] = field(default_factory=dict)
    mill_tools: dict[int, MillToolRow] = field(default_factory=dict)
    presets: dict[int, PresetRow] = field(default_factory=dict)
    active_preset: int = 0  # The preset in force on a mill; 0: the preset of the machine file.
    user_access: UserAccess = field(
        default_factory=UserAccess
    )  # The signed-in user and the permitted changes.
    has_read_failed: bool = False  # True if offsets cannot be read.
    at: int = 1  # The tool that the tool pages have selected.
    changes: int = 0  # Number of saved changes.
    _saving: Future[Any] | None = None
    # Set by another thread and read by ``poll_saving``.
    _reopened: tuple[Store | None, str, OffsetRows | None] | None = None

    def __post_init__(self) -> None:
        self.read_store()

    # --- present values ------------------------------------------------------------------------------

    def get_rows(self, kind: OffsetKind) -> Mapping[int, OffsetRow]:
        """Return the rows of one offset table, by number."""
        tables: dict[OffsetKind, Mapping[int, OffsetRow]] = {
            OffsetKind.TOOL: self.tool_offsets,
            OffsetKind.SECONDARY: self.secondary_offsets,
            OffsetKind.ZERO: self.zero_offsets,
            OffsetKind.SHAPE: self.tool_shapes,
            OffsetKind.MILL_TOOL: self.mill_tools,
            OffsetKind.PRESET: self.presets,
        }
        return tables[kind]

    @property
    def master_tool_number(self) -> int:
        """Return the number of the master tool, or 0 if there is no master tool."""
        return next((number for number, row in self.tool_offsets.items() if row.master), 0)

    def read_history(self, kind: OffsetKind, limit: int = 200) -> tuple[OffsetChange, ...]:
        """Return the last changes of an offset table, newest first, or an empty tuple without a store."""
        return () if self.store is None else self.store.offsets.get_table(kind).read_history(limit)

    def read_store(self) -> None:
        """Read the offset tables from the store.

        Reading does not block, even while the store is being written.
        """
        if self.store is not None:
            self.replace_rows(read_store_rows(self.store))

    def replace_rows(self, rows: OffsetRows) -> None:
        """Replace the displayed offsets with these rows.

        Without a store, the offsets can be displayed but not changed.
        """
        self.tool_offsets, self.secondary_offsets, self.zero_offsets = (
            dict(rows.tool_offsets),
            dict(rows.secondary_offsets),
            dict(rows.zero_offsets),
        )
        self.tool_shapes, self.mill_tools, self.presets = (
            dict(rows.tool_shapes),
            dict(rows.mill_tools),
            dict(rows.presets),
        )
        self.active_preset = rows.active_preset

    def _shown(self) -> OffsetRows:
        return OffsetRows(
            self.tool_offsets,
            self.secondary_offsets,
            self.zero_offsets,
            self.tool_shapes,
            self.mill_tools,
            self.presets,
            self.active_preset,
        )

    # --- changes: each returns why it was rejected, or an empty text ----------------------------------

    def change_fields(
        self, kind: OffsetKind, number: int, values: Mapping[str, FieldValue], reason: str
    ) -> str:
        """Save some fields of an offset row, and leave its other fields unchanged."""
        return self._post(
            find_required_access_right(kind, values),
            lambda store, who: store.offsets.get_table(kind).change_row(number, reason, values, who=who),
        )

    def touch_off(self, tool_number: int, touch: TouchPosition, reason: str) -> str:
        """Set the offset of a tool by a touch-off.

        If the tool is the master tool, the offsets of all other tools follow.
        """
        return self._post(
            ProtectedChange.TOOLS,
            lambda store, who: store.offsets.tool_offsets.set_touched_offset(
                tool_number, touch, reason, author=who
            ),
        )

    def set_master_tool(self, tool_number: int, reason: str) -> str:
        """Make a tool the master tool.

        The tool number 0 means that no tool is the master tool.
        """
        return self._post(
            ProtectedChange.TOOLS,
            lambda store, who: store.offsets.tool_offsets.set_master_tool(tool_number, reason, author=who),
        )

    def activate_preset(self, preset_number: int) -> str:
        """Activate another preset.

        Preset 0 is the preset of the machine file.
        """
        before = self.active_preset

        def save_active_preset(store: Store, _who: str) -> Future[None]:
            self.user_access.persistence.log_change(
                Message("active preset: {before} → {number}", before=before, number=preset_number)
            )
            return store.settings.save_setting(PRESET_SETTING, preset_number)

        return self._post(ProtectedChange.PRESETS, save_active_preset)

    def remove_shape(self, tool_number: int, reason: str) -> str:
        """Delete the shape of a tool."""
        return self._post(
            ProtectedChange.SHAPES,
            lambda store, who: store.offsets.tool_shapes.remove_row(tool_number, reason, author=who),
        )

    def clear_table(self, kind: OffsetKind, reason: str) -> str:
        """Delete all rows of an offset table."""
        return self._post(
            find_required_access_right(kind),
            lambda store, who: store.offsets.get_table(kind).remove_all_rows(reason, author=who),
        )

    def find_undoable_changes(self, kind: OffsetKind, number: int | None) -> tuple[OffsetChange, ...]:
        """Return the changes of the last step that undo would reverse.

        ``number`` is a row, or None for the last step of the whole table. Raises StoreError if the history
        cannot be read.
        """
        return () if self.store is None else self.store.offsets.get_table(kind).find_undoable_changes(number)

    def undo_step(self, kind: OffsetKind, number: int | None, step_number: int) -> str:
        """Undo one step of the offset history. Other steps remain unchanged."""
        return self._post(
            find_required_access_right(kind),
            lambda store, who: store.offsets.get_table(kind).undo_step(number, step_number, author=who),
        )

    def barred(self, change: ProtectedChange) -> str:
        """Return the reason why a change of this type cannot be saved now, or an empty string if it can."""
        if self.store is None or self.is_saving:
            return self.lock_reason or SAVE_IN_PROGRESS
        return self.user_access.find_refusal_reason(change)

    def _post(self, act: ProtectedChange, write: Callable[[Store, str], Future[Any]]) -> str:
        if (why := self.barred(act)) or self.store is None:
            return why
        try:
            self._saving = write(self.store, self.user_access.history_user_name)
        except StoreError as error:
            return str(error)
        return ""

    # --- once a frame --------------------------------------------------------------------------------

    @property
    def is_saving(self) -> bool:
        """Return whether a change is being saved."""
        return self._saving is not None

    def poll_saving(self) -> str:
        """Check whether the pending change has been saved. Return an error message if saving failed.

        Otherwise, the result is an empty string.
        """
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

    def switch_store(self, store: Store | None, error_text: str, rows: OffsetRows | None = None) -> None:
        """Use another store from the next call of ``poll_saving`` on.

        This method can be called from any thread. If ``store`` is None, ``error_text`` is the reason.
        ``rows`` are the offsets of a store that belongs to another TurnDesk process.
        """
        self._reopened = store, error_text, rows

    def _turn_to(self, store: Store | None, error_text: str, rows: OffsetRows | None) -> str:
        self._reopened, self._saving = None, None
        if store is not self.store or (rows is not None and rows != self._shown()):
            self.changes += 1
        if rows is not None:
            self.replace_rows(rows)
        self.store, self.has_read_failed = store, self.has_read_failed and store is None and rows is None
        self.lock_reason = (
            "" if store is not None else Message("OFFSETS CANNOT BE SAVED: {problem}", problem=error_text)
        )
        return self._read_or_why()

    def _read_or_why(self) -> str:
        try:
            self.read_store()
        except StoreError as error:
            return str(error)
        return ""

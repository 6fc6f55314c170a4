"""Search for a text in the rows of one list at a time."""

from __future__ import annotations

from collections.abc import Callable

from app.desk.pages.page_entry import MANUAL_STATES
from app.desk.pages.table_content import ROW_STEPS, InputField
from app.desk.status.prompt_line import ACTIVE_STATES, MOVING_STATES
from app.desk.translation import tr
from app.screen.lists.searchable_list import SearchableList
from core.accents import remove_accents
from core.executor.snapshot import MachineState, Snapshot

# The search closes when the machine enters one of these groups of states: stopped, running, moving.
_CLOSING_STATES = (frozenset({MachineState.ESTOP, MachineState.FAULT}), ACTIVE_STATES, MOVING_STATES)


def _fold(text: str) -> str:
    """Return a text in lower case and without accents, which the touch keyboard does not have."""
    return remove_accents(text.casefold())


class ListSearch:
    """Search that shows only the rows of a list that contain the typed text.

    While the search is open, all characters are text. The first found row is selected, unless the selected
    row is also found.
    """

    def __init__(self) -> None:
        self.searched_list: SearchableList | None = None
        self.input_field = InputField(words=True)
        self.is_row_missing = False  # No row contains the text.
        self._former_row, self._row_count = -1, 0  # When the search was opened.
        self._texts: tuple[str, ...] = ()
        self._snapshot = Snapshot()  # The state of the machine when it was last checked.
        self.on_close: Callable[[], None] = lambda: None
        self.on_forced_close: Callable[[], None] = lambda: None

    @property
    def is_open(self) -> bool:
        """Return whether a search is open."""
        return self.searched_list is not None

    @property
    def is_selection_hidden(self) -> bool:
        """Return whether the selected row is not one of the found rows."""
        rows = self.searched_list
        if rows is None or rows.found_rows is None or rows.on_select is None:
            return False
        return rows.selected_row not in rows.found_rows

    def find_refusal(self, searched_list: SearchableList | None, snapshot: Snapshot) -> str:
        """Return the reason why a search cannot be opened now, or an empty string if it can."""
        if snapshot.state in MANUAL_STATES:
            return tr("AXES ARE MOVING. WAIT UNTIL THEY STOP BEFORE SEARCHING")
        if snapshot.wheel:
            return tr("HANDWHEEL IS ON. TURN IT OFF BEFORE SEARCHING")
        if searched_list and searched_list.search_hint:
            return tr(searched_list.search_hint)
        if not (searched_list and searched_list.can_be_searched and searched_list.list_row_texts()):
            return tr("NO LIST TO SEARCH HERE")
        return ""

    def open(self, searched_list: SearchableList, snapshot: Snapshot) -> None:
        """Open the search in a list."""
        self.searched_list, self.input_field.text = searched_list, ""
        self.is_row_missing, self._texts = False, ()
        if searched_list.on_search is not None:
            searched_list.on_search("")
        self._former_row, self._snapshot = searched_list.selected_row, snapshot
        self._row_count = len(searched_list.list_row_texts())

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if it is Enter but the selected row does not contain the text."""
        rows = self.searched_list
        if rows is None:
            return False
        if key == "Enter":
            if self.is_row_missing or self.is_selection_hidden:
                return False
            self.close()
        elif key in ROW_STEPS:
            rows.move_selection(key)
        elif self.input_field.handle_key(key):
            if rows.on_search is not None:
                rows.on_search(self.input_field.text.strip())
            self._show_found_rows(rows, self._match_rows(rows))
            if rows.found_rows and rows.on_select is not None and self.is_selection_hidden:
                rows.on_select(rows.found_rows[0])
        return True

    def update(self, snapshot: Snapshot) -> None:
        """Search again if the rows have changed, without a change of the selection.

        Manual motion, the handwheel, a cycle start, a new alarm, an E-stop and a hidden list close it.
        This is called once a frame.
        """
        rows = self.searched_list
        if rows is None:
            return
        if not rows.isVisible() or self._has_machine_changed(snapshot):
            self.force_close()
        else:
            self._find_changed_rows(rows)

    def _has_machine_changed(self, snapshot: Snapshot) -> bool:
        """Return whether the machine has changed so that letters must be commands again."""
        former, self._snapshot = self._snapshot, snapshot
        return (
            snapshot.state in MANUAL_STATES
            or bool(snapshot.wheel)
            or len(snapshot.alarms) > len(former.alarms)
            or any(snapshot.state in each and former.state not in each for each in _CLOSING_STATES)
        )

    def _match_rows(self, rows: SearchableList) -> tuple[int, ...]:
        """Return the indices of the rows that contain the text."""
        self._texts = tuple(rows.list_row_texts())
        text = "" if rows.on_search is not None else _fold(self.input_field.text.strip())
        return tuple(number for number, each in enumerate(self._texts) if text in _fold(each))

    def _find_changed_rows(self, rows: SearchableList) -> None:
        """Search again if the texts have changed. A selected row that is shown remains shown."""
        if tuple(rows.list_row_texts()) == self._texts:
            return
        selected = rows.selected_row
        is_shown = rows.found_rows is None or selected in rows.found_rows
        found = self._match_rows(rows)
        if is_shown and 0 <= selected < len(self._texts) and selected not in found:
            found = tuple(sorted((*found, selected)))
        self._show_found_rows(rows, found)

    def _show_found_rows(self, rows: SearchableList, found: tuple[int, ...]) -> None:
        rows.found_rows, self.is_row_missing = found, not found

    def close(self) -> None:
        """Close the search, show all rows, and keep the selected row."""
        if self.searched_list is not None:
            self.searched_list.found_rows = None
            self.searched_list = None
            self.on_close()

    def cancel(self) -> None:
        """Close the search, show all rows, and select the former row unless rows were added or removed."""
        rows = self.searched_list
        self.close()
        if rows is None:
            return
        if rows.on_search is not None:
            rows.on_search("")
        if rows.on_select is not None and 0 <= self._former_row < self._row_count == len(
            rows.list_row_texts()
        ):
            rows.on_select(self._former_row)

    def force_close(self) -> None:
        """Close the search although the operator may still be typing, and select the former row."""
        if self.is_open:
            self.cancel()
            self.on_forced_close()

    def prompt_text(self, snapshot: Snapshot) -> str:
        """Return the prompt while the search is open."""
        if self.is_row_missing:
            return tr("NO ROW CONTAINS THIS TEXT   BACKSPACE: EDIT   ESC: CLOSE")
        if snapshot.state in ACTIVE_STATES:
            return tr("TYPE THE TEXT TO FIND   PAUSE: FEED HOLD   ENTER: KEEP ROW   ESC: CLOSE")
        return tr("TYPE THE TEXT TO FIND   ARROWS: ROW   ENTER: KEEP ROW   ESC: CLOSE")

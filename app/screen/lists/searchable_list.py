"""Base class of all lists: keys that move the selection, and the rows that a search has found."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.desk.pages.table_content import ROW_STEPS
from app.screen.panel import OnPress, Panel, RedrawingAttribute

LIST_KEYS = frozenset({"Page up", "Page down", "Home", "End"})
"""Keys that every list uses before its page."""


class SearchableList(Panel):
    """A list whose selection is moved by the arrow, page, Home and End keys, and whose rows can be searched.

    A subclass returns the texts of its rows from ``list_row_texts``. The owner of the list sets
    ``on_select``. A list without a selection scrolls instead.
    """

    found_rows: RedrawingAttribute[tuple[int, ...] | None] = RedrawingAttribute(None)  # None: all rows.
    # Opens the search. A list that does not show all its rows then draws a key for it.
    on_search_key: RedrawingAttribute[Callable[[], None] | None] = RedrawingAttribute(None)
    on_select: Callable[[int], None] | None = None  # Selects a row, without executing its action.
    on_search: Callable[[str], None] | None = None  # Searches instead of the list, such as in the store.
    rows = 1  # Number of rows that fit.
    search_hint = ""  # Tells why the search of the window is not used for this list.
    is_searchable = False  # ``list_row_texts`` returns the texts of all rows.

    def list_row_texts(self) -> Sequence[str]:
        """Return the text of each row. The base class returns none."""
        return ()

    @property
    def selected_row(self) -> int:
        """Return the index of the selected row, or -1 if no row is selected."""
        return -1

    @property
    def has_typed_text(self) -> bool:
        """Return whether the entry line of the list contains text. The base class has no entry line."""
        return False

    def scroll_by(self, rows: int) -> None:
        """Scroll down by a number of rows, or up if it is negative. The base class shows all its rows."""

    @property
    def shown_rows(self) -> Sequence[int]:
        """Return the indices of the found rows during a search, and of all rows at other times."""
        return range(len(self.list_row_texts())) if self.found_rows is None else self.found_rows

    @property
    def can_be_searched(self) -> bool:
        """Return whether the rows can be searched and the found row can be selected."""
        can_select = self.on_select is not None or self.selected_row < 0
        return self.is_searchable and can_select and not self.search_hint

    def press_row(self, row: int, press: OnPress) -> None:
        """Execute the action of a touched row, or only select the row while a search is open."""
        if self.found_rows is None:
            press()
        elif self.on_select is not None:
            self.on_select(row)

    def move_selection(self, key: str) -> bool:
        """Select the row to which an arrow, page, Home or End key leads.

        A page has as many rows as are visible. Return False if the list does not use the key.
        """
        steps = {**ROW_STEPS, "Page up": -self.rows, "Page down": self.rows}
        if key not in steps:
            return False
        if self.on_select is None:
            if self.selected_row < 0:
                self.scroll_by(steps[key])
            return self.selected_row < 0
        order = self.shown_rows
        if not order:
            return self.found_rows is not None
        at = order.index(self.selected_row) if self.selected_row in order else 0
        self.on_select(order[max(0, min(len(order) - 1, at + steps[key]))])
        return True

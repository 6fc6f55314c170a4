"""Special functions of page F10: their base classes and the list from which they are opened."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from app.desk.arithmetic import InvalidEntryError
from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, InputField, TableContent, TableRow, refused
from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.message import Message


class SpecialFunction(ABC):
    """Special function on page F10.

    No method blocks. If an action is rejected, the reason is shown with ``desk.say``.
    """

    name: ClassVar[str]
    use: ClassVar[str]
    page: ClassVar[str] = ""  # page that opens instead of this function

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.marked = 0

    @abstractmethod
    def make_table(self, snapshot: Snapshot) -> TableContent:
        """Return the table that this special function shows, filled with the values of a snapshot."""

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys of this special function, which can use F2 to F10 except F7."""
        return {}

    def handle_key(self, key: str) -> bool:
        """Handle a key.

        Return False to let the window handle the key.
        """
        return (key == "Enter" and self.activate_selected_row()) or self.move_selection(key)

    def activate_selected_row(self) -> bool:
        """Execute the action of the selected row. Return False if the row has no action."""
        return False

    def accepts_key(self, _key: str) -> bool:
        """Return whether a text field of this function currently accepts the character."""
        return False

    def prompt_text(self) -> str:
        """Return the text of the prompt line."""
        return "ESC: BACK TO THE LIST"

    def handle_escape(self) -> bool:
        """Close the innermost open entry or list. Return False if neither was open."""
        return False

    def on_open(self) -> None:
        """Prepare the function for display.

        The base class does nothing.
        """

    def on_close(self) -> None:
        """Cancel entries and questions when the function closes."""

    def process_device_input(self, *, is_displayed: bool) -> None:
        """Process data from a connected device, such as a gauge.

        This method is called once per frame. ``is_displayed`` is True while the function is displayed.
        """

    def close(self) -> None:
        """Finish pending work when TurnDesk closes."""

    def choose(self, row: int) -> None:
        """Select the touched row, or execute it if it is already selected."""
        if row != self.marked:
            self.desk.clear_prompt_line()
            self.marked = row
        else:
            self.activate_selected_row()

    def select_row(self, row: int) -> None:
        """Select a row without executing its action."""
        self.desk.clear_prompt_line()
        self.marked = row

    def find_row_search(self) -> Callable[[str], None] | None:
        """Return the function that searches for a text in more rows than the table has, or None."""
        return None

    @property
    def row_count(self) -> int:
        """Return the number of rows that can be selected."""
        return 0

    def move_selection(self, key: str) -> bool:
        """Move the selection if the key is a selection key. Return False for any other key."""
        if key not in ROW_STEPS or not self.row_count:
            return False
        self.desk.clear_prompt_line()
        self.marked = max(0, min(self.row_count - 1, self.marked + ROW_STEPS[key]))
        return True


class SeparatePageFunction(SpecialFunction):
    """Special function that has its own screen page.

    On page F10, it shows only a table with a short summary. Enter or a tap opens its own page.
    """

    key_hint: ClassVar[str]  # description of other keys that open the page

    @abstractmethod
    def make_information_rows(self) -> tuple[TableRow, ...]:
        """Return the rows of the summary table on page F10."""

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the summary table that page F10 shows for this function."""
        return TableContent(
            tr(self.name), ("", ""), (0.4, 0.6), self.make_information_rows(), notes=(self.key_hint,)
        )


class NumericEntryFunction(SpecialFunction):
    """Special function with a numeric entry that accepts arithmetic.

    Enter passes the text to ``accept_entry``.
    """

    def __init__(self, desk: Desk) -> None:
        super().__init__(desk)
        self.entry = InputField()

    @abstractmethod
    def accept_entry(self, text: str) -> bool:
        """Accept the typed text.

        Return False if it was rejected with a message. Raise InvalidEntryError for an invalid entry.
        """

    def submit_entry(self) -> None:
        """Accept the typed text, or show the reason why it was rejected."""
        try:
            if self.accept_entry(self.entry.text):
                self.entry.text = ""
        except InvalidEntryError as error:
            self.entry.text = refused(self.entry.text)
            self.desk.show_refusal(str(error))

    def accepts_key(self, key: str) -> bool:
        """Return whether the numeric entry accepts the character (a digit or an operator)."""
        return self.entry.accepts_key(key)

    def handle_key(self, key: str) -> bool:
        """Edit the numeric entry, or submit it when Enter is pressed."""
        if key == "Enter":
            self.submit_entry()
            return True
        if self.entry.handle_key(key):
            self.desk.clear_prompt_line()
            return True
        return False

    def handle_escape(self) -> bool:
        """Clear the numeric entry. Return False if it was empty."""
        begun, self.entry.text = bool(self.entry.text), ""
        return begun

    def on_close(self) -> None:
        """Clear the entry when the function closes."""
        self.entry.text = ""


@dataclass(slots=True)
class SpecialFunctionsModel:
    """List of special functions, and the function that is displayed.

    ``at`` is the index of the displayed function. While ``inside`` is True, this function is open and
    receives the keys.
    """

    functions: Sequence[SpecialFunction]
    worker: LatestRequestWorker
    at: int = 0
    inside: bool = False
    number: str = ""  # digits typed in the list so far

    @property
    def shown_function(self) -> SpecialFunction:
        """Return the displayed function."""
        return self.functions[self.at]

    def show_function(self, index: int) -> None:
        """Display the special function at an index of the list."""
        self.number = ""
        index = max(0, min(len(self.functions) - 1, index))
        if index != self.at or self.inside:
            self.shown_function.desk.clear_prompt_line()
            self.shown_function.on_close()
            self.at, self.inside = index, False
            self.shown_function.on_open()

    def open_function(self, index: int) -> None:
        """Open the special function at an index, so that it receives the keys."""
        self.show_function(index)
        self.inside = True

    def handle_key(self, key: str) -> bool:
        """Handle a key.

        Arrow and page keys or a number select a function, and Enter opens it. An open function receives all
        keys.
        """
        if self.inside:
            return self.shown_function.handle_key(key)
        if key in ROW_STEPS:
            self.show_function(self.at + ROW_STEPS[key])
        elif key in {"Enter", "Tab"}:
            self.open_function(self.at)
        elif self.accepts_key(key):
            self._add_digit(key)
        else:
            return False
        return True

    def _add_digit(self, digit: str) -> None:
        """Append a digit to the typed number, and select the function with this number.

        If no function has this number, the digit starts a new number.
        """
        numbers = range(1, len(self.functions) + 1)
        typed = next((each for each in (self.number + digit, digit) if int(each) in numbers), "")
        if not typed:
            words = tr("FUNCTION {number} DOES NOT EXIST: TYPE 1 TO {last}")
            self.shown_function.desk.say(
                tr(Message(words, number=self.number + digit, last=len(self.functions)))
            )
            return
        self.show_function(int(typed) - 1)
        self.number = typed

    def accepts_key(self, key: str) -> bool:
        """Return whether the open function or the number selection accepts the character."""
        return self.shown_function.accepts_key(key) if self.inside else key.isascii() and key.isdigit()

    def handle_escape(self) -> bool:
        """Close an entry or the open function. Return False if only the list is open."""
        shown = self.shown_function
        if not self.inside:
            return False
        if shown.desk.prompt_notice:
            shown.desk.clear_prompt_line()
        elif not shown.handle_escape():
            self.inside = False
        return True

    def prompt_text(self) -> str:
        """Return the prompt of the open function, or of the list if no function is open."""
        if self.inside:
            return self.shown_function.prompt_text()
        return "TAP A FUNCTION OR TYPE ITS NUMBER   ENTER: OPEN   ESC: BACK"

    def on_open(self) -> None:
        """Show the list when the page opens."""
        self.inside, self.number = False, ""
        self.shown_function.on_open()

    def on_close(self) -> None:
        """Close the displayed function when the page closes."""
        self.shown_function.on_close()
        self.inside = False

    def process_worker_results(self) -> None:
        """Process the results of the worker.

        This is called once a frame.
        """
        self.worker.deliver_results()

    def close(self) -> None:
        """Finish pending work of all functions, and stop the worker."""
        for function in self.functions:
            function.close()
        self.worker.close()

"""Model of the PART page without Qt: findings in the loaded program, and the stock that its proof uses.

Entries are stored with the program in the store, never in the program text. The program is then proved
again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from pathlib import Path

from app.desk.arithmetic import EXPRESSION_CHARACTERS, InvalidEntryError
from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, apply_edit_key, following, refused
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.stored_part import EMPTY_STORED_PART, StoredPart, load_stored_part, make_stock_path_absolute
from app.desk.translation import tr
from app.part.stock_entry import StockEntry, StockField, StockKind
from core.access.access_table import ProtectedChange
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.part.stock_spec import StockError
from core.store.store_errors import StoreError

_CHOICE_STEPS = {"Left": -1, "Right": 1}


class PartPageTable(StrEnum):
    """Tables of the PART page: findings and stock."""

    FINDINGS = "findings"
    STOCK = "stock"


@dataclass(slots=True)
class PartPageModel:
    """Model of the PART page.

    ``check_codes`` are the checks that the operator can turn off. ``machine_disabled_checks`` are the
    checks that the machine file turns off. ``show_location`` is called with a finding, and shows where it
    is in the program.
    """

    desk: Desk
    persistence: Persistence
    check_codes: frozenset[str] = frozenset()
    machine_disabled_checks: frozenset[str] = frozenset()
    assumed_stick_out_mm: float = 0.0  # mm, from the machine file; 0 if not specified
    has_workholding: bool = (
        False  # whether the machine file has a chuck or collet to which a stick-out applies
    )
    shown_table: PartPageTable = PartPageTable.FINDINGS
    selected_rows: dict[PartPageTable, int] = field(default_factory=dict)
    entry_text: str = ""  # typed text
    check_to_disable: str = ""  # check whose reason is being typed
    is_entering_file_name: bool = False  # a file name is being typed: every character is part of the name
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-part"))
    show_location: Callable[[Diagnostic], None] = field(default=lambda _found: None)
    stored_part: StoredPart = EMPTY_STORED_PART
    stock_entry: StockEntry = field(default_factory=StockEntry)
    _seen: tuple[str, int] = ("", -1)  # program name and load count of the stored data

    def close(self) -> None:
        """Finish pending writes, and stop the worker."""
        self.worker.close()

    # --- displayed values ----------------------------------------------------------------------------

    @property
    def loaded_program(self) -> LoadedProgram:
        """Return the loaded program."""
        return self.desk.program_loader.loaded_program

    @property
    def program_name(self) -> str:
        """Return the name under which the part data is stored."""
        return self.loaded_program.name

    @property
    def is_metric(self) -> bool:
        """Return whether the program uses millimeters."""
        picture = self.loaded_program.picture
        return picture is not None and picture.metric

    @property
    def findings(self) -> tuple[Diagnostic, ...]:
        """Return all findings, sorted by program line."""
        return self.loaded_program.diagnostics

    @property
    def selected_row_index(self) -> int:
        """Return the index of the selected row.

        If no row has been selected, return the index of the most important finding.
        """
        first = _find_most_important(self.findings) if self.shown_table is PartPageTable.FINDINGS else 0
        return max(0, min(self.selected_rows.get(self.shown_table, first), self._count - 1))

    @property
    def _count(self) -> int:
        return (
            len(self.findings) if self.shown_table is PartPageTable.FINDINGS else len(self.stock_entry.fields)
        )

    @property
    def selected_finding(self) -> Diagnostic | None:
        """Return the selected finding, or None if no finding is selected."""
        if self.shown_table is not PartPageTable.FINDINGS or not self.findings:
            return None
        return self.findings[self.selected_row_index]

    @property
    def selected_field(self) -> StockField:
        """Return the selected field of the stock."""
        return self.stock_entry.fields[
            min(self.selected_rows.get(PartPageTable.STOCK, 0), len(self.stock_entry.fields) - 1)
        ]

    def poll(self) -> None:
        """Process finished writes and a change of the loaded program.

        This is called once a frame.
        """
        self.worker.deliver_results()
        seen = self.program_name, self.desk.program_loader.load_count
        if seen != self._seen:
            if seen[0] != self._seen[0]:
                self.cancel_entry()
                self.selected_rows.clear()
            self._seen = seen
            self._read()

    def _read(self) -> None:
        try:
            self.stored_part = load_stored_part(self.persistence.read_setting, self.program_name)
        except StoreError as error:
            self.stored_part = EMPTY_STORED_PART
            self.desk.show_refusal(str(error))
        self.stock_entry = StockEntry.from_stored_part(self.stored_part)

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys that are available now."""
        if self.shown_table is PartPageTable.STOCK:
            return {
                "F2": FunctionKey("FINDINGS", self.toggle_table),
                "F4": FunctionKey("KIND", self.select_next_stock_kind),
                "F6": FunctionKey("DELETE", self.delete_stock),
            }
        found = self.selected_finding
        word = "UNDO" if found is not None and found.downgrade_reason else "CHECK OFF"
        silenced = FunctionKey(
            word, self.toggle_check, barred=bool(self._find_silence_refusal() or self._find_lock_reason())
        )
        return {"F2": FunctionKey("STOCK", self.toggle_table), "F4": silenced}

    def toggle_table(self) -> None:
        """Switch between the tables of findings and stock."""
        self.cancel_entry()
        self.desk.clear_prompt_line()
        self.shown_table = following(PartPageTable, self.shown_table)

    def show_stock_table(self) -> None:
        """Show the table of the stock."""
        self.shown_table = PartPageTable.STOCK

    @property
    def is_entering_text(self) -> bool:
        """Return whether a text is being entered, so that every typed character is added to it."""
        return bool(self.check_to_disable) or self.is_entering_file_name

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be typed into the current entry."""
        if self.is_entering_text:
            return len(key) == 1 and key.isprintable()
        return self.shown_table is PartPageTable.STOCK and self._figures and key in EXPRESSION_CHARACTERS

    @property
    def _figures(self) -> bool:
        return bool(self.program_name) and self.selected_field not in {StockField.KIND, StockField.FILE}

    def handle_key(self, key: str) -> bool:
        """Handle a key.

        Arrow keys select a row, Enter accepts, and other characters edit the entry.
        """
        if key == "Enter":
            self._enter()
        elif self.accepts_key(key) or (key in {"Back", "Delete"} and self.has_entry):
            self.entry_text = apply_edit_key(self.entry_text, key, 200)
        elif (
            key in _CHOICE_STEPS
            and self.shown_table is PartPageTable.STOCK
            and self.selected_field is StockField.KIND
        ):
            self.select_next_stock_kind(_CHOICE_STEPS[key])
        elif key in ROW_STEPS and not self.is_entering_text:
            self.select_row(self.selected_row_index + ROW_STEPS[key])
        else:
            return False
        return True

    @property
    def has_entry(self) -> bool:
        """Return whether a reason, a file name or a value of the stock can be entered now."""
        return self.is_entering_text or (self.shown_table is PartPageTable.STOCK and self._figures)

    def select_row(self, row: int) -> None:
        """Select a row, and show the location of its finding."""
        self.cancel_entry()
        self.desk.clear_prompt_line()
        self.selected_rows[self.shown_table] = max(0, min(row, self._count - 1))
        found = self.selected_finding
        if found is not None:
            self.show_location(found)

    def handle_row_touch(self, row: int) -> None:
        """Select the touched row.

        A second touch changes the kind of stock or opens the file name entry.
        """
        if row != self.selected_row_index or self.shown_table is PartPageTable.FINDINGS:
            self.select_row(row)
        elif self.selected_field in {StockField.KIND, StockField.FILE} and not self.is_entering_file_name:
            self._enter()

    def _enter(self) -> None:
        if self.check_to_disable:
            self._silence(self.check_to_disable, self.entry_text.strip())
        elif self.shown_table is PartPageTable.FINDINGS:
            if self.selected_finding is not None:
                self.show_location(self.selected_finding)
        elif self.selected_field is StockField.KIND:
            self.select_next_stock_kind()
        elif self.selected_field is StockField.FILE and not self.is_entering_file_name:
            self.is_entering_file_name = not self._is_refused()
        else:
            self._accept_entry()

    def handle_escape(self) -> bool:
        """Cancel the entry, the message or an incomplete stock, and return whether there was one."""
        if self.entry_text or self.is_entering_text:
            self.cancel_entry()
        elif self.desk.prompt_notice:
            self.desk.clear_prompt_line()
        elif self.stock_entry != StockEntry.from_stored_part(self.stored_part):
            self.stock_entry = StockEntry.from_stored_part(self.stored_part)
        else:
            return False
        return True

    def cancel_entry(self) -> None:
        """Cancel the entry of a reason, a file name or a value."""
        self.entry_text, self.check_to_disable, self.is_entering_file_name = "", "", False

    def on_open(self) -> None:
        """Reload the data when the page opens."""
        self._seen = ("", -1)
        self.poll()

    def on_close(self) -> None:
        """Cancel the entry and reset the selection when the page closes."""
        self.cancel_entry()
        self.shown_table = PartPageTable.FINDINGS
        self.selected_rows.clear()

    def prompt_text(self) -> str:
        """Return the prompt that names the keys that are available now."""
        if self.check_to_disable:
            return tr("TYPE THE REASON   ENTER: TURN CHECK OFF   ESC: LEAVE IT ON")
        if self.is_entering_file_name:
            return tr("TYPE THE FILE NAME   ENTER: ACCEPT   ESC: CANCEL")
        if self.shown_table is PartPageTable.FINDINGS:
            if self.make_function_keys()["F4"].barred:
                return tr("UP/DOWN: SHOW WHERE EACH FINDING IS   F2: STOCK")
            return tr("UP/DOWN: SHOW EACH FINDING   F2: STOCK   F4: TURN CHECK OFF")
        if self.selected_field is StockField.KIND:
            return tr("LEFT/RIGHT: CHANGE STOCK TYPE   F6: DELETE STOCK DATA")
        return tr("TYPE A LENGTH OR EXPRESSION   ENTER: SAVE   0: NOT SPECIFIED")

    # --- entries -------------------------------------------------------------------------------------

    def _is_refused(self) -> bool:
        """Return whether changes of the part data are refused now, and if so, show the reason."""
        if why := self._find_lock_reason():
            self.desk.say(why)
        return bool(why)

    def _find_lock_reason(self) -> str:
        """Return why the part data cannot be changed now, or an empty string if it can."""
        if not self.program_name:
            return tr("LOAD A PROGRAM FIRST. STOCK DATA IS SAVED WITH THE PROGRAM")
        if self.desk.machine.machine is not None and self.desk.machine.machine.kind != "lathe":
            return tr("ON A MILL, TURNDESK DOES NOT CHECK THE FINISHED PART")
        if self.desk.read_snapshot().state in ACTIVE_STATES:
            return tr("PROGRAM RUNNING. EDIT STOCK OR PART CHECKS ONLY BETWEEN CYCLES")
        if self.worker.is_busy or self.loaded_program.is_busy:
            return tr("THE PROGRAM IS BEING PROVED: WAIT A MOMENT")
        return ""

    def select_next_stock_kind(self, steps: int = 1) -> None:
        """Select the next kind of stock.

        An incomplete stock takes effect only when its missing value is entered.
        """
        self.cancel_entry()
        if self._is_refused():
            return
        self.desk.clear_prompt_line()
        kinds = list(StockKind)
        kind = kinds[(kinds.index(self.stock_entry.kind) + steps) % len(kinds)]
        self._store_entry(replace(self.stock_entry, kind=kind, file=""))
        self.selected_rows[PartPageTable.STOCK] = 0

    def delete_stock(self) -> None:
        """Delete the stock and the stick-out that are stored for the program."""
        self.cancel_entry()
        if self._is_refused():
            return
        if not (self.stored_part.stock_text or self.stored_part.stick_out_mm):
            self.desk.say(tr("NO STOCK IS SPECIFIED FOR THIS PROGRAM"))
            return
        self.stock_entry = StockEntry()
        self._save_part(replace(self.stored_part, stock_text="", stick_out_mm=None), tr("STOCK DATA DELETED"))

    def _accept_entry(self) -> None:
        """Accept the typed text for the selected field."""
        if self._is_refused():
            return
        try:
            if self.is_entering_file_name:
                entry = replace(self.stock_entry, file=self._find_file_path(self.entry_text.strip()))
            else:
                entry = self.stock_entry.typed(self.selected_field, self.entry_text, self.is_metric)
        except InvalidEntryError as error:
            self.entry_text = refused(self.entry_text)
            self.desk.show_refusal(str(error))
            return
        self.cancel_entry()
        self.desk.clear_prompt_line()
        self._store_entry(entry)

    def _find_file_path(self, name: str) -> str:
        """Return the path of a file in the program's folder or in one of the program folders.

        Raise InvalidEntryError if the file does not exist.
        """
        program_folder = self.loaded_program.path.parent if self.loaded_program.path is not None else Path()
        there = program_folder / Path(name).expanduser()
        if name and there.is_file():
            return str(there)
        path = self.desk.program_choice.program_folders.find_path(name) if name else None
        if path is None:
            raise InvalidEntryError(
                tr(Message("file {name} was not found in the program's folder", name=name or "–"))
            )
        return str(path)

    def _store_entry(self, entry: StockEntry) -> None:
        """Store an entry if it is complete, and prove the program with the new stock."""
        self.stock_entry = entry
        if entry.missing_field is not None:
            return
        try:
            stock = make_stock_path_absolute(entry.words)
        except StockError as error:
            self.desk.show_refusal(str(error))
            return
        kept = replace(self.stored_part, stock_text=stock, stick_out_mm=entry.stick_out or None)
        if kept != self.stored_part:
            self._save_part(kept, tr(Message("STOCK DATA SAVED WITH {name}", name=self.program_name)))

    # --- checks that are turned off ------------------------------------------------------------------

    def _find_silence_refusal(self) -> str:
        """Return why the selected finding's check cannot be turned off, or an empty string if it can."""
        found = self.selected_finding
        if found is None:
            return tr("SELECT THE FINDING WHOSE CHECK YOU WANT TO TURN OFF")
        if found.check_name not in self.check_codes:
            return tr("PROGRAM CHECKS CANNOT BE TURNED OFF, ONLY PART CHECKS")
        if found.check_name in self.machine_disabled_checks:
            return tr(
                Message(
                    "{check} CHECK IS TURNED OFF IN THE MACHINE FILE, SECTION [checks]",
                    check=found.check_name,
                )
            )
        return ""

    def toggle_check(self) -> None:
        """Handle F4: ask for the reason to turn the check off, or turn the check on again."""
        found = self.selected_finding
        self.cancel_entry()
        why = self._find_silence_refusal()
        if found is None or why:
            self.desk.say(why)
        elif self._is_refused():
            return
        elif found.downgrade_reason:
            rest = {
                check: why
                for check, why in self.stored_part.silenced_checks.items()
                if check != found.check_name
            }
            said = tr(Message("{check} CHECK IS ON AGAIN", check=found.check_name))
            self._save_part(replace(self.stored_part, silenced_checks=rest), said)
        else:
            self.desk.clear_prompt_line()
            self.check_to_disable = found.check_name

    def _silence(self, check: str, why: str) -> None:
        if not why:
            self.desk.show_refusal(tr("enter a reason to turn a check off"))
        elif not self._is_refused():
            silenced = {**self.stored_part.silenced_checks, check: why}
            self.cancel_entry()
            self._save_part(
                replace(self.stored_part, silenced_checks=silenced),
                tr(Message("{check} CHECK TURNED OFF", check=check)),
            )

    # --- store ---------------------------------------------------------------------------------------

    def _save_part(self, stored: StoredPart, on_done: str) -> None:
        """Store the part data on the worker thread, then prove the program again."""
        name = self.program_name
        if self.desk.is_refused(ProtectedChange.STOCK):
            return
        silenced = ", ".join(stored.silenced_checks) or "none"
        change_text = Message(
            "{name}: stock {stock}, checks turned off: {silenced}",
            name=name,
            stock=stored.stock_text or "not specified",
            silenced=silenced,
        )

        def report_saved(_none: None) -> None:
            self.persistence.log_change(change_text)
            self._is_kept(name, on_done)

        self.worker.enqueue_work(
            partial(self.persistence.save_settings, stored.make_stored_settings(name)),
            report_saved,
            lambda why: self.desk.say(tr(Message("NOT SAVED: {why}", why=why))),
        )

    def _is_kept(self, name: str, said: str) -> None:
        self.desk.show_success(said)
        loaded = self.loaded_program
        if self.program_name != name or loaded.path is None:
            return
        # A cycle was started at the operator station in the meantime.
        if self.desk.read_snapshot().state in ACTIVE_STATES:
            self.desk.renewal.is_requested = True
        else:
            self.desk.program_loader.start_loading(loaded.path, loaded.is_block_delete_on)


def _find_most_important(found: tuple[Diagnostic, ...]) -> int:
    """Return the index of the first error, or if there is none, of the first finding about the part."""
    errors = [place for place, each in enumerate(found) if each.severity is Severity.ERROR]
    of_part = [place for place, each in enumerate(found) if each.block_number and not each.downgrade_reason]
    return next(iter((*errors, *of_part)), 0)

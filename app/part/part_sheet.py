"""Model of the page PART without Qt: findings in the loaded program, and the stock of its proof.

Entries are stored with the program in the store, never in the program text. The program is then proved again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import partial
from pathlib import Path

from app.desk.arithmetic import CHARACTERS, EntryError
from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.kept_part import NOTHING_KEPT, KeptPart, kept_part, lasting
from app.desk.pages.sheet import STEPS, Key, edited, following, refused
from app.desk.persistence import Persistence
from app.desk.programs.program_loading import Loaded
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.part.stock_entry import StockEntry, StockField, StockKind
from core.access.access_table import Act
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.part.stock_spec import StockError
from core.store.store_errors import StoreError

_TURNS = {"Left": -1, "Right": 1}


class Section(StrEnum):
    """Content of the table."""

    FINDINGS = "findings"
    STOCK = "stock"


@dataclass(slots=True)
class PartSheet:
    """Model of the page PART.

    ``checks`` are the checks that can be turned off, and ``of_machine`` those that the machine file turns
    off. ``shows`` is called with a finding when the page has to show its location.
    """

    desk: Desk
    keep: Persistence
    checks: frozenset[str] = frozenset()
    of_machine: frozenset[str] = frozenset()
    stick_out: float = 0.0  # mm, from the machine file; 0 if not specified
    holds: bool = False  # whether the machine file has a chuck or collet to which a stick-out applies
    section: Section = Section.FINDINGS
    at: dict[Section, int] = field(default_factory=dict)
    text: str = ""  # typed text
    silencing: str = ""  # check whose reason is being typed
    writing: bool = False  # a file name is being typed: every character is part of the name
    worker: Latest = field(default_factory=lambda: Latest("editing-part"))
    shows: Callable[[Diagnostic], None] = field(default=lambda _found: None)
    kept: KeptPart = NOTHING_KEPT
    entry: StockEntry = field(default_factory=StockEntry)
    _seen: tuple[str, int] = ("", -1)  # program name and load count of the stored data

    def close(self) -> None:
        """Stop the worker after pending writes are finished."""
        self.worker.close()

    # --- displayed values ----------------------------------------------------------------------------

    @property
    def loaded(self) -> Loaded:
        """Loaded program."""
        return self.desk.session.now

    @property
    def name(self) -> str:
        """Name under which the part data is stored."""
        return self.loaded.name

    @property
    def metric(self) -> bool:
        """Whether the program uses millimeters."""
        picture = self.loaded.picture
        return picture is not None and picture.metric

    @property
    def findings(self) -> tuple[Diagnostic, ...]:
        """All findings in the order of lines."""
        return self.loaded.diagnostics

    @property
    def marked(self) -> int:
        """Index of the selected row; before a selection, the most important finding."""
        first = _first(self.findings) if self.section is Section.FINDINGS else 0
        return max(0, min(self.at.get(self.section, first), self._count - 1))

    @property
    def _count(self) -> int:
        return len(self.findings) if self.section is Section.FINDINGS else len(self.entry.fields)

    @property
    def finding(self) -> Diagnostic | None:
        """Selected finding, or None."""
        if self.section is not Section.FINDINGS or not self.findings:
            return None
        return self.findings[self.marked]

    @property
    def marked_field(self) -> StockField:
        """Selected field of the stock."""
        return self.entry.fields[min(self.at.get(Section.STOCK, 0), len(self.entry.fields) - 1)]

    def look(self) -> None:
        """Process finished writes and a change of the loaded program; called once per frame."""
        self.worker.poll()
        seen = self.name, self.desk.session.loads
        if seen != self._seen:
            if seen[0] != self._seen[0]:
                self.drop()
                self.at.clear()
            self._seen = seen
            self._read()

    def _read(self) -> None:
        try:
            self.kept = kept_part(self.keep.read_setting, self.name)
        except StoreError as error:
            self.kept = NOTHING_KEPT
            self.desk.refuse(str(error))
        self.entry = StockEntry.of(self.kept)

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys that are available now."""
        if self.section is Section.STOCK:
            return {
                "F2": Key("FINDINGS", self.turn),
                "F4": Key("KIND", self.turn_kind),
                "F6": Key("DELETE", self.forget),
            }
        found = self.finding
        word = "UNDO" if found is not None and found.silenced else "CHECK OFF"
        silenced = Key(word, self.silence, barred=bool(self._not_silenced() or self._locked()))
        return {"F2": Key("STOCK", self.turn), "F4": silenced}

    def turn(self) -> None:
        """Switch to the other table."""
        self.drop()
        self.desk.clear()
        self.section = following(Section, self.section)

    def show_stock(self) -> None:
        """Show the table of the stock."""
        self.section = Section.STOCK

    @property
    def has_keyboard(self) -> bool:
        """Whether every typed character is text."""
        return bool(self.silencing) or self.writing

    def takes(self, key: str) -> bool:
        """Return whether a character is part of an entry."""
        if self.has_keyboard:
            return len(key) == 1 and key.isprintable()
        return self.section is Section.STOCK and self._figures and key in CHARACTERS

    @property
    def _figures(self) -> bool:
        return bool(self.name) and self.marked_field not in {StockField.KIND, StockField.FILE}

    def typed(self, key: str) -> bool:
        """Handle a key: arrows select a row, Enter accepts, and other characters edit the entry."""
        if key == "Enter":
            self._enter()
        elif self.takes(key) or (key in {"Back", "Delete"} and self.has_entry):
            self.text = edited(self.text, key, 200)
        elif key in _TURNS and self.section is Section.STOCK and self.marked_field is StockField.KIND:
            self.turn_kind(_TURNS[key])
        elif key in STEPS and not self.has_keyboard:
            self.choose(self.marked + STEPS[key])
        else:
            return False
        return True

    @property
    def has_entry(self) -> bool:
        """Whether an entry is active: a reason, a file name or a value of the stock."""
        return self.has_keyboard or (self.section is Section.STOCK and self._figures)

    def choose(self, row: int) -> None:
        """Select a row. The location of a selected finding is shown."""
        self.drop()
        self.desk.clear()
        self.at[self.section] = max(0, min(row, self._count - 1))
        found = self.finding
        if found is not None:
            self.shows(found)

    def touch(self, row: int) -> None:
        """Select the touched row.

        A second touch changes the kind of stock or opens the file name entry.
        """
        if row != self.marked or self.section is Section.FINDINGS:
            self.choose(row)
        elif self.marked_field in {StockField.KIND, StockField.FILE} and not self.writing:
            self._enter()

    def _enter(self) -> None:
        if self.silencing:
            self._silence(self.silencing, self.text.strip())
        elif self.section is Section.FINDINGS:
            if self.finding is not None:
                self.shows(self.finding)
        elif self.marked_field is StockField.KIND:
            self.turn_kind()
        elif self.marked_field is StockField.FILE and not self.writing:
            self.writing = not self._barred()
        else:
            self._take()

    def escape(self) -> bool:
        """Cancel the entry, the message or an incomplete stock.

        Return False if there was nothing to cancel.
        """
        if self.text or self.has_keyboard:
            self.drop()
        elif self.desk.notice:
            self.desk.clear()
        elif self.entry != StockEntry.of(self.kept):
            self.entry = StockEntry.of(self.kept)
        else:
            return False
        return True

    def drop(self) -> None:
        """Cancel the entry."""
        self.text, self.silencing, self.writing = "", "", False

    def opened(self) -> None:
        """Reload the data when the page opens."""
        self._seen = ("", -1)
        self.look()

    def leave(self) -> None:
        """Cancel the entry and reset the selection when the page closes."""
        self.drop()
        self.section = Section.FINDINGS
        self.at.clear()

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.silencing:
            return tr("TYPE THE REASON   ENTER: TURN CHECK OFF   ESC: LEAVE IT ON")
        if self.writing:
            return tr("TYPE THE FILE NAME   ENTER: ACCEPT   ESC: CANCEL")
        if self.section is Section.FINDINGS:
            if self.keys()["F4"].barred:
                return tr("UP/DOWN: SHOW WHERE EACH FINDING IS   F2: STOCK")
            return tr("UP/DOWN: SHOW EACH FINDING   F2: STOCK   F4: TURN CHECK OFF")
        if self.marked_field is StockField.KIND:
            return tr("LEFT/RIGHT: CHANGE STOCK TYPE   F6: DELETE STOCK DATA")
        return tr("TYPE A LENGTH OR EXPRESSION   ENTER: SAVE   0: NOT SPECIFIED")

    # --- entries -------------------------------------------------------------------------------------

    def _barred(self) -> bool:
        """Return whether changes are not possible now, and show the reason."""
        if why := self._locked():
            self.desk.say(why)
        return bool(why)

    def _locked(self) -> str:
        """Return the reason why changes are not possible now, or an empty string."""
        if not self.name:
            return tr("LOAD A PROGRAM FIRST. STOCK DATA IS SAVED WITH THE PROGRAM")
        if self.desk.machine.model is not None and self.desk.machine.model.kind != "lathe":
            return tr("ON A MILL, TURNDESK DOES NOT CHECK THE FINISHED PART")
        if self.desk.snapshot().state in UNDER_WAY:
            return tr("PROGRAM RUNNING. EDIT STOCK OR PART CHECKS ONLY BETWEEN CYCLES")
        if self.worker.busy or self.loaded.busy:
            return tr("THE PROGRAM IS BEING PROVED: WAIT A MOMENT")
        return ""

    def turn_kind(self, by: int = 1) -> None:
        """Select the next kind of stock.

        An incomplete stock takes effect only when its missing value is entered.
        """
        self.drop()
        if self._barred():
            return
        self.desk.clear()
        kinds = list(StockKind)
        kind = kinds[(kinds.index(self.entry.kind) + by) % len(kinds)]
        self._say(replace(self.entry, kind=kind, file=""))
        self.at[Section.STOCK] = 0

    def forget(self) -> None:
        """Delete the stock and the stick-out of the program."""
        self.drop()
        if self._barred():
            return
        if not (self.kept.stock or self.kept.stick_out):
            self.desk.say(tr("NO STOCK IS SPECIFIED FOR THIS PROGRAM"))
            return
        self.entry = StockEntry()
        self._keep(replace(self.kept, stock="", stick_out=None), tr("STOCK DATA DELETED"))

    def _take(self) -> None:
        """Accept the typed text for the selected field."""
        if self._barred():
            return
        try:
            if self.writing:
                entry = replace(self.entry, file=self._found(self.text.strip()))
            else:
                entry = self.entry.typed(self.marked_field, self.text, self.metric)
        except EntryError as error:
            self.text = refused(self.text)
            self.desk.refuse(str(error))
            return
        self.drop()
        self.desk.clear()
        self._say(entry)

    def _found(self, name: str) -> str:
        """Return the path of a file in the program's folder or in the program folders.

        Raises EntryError if the file does not exist.
        """
        beside = self.loaded.path.parent if self.loaded.path is not None else Path()
        there = beside / Path(name).expanduser()
        if name and there.is_file():
            return str(there)
        path = self.desk.programs.folders.find(name) if name else None
        if path is None:
            raise EntryError(
                tr(Message("file {name} was not found in the program's folder", name=name or "–"))
            )
        return str(path)

    def _say(self, entry: StockEntry) -> None:
        """Store an entry if it is complete, and prove the program with the new stock."""
        self.entry = entry
        if entry.lacks is not None:
            return
        try:
            stock = lasting(entry.words)
        except StockError as error:
            self.desk.refuse(str(error))
            return
        kept = replace(self.kept, stock=stock, stick_out=entry.stick_out or None)
        if kept != self.kept:
            self._keep(kept, tr(Message("STOCK DATA SAVED WITH {name}", name=self.name)))

    # --- checks that are turned off ------------------------------------------------------------------

    def _not_silenced(self) -> str:
        """Return the reason why the check of the finding cannot be turned off, or an empty string."""
        found = self.finding
        if found is None:
            return tr("SELECT THE FINDING WHOSE CHECK YOU WANT TO TURN OFF")
        if found.check not in self.checks:
            return tr("PROGRAM CHECKS CANNOT BE TURNED OFF, ONLY PART CHECKS")
        if found.check in self.of_machine:
            return tr(
                Message(
                    "{check} CHECK IS TURNED OFF IN THE MACHINE FILE, SECTION [checks]", check=found.check
                )
            )
        return ""

    def silence(self) -> None:
        """Ask for the reason to turn the check off, or turn it on again (F4)."""
        found = self.finding
        self.drop()
        why = self._not_silenced()
        if found is None or why:
            self.desk.say(why)
        elif self._barred():
            return
        elif found.silenced:
            rest = {check: why for check, why in self.kept.silenced.items() if check != found.check}
            said = tr(Message("{check} CHECK IS ON AGAIN", check=found.check))
            self._keep(replace(self.kept, silenced=rest), said)
        else:
            self.desk.clear()
            self.silencing = found.check

    def _silence(self, check: str, why: str) -> None:
        if not why:
            self.desk.refuse(tr("enter a reason to turn a check off"))
        elif not self._barred():
            silenced = {**self.kept.silenced, check: why}
            self.drop()
            self._keep(
                replace(self.kept, silenced=silenced), tr(Message("{check} CHECK TURNED OFF", check=check))
            )

    # --- store ---------------------------------------------------------------------------------------

    def _keep(self, kept: KeptPart, said: str) -> None:
        """Write the data on the worker, then prove the program again."""
        name = self.name
        if self.desk.refused(Act.STOCK):
            return
        silenced = ", ".join(kept.silenced) or "none"
        told = Message(
            "{name}: stock {stock}, checks turned off: {silenced}",
            name=name,
            stock=kept.stock or "not specified",
            silenced=silenced,
        )

        def done(_none: None) -> None:
            self.keep.note_change(told)
            self._is_kept(name, said)

        self.worker.queue(
            partial(self.keep.keep_settings, kept.settings(name)),
            done,
            lambda why: self.desk.say(tr(Message("NOT SAVED: {why}", why=why))),
        )

    def _is_kept(self, name: str, said: str) -> None:
        self.desk.done(said)
        loaded = self.loaded
        if self.name != name or loaded.path is None:
            return
        # A cycle was started at the operator station in the meantime.
        if self.desk.snapshot().state in UNDER_WAY:
            self.desk.rebuilding.wanted = True
        else:
            self.desk.session.load(loaded.path, loaded.block_delete)


def _first(found: tuple[Diagnostic, ...]) -> int:
    """Return the index of the first error, or else of the first finding in the part."""
    errors = [place for place, each in enumerate(found) if each.severity is Severity.ERROR]
    of_part = [place for place, each in enumerate(found) if each.n and not each.silenced]
    return next(iter((*errors, *of_part)), 0)

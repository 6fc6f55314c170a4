"""Access levels: signed-in user, sign-in by PIN, users, and the changes that each level permits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from app.desk.access import Access
from app.desk.desk import Desk
from app.desk.pages.sheet import Entry, Key, Row, Sheet, following
from app.desk.persistence import Persistence
from app.desk.status.machine_status import Tone
from app.desk.translation import data, tr
from app.extras.access.sign_in import MINUTES, AccessReset, SignIn
from app.special.special_functions import SpecialFunction
from core.access.access_table import RULES, Act, Level
from core.executor.snapshot import Snapshot
from core.extras.access.pins import LONGEST, PinError, check_pin, hashed
from core.message import Message
from core.store.people import NAME_LONGEST, PersonRow, check_person
from core.store.store_errors import StoreError

_DOT = "●"


@dataclass(slots=True)
class _Draft:
    """Entry in several steps: the PIN for signing in, or a user with a PIN."""

    step: str  # sign in, name, level, pin or again
    name: str = ""
    level: Level = Level.SERVICE
    pin: str = ""


class AccessLevels(SpecialFunction):
    """Special function for access levels: Enter on a name asks for the PIN.

    SERVICE level edits users.
    """

    name = "ACCESS LEVELS"
    use = "sign in, users, PINs"

    def __init__(self, desk: Desk, persistence: Persistence, sign_in: SignIn) -> None:
        super().__init__(desk)
        self.persistence, self.session = persistence, sign_in
        self.entry = Entry()
        self.draft: _Draft | None = None
        self.table = False
        self.service_reset = AccessReset(sign_in, desk.say, self._reset_now)

    @property
    def access(self) -> Access:
        """Present access of TurnDesk."""
        return self.desk.access

    @property
    def count(self) -> int:
        """Number of rows that can be selected."""
        return len(RULES) if self.table else len(self.access.people.rows)

    @property
    def person(self) -> PersonRow | None:
        """Selected user, or None."""
        rows = self.access.people.rows
        return rows[min(self.marked, len(rows) - 1)] if rows and not self.table else None

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of users, or of the level that each change requires."""
        if self.table:
            rows = tuple(Row((act.value, rule.level.name)) for act, rule in RULES.items())
            heads, shares, raw = ("TYPE OF CHANGE", "LEVEL"), (0.65, 0.35), frozenset[int]()
        else:
            rows = tuple(self._row(each) for each in self.access.people.rows)
            heads, shares, raw = ("WHO", "LEVEL"), (0.65, 0.35), frozenset({0})
        question = self._question()
        text = (
            self.entry.text
            if self.draft and self.draft.step in {"name", "level"}
            else _DOT * len(self.entry.text)
        )
        return Sheet("ACCESS LEVELS", heads, shares, rows, self.marked, question, text, self._notes(), raw)

    def _row(self, row: PersonRow) -> Row:
        here = row.name == self.access.name
        return Row((row.name, Level(row.level).name), here, Tone.RUN)

    def _notes(self) -> tuple[str, ...]:
        if not self.access.people.on:
            return (
                "Access levels are off: anyone can change anything, and no PIN is required.",
                "F3 adds the first user, with SERVICE level, and turns access levels on.",
            )
        minutes = tr("After {minutes} minutes without input, the level returns to OPERATOR.")
        return (
            tr(Message(minutes, minutes=self.session.minutes)),
            "E-stop, feed hold, Reset and Drives Off work at every level.",
        )

    def _question(self) -> str:
        draft = self.draft
        if draft is None:
            return ""
        return {
            "sign in": tr(Message("PIN FOR {name}?", name=data(draft.name))),
            "name": tr("NAME?"),
            "level": tr("LEVEL? 1 OPERATOR, 2 SETUP, 3 SERVICE"),
            "pin": tr(Message("NEW PIN FOR {name}?", name=data(draft.name))),
            "again": tr("CONFIRM PIN:"),
        }[draft.step]

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.service_reset.under_way:
            return tr("PINS WILL BE REMOVED. RELEASE E-STOP OR SIGN IN TO CANCEL")
        if self.draft is not None:
            return tr("TYPE THE ENTRY   ENTER: ACCEPT   ESC: CANCEL")
        if not self.access.people.on:
            return tr("F3: ADD USER, TURN ACCESS LEVELS ON   ESC: BACK TO THE LIST")
        return tr("SELECT YOUR NAME   ENTER: SIGN IN   F2: SIGN OUT   ESC: BACK")

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys. Most exist only while access levels are on."""
        keys = {"F3": Key("NEW", self.add), "F5": Key("USERS" if self.table else "LEVELS", self._turn)}
        if self.access.people.on:
            keys |= {
                "F2": Key("SIGN OUT", self.sign_out),
                "F4": Key("PIN", self.new_pin),
                "F6": Key("REMOVE", self.remove),
                "F8": Key("TIME", self.next_minutes),
                "F9": Key("RESET", self.ask_reset),
            }
        return keys

    def _turn(self) -> None:
        self.desk.clear()
        self.draft, self.table, self.marked = None, not self.table, 0

    def takes(self, key: str) -> bool:
        """Return whether a character is part of a name or a PIN."""
        if self.draft is None or len(key) != 1:
            return False
        return self.entry.takes(key) if self.draft.step == "name" else key.isascii() and key.isdigit()

    def typed(self, key: str) -> bool:
        """Handle a key of the entry, or of the list."""
        if self.draft is None:
            return super().typed(key)
        if key == "Enter":
            self._enter(self.draft)
            return True
        if not (self.takes(key) or key in {"Back", "Delete"}):
            return False
        self.desk.clear()
        longest = NAME_LONGEST if self.draft.step == "name" else LONGEST
        if key in {"Back", "Delete"} or len(self.entry.text) < longest:
            self.entry.type(key)
        return True

    def act(self) -> bool:
        """Ask for the PIN of the selected user."""
        row = self.person
        if row is not None:
            self._ask(_Draft("sign in", row.name))
        return row is not None

    def escape(self) -> bool:
        """Cancel the entry. Return False without an entry."""
        open_before, self.draft, self.entry = self.draft is not None, None, Entry()
        return open_before

    def left(self) -> None:
        """Cancel the entry when the function closes."""
        self.draft, self.entry, self.table = None, Entry(), False

    # --- entry in steps ------------------------------------------------------------------------------

    def _ask(self, draft: _Draft) -> None:
        self.desk.clear()
        self.draft, self.entry, self.table = draft, Entry(words=draft.step == "name"), False

    def _enter(self, draft: _Draft) -> None:
        text = self.entry.text
        steps: dict[str, Callable[[_Draft, str], None]] = {
            "sign in": self._sign_in,
            "name": self._named,
            "level": self._levelled,
            "pin": self._first,
            "again": self._again,
        }
        try:
            steps[draft.step](draft, text)
        except (StoreError, PinError) as error:
            self.entry.text = ""
            self.desk.refuse(str(error))

    def _sign_in(self, draft: _Draft, pin: str) -> None:
        row = self.access.people.named(draft.name)
        self.escape()
        if row is not None and pin:
            self.session.sign_in(row, pin)

    def _named(self, draft: _Draft, text: str) -> None:
        draft.name = check_person(text)
        if self.access.people.named(draft.name) is not None:
            raise StoreError(
                Message("{draft} already exists; press F4 to change the PIN", draft=draft.name), "name-in-use"
            )
        draft.step = "level" if self.access.people.on else "pin"
        self._ask(draft)

    def _levelled(self, draft: _Draft, text: str) -> None:
        if text not in {str(level.value) for level in Level}:
            raise StoreError("the level must be 1, 2 or 3", "invalid-level")
        draft.level, draft.step = Level(int(text)), "pin"
        self._ask(draft)

    def _first(self, draft: _Draft, pin: str) -> None:
        check_pin(pin)
        draft.pin, draft.step = pin, "again"
        self._ask(draft)

    def _again(self, draft: _Draft, pin: str) -> None:
        if pin != draft.pin:
            self.draft = None
            raise PinError("the two PINs do not match; nothing was saved. Enter the PIN again")
        self.escape()
        if draft.name != self.access.name and self.desk.refused(Act.PEOPLE):
            return  # the user who started the entry was signed out in the meantime
        row = PersonRow(draft.name, draft.level, b"", b"")
        said = tr(Message("{name}: {level}, PIN SAVED", name=data(draft.name), level=tr(draft.level.name)))
        self._change(
            lambda: self._keep(row, pin),
            said,
            Message(
                "user {draft} saved with level {level} and a new PIN",
                draft=draft.name,
                level=draft.level.name,
            ),
        )

    def _keep(self, row: PersonRow, pin: str) -> None:
        """Store the user on the worker. Raises StoreError."""
        renewed = PersonRow(row.name, row.level, *hashed(pin))
        self.persistence.opened().people.save_person(renewed).result()

    def _change(self, work: Callable[[], None], said: str, noted: str) -> None:
        """Change the users on the worker, reload them, report the change and log it with the user."""

        def done(_none: None) -> None:
            self.access.note(noted)
            self.access.reload()
            self.desk.done(said)

        self.session.worker.queue(work, done, self.desk.refuse)

    # --- users ---------------------------------------------------------------------------------------

    def sign_out(self) -> None:
        """Sign out (F2)."""
        self.access.sign_out()
        self.desk.done(tr("SIGNED OUT: OPERATOR LEVEL IS ACTIVE"))

    def add(self) -> None:
        """Add a user (F3). The first user has SERVICE level."""
        if not self.desk.refused(Act.PEOPLE):
            self._ask(_Draft("name"))

    def new_pin(self) -> None:
        """Change the PIN of the selected user (F4). All users may change their own PIN."""
        row = self.person
        if row is None or (row.name != self.access.name and self.desk.refused(Act.PEOPLE)):
            return
        self._ask(_Draft("pin", row.name, Level(row.level)))

    def remove(self) -> None:
        """Remove the selected user (F6). Removing the last user turns access levels off."""
        row = self.person
        if row is None or self.desk.refused(Act.PEOPLE):
            return
        said = tr(Message("{name} REMOVED", name=data(row.name)))

        def work() -> None:
            self.persistence.opened().people.remove_person(row.name).result()

        asked = tr(Message("PRESS Y TO REMOVE {name}, N TO KEEP THE USER AND PIN", name=data(row.name)))
        self.desk.ask(asked, partial(self._change, work, said, Message("{row} removed", row=row.name)))

    def next_minutes(self) -> None:
        """Select the next time for the automatic sign-out (F8)."""
        if not self.desk.refused(Act.PEOPLE):
            self.desk.clear()
            self.session.choose_minutes(following(MINUTES, self.session.minutes))

    # --- service reset -------------------------------------------------------------------------------

    def ask_reset(self) -> None:
        """Start the reset of all PINs after confirmation (F9). The E-stop must stay pressed."""
        why = self.service_reset.why_not(self.desk.snapshot())
        if why:
            self.desk.say(why)
            return
        question = tr("Y: REMOVE ALL PINS IN 10 MINUTES (LOGGED)   N: KEEP THEM")
        self.desk.ask(question, self.service_reset.begin)

    def _reset_now(self) -> None:
        """Remove all users. If the store is unreadable, levels are off until TurnDesk ends."""

        def remove() -> None:
            if not self.access.is_unread:
                self.persistence.opened().people.remove_all_people().result()

        def done(_none: None) -> None:
            self.access.lift()
            self.desk.done(tr("ALL PINS REMOVED. ACCESS LEVELS OFF: ALL FUNCTIONS UNLOCKED"))

        self.session.worker.queue(remove, done, self.desk.refuse)

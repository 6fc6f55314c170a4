"""Access levels: who works here, signing in by PIN, people, and what each level may change."""

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
    """What is being entered: the PIN of somebody who signs in, or a person and his PIN, step by step."""

    step: str  # sign in, name, level, pin, again
    name: str = ""
    level: Level = Level.SERVICE
    pin: str = ""


class AccessLevels(SpecialFunction):
    """Return on a name asks its PIN; whoever is of SERVICE level enters the people."""

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
        """Who is in force."""
        return self.desk.access

    @property
    def count(self) -> int:
        """How many rows can be marked."""
        return len(RULES) if self.table else len(self.access.people.rows)

    @property
    def person(self) -> PersonRow | None:
        """The one that is marked."""
        rows = self.access.people.rows
        return rows[min(self.marked, len(rows) - 1)] if rows and not self.table else None

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """The people, or what each level may change."""
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
        """What the keys do."""
        if self.service_reset.under_way:
            return tr("PINS WILL BE REMOVED. RELEASE E-STOP OR SIGN IN TO CANCEL")
        if self.draft is not None:
            return tr("TYPE THE ENTRY   ENTER: ACCEPT   ESC: CANCEL")
        if not self.access.people.on:
            return tr("F3: ADD USER, TURN ACCESS LEVELS ON   ESC: BACK TO THE LIST")
        return tr("SELECT YOUR NAME   ENTER: SIGN IN   F2: SIGN OUT   ESC: BACK")

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Those of the people, as far as there are levels."""
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
        """Letters of a name; figures of a PIN."""
        if self.draft is None or len(key) != 1:
            return False
        return self.entry.takes(key) if self.draft.step == "name" else key.isascii() and key.isdigit()

    def typed(self, key: str) -> bool:
        """What is asked takes every key; else arrows mark and Return signs in."""
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
        """Return on a name: its PIN is asked."""
        row = self.person
        if row is not None:
            self._ask(_Draft("sign in", row.name))
        return row is not None

    def escape(self) -> bool:
        """Leave what is being entered; False when nothing was."""
        open_before, self.draft, self.entry = self.draft is not None, None, Entry()
        return open_before

    def left(self) -> None:
        """Nothing stays half typed."""
        self.draft, self.entry, self.table = None, Entry(), False

    # --- what is entered, step by step ---------------------------------------------------------------

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
            return  # who began it was away too long, or has signed out
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
        """On the worker. Raises StoreError."""
        renewed = PersonRow(row.name, row.level, *hashed(pin))
        self.persistence.opened().people.save_person(renewed).result()

    def _change(self, work: Callable[[], None], said: str, noted: str) -> None:
        """Have the people changed, read them again and say so; the log has by whom."""

        def done(_none: None) -> None:
            self.access.note(noted)
            self.access.reload()
            self.desk.done(said)

        self.session.worker.queue(work, done, self.desk.refuse)

    # --- people --------------------------------------------------------------------------------------

    def sign_out(self) -> None:
        """F2: nobody is signed in any more."""
        self.access.sign_out()
        self.desk.done(tr("SIGNED OUT: OPERATOR LEVEL IS ACTIVE"))

    def add(self) -> None:
        """F3: somebody new; the first one is of SERVICE level."""
        if not self.desk.refused(Act.PEOPLE):
            self._ask(_Draft("name"))

    def new_pin(self) -> None:
        """F4: another PIN of the marked person; everybody may change his own."""
        row = self.person
        if row is None or (row.name != self.access.name and self.desk.refused(Act.PEOPLE)):
            return
        self._ask(_Draft("pin", row.name, Level(row.level)))

    def remove(self) -> None:
        """F6: the marked person works here no more; with the last one levels go off."""
        row = self.person
        if row is None or self.desk.refused(Act.PEOPLE):
            return
        said = tr(Message("{name} REMOVED", name=data(row.name)))

        def work() -> None:
            self.persistence.opened().people.remove_person(row.name).result()

        asked = tr(Message("PRESS Y TO REMOVE {name}, N TO KEEP THE USER AND PIN", name=data(row.name)))
        self.desk.ask(asked, partial(self._change, work, said, Message("{row} removed", row=row.name)))

    def next_minutes(self) -> None:
        """F8: another time after which the level falls back."""
        if not self.desk.refused(Act.PEOPLE):
            self.desk.clear()
            self.session.choose_minutes(following(MINUTES, self.session.minutes))

    # --- service reset -------------------------------------------------------------------------------

    def ask_reset(self) -> None:
        """F9: where every PIN is forgotten; the E-stop stays pressed meanwhile."""
        why = self.service_reset.why_not(self.desk.snapshot())
        if why:
            self.desk.say(why)
            return
        question = tr("Y: REMOVE ALL PINS IN 10 MINUTES (LOGGED)   N: KEEP THEM")
        self.desk.ask(question, self.service_reset.begin)

    def _reset_now(self) -> None:
        """Also where no store can be read: until TurnDesk ends its levels are off then."""

        def remove() -> None:
            if not self.access.is_unread:
                self.persistence.opened().people.remove_all_people().result()

        def done(_none: None) -> None:
            self.access.lift()
            self.desk.done(tr("ALL PINS REMOVED. ACCESS LEVELS OFF: ALL FUNCTIONS UNLOCKED"))

        self.session.worker.queue(remove, done, self.desk.refuse)

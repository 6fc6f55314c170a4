"""Access levels: users, sign-in by PIN, and the level that each type of change requires."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from app.desk.access import UserAccess
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, InputField, TableContent, TableRow, following
from app.desk.persistence import Persistence
from app.desk.status.machine_status import StatusTone
from app.desk.translation import mark_untranslated, tr
from app.extras.access.sign_in import TIMEOUT_CHOICES_MIN, AccessReset, PinSignIn
from app.special.special_functions import SpecialFunction
from core.access.access_table import ACCESS_RULES, AccessLevel, ProtectedChange
from core.executor.snapshot import Snapshot
from core.extras.access.pins import LONGEST, PinError, check_pin, hash_pin
from core.message import Message
from core.store.store_errors import StoreError
from core.store.user_records import MAX_NAME_LENGTH, UserRow, normalize_user_name

_DOT = "●"


@dataclass(slots=True)
class _EntryDraft:
    """Unfinished entry of several steps: the PIN for signing in, or the data of a new user."""

    entry_step: str  # sign in, name, level, pin or again
    name: str = ""
    level: AccessLevel = AccessLevel.SERVICE
    pin: str = ""


class AccessLevelsFunction(SpecialFunction):
    """Special function that shows the users and their access levels.

    Enter on a user name asks for that user's PIN. A user with SERVICE level can edit users.
    """

    name = "ACCESS LEVELS"
    use = "sign in, users, PINs"

    def __init__(self, desk: Desk, persistence: Persistence, sign_in: PinSignIn) -> None:
        super().__init__(desk)
        self.persistence, self.session = persistence, sign_in
        self.entry = InputField()
        self.draft: _EntryDraft | None = None
        self.shows_levels = False
        self.service_reset = AccessReset(sign_in, desk.say, self._remove_all_users)

    @property
    def user_access(self) -> UserAccess:
        """Return the current user access of TurnDesk."""
        return self.desk.user_access

    @property
    def row_count(self) -> int:
        """Return the number of rows in the displayed table."""
        return len(ACCESS_RULES) if self.shows_levels else len(self.user_access.user_list.rows)

    @property
    def selected_user(self) -> UserRow | None:
        """Return the selected user, or None if no user is selected."""
        rows = self.user_access.user_list.rows
        return rows[min(self.marked, len(rows) - 1)] if rows and not self.shows_levels else None

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the displayed table: the users, or the access level required for each type of change."""
        if self.shows_levels:
            rows = tuple(TableRow((act.value, rule.minimum_level.name)) for act, rule in ACCESS_RULES.items())
            heads, shares, raw = ("TYPE OF CHANGE", "LEVEL"), (0.65, 0.35), frozenset[int]()
        else:
            rows = tuple(self._row(each) for each in self.user_access.user_list.rows)
            heads, shares, raw = ("WHO", "LEVEL"), (0.65, 0.35), frozenset({0})
        question = self._question()
        text = (
            self.entry.text
            if self.draft and self.draft.entry_step in {"name", "level"}
            else _DOT * len(self.entry.text)
        )
        return TableContent(
            "ACCESS LEVELS", heads, shares, rows, self.marked, question, text, self._notes(), raw
        )

    def _row(self, row: UserRow) -> TableRow:
        here = row.name == self.user_access.user_name
        return TableRow((row.name, AccessLevel(row.level).name), here, StatusTone.RUN)

    def _notes(self) -> tuple[str, ...]:
        if not self.user_access.user_list.is_access_restricted:
            return (
                "Access levels are off: anyone can change anything, and no PIN is required.",
                "F3 adds the first user, with SERVICE level, and turns access levels on.",
            )
        minutes = tr("After {minutes} minutes without input, the level returns to OPERATOR.")
        return (
            tr(Message(minutes, minutes=self.session.timeout_minutes)),
            "E-stop, feed hold, Reset and Drives Off work at every level.",
        )

    def _question(self) -> str:
        draft = self.draft
        if draft is None:
            return ""
        return {
            "sign in": tr(Message("PIN FOR {name}?", name=mark_untranslated(draft.name))),
            "name": tr("NAME?"),
            "level": tr("LEVEL? 1 OPERATOR, 2 SETUP, 3 SERVICE"),
            "pin": tr(Message("NEW PIN FOR {name}?", name=mark_untranslated(draft.name))),
            "again": tr("CONFIRM PIN:"),
        }[draft.entry_step]

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        if self.service_reset.is_running:
            return tr("PINS WILL BE REMOVED. RELEASE E-STOP OR SIGN IN TO CANCEL")
        if self.draft is not None:
            return tr("TYPE THE ENTRY   ENTER: ACCEPT   ESC: CANCEL")
        if not self.user_access.user_list.is_access_restricted:
            return tr("F3: ADD USER, TURN ACCESS LEVELS ON   ESC: BACK TO THE LIST")
        return tr("SELECT YOUR NAME   ENTER: SIGN IN   F2: SIGN OUT   ESC: BACK")

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys, most of which are available only while access levels are on."""
        keys = {
            "F3": FunctionKey("NEW", self.add_user),
            "F5": FunctionKey("USERS" if self.shows_levels else "LEVELS", self._turn),
        }
        if self.user_access.user_list.is_access_restricted:
            keys |= {
                "F2": FunctionKey("SIGN OUT", self.sign_out),
                "F4": FunctionKey("PIN", self.change_pin),
                "F6": FunctionKey("REMOVE", self.remove_user),
                "F8": FunctionKey("TIME", self.select_next_timeout),
                "F9": FunctionKey("RESET", self.ask_for_pin_reset),
            }
        return keys

    def _turn(self) -> None:
        self.desk.clear_prompt_line()
        self.draft, self.shows_levels, self.marked = None, not self.shows_levels, 0

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered in the name or the PIN."""
        if self.draft is None or len(key) != 1:
            return False
        return (
            self.entry.accepts_key(key)
            if self.draft.entry_step == "name"
            else key.isascii() and key.isdigit()
        )

    def handle_key(self, key: str) -> bool:
        """Handle a key in the open entry, or in the list if no entry is open."""
        if self.draft is None:
            return super().handle_key(key)
        if key == "Enter":
            self._enter(self.draft)
            return True
        if not (self.accepts_key(key) or key in {"Back", "Delete"}):
            return False
        self.desk.clear_prompt_line()
        longest = MAX_NAME_LENGTH if self.draft.entry_step == "name" else LONGEST
        if key in {"Back", "Delete"} or len(self.entry.text) < longest:
            self.entry.handle_key(key)
        return True

    def activate_selected_row(self) -> bool:
        """Ask for the PIN of the selected user and return whether a user is selected."""
        row = self.selected_user
        if row is not None:
            self._ask(_EntryDraft("sign in", row.name))
        return row is not None

    def handle_escape(self) -> bool:
        """Cancel the entry and return whether an entry was open."""
        open_before, self.draft, self.entry = self.draft is not None, None, InputField()
        return open_before

    def on_close(self) -> None:
        """Cancel the entry when the function closes."""
        self.draft, self.entry, self.shows_levels = None, InputField(), False

    # --- entry in steps ------------------------------------------------------------------------------

    def _ask(self, draft: _EntryDraft) -> None:
        self.desk.clear_prompt_line()
        self.draft, self.entry, self.shows_levels = draft, InputField(words=draft.entry_step == "name"), False

    def _enter(self, draft: _EntryDraft) -> None:
        text = self.entry.text
        steps: dict[str, Callable[[_EntryDraft, str], None]] = {
            "sign in": self._sign_in,
            "name": self._named,
            "level": self._levelled,
            "pin": self._first,
            "again": self._again,
        }
        try:
            steps[draft.entry_step](draft, text)
        except (StoreError, PinError) as error:
            self.entry.text = ""
            self.desk.show_refusal(str(error))

    def _sign_in(self, draft: _EntryDraft, pin: str) -> None:
        row = self.user_access.user_list.find_user(draft.name)
        self.handle_escape()
        if row is not None and pin:
            self.session.sign_in(row, pin)

    def _named(self, draft: _EntryDraft, text: str) -> None:
        draft.name = normalize_user_name(text)
        if self.user_access.user_list.find_user(draft.name) is not None:
            raise StoreError(
                Message("{draft} already exists; press F4 to change the PIN", draft=draft.name), "name-in-use"
            )
        draft.entry_step = "level" if self.user_access.user_list.is_access_restricted else "pin"
        self._ask(draft)

    def _levelled(self, draft: _EntryDraft, text: str) -> None:
        if text not in {str(level.value) for level in AccessLevel}:
            raise StoreError("the level must be 1, 2 or 3", "invalid-level")
        draft.level, draft.entry_step = AccessLevel(int(text)), "pin"
        self._ask(draft)

    def _first(self, draft: _EntryDraft, pin: str) -> None:
        check_pin(pin)
        draft.pin, draft.entry_step = pin, "again"
        self._ask(draft)

    def _again(self, draft: _EntryDraft, pin: str) -> None:
        if pin != draft.pin:
            self.draft = None
            raise PinError("the two PINs do not match; nothing was saved. Enter the PIN again")
        self.handle_escape()
        if draft.name != self.user_access.user_name and self.desk.is_refused(ProtectedChange.PEOPLE):
            return  # the user who started the entry was signed out in the meantime
        row = UserRow(draft.name, draft.level, b"", b"")
        said = tr(
            Message(
                "{name}: {level}, PIN SAVED", name=mark_untranslated(draft.name), level=tr(draft.level.name)
            )
        )
        self._change(
            lambda: self._save_user(row, pin),
            said,
            Message(
                "user {draft} saved with level {level} and a new PIN",
                draft=draft.name,
                level=draft.level.name,
            ),
        )

    def _save_user(self, row: UserRow, pin: str) -> None:
        """Store the user with a PIN.

        This method runs on the worker. Raises StoreError if the user cannot be stored.
        """
        renewed = UserRow(row.name, row.level, *hash_pin(pin))
        self.persistence.require_store().people.save_user(renewed).result()

    def _change(self, work: Callable[[], None], said: str, noted: str) -> None:
        """Change the users on the worker and reload them.

        ``said`` is the message for the operator, and ``noted`` is the text that is logged with the user
        name.
        """

        def report_change(_none: None) -> None:
            self.user_access.log_access(noted)
            self.user_access.reload()
            self.desk.show_success(said)

        self.session.worker.enqueue_work(work, report_change, self.desk.show_refusal)

    # --- users ---------------------------------------------------------------------------------------

    def sign_out(self) -> None:
        """Sign out the user (F2)."""
        self.user_access.sign_out()
        self.desk.show_success(tr("SIGNED OUT: OPERATOR LEVEL IS ACTIVE"))

    def add_user(self) -> None:
        """Start the entry of a new user (F3).

        The first user has SERVICE level.
        """
        if not self.desk.is_refused(ProtectedChange.PEOPLE):
            self._ask(_EntryDraft("name"))

    def change_pin(self) -> None:
        """Start the entry of a new PIN for the selected user (F4).

        Users of every level may change their own PIN.
        """
        row = self.selected_user
        if row is None or (
            row.name != self.user_access.user_name and self.desk.is_refused(ProtectedChange.PEOPLE)
        ):
            return
        self._ask(_EntryDraft("pin", row.name, AccessLevel(row.level)))

    def remove_user(self) -> None:
        """Remove the selected user after confirmation (F6).

        Removing the last user turns access levels off.
        """
        row = self.selected_user
        if row is None or self.desk.is_refused(ProtectedChange.PEOPLE):
            return
        said = tr(Message("{name} REMOVED", name=mark_untranslated(row.name)))

        def delete_stored_user() -> None:
            self.persistence.require_store().people.remove_user(row.name).result()

        asked = tr(
            Message("PRESS Y TO REMOVE {name}, N TO KEEP THE USER AND PIN", name=mark_untranslated(row.name))
        )
        self.desk.ask_operator(
            asked, partial(self._change, delete_stored_user, said, Message("{row} removed", row=row.name))
        )

    def select_next_timeout(self) -> None:
        """Select the next choice for the automatic sign-out timeout (F8)."""
        if not self.desk.is_refused(ProtectedChange.PEOPLE):
            self.desk.clear_prompt_line()
            self.session.set_timeout(following(TIMEOUT_CHOICES_MIN, self.session.timeout_minutes))

    # --- service reset -------------------------------------------------------------------------------

    def ask_for_pin_reset(self) -> None:
        """Ask for confirmation, and then start the reset of all PINs (F9).

        The E-stop must stay pressed during the reset.
        """
        why = self.service_reset.find_start_refusal(self.desk.read_snapshot())
        if why:
            self.desk.say(why)
            return
        question = tr("Y: REMOVE ALL PINS IN 10 MINUTES (LOGGED)   N: KEEP THEM")
        self.desk.ask_operator(question, self.service_reset.start)

    def _remove_all_users(self) -> None:
        """Remove all users.

        If the store is unreadable, access levels are turned off only until TurnDesk closes.
        """

        def delete_stored_users() -> None:
            if not self.user_access.has_read_failed:
                self.persistence.require_store().people.remove_all_users().result()

        def report_removal(_none: None) -> None:
            self.user_access.remove_access_levels()
            self.desk.show_success(tr("ALL PINS REMOVED. ACCESS LEVELS OFF: ALL FUNCTIONS UNLOCKED"))

        self.session.worker.enqueue_work(delete_stored_users, report_removal, self.desk.show_refusal)

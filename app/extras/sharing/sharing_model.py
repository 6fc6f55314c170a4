"""Model of the page SHARED PROGRAMS without Qt: newer versions, their authors and machines."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import wrap

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import STEPS, Key, Row, Sheet
from app.desk.status.formats import NOTHING, local_time
from app.desk.status.machine_status import Tone
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.editor.versions import NoArchive, VersionHistory, lines_of
from app.extras.sharing.sharing import Shared, Sharing
from core.access.access_table import Act
from core.extras.sharing.shared_versions import Family, SharedVersion, key_of
from core.message import Message, join_messages
from core.store.store_rows import VersionRow

NO_PLACE = (
    "NO LOCATION FOR SHARED PROGRAMS IS SET. SPECIFY A FOLDER OR A "
    "DATABASE UNDER [sharing] IN THE MACHINE FILE"
)
NOTHING_YET = "NOTHING SHARED YET. NEXT REFRESH SHARES THE PROGRAM FOLDER"
MARK_ONE = "SELECT A PROGRAM FIRST"
BUSY = "STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE"
_STATES = {
    "new": ("NOT ON THIS CONTROL", Tone.READY),
    "newer": ("NEWER VERSION ON ANOTHER CONTROL", Tone.PAUSE),
    "both": ("CHANGED HERE AND ON ANOTHER CONTROL", Tone.ALARM),
    "same": ("UP TO DATE", Tone.RUN),
}
_ORDER = tuple(_STATES)
_WIDE = 110  # characters of a note
_PATIENCE = 30.0  # seconds after which a slow location is reported


@dataclass(slots=True)
class VersionsElsewhere(VersionHistory):
    """Newest versions on other machines. ``changes`` are the differences from the local text."""

    def heading(self) -> str:
        """Return the heading of the comparison."""
        return "CHANGES IF YOU USE THE SELECTED VERSION"

    def words(self) -> str:
        """Return the status of the selected version as text."""
        if self.trouble:
            return self.trouble
        if not self.rows:
            return "READING" if self.worker.busy else "NO OTHER CONTROL HAS A NEWER VERSION"
        if self.text is None:
            return "COMPARING"
        return "" if self.changes else "SAME TEXT AS ON THIS CONTROL"

    def between(self, marked: str, now: str) -> tuple[str, str]:
        """Return the local text and the text of the selected version."""
        return now, marked


@dataclass(slots=True)
class NewestElsewhere:
    """Archive for ``VersionsElsewhere``: the versions of the last synchronization, numbered from 1."""

    sharing: Sharing

    def of(self, key: str) -> Sequence[SharedVersion]:
        """Return the versions that this machine does not have."""
        return self.sharing.now.families.get(key, Family()).elsewhere

    def versions(self, name: str) -> Sequence[VersionRow]:
        """Return the versions with their author and the machines that have them."""
        return [self._row(number, each) for number, each in enumerate(self.of(name), 1)]

    def text_of(self, name: str, version: int) -> bytes:
        """Return the text of a version. Raises SharingError and StoreError."""
        return self.sharing.text(self.of(name)[version - 1])

    def save_version(self, _name: str, _text: bytes, _why: str) -> int:
        """Store nothing and return 0."""
        return 0

    def _row(self, number: int, version: SharedVersion) -> VersionRow:
        on = ", ".join(self.sharing.now.who_has(version.id))
        who = (
            join_messages("  ·  ", (version.desk, tr(Message("AVAILABLE ON {desks}", desks=on))))
            if on
            else version.desk
        )
        return VersionRow(number, version.text, version.saved, who, version.size)


@dataclass(slots=True)
class SharingModel:
    """Model of the page. ``sharing`` is None without a location, ``look_now`` wakes the sharing thread.

    ``silent_for`` returns how long the thread has waited for the location, in seconds.
    """

    desk: Desk
    sharing: Sharing | None = None
    look_now: Callable[[], None] = lambda: None
    silent_for: Callable[[], float] = lambda: 0.0
    marked: int = 0
    worker: Latest = field(default_factory=lambda: Latest("sharing-page"))
    elsewhere: VersionsElsewhere = field(init=False)
    _seen: tuple[object, str] = (None, "")  # program and state of the comparison
    # sorted state
    _of: tuple[Shared | None, tuple[tuple[str, Family], ...], tuple[Row, ...]] = (None, (), ())

    def __post_init__(self) -> None:
        archive = NewestElsewhere(self.sharing) if self.sharing is not None else NoArchive()
        self.elsewhere = VersionsElsewhere(archive, self.worker)

    # --- display -------------------------------------------------------------------------------------

    @property
    def shared(self) -> Shared:
        """Result of the last synchronization."""
        return self.sharing.now if self.sharing is not None else Shared()

    @property
    def programs(self) -> tuple[tuple[str, Family], ...]:
        """Shared programs, with those that need a decision first, then by name."""
        shared = self.shared
        if shared is not self._of[0]:
            states = shared.states
            order = sorted(shared.families.items(), key=lambda each: (_ORDER.index(states[each[0]]), each[0]))
            rows = tuple(self._row(key, family) for key, family in order)
            self._of = shared, tuple(order), rows
        return self._of[1]

    @property
    def program(self) -> tuple[str, Family] | None:
        """Selected program with its key, or None."""
        programs = self.programs
        return programs[self.marked] if self.marked < len(programs) else None

    @property
    def version(self) -> SharedVersion | None:
        """Selected version of another machine, or None."""
        here, number = self.program, self.elsewhere.number
        if here is None or self.elsewhere.name != here[0] or not 0 < number <= len(here[1].elsewhere):
            return None
        return here[1].elsewhere[number - 1]

    def look(self) -> None:
        """Process results of the worker, and compare again after a change; called once per frame."""
        self.worker.poll()
        self.marked = max(0, min(self.marked, len(self.shared.families) - 1))
        key = self.program[0] if self.program is not None else ""
        now = self.program[1] if self.program is not None else None
        if (now, key) == self._seen or self.sharing is None:
            return
        self._seen = now, key
        sharing = self.sharing
        self.worker.queue(
            lambda: lines_of(sharing.text_here(key)),
            lambda text: self.elsewhere.look(key, text),
            self.desk.refuse,
        )

    def sheet(self) -> Sheet:
        """Return the table of programs with state, author, time and machines of the newest version."""
        rows = self._of[2] if self.programs else ()
        notes = wrap(self._silence() or tr(self.shared.trouble), _WIDE)
        notes += [f"{name}: {why}" for name, why in list(self.shared.refused.items())[:2]]
        if self.sharing is None:
            notes = [NO_PLACE]
        elif not rows and not notes:
            notes = [NOTHING_YET]
        waiting = (
            tr(Message("{count} WAITING TO BE SHARED", count=self.shared.waiting))
            if self.shared.waiting
            else ""
        )
        where = self.sharing.place.name if self.sharing is not None else ""
        title = join_messages("  ·  ", filter(None, (tr("SHARED PROGRAMS"), where, waiting)))
        return Sheet(
            title,
            ("PROGRAM", "STATE", "BY", "SAVED", "AVAILABLE ON"),
            (0.24, 0.26, 0.14, 0.16, 0.2),
            rows,
            self.marked if rows else -1,
            notes=tuple(notes),
            raw=frozenset({0, 2, 3, 4}),
        )

    def _silence(self) -> str:
        """Return a message if the location has not responded for a long time, or an empty string."""
        seconds = self.silent_for()
        if self.sharing is None or seconds < _PATIENCE:
            return ""
        words = tr("{name}: NO RESPONSE FOR {seconds} S. PROGRAMS STAY LOCAL FOR NOW")
        return tr(Message(words, name=self.sharing.place.name, seconds=f"{seconds:.0f}"))

    def _row(self, key: str, family: Family) -> Row:
        state = self.shared.states[key]
        words, tone = _STATES[state]
        here = family.versions.get(family.here)
        shown = family.elsewhere[0] if family.elsewhere else here
        if shown is None:
            return Row((NOTHING,) * 5)
        on = ", ".join(self.shared.who_has(shown.id)) or NOTHING
        saved = local_time(shown.saved, seconds=False)
        return Row(((here or shown).program, words, shown.desk, saved, on), state != "same", tone)

    def prompt(self) -> str:
        """Return the prompt for the present keys."""
        if self.sharing is None:
            return NO_PLACE
        if self.version is None:
            return "UP/DOWN: SELECT PROGRAM   F5: REFRESH   ESC: AUTOMATIC"
        if not self._both:
            return "F2: USE SELECTED VERSION (ASKS FIRST)   ESC: AUTOMATIC"
        return "F2: USE SELECTED VERSION   F3: KEEP LOCAL VERSION   ESC: BACK"

    # --- keys ----------------------------------------------------------------------------------------

    def keys(self) -> Mapping[str, Key]:
        """Return the present function keys."""
        return {
            "F2": Key("USE", self.take, barred=self.version is None or self.program is None),
            "F3": Key("KEEP", self.keep, barred=not self._both),
            "F4": Key("VERSION", self.next_version),
            "F5": Key("REFRESH", self.ask_for_a_look, barred=self.sharing is None),
        }

    def take(self) -> None:
        """Copy the selected version into the program folder.

        Replacing a program requires confirmation.
        """
        version, here = self.version, self.program
        if version is None or here is None:
            self.desk.say(MARK_ONE if here is None else "NO OTHER CONTROL HAS A NEWER VERSION")
        elif self.desk.refused(Act.PROGRAMS):
            return
        elif why := self._silence() or self._in_use(version.key):
            self.desk.say(why)
        elif here[1].here:
            words = tr("Y: USE {name} FROM {desk} (LOCAL VERSION STAYS STORED)   N: CANCEL")
            self.desk.ask(
                tr(Message(words, name=version.program, desk=version.desk)), lambda: self._take(version)
            )
        else:
            self._take(version)

    def _take(self, version: SharedVersion) -> None:
        # The program was started or the access level has expired in the meantime.
        why = self._in_use(version.key) or self.desk.access.refusal(Act.PROGRAMS)
        if why or self.sharing is None:
            self.desk.say(why)
            return
        sharing = self.sharing
        done = tr(
            Message("{name} IS NOW THE VERSION FROM {machine}", name=version.program, machine=version.desk)
        )
        change = Message(
            "program {program}: version from {machine} now in use",
            program=version.program,
            machine=version.desk,
        )
        self._work(lambda: sharing.take(version), done, change)

    @property
    def _both(self) -> bool:
        """Whether the selected program was changed both here and on another machine."""
        here = self.program
        return here is not None and self.shared.states.get(here[0]) == "both"

    def keep(self) -> None:
        """Keep the local version instead of changes on other machines, after confirmation."""
        here = self.program
        if here is None or not self._both:
            self.desk.say("NO DECISION NEEDED: NO OTHER CONTROL HAS CHANGED THIS PROGRAM")
            return
        if self.desk.refused(Act.PROGRAMS):
            return
        key, name = here[0], here[1].versions[here[1].here].program
        words = tr("Y: KEEP LOCAL {name}, STORE OTHER VERSIONS   N: CANCEL")
        self.desk.ask(tr(Message(words, name=name)), lambda: self._keep(key, name))

    def _keep(self, key: str, name: str) -> None:
        if self.sharing is not None and not self.desk.refused(Act.PROGRAMS):
            sharing = self.sharing
            said = tr(Message("{name}: LOCAL VERSION RETAINED", name=name))
            self._work(
                lambda: sharing.keep(key), said, Message("program {name}: local version retained", name=name)
            )

    def _work(self, work: Callable[[], object], words: str, change: str) -> None:
        if self.worker.busy or self._silence():
            self.desk.say(self._silence() or BUSY)
            return

        who = self.desk.access.who  # the user of the request, even if another user signs in

        def done(_answer: object) -> None:
            self.desk.done(words)
            self.desk.access.persistence.note_change(change, who)
            self.look_now()

        self.worker.queue(work, done, self.desk.refuse)

    def _in_use(self, key: str) -> str:
        """Return the reason why a program must not be replaced now, or an empty string."""
        snapshot, loaded = self.desk.snapshot(), self.desk.session.now
        if snapshot.interrupted is not None and key_of(snapshot.interrupted.program) == key:
            words = tr("{name} WAS INTERRUPTED. FINISH OR CANCEL THE RUN FIRST")
            return tr(Message(words, name=snapshot.interrupted.program))
        names = [Path(snapshot.program).name, loaded.name]
        if loaded.source is not None:
            names += [each.name for each in loaded.source.subprograms]
        used = next((name for name in names if key_of(name) == key), "")
        if used and snapshot.state in UNDER_WAY:
            return tr(Message("{name} IS RUNNING. LET IT FINISH FIRST", name=used))
        return ""

    def next_version(self) -> None:
        """Select the next version if several machines have changed the program."""
        count = len(self.elsewhere.rows)
        if count:
            self.desk.clear()
            self.elsewhere.mark((self.elsewhere.marked + 1) % count)

    def ask_for_a_look(self) -> None:
        """Start a synchronization now."""
        if self.sharing is None:
            self.desk.say(NO_PLACE)
        elif self._silence():
            self.desk.say(self._silence())
        else:
            self.desk.done("CHECKING …")
            self.look_now()

    def typed(self, key: str) -> bool:
        """Handle a key: arrows select a program, and Enter takes the selected version."""
        if key in STEPS and self.programs:
            self.choose(self.marked + STEPS[key])
        elif key == "Enter":
            self.take()
        else:
            return False
        return True

    def takes(self, _key: str) -> bool:
        """Return False, because this page has no entry."""
        return False

    def choose(self, row: int) -> None:
        """Select a program."""
        self.desk.clear()
        self.marked = max(0, min(len(self.programs) - 1, row))

    def opened(self) -> None:
        """Start a synchronization when the page opens."""
        self.look_now()

    def escape(self) -> bool:
        """Go back one step. Return False if the page can close."""
        if not self.desk.notice:
            return False
        self.desk.clear()
        return True

    def leave(self) -> None:
        """Do nothing, because there is nothing to cancel."""

    def close(self) -> None:
        """Stop the worker after pending changes are finished."""
        self.worker.close()

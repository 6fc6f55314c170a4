"""Model of the SHARED PROGRAMS page, independent of Qt.

The page shows newer versions from other machines, their authors, and the machines on which they exist.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import wrap

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, TableContent, TableRow
from app.desk.status.formats import NO_VALUE, format_local_time
from app.desk.status.machine_status import StatusTone
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.editor.version_history import NullVersionArchive, VersionHistory, decode_text
from app.extras.sharing.sharing import ProgramSharing, SharingResult
from core.access.access_table import ProtectedChange
from core.extras.sharing.shared_versions import ProgramVersions, SharedVersion, make_program_key
from core.message import Message, join_messages
from core.store.store_rows import ProgramVersionRow

NO_LOCATION_MESSAGE = (
    "NO LOCATION FOR SHARED PROGRAMS IS SET. SPECIFY A FOLDER OR A "
    "DATABASE UNDER [sharing] IN THE MACHINE FILE"
)
NOTHING_SHARED_MESSAGE = "NOTHING SHARED YET. NEXT REFRESH SHARES THE PROGRAM FOLDER"
SELECT_PROGRAM_MESSAGE = "SELECT A PROGRAM FIRST"
BUSY_MESSAGE = "STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE"
_STATES = {
    "new": ("NOT ON THIS CONTROL", StatusTone.READY),
    "newer": ("NEWER VERSION ON ANOTHER CONTROL", StatusTone.PAUSE),
    "both": ("CHANGED HERE AND ON ANOTHER CONTROL", StatusTone.ALARM),
    "same": ("UP TO DATE", StatusTone.RUN),
}
_ORDER = tuple(_STATES)
_WIDE = 110  # characters of a note
_PATIENCE = 30.0  # seconds after which a slow location is reported


@dataclass(slots=True)
class RemoteVersions(VersionHistory):
    """Newest versions of a program on other machines, compared with the local text.

    ``changes`` are the differences between the local text and the selected version.
    """

    def heading(self) -> str:
        """Return the heading of the comparison."""
        return "CHANGES IF YOU USE THE SELECTED VERSION"

    def words(self) -> str:
        """Return the status of the list of remote versions as display text."""
        if self.error_text:
            return self.error_text
        if not self.rows:
            return "READING" if self.worker.is_busy else "NO OTHER CONTROL HAS A NEWER VERSION"
        if self.text is None:
            return "COMPARING"
        return "" if self.changes else "SAME TEXT AS ON THIS CONTROL"

    def order_texts(self, selected: str, current: str) -> tuple[str, str]:
        """Return the two texts to compare: the local text and the text of the selected version."""
        return current, selected


@dataclass(slots=True)
class RemoteVersionArchive:
    """Archive of the remote versions for ``RemoteVersions``.

    It contains the remote versions found by the last synchronization, numbered from 1.
    """

    program_sharing: ProgramSharing

    def find_remote_versions(self, program_key: str) -> Sequence[SharedVersion]:
        """Return the newest versions of a program that are missing on this machine."""
        return self.program_sharing.last_result.versions_by_program.get(
            program_key, ProgramVersions()
        ).newest_remote_versions

    def versions(self, name: str) -> Sequence[ProgramVersionRow]:
        """Return the remote versions of a program, with their authors and the machines that have them."""
        return [self._row(number, each) for number, each in enumerate(self.find_remote_versions(name), 1)]

    def read_version_text(self, name: str, version: int) -> bytes:
        """Return the text of a version.

        Raises SharingError or StoreError if the text cannot be read.
        """
        return self.program_sharing.read_version_text(self.find_remote_versions(name)[version - 1])

    def save_version(self, _name: str, _text: bytes, _why: str) -> int:
        """Store nothing and return 0, because remote versions are read-only."""
        return 0

    def _row(self, number: int, version: SharedVersion) -> ProgramVersionRow:
        on = ", ".join(self.program_sharing.last_result.find_machines_with_version(version.id))
        who = (
            join_messages("  ·  ", (version.desk, tr(Message("AVAILABLE ON {desks}", desks=on))))
            if on
            else version.desk
        )
        return ProgramVersionRow(number, version.text, version.saved, who, version.size)


@dataclass(slots=True)
class SharingModel:
    """Model of the SHARED PROGRAMS page.

    - ``sharing`` is None if no shared location is configured.
    - ``synchronize_now`` starts a synchronization on the sharing thread.
    - ``get_waiting_time_s`` returns how long this thread has been waiting for the location, in seconds.
    """

    desk: Desk
    program_sharing: ProgramSharing | None = None
    synchronize_now: Callable[[], None] = lambda: None
    get_waiting_time_s: Callable[[], float] = lambda: 0.0
    selected_row: int = 0
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("sharing-page"))
    remote_versions: RemoteVersions = field(init=False)
    _seen: tuple[object, str] = (None, "")  # program and state of the comparison
    # sorted state
    _of: tuple[SharingResult | None, tuple[tuple[str, ProgramVersions], ...], tuple[TableRow, ...]] = (
        None,
        (),
        (),
    )

    def __post_init__(self) -> None:
        archive = (
            RemoteVersionArchive(self.program_sharing)
            if self.program_sharing is not None
            else NullVersionArchive()
        )
        self.remote_versions = RemoteVersions(archive, self.worker)

    # --- display -------------------------------------------------------------------------------------

    @property
    def last_result(self) -> SharingResult:
        """Return the result of the last synchronization."""
        return self.program_sharing.last_result if self.program_sharing is not None else SharingResult()

    @property
    def shared_programs(self) -> tuple[tuple[str, ProgramVersions], ...]:
        """Return the shared programs, each with its program key.

        Programs for which the operator must make a decision come first. Programs with the same state are
        sorted by name.
        """
        shared = self.last_result
        if shared is not self._of[0]:
            states = shared.states_by_program
            order = sorted(
                shared.versions_by_program.items(), key=lambda each: (_ORDER.index(states[each[0]]), each[0])
            )
            rows = tuple(self._row(key, family) for key, family in order)
            self._of = shared, tuple(order), rows
        return self._of[1]

    @property
    def selected_program(self) -> tuple[str, ProgramVersions] | None:
        """Return the selected program with its program key, or None if no program is shared."""
        programs = self.shared_programs
        return programs[self.selected_row] if self.selected_row < len(programs) else None

    @property
    def selected_version(self) -> SharedVersion | None:
        """Return the selected version from another machine, or None if no version is selected."""
        here, number = self.selected_program, self.remote_versions.number
        if (
            here is None
            or self.remote_versions.program_name != here[0]
            or not 0 < number <= len(here[1].newest_remote_versions)
        ):
            return None
        return here[1].newest_remote_versions[number - 1]

    def update(self) -> None:
        """Process results of the worker and compare the texts again after a change.

        This method is called once per frame.
        """
        self.worker.deliver_results()
        self.selected_row = max(0, min(self.selected_row, len(self.last_result.versions_by_program) - 1))
        key = self.selected_program[0] if self.selected_program is not None else ""
        now = self.selected_program[1] if self.selected_program is not None else None
        if (now, key) == self._seen or self.program_sharing is None:
            return
        self._seen = now, key
        sharing = self.program_sharing
        self.worker.enqueue_work(
            lambda: decode_text(sharing.read_local_text(key)),
            lambda text: self.remote_versions.open_history(key, text),
            self.desk.show_refusal,
        )

    def make_table(self) -> TableContent:
        """Return the table of shared programs.

        Each row contains the state of the program, and the author, time and machines of its newest version.
        """
        rows = self._of[2] if self.shared_programs else ()
        notes = wrap(self._silence() or tr(self.last_result.error_text), _WIDE)
        notes += [f"{name}: {why}" for name, why in list(self.last_result.rejected_files.items())[:2]]
        if self.program_sharing is None:
            notes = [NO_LOCATION_MESSAGE]
        elif not rows and not notes:
            notes = [NOTHING_SHARED_MESSAGE]
        waiting = (
            tr(Message("{count} WAITING TO BE SHARED", count=self.last_result.unpublished_version_count))
            if self.last_result.unpublished_version_count
            else ""
        )
        where = self.program_sharing.location.name if self.program_sharing is not None else ""
        title = join_messages("  ·  ", filter(None, (tr("SHARED PROGRAMS"), where, waiting)))
        return TableContent(
            title,
            ("PROGRAM", "STATE", "BY", "SAVED", "AVAILABLE ON"),
            (0.24, 0.26, 0.14, 0.16, 0.2),
            rows,
            self.selected_row if rows else -1,
            notes=tuple(notes),
            untranslated_columns=frozenset({0, 2, 3, 4}),
        )

    def _silence(self) -> str:
        """Return a message if the shared location has not responded for long, or an empty string."""
        seconds = self.get_waiting_time_s()
        if self.program_sharing is None or seconds < _PATIENCE:
            return ""
        words = tr("{name}: NO RESPONSE FOR {seconds} S. PROGRAMS STAY LOCAL FOR NOW")
        return tr(Message(words, name=self.program_sharing.location.name, seconds=f"{seconds:.0f}"))

    def _row(self, key: str, family: ProgramVersions) -> TableRow:
        state = self.last_result.states_by_program[key]
        words, tone = _STATES[state]
        here = family.versions.get(family.local_version_id)
        shown = family.newest_remote_versions[0] if family.newest_remote_versions else here
        if shown is None:
            return TableRow((NO_VALUE,) * 5)
        on = ", ".join(self.last_result.find_machines_with_version(shown.id)) or NO_VALUE
        saved = format_local_time(shown.saved, with_seconds=False)
        return TableRow(((here or shown).program, words, shown.desk, saved, on), state != "same", tone)

    def prompt_text(self) -> str:
        """Return the prompt that explains the current keys."""
        if self.program_sharing is None:
            return NO_LOCATION_MESSAGE
        if self.selected_version is None:
            return "UP/DOWN: SELECT PROGRAM   F5: REFRESH   ESC: AUTOMATIC"
        if not self._both:
            return "F2: USE SELECTED VERSION (ASKS FIRST)   ESC: AUTOMATIC"
        return "F2: USE SELECTED VERSION   F3: KEEP LOCAL VERSION   ESC: BACK"

    # --- keys ----------------------------------------------------------------------------------------

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys of the page. Keys that currently have no effect are disabled."""
        return {
            "F2": FunctionKey(
                "USE",
                self.copy_version,
                barred=self.selected_version is None or self.selected_program is None,
            ),
            "F3": FunctionKey("KEEP", self.keep_local_version, barred=not self._both),
            "F4": FunctionKey("VERSION", self.select_next_version),
            "F5": FunctionKey("REFRESH", self.start_synchronization, barred=self.program_sharing is None),
        }

    def copy_version(self) -> None:
        """Copy the selected version into the program folder.

        If the copy would replace a program, the operator must confirm.
        """
        version, here = self.selected_version, self.selected_program
        if version is None or here is None:
            self.desk.say(SELECT_PROGRAM_MESSAGE if here is None else "NO OTHER CONTROL HAS A NEWER VERSION")
        elif self.desk.is_refused(ProtectedChange.PROGRAMS):
            return
        elif why := self._silence() or self._find_use_refusal(version.program_key):
            self.desk.say(why)
        elif here[1].local_version_id:
            words = tr("Y: USE {name} FROM {desk} (LOCAL VERSION STAYS STORED)   N: CANCEL")
            self.desk.ask_operator(
                tr(Message(words, name=version.program, desk=version.desk)), lambda: self._take(version)
            )
        else:
            self._take(version)

    def _take(self, version: SharedVersion) -> None:
        # The program was started or the access level has expired in the meantime.
        why = self._find_use_refusal(version.program_key) or self.desk.user_access.find_refusal_reason(
            ProtectedChange.PROGRAMS
        )
        if why or self.program_sharing is None:
            self.desk.say(why)
            return
        sharing = self.program_sharing
        done = tr(
            Message("{name} IS NOW THE VERSION FROM {machine}", name=version.program, machine=version.desk)
        )
        change = Message(
            "program {program}: version from {machine} now in use",
            program=version.program,
            machine=version.desk,
        )
        self._work(lambda: sharing.copy_version(version), done, change)

    @property
    def _both(self) -> bool:
        """Return whether both this machine and another machine have changed the selected program."""
        here = self.selected_program
        return here is not None and self.last_result.states_by_program.get(here[0]) == "both"

    def keep_local_version(self) -> None:
        """Resolve the version conflict in favor of the local version, after the operator confirms."""
        here = self.selected_program
        if here is None or not self._both:
            self.desk.say("NO DECISION NEEDED: NO OTHER CONTROL HAS CHANGED THIS PROGRAM")
            return
        if self.desk.is_refused(ProtectedChange.PROGRAMS):
            return
        key, name = here[0], here[1].versions[here[1].local_version_id].program
        words = tr("Y: KEEP LOCAL {name}, STORE OTHER VERSIONS   N: CANCEL")
        self.desk.ask_operator(tr(Message(words, name=name)), lambda: self._keep(key, name))

    def _keep(self, key: str, name: str) -> None:
        if self.program_sharing is not None and not self.desk.is_refused(ProtectedChange.PROGRAMS):
            sharing = self.program_sharing
            said = tr(Message("{name}: LOCAL VERSION RETAINED", name=name))
            self._work(
                lambda: sharing.resolve_with_local_version(key),
                said,
                Message("program {name}: local version retained", name=name),
            )

    def _work(self, work: Callable[[], object], words: str, change: str) -> None:
        if self.worker.is_busy or self._silence():
            self.desk.say(self._silence() or BUSY_MESSAGE)
            return

        who = (
            self.desk.user_access.history_user_name
        )  # the user of the request, even if another user signs in

        def report_success(_answer: object) -> None:
            self.desk.show_success(words)
            self.desk.user_access.persistence.log_change(change, who)
            self.synchronize_now()

        self.worker.enqueue_work(work, report_success, self.desk.show_refusal)

    def _find_use_refusal(self, key: str) -> str:
        """Return the reason why a program must not be replaced now, or else an empty string.

        A program must not be replaced while it is running, also as a subprogram, or while its run is
        interrupted.
        """
        snapshot, loaded = self.desk.read_snapshot(), self.desk.program_loader.loaded_program
        if snapshot.interrupted is not None and make_program_key(snapshot.interrupted.program) == key:
            words = tr("{name} WAS INTERRUPTED. FINISH OR CANCEL THE RUN FIRST")
            return tr(Message(words, name=snapshot.interrupted.program))
        names = [Path(snapshot.program).name, loaded.name]
        if loaded.source is not None:
            names += [each.name for each in loaded.source.subprograms]
        used = next((name for name in names if make_program_key(name) == key), "")
        if used and snapshot.state in ACTIVE_STATES:
            return tr(Message("{name} IS RUNNING. LET IT FINISH FIRST", name=used))
        return ""

    def select_next_version(self) -> None:
        """Select the next version if several other machines have changed the program."""
        count = len(self.remote_versions.rows)
        if count:
            self.desk.clear_prompt_line()
            self.remote_versions.mark((self.remote_versions.marked + 1) % count)

    def start_synchronization(self) -> None:
        """Start a synchronization now, or show the reason why this is not possible."""
        if self.program_sharing is None:
            self.desk.say(NO_LOCATION_MESSAGE)
        elif self._silence():
            self.desk.say(self._silence())
        else:
            self.desk.show_success("CHECKING …")
            self.synchronize_now()

    def handle_key(self, key: str) -> bool:
        """Handle a key and return whether it was used.

        The arrow keys select a program. Enter copies the selected version.
        """
        if key in ROW_STEPS and self.shared_programs:
            self.select_row(self.selected_row + ROW_STEPS[key])
        elif key == "Enter":
            self.copy_version()
        else:
            return False
        return True

    def accepts_key(self, _key: str) -> bool:
        """Return False because this page has no entry field."""
        return False

    def select_row(self, row: int) -> None:
        """Select a program by its row."""
        self.desk.clear_prompt_line()
        self.selected_row = max(0, min(len(self.shared_programs) - 1, row))

    def on_open(self) -> None:
        """Start a synchronization when the page opens."""
        self.synchronize_now()

    def handle_escape(self) -> bool:
        """Clear the message on the prompt line.

        Return False if there is no message, so the page can close.
        """
        if not self.desk.prompt_notice:
            return False
        self.desk.clear_prompt_line()
        return True

    def on_close(self) -> None:
        """Do nothing, because the page has no work to cancel."""

    def close(self) -> None:
        """Stop the worker after the pending changes have been processed."""
        self.worker.close()

"""Import and export of programs through folders and USB sticks.

An existing program is replaced only with permission, and its text is first archived as a version. A copy is
reported as done only after it has been written to the disk and verified.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import ROW_STEPS, FunctionKey, TableContent
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import AcceptsName, is_program_name
from app.desk.translation import tr
from app.programs.atomic_files import (
    FileOperationError,
    copy_to_medium,
    flush_folder,
    read_file_if_exists,
    write_program_file,
)
from app.programs.program_commands import COMMAND_IN_PROGRESS, add_missing_extension, find_matching_file_name
from app.programs.removable_media import FolderChooser, TargetMedium, describe_media_error, make_chooser_table
from core.access.access_table import ProtectedChange
from core.input_file import TooLargeError, read_input_bytes
from core.language.source import SourceError, load_source
from core.message import Message
from core.store.store_errors import StoreError

MAX_FILE_BYTES = 50_000_000  # bytes; programs are smaller

ReportProgress = Callable[[int, int], None]  # arguments: number of finished programs, total
CheckProgram = Callable[[Path], str]  # returns the first error of a program, or an empty string
OPEN_LOCATION_FIRST = "OPEN A LOCATION FIRST   ARROWS: SELECT   ENTER: OPEN"


# --- file operations on a worker ---------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class TransferResult:
    """Result of an import or export.

    It contains the copied names, the names that exist with different content, and the errors of the proof.
    """

    copied_names: tuple[str, ...] = ()
    conflicting_names: tuple[str, ...] = ()
    proof_errors: tuple[str, ...] = ()


def import_programs(
    sources: Sequence[Path],
    folder: Path,
    persistence: Persistence,
    check_program: CheckProgram,
    *,
    may_overwrite: bool,
    is_drawing: AcceptsName = lambda _name: False,
    report_progress: ReportProgress = lambda _done, _of: None,
) -> TransferResult:
    """Copy programs into the operator's folder, and prove each of them.

    Drawings are copied but not proved. If a program with the same name and other content exists, nothing is
    copied unless ``may_overwrite`` is True. Raise FileOperationError on failure.
    """
    texts = {
        add_missing_extension(path.name, path, lambda name: is_program_name(name) or is_drawing(name)): (
            _bytes(path) if is_drawing(path.name) else _read_program(path)
        )
        for path in sources
    }
    differing = _find_different(texts, folder)
    if differing and not may_overwrite:
        return TransferResult(conflicting_names=differing)
    found = []
    for number, (name, text) in enumerate(texts.items()):
        report_progress(number, len(texts))
        target = folder / (find_matching_file_name(folder, name) or name)
        _keep_old(target, persistence, text)
        write_program_file(target, text)
        if not is_drawing(target.name) and (problem := check_program(target)):
            found.append(Message("{target}: {problem}", target=target.name, problem=problem))
    return TransferResult(tuple(texts), (), tuple(found))


def export_programs(
    sources: Sequence[Path],
    folder: Path,
    *,
    may_overwrite: bool,
    medium: TargetMedium | None = None,
    report_progress: ReportProgress = lambda _done, _of: None,
) -> TransferResult:
    """Copy programs to a folder or USB stick, and return after they have been written to the medium.

    ``medium`` is the medium that was present when the folder was opened. Another medium is rejected. If a
    different program with the same name exists, nothing is copied unless ``may_overwrite`` is True. Raise
    FileOperationError on failure.
    """
    texts = {path.name: _bytes(path) for path in sources}
    medium = medium or TargetMedium.from_folder(folder)
    medium.check_medium_present()
    differing = _find_different(texts, folder)
    if differing and not may_overwrite:
        return TransferResult(conflicting_names=differing)
    medium.check_free_space(sum(map(len, texts.values())))
    for number, (name, text) in enumerate(texts.items()):
        report_progress(number, len(texts))
        with _copy_context(medium, number, len(texts)):
            medium.check_medium_present()
            copy_to_medium(folder / (find_matching_file_name(folder, name) or name), text)
    with _copy_context(medium, 0, len(texts)):
        flush_folder(folder)
        medium.check_medium_present()
    return TransferResult(tuple(texts))


@contextmanager
def _copy_context(medium: TargetMedium, count: int, total: int) -> Iterator[None]:
    """Convert a USB stick error into an operator message with the number of programs copied so far."""
    try:
        yield
    except FileOperationError as error:
        cause = error.__cause__
        why = describe_media_error(cause, medium.folder) if isinstance(cause, OSError) else str(error)
        copied = Message("{done} OF {total} PROGRAMS COPIED", done=count, total=total)
        raise FileOperationError(Message("{copied}: {why}", copied=copied, why=why)) from error


def _read_program(path: Path) -> bytes:
    """Return the bytes of a file if it is a valid program text.

    Raise FileOperationError otherwise.
    """
    data = _bytes(path)
    try:
        load_source(path)
    except SourceError as error:
        raise FileOperationError(
            Message("{path} IS NOT A PROGRAM: {error}", path=path.name, error=error)
        ) from error
    return data


def _bytes(path: Path) -> bytes:
    try:
        return read_input_bytes(path, MAX_FILE_BYTES)
    except TooLargeError as error:
        raise FileOperationError(
            Message(
                "{path} IS TOO LARGE FOR A PROGRAM (LIMIT {largest} MB)",
                path=path.name,
                largest=MAX_FILE_BYTES // 1000000,
            )
        ) from error
    except OSError as error:
        raise FileOperationError(
            Message("{path} CANNOT BE READ: {cause}", path=path.name, cause=error.strerror)
        ) from error


def _find_different(texts: dict[str, bytes], folder: Path) -> tuple[str, ...]:
    """Return the names of programs that already exist in the folder with a different text."""
    found = []
    for name, text in texts.items():
        other = find_matching_file_name(folder, name)
        if other and _bytes(folder / other) != text:
            found.append(other)
    return tuple(found)


def _keep_old(target: Path, persistence: Persistence, text: bytes) -> None:
    try:
        old = read_file_if_exists(target)
        if old is not None and old != text:
            persistence.save_version(target.name, old, "program replaced by an import")
    except (StoreError, FileOperationError) as error:
        raise FileOperationError(
            Message(
                "{target} NOT REPLACED. ITS OLD VERSION CANNOT BE SAVED: {error}",
                target=target.name,
                error=error,
            )
        ) from error


# --- folder chooser and result ----------------------------------------------------------------------------


@dataclass(slots=True)
class ProgramTransfer:
    """Import and export of programs through a folder chooser.

    ``check_program`` proves an imported program. ``on_finished`` is called when the program list must be
    read again.
    """

    desk: Desk
    operator_folder: Path
    persistence: Persistence
    worker: LatestRequestWorker
    check_program: CheckProgram
    folder_chooser: FolderChooser
    on_finished: Callable[[], None] = field(default=lambda: None)
    is_open: bool = False
    is_exporting: bool = False
    listed_paths: tuple[Path, ...] = ()  # programs of the list
    selected_path: Path | None = None  # selected program of the list
    _asked: tuple[Path, ...] = ()  # programs that are being copied
    _at: Path = Path()  # target folder
    _done_of: tuple[int, int] = (0, 0)  # finished and total programs, as reported by the worker

    def open_chooser(
        self, listed_paths: tuple[Path, ...], selected_path: Path | None, is_export: bool
    ) -> None:
        """Open the folder chooser with the list of locations."""
        if not is_export and self.desk.is_refused(ProtectedChange.PROGRAMS):
            return
        self.is_open, self.is_exporting, self.listed_paths, self.selected_path = (
            True,
            is_export,
            listed_paths,
            selected_path,
        )
        self._asked = ()
        self.folder_chooser.current_folder = self.folder_chooser.top_folder = None
        self.folder_chooser.selected_row = 0
        self._look()

    def close_chooser(self) -> None:
        """Close the folder chooser, and discard an unanswered question."""
        self.is_open, self._asked = False, ()

    def _look(self) -> None:
        self.worker.enqueue_work(
            self.folder_chooser.list_entries, self.folder_chooser.show_entries, self._unread
        )

    def _unread(self, why: str) -> None:
        self.desk.show_refusal(why)
        self.folder_chooser.current_folder = self.folder_chooser.top_folder = None
        self.worker.enqueue_work(
            self.folder_chooser.list_entries, self.folder_chooser.show_entries, self.desk.say
        )

    def make_table(self) -> TableContent:
        """Return the table of the open folder."""
        name = self.selected_path.name if self.selected_path else ""
        return make_chooser_table(
            self.folder_chooser, Message("EXPORT {name}", name=name) if self.is_exporting else "IMPORT"
        )

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function keys for copying and refreshing."""
        if self.is_exporting:
            return {
                "F2": FunctionKey("REFRESH", self._look),
                "F4": FunctionKey("COPY ONE", self._one_here),
                "F5": FunctionKey("COPY ALL", lambda: self._send(self.listed_paths)),
            }
        return {
            "F2": FunctionKey("REFRESH", self._look),
            "F5": FunctionKey("ALL", lambda: self._send(self.folder_chooser.program_paths)),
        }

    def handle_key(self, key: str) -> bool:
        """Handle a key of the folder chooser.

        Arrow keys select a line, and Enter opens a folder or imports a program.
        """
        if key in ROW_STEPS:
            self.select_entry(self.folder_chooser.selected_row + ROW_STEPS[key])
        elif key == "Enter":
            self._enter()
        else:
            return False
        return True

    def select_entry(self, row: int) -> None:
        """Select a line of the chooser."""
        self._asked = ()
        self.desk.clear_prompt_line()
        self.folder_chooser.selected_row = max(0, min(len(self.folder_chooser.listed_entries) - 1, row))

    def handle_entry_touch(self, row: int) -> None:
        """Select the touched line of the chooser.

        A touch on the line that is already selected acts like Enter.
        """
        if row == self.folder_chooser.selected_row:
            self._enter()
        else:
            self.select_entry(row)

    def _enter(self) -> None:
        line = self.folder_chooser.selected_entry
        if line is None:
            return
        if line.is_folder:
            self._asked = ()
            self.desk.clear_prompt_line()
            self.folder_chooser.open_entry(line)
            self._look()
        elif self.is_exporting:
            self.desk.say("F4: EXPORT TO THE OPEN FOLDER   ENTER: OPEN A FOLDER")
        else:
            self._send((line.path,))

    def _one_here(self) -> None:
        if self.selected_path is not None:
            self._send((self.selected_path,))

    def handle_escape(self) -> None:
        """Go back to the list of locations, or close the chooser."""
        if self.folder_chooser.current_folder is None:
            self.close_chooser()
        else:
            self.folder_chooser.current_folder = self.folder_chooser.top_folder = None
            self._look()
        self._asked = ()

    def _send(self, paths: tuple[Path, ...]) -> None:
        if self.worker.is_busy:
            self.desk.say(COMMAND_IN_PROGRESS)
        elif self.folder_chooser.current_folder is None:
            self.desk.say(OPEN_LOCATION_FIRST)
        elif not paths:
            self.desk.say("NO PROGRAMS IN THIS FOLDER")
        else:
            self._carry(paths, self.folder_chooser.current_folder, replace=False)

    def _carry(self, paths: tuple[Path, ...], at: Path, *, replace: bool) -> None:
        if self.worker.is_busy:
            self.desk.say(COMMAND_IN_PROGRESS)
            return
        if not self.is_exporting and self.desk.is_refused(ProtectedChange.PROGRAMS):
            return  # The access level may have expired since the chooser was opened.
        self._asked = paths
        self._at = at
        self._done_of = (0, len(paths))
        self.desk.clear_prompt_line()
        report_progress = self._update_progress
        if self.is_exporting:
            work = partial(
                export_programs,
                paths,
                at,
                may_overwrite=replace,
                medium=self.folder_chooser.medium,
                report_progress=report_progress,
            )
        else:
            work = partial(
                import_programs,
                paths,
                self.operator_folder,
                self.persistence,
                self.check_program,
                may_overwrite=replace,
                is_drawing=self.desk.program_choice.program_folders.is_drawing_name,
                report_progress=report_progress,
            )
        self.worker.enqueue_work(
            partial(self._run_transfer, work, self.folder_chooser.medium), self._done, self._failed
        )

    def _update_progress(self, done: int, total: int) -> None:
        """Store the progress of the transfer, which the prompt line shows. The worker calls this."""
        self._done_of = (done, total)

    @staticmethod
    def _run_transfer(work: Callable[[], TransferResult], medium: TargetMedium | None) -> TransferResult:
        """Run a transfer on the worker, and report an unplugged USB stick as the cause of a failure.

        Raise FileOperationError on failure.
        """
        try:
            return work()
        except FileOperationError:
            if medium is not None:
                medium.check_medium_present()
            raise

    def _done(self, carried: TransferResult) -> None:
        self._done_of = (0, 0)
        if carried.conflicting_names:
            names = ", ".join(carried.conflicting_names[:3]) + (
                " …" if len(carried.conflicting_names) > 3 else ""
            )
            asked = tr("EXISTS WITH DIFFERENT CONTENT: {names}. Y: REPLACE   N: KEEP")
            again = partial(self._carry, self._asked, self._at, replace=True)
            self.desk.ask_operator(tr(Message(asked, names=names)), again)
            return
        self._asked = ()
        count = len(carried.copied_names)
        if not self.is_exporting:
            self.persistence.log_change(
                Message("programs imported: {done}", done=", ".join(carried.copied_names))
            )
        if self.is_exporting:
            words = tr(
                Message(
                    "COPIED AND VERIFIED: {count}. YOU CAN REMOVE THE USB STICK",
                    count=count,
                )
            )
        elif carried.proof_errors:
            words = tr(
                Message(
                    "PROGRAMS IMPORTED: {count}. AT LEAST ONE HAS ERRORS: {value}",
                    count=count,
                    value=carried.proof_errors[0],
                )
            )
        else:
            words = tr(Message("PROGRAMS IMPORTED AND PROVED WITHOUT ERRORS: {count}", count=count))
        (self.desk.say if carried.proof_errors else self.desk.show_success)(words)
        self._look()
        self.on_finished()

    def _failed(self, why: str) -> None:
        self._asked, self._done_of = (), (0, 0)
        self.on_finished()
        self.desk.show_refusal(why)

    def prompt_text(self) -> str:
        """Return the prompt, or the progress during a transfer."""
        done, of = self._done_of
        if of:
            words = tr("COPYING PROGRAM {number} OF {of}. DO NOT REMOVE THE USB STICK")
            return tr(Message(words, number=min(done + 1, of), of=of))
        if self.is_exporting:
            return "ENTER: OPEN   F4: COPY FILE HERE   F5: COPY ALL   ESC: BACK"
        return "ENTER: OPEN FOLDER OR IMPORT   F5: IMPORT ALL   ESC: BACK"

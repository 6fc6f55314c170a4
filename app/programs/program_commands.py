"""Commands that copy, rename and delete programs, with a name entry or a confirmation.

A worker changes the files. Files are never overwritten.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import InputField
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import PROGRAM_EXTENSIONS, AcceptsName, is_program_name
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.translation import tr
from app.programs.atomic_files import FileOperationError, read_file_if_exists, write_program_file
from app.programs.program_rows import ListedFile
from core.access.access_table import ProtectedChange
from core.message import Message
from core.store.program_records import check_new_program_name
from core.store.store_errors import StoreError

SAMPLE_READ_ONLY = "SAMPLES ARE READ-ONLY. F4: COPY THE SAMPLE FIRST"
NO_SELECTION = "SELECT A PROGRAM FIRST"
COMMAND_IN_PROGRESS = "STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE"
COPY, RENAME = "NAME FOR THE COPY?", "NEW NAME?"


def add_missing_extension(
    name: str, reference_name: Path, accepts_name: AcceptsName = is_program_name
) -> str:
    """Return ``name`` without surrounding blanks, with an extension that ``accepts_name`` accepts.

    The extension of ``reference_name`` is added if ``name`` has no extension or an extension that is not
    accepted. Raise FileOperationError for an invalid name.
    """
    name = name.strip()
    if not name:
        raise FileOperationError("TYPE A NAME FIRST")
    if not Path(name).suffix or not accepts_name(name):
        name += reference_name.suffix
    try:
        check_new_program_name(name)
    except StoreError as error:
        raise FileOperationError(str(error)) from error
    if name.startswith("."):
        raise FileOperationError(
            Message("{name} WOULD BE HIDDEN. USE A NAME WITHOUT A LEADING PERIOD", name=name)
        )
    return name


def remove_extension(name: str) -> str:
    """Return a program name without its extension.

    Return the whole name if the rest would itself end in a program extension.
    """
    left = Path(name).stem
    return name if Path(left).suffix.lower() in PROGRAM_EXTENSIONS - {""} else left


def find_matching_file_name(folder: Path, name: str) -> str:
    """Return the name of a file in the folder that differs from a name at most in letter case.

    Return an empty string if there is no such file.
    """
    try:
        names = [path.name for path in folder.iterdir()]
    except OSError:
        return ""
    return next((other for other in names if other.lower() == name.lower()), "")


def copy_program(source: Path, folder: Path, name: str, accepts_name: AcceptsName = is_program_name) -> str:
    """Copy a program to the operator's folder, and return its name.

    Raise FileOperationError on failure.
    """
    name = add_missing_extension(name, source, accepts_name)
    _free(folder, name)
    write_program_file(folder / name, _read(source))
    return name


def rename_program(
    source: Path, name: str, persistence: Persistence, accepts_name: AcceptsName = is_program_name
) -> str:
    """Rename a program with its versions, part count and run record, and return the new name.

    Raise FileOperationError on failure. If only the store fails, the file already has its new name, and the
    versions, part count and run record remain under the old name.
    """
    name = add_missing_extension(name, source, accepts_name)
    if name == source.name:
        raise FileOperationError(Message("THE PROGRAM IS ALREADY NAMED {name}", name=name))
    if name.lower() != source.name.lower():
        _free(source.parent, name)
    try:
        source.rename(source.with_name(name))
        persistence.rename_program(source.name, name)
    except OSError as error:
        raise FileOperationError(
            Message("{source} CANNOT BE RENAMED: {cause}", source=source.name, cause=error.strerror)
        ) from error
    except StoreError as error:
        raise FileOperationError(
            Message(
                "PROGRAM RENAMED, BUT ITS VERSIONS REMAIN UNDER THE NAME {source}: {error}",
                source=source.name,
                error=error,
            )
        ) from error
    return name


def delete_program(path: Path, persistence: Persistence) -> str:
    """Archive a program as a version, delete its file, and return the file name.

    Raise FileOperationError if the file no longer exists, or if it cannot be read, archived or deleted. An
    existing file is then unchanged.
    """
    try:
        persistence.save_version(path.name, _read(path), "deleted")
        path.unlink()
    except StoreError as error:
        raise FileOperationError(
            Message("PROGRAM NOT DELETED. ITS CURRENT VERSION CANNOT BE SAVED FIRST: {error}", error=error)
        ) from error
    except OSError as error:
        raise FileOperationError(
            Message("{path} CANNOT BE DELETED: {cause}", path=path.name, cause=error.strerror)
        ) from error
    return path.name


def _free(folder: Path, name: str) -> None:
    if other := find_matching_file_name(folder, name):
        raise FileOperationError(Message("{other} ALREADY EXISTS. USE ANOTHER NAME", other=other))


def _read(path: Path) -> bytes:
    data = read_file_if_exists(path)
    if data is None:
        raise FileOperationError(Message("{path} NO LONGER EXISTS", path=path.name))
    return data


@dataclass(slots=True)
class ProgramCommands:
    """Commands that copy, rename and delete the selected program.

    After the list has been read again, ``on_changed`` is called with the name to select.
    """

    desk: Desk
    operator_folder: Path
    persistence: Persistence
    worker: LatestRequestWorker
    find_selected_program: Callable[[], ListedFile | None]
    on_changed: Callable[[str], None]
    question: str = ""
    name_field: InputField = field(default_factory=lambda: InputField(words=True))

    def ask_for_name(self, question: str) -> None:
        """Ask the operator for the name of a copy, or for the new name of a program."""
        here = self.find_selected_program()
        if here is None:
            self.desk.say(NO_SELECTION)
        elif self.desk.is_refused(ProtectedChange.PROGRAMS):
            return
        elif question == RENAME and self._find_protection(here):
            self.desk.say(self._find_protection(here))
        else:
            self.desk.clear_prompt_line()
            self.question = question
            self.name_field.propose(remove_extension(here.name))

    @property
    def is_protected(self) -> bool:
        """Return whether the selected program cannot be renamed or deleted now."""
        here = self.find_selected_program()
        return here is None or bool(self._find_protection(here))

    def _find_protection(self, program: ListedFile) -> str:
        """Return why a program cannot be changed, or an empty string if it can."""
        if program.is_outside:
            return tr(Message("{name} IS IN ANOTHER FOLDER. F4: COPY IT FIRST", name=program.name))
        if program.is_sample:
            return SAMPLE_READ_ONLY
        found = self.desk.read_snapshot().interrupted
        if found is not None and found.program == program.name:
            words = tr("{name} WAS INTERRUPTED. FINISH OR CANCEL THE RUN FIRST")
            return tr(Message(words, name=program.name))
        state = self.desk.read_snapshot().state
        if state in ACTIVE_STATES and self.desk.program_loader.loaded_program.path == program.path:
            return tr(Message("{name} IS RUNNING. LET IT FINISH FIRST", name=program.name))
        return ""

    def apply_entered_name(self) -> None:
        """Execute the command with the typed name."""
        here, name, question = self.find_selected_program(), self.name_field.text, self.question
        takes = self.desk.program_choice.program_folders.accepts_file_name
        if here is None:
            self.question = ""
        elif self.desk.is_refused(ProtectedChange.PROGRAMS):
            return  # The entry remains until an authorized user has signed in.
        elif question == COPY:
            self._change(
                lambda: copy_program(here.path, self.operator_folder, name, takes), "COPIED AS {name}"
            )
        else:
            self._change(
                lambda: rename_program(here.path, name, self.persistence, takes), "RENAMED TO {name}"
            )

    def confirm_delete(self) -> None:
        """Delete the selected program after the operator confirms.

        Its text remains stored as a version.
        """
        here = self.find_selected_program()
        if here is None or self._find_protection(here):
            self.desk.say(self._find_protection(here) if here else NO_SELECTION)
            return
        if self.desk.is_refused(ProtectedChange.PROGRAMS):
            return
        asked = tr("Y: DELETE {name} (STORED VERSIONS REMAIN)   N: KEEP IT")
        self.desk.ask_operator(tr(Message(asked, name=here.name)), lambda: self._delete(here))

    def _delete(self, program: ListedFile) -> None:
        if self._find_protection(program):  # The program was started in the meantime.
            self.desk.say(self._find_protection(program))
            return
        self._change(
            lambda: delete_program(program.path, self.persistence),
            "{name} DELETED. ITS STORED VERSIONS REMAIN",
        )

    def _change(self, work: Callable[[], str], words: str) -> None:
        if self.worker.is_busy:
            self.desk.say(COMMAND_IN_PROGRESS)
            return

        def report_change(name: str) -> None:
            self.question = ""
            self.desk.show_success(tr(Message(words, name=name)))
            self.persistence.log_change(
                Message("program {words}", words=tr(Message(words, name=name)).lower())
            )
            self.on_changed(name)

        self.worker.enqueue_work(work, report_change, self.desk.show_refusal)

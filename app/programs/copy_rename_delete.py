"""Copying, renaming and deleting programs, with a name entry or a confirmation.

A worker changes the files, and no file is ever overwritten.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Entry
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ENDINGS, Takes, is_program
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.programs.program_rows import Program
from app.programs.whole_file import FileError, present, write_whole
from core.access.access_table import Act
from core.message import Message
from core.store.program_records import check_name
from core.store.store_errors import StoreError

SAMPLE = "SAMPLES ARE READ-ONLY. F4: COPY THE SAMPLE FIRST"
NONE = "SELECT A PROGRAM FIRST"
BUSY = "STILL BUSY. WAIT UNTIL THE LAST COMMAND IS DONE"
COPY, RENAME = "NAME FOR THE COPY?", "NEW NAME?"


def checked_name(name: str, like: Path, takes: Takes = is_program) -> str:
    """Return ``name``, with the extension of ``like`` if it has none.

    Raises FileError for an invalid name.
    """
    name = name.strip()
    if not name:
        raise FileError("TYPE A NAME FIRST")
    if not Path(name).suffix or not takes(name):
        name += like.suffix
    try:
        check_name(name)
    except StoreError as error:
        raise FileError(str(error)) from error
    if name.startswith("."):
        raise FileError(Message("{name} WOULD BE HIDDEN. USE A NAME WITHOUT A LEADING PERIOD", name=name))
    return name


def without_ending(name: str) -> str:
    """Return the name without its extension, or the whole name if the rest ends in another extension."""
    left = Path(name).stem
    return name if Path(left).suffix.lower() in ENDINGS - {""} else left


def same_name_in(folder: Path, name: str) -> str:
    """Return the name of the file that is equal except for case, or an empty string."""
    try:
        names = [path.name for path in folder.iterdir()]
    except OSError:
        return ""
    return next((other for other in names if other.lower() == name.lower()), "")


def copy_program(source: Path, folder: Path, name: str, takes: Takes = is_program) -> str:
    """Copy a program to the operator's folder and return its name. Raises FileError."""
    name = checked_name(name, source, takes)
    _free(folder, name)
    write_whole(folder / name, _read(source))
    return name


def rename_program(source: Path, name: str, persistence: Persistence, takes: Takes = is_program) -> str:
    """Rename a program together with its versions, count and record, and return the name.

    Raises FileError.
    """
    name = checked_name(name, source, takes)
    if name == source.name:
        raise FileError(Message("THE PROGRAM IS ALREADY NAMED {name}", name=name))
    if name.lower() != source.name.lower():
        _free(source.parent, name)
    try:
        source.rename(source.with_name(name))
        persistence.renamed(source.name, name)
    except OSError as error:
        raise FileError(
            Message("{source} CANNOT BE RENAMED: {cause}", source=source.name, cause=error.strerror)
        ) from error
    except StoreError as error:
        raise FileError(
            Message(
                "PROGRAM RENAMED, BUT ITS VERSIONS REMAIN UNDER THE NAME {source}: {error}",
                source=source.name,
                error=error,
            )
        ) from error
    return name


def delete_program(path: Path, persistence: Persistence) -> str:
    """Archive a program as a version and delete its file.

    If FileError is raised, the file still exists.
    """
    try:
        persistence.save_version(path.name, _read(path), "deleted")
        path.unlink()
    except StoreError as error:
        raise FileError(
            Message("PROGRAM NOT DELETED. ITS CURRENT VERSION CANNOT BE SAVED FIRST: {error}", error=error)
        ) from error
    except OSError as error:
        raise FileError(
            Message("{path} CANNOT BE DELETED: {cause}", path=path.name, cause=error.strerror)
        ) from error
    return path.name


def _free(folder: Path, name: str) -> None:
    if other := same_name_in(folder, name):
        raise FileError(Message("{other} ALREADY EXISTS. USE ANOTHER NAME", other=other))


def _read(path: Path) -> bytes:
    data = present(path)
    if data is None:
        raise FileError(Message("{path} NO LONGER EXISTS", path=path.name))
    return data


@dataclass(slots=True)
class CopyRenameDelete:
    """Commands on the selected program.

    ``changed`` is called with the name to select after the list was read again.
    """

    desk: Desk
    own: Path
    persistence: Persistence
    worker: Latest
    marked_program: Callable[[], Program | None]
    changed: Callable[[str], None]
    question: str = ""
    entry: Entry = field(default_factory=lambda: Entry(words=True))

    def ask(self, question: str) -> None:
        """Ask for the name of a copy or the new name."""
        here = self.marked_program()
        if here is None:
            self.desk.say(NONE)
        elif self.desk.refused(Act.PROGRAMS):
            return
        elif question == RENAME and self._fixed(here):
            self.desk.say(self._fixed(here))
        else:
            self.desk.clear()
            self.question = question
            self.entry.offer(without_ending(here.name))

    @property
    def fixed(self) -> bool:
        """Whether the selected program cannot be renamed or deleted now."""
        here = self.marked_program()
        return here is None or bool(self._fixed(here))

    def _fixed(self, program: Program) -> str:
        """Return the reason why a program cannot be changed, or an empty string."""
        if program.sample:
            return SAMPLE
        found = self.desk.snapshot().interrupted
        if found is not None and found.program == program.name:
            words = tr("{name} WAS INTERRUPTED. FINISH OR CANCEL THE RUN FIRST")
            return tr(Message(words, name=program.name))
        state = self.desk.snapshot().state
        if state in UNDER_WAY and self.desk.session.now.path == program.path:
            return tr(Message("{name} IS RUNNING. LET IT FINISH FIRST", name=program.name))
        return ""

    def answer(self) -> None:
        """Execute the command with the typed name."""
        here, name, question = self.marked_program(), self.entry.text, self.question
        takes = self.desk.programs.folders.takes
        if here is None:
            self.question = ""
        elif self.desk.refused(Act.PROGRAMS):
            return  # The entry remains until an authorized user has signed in.
        elif question == COPY:
            self._change(lambda: copy_program(here.path, self.own, name, takes), "COPIED AS {name}")
        else:
            self._change(
                lambda: rename_program(here.path, name, self.persistence, takes), "RENAMED TO {name}"
            )

    def delete(self) -> None:
        """Delete the selected program after confirmation. Its text remains as a version."""
        here = self.marked_program()
        if here is None or self._fixed(here):
            self.desk.say(self._fixed(here) if here else NONE)
            return
        if self.desk.refused(Act.PROGRAMS):
            return
        asked = tr("Y: DELETE {name} (STORED VERSIONS REMAIN)   N: KEEP IT")
        self.desk.ask(tr(Message(asked, name=here.name)), lambda: self._delete(here))

    def _delete(self, program: Program) -> None:
        if self._fixed(program):  # The program was started in the meantime.
            self.desk.say(self._fixed(program))
            return
        self._change(
            lambda: delete_program(program.path, self.persistence),
            "{name} DELETED. ITS STORED VERSIONS REMAIN",
        )

    def _change(self, work: Callable[[], str], words: str) -> None:
        if self.worker.busy:
            self.desk.say(BUSY)
            return

        def done(name: str) -> None:
            self.question = ""
            self.desk.done(tr(Message(words, name=name)))
            self.persistence.note_change(
                Message("program {words}", words=tr(Message(words, name=name)).lower())
            )
            self.changed(name)

        self.worker.queue(work, done, self.desk.refuse)

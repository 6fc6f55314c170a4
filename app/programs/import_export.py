"""Import and export of programs by folder and USB stick.

An existing program is replaced only with permission, and its text is archived as a version first. A copy is
reported as done after it was written to the disk and verified.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import STEPS, Key, Sheet
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import Takes, is_program
from app.desk.translation import tr
from app.programs.copy_rename_delete import BUSY, checked_name, same_name_in
from app.programs.removable_media import FolderChooser, Medium, chooser_sheet, why_not
from app.programs.whole_file import FileError, present, settle, write_out, write_whole
from core.access.access_table import Act
from core.input_file import TooLargeError, input_bytes
from core.language.source import SourceError, load_source
from core.message import Message
from core.store.store_errors import StoreError

LARGEST = 50_000_000  # bytes; programs are smaller

Told = Callable[[int, int], None]  # arguments: number of finished programs, total
Check = Callable[[Path], str]  # returns the first error of a program, or an empty string
PLACE_FIRST = "OPEN A LOCATION FIRST   ARROWS: SELECT   ENTER: OPEN"


# --- file operations on a worker ---------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Carried:
    """Result of a transfer: copied names, existing names with different content, and errors of the proof."""

    done: tuple[str, ...] = ()
    differing: tuple[str, ...] = ()
    findings: tuple[str, ...] = ()


def import_programs(
    sources: Sequence[Path],
    folder: Path,
    persistence: Persistence,
    check: Check,
    *,
    replace: bool,
    is_drawing: Takes = lambda _name: False,
    told: Told = lambda _done, _of: None,
) -> Carried:
    """Copy programs into the operator's folder and prove each of them. Drawings are only copied.

    Nothing is written while a program with the same name and other content exists, unless ``replace`` is set.
    Raises FileError.
    """
    texts = {
        checked_name(path.name, path, lambda name: is_program(name) or is_drawing(name)): (
            _bytes(path) if is_drawing(path.name) else _program(path)
        )
        for path in sources
    }
    differing = _differing(texts, folder)
    if differing and not replace:
        return Carried(differing=differing)
    found = []
    for number, (name, text) in enumerate(texts.items()):
        told(number, len(texts))
        target = folder / (same_name_in(folder, name) or name)
        _keep_old(target, persistence, text)
        write_whole(target, text)
        if not is_drawing(target.name) and (trouble := check(target)):
            found.append(Message("{target}: {problem}", target=target.name, problem=trouble))
    return Carried(tuple(texts), (), tuple(found))


def export_programs(
    sources: Sequence[Path],
    folder: Path,
    *,
    replace: bool,
    medium: Medium | None = None,
    told: Told = lambda _done, _of: None,
) -> Carried:
    """Copy programs to a folder or stick, and return after they are written to the medium.

    ``medium`` is the medium at the time when the folder was opened. Another medium is rejected. Nothing is
    written while a different program with the same name exists, unless ``replace`` is set. Raises FileError.
    """
    texts = {path.name: _bytes(path) for path in sources}
    medium = medium or Medium.of(folder)
    medium.check()
    differing = _differing(texts, folder)
    if differing and not replace:
        return Carried(differing=differing)
    medium.room_for(sum(map(len, texts.values())))
    for number, (name, text) in enumerate(texts.items()):
        told(number, len(texts))
        with _on(medium, number, len(texts)):
            medium.check()
            write_out(folder / (same_name_in(folder, name) or name), text)
    with _on(medium, 0, len(texts)):
        settle(folder)
        medium.check()
    return Carried(tuple(texts))


@contextmanager
def _on(medium: Medium, done: int, of: int) -> Iterator[None]:
    """Convert an error on a stick into a message for the operator, with the number of copied programs."""
    try:
        yield
    except FileError as error:
        cause = error.__cause__
        why = why_not(cause, medium.folder) if isinstance(cause, OSError) else str(error)
        copied = Message("{done} OF {total} PROGRAMS COPIED", done=done, total=of)
        raise FileError(Message("{copied}: {why}", copied=copied, why=why)) from error


def _program(path: Path) -> bytes:
    """Return the bytes of a file that is a valid program text. Raises FileError otherwise."""
    data = _bytes(path)
    try:
        load_source(path)
    except SourceError as error:
        raise FileError(Message("{path} IS NOT A PROGRAM: {error}", path=path.name, error=error)) from error
    return data


def _bytes(path: Path) -> bytes:
    try:
        return input_bytes(path, LARGEST)
    except TooLargeError as error:
        raise FileError(
            Message(
                "{path} IS TOO LARGE FOR A PROGRAM (LIMIT {largest} MB)",
                path=path.name,
                largest=LARGEST // 1000000,
            )
        ) from error
    except OSError as error:
        raise FileError(
            Message("{path} CANNOT BE READ: {cause}", path=path.name, cause=error.strerror)
        ) from error


def _differing(texts: dict[str, bytes], folder: Path) -> tuple[str, ...]:
    """Return the names of programs that exist in the folder with another text."""
    found = []
    for name, text in texts.items():
        other = same_name_in(folder, name)
        if other and _bytes(folder / other) != text:
            found.append(other)
    return tuple(found)


def _keep_old(target: Path, persistence: Persistence, text: bytes) -> None:
    try:
        old = present(target)
        if old is not None and old != text:
            persistence.save_version(target.name, old, "program replaced by an import")
    except (StoreError, FileError) as error:
        raise FileError(
            Message(
                "{target} NOT REPLACED. ITS OLD VERSION CANNOT BE SAVED: {error}",
                target=target.name,
                error=error,
            )
        ) from error


# --- folder chooser and result ----------------------------------------------------------------------------


@dataclass(slots=True)
class ImportExport:
    """Import and export through a folder chooser.

    ``check`` proves an imported program, and ``finished`` is called when the list must be read again.
    """

    desk: Desk
    own: Path
    persistence: Persistence
    worker: Latest
    check: Check
    chooser: FolderChooser
    finished: Callable[[], None] = field(default=lambda: None)
    open: bool = False
    out: bool = False
    all: tuple[Path, ...] = ()  # programs of the list
    one: Path | None = None  # selected program of the list
    _asked: tuple[Path, ...] = ()  # programs that are being copied
    _at: Path = Path()  # target folder
    _done_of: tuple[int, int] = (0, 0)  # finished and total programs, as reported by the worker

    def begin(self, shown: tuple[Path, ...], marked: Path | None, out: bool) -> None:
        """Open the chooser at the list of places."""
        if not out and self.desk.refused(Act.PROGRAMS):
            return
        self.open, self.out, self.all, self.one = True, out, shown, marked
        self._asked = ()
        self.chooser.at = self.chooser.top = None
        self.chooser.marked = 0
        self._look()

    def shut(self) -> None:
        """Close the chooser."""
        self.open, self._asked = False, ()

    def _look(self) -> None:
        self.worker.queue(self.chooser.look, self.chooser.show_lines, self._unread)

    def _unread(self, why: str) -> None:
        self.desk.refuse(why)
        self.chooser.at = self.chooser.top = None
        self.worker.queue(self.chooser.look, self.chooser.show_lines, self.desk.say)

    def sheet(self) -> Sheet:
        """Return the table of the open folder."""
        name = self.one.name if self.one else ""
        return chooser_sheet(self.chooser, Message("EXPORT {name}", name=name) if self.out else "IMPORT")

    def keys(self) -> Mapping[str, Key]:
        """Return the function keys for copying and refreshing."""
        if self.out:
            return {
                "F2": Key("REFRESH", self._look),
                "F4": Key("COPY ONE", self._one_here),
                "F5": Key("COPY ALL", lambda: self._send(self.all)),
            }
        return {"F2": Key("REFRESH", self._look), "F5": Key("ALL", lambda: self._send(self.chooser.programs))}

    def typed(self, key: str) -> bool:
        """Handle a key: arrows select a line, and Enter opens a folder or imports a program."""
        if key in STEPS:
            self.choose(self.chooser.marked + STEPS[key])
        elif key == "Enter":
            self._enter()
        else:
            return False
        return True

    def choose(self, row: int) -> None:
        """Select a line."""
        self._asked = ()
        self.desk.clear()
        self.chooser.marked = max(0, min(len(self.chooser.lines) - 1, row))

    def touch(self, row: int) -> None:
        """Select the touched line. A touch on the selected line acts like Enter."""
        if row == self.chooser.marked:
            self._enter()
        else:
            self.choose(row)

    def _enter(self) -> None:
        line = self.chooser.marked_line
        if line is None:
            return
        if line.folder:
            self._asked = ()
            self.desk.clear()
            self.chooser.go(line)
            self._look()
        elif self.out:
            self.desk.say("F4: EXPORT TO THE OPEN FOLDER   ENTER: OPEN A FOLDER")
        else:
            self._send((line.path,))

    def _one_here(self) -> None:
        if self.one is not None:
            self._send((self.one,))

    def escape(self) -> None:
        """Go back to the list of places, or close the chooser."""
        if self.chooser.at is None:
            self.shut()
        else:
            self.chooser.at = self.chooser.top = None
            self._look()
        self._asked = ()

    def _send(self, paths: tuple[Path, ...]) -> None:
        if self.worker.busy:
            self.desk.say(BUSY)
        elif self.chooser.at is None:
            self.desk.say(PLACE_FIRST)
        elif not paths:
            self.desk.say("NO PROGRAMS IN THIS FOLDER")
        else:
            self._carry(paths, self.chooser.at, replace=False)

    def _carry(self, paths: tuple[Path, ...], at: Path, *, replace: bool) -> None:
        if self.worker.busy:
            self.desk.say(BUSY)
            return
        if not self.out and self.desk.refused(Act.PROGRAMS):
            return  # The access level may have expired since the chooser was opened.
        self._asked = paths
        self._at = at
        self._done_of = (0, len(paths))
        self.desk.clear()
        told = self._count
        if self.out:
            work = partial(export_programs, paths, at, replace=replace, medium=self.chooser.medium, told=told)
        else:
            work = partial(
                import_programs,
                paths,
                self.own,
                self.persistence,
                self.check,
                replace=replace,
                is_drawing=self.desk.programs.folders.is_drawing,
                told=told,
            )
        self.worker.queue(partial(self._carried, work, self.chooser.medium), self._done, self._failed)

    def _count(self, done: int, of: int) -> None:
        """Store the progress for the prompt line; called by the worker."""
        self._done_of = (done, of)

    @staticmethod
    def _carried(work: Callable[[], Carried], medium: Medium | None) -> Carried:
        """Run a transfer on the worker. A missing stick is reported as the cause of a failure.

        Raises FileError.
        """
        try:
            return work()
        except FileError:
            if medium is not None:
                medium.check()
            raise

    def _done(self, carried: Carried) -> None:
        self._done_of = (0, 0)
        if carried.differing:
            names = ", ".join(carried.differing[:3]) + (" …" if len(carried.differing) > 3 else "")
            asked = tr("EXISTS WITH DIFFERENT CONTENT: {names}. Y: REPLACE   N: KEEP")
            again = partial(self._carry, self._asked, self._at, replace=True)
            self.desk.ask(tr(Message(asked, names=names)), again)
            return
        self._asked = ()
        count = len(carried.done)
        if not self.out:
            self.persistence.note_change(Message("programs imported: {done}", done=", ".join(carried.done)))
        if self.out:
            words = tr(
                Message(
                    "COPIED AND VERIFIED: {count}. YOU CAN REMOVE THE USB STICK",
                    count=count,
                )
            )
        elif carried.findings:
            words = tr(
                Message(
                    "PROGRAMS IMPORTED: {count}. AT LEAST ONE HAS ERRORS: {value}",
                    count=count,
                    value=carried.findings[0],
                )
            )
        else:
            words = tr(Message("PROGRAMS IMPORTED AND PROVED WITHOUT ERRORS: {count}", count=count))
        (self.desk.say if carried.findings else self.desk.done)(words)
        self._look()
        self.finished()

    def _failed(self, why: str) -> None:
        self._asked, self._done_of = (), (0, 0)
        self.finished()
        self.desk.refuse(why)

    def prompt(self) -> str:
        """Return the prompt, or the progress during a transfer."""
        done, of = self._done_of
        if of:
            words = tr("COPYING PROGRAM {number} OF {of}. DO NOT REMOVE THE USB STICK")
            return tr(Message(words, number=min(done + 1, of), of=of))
        if self.out:
            return "ENTER: OPEN   F4: COPY FILE HERE   F5: COPY ALL   ESC: BACK"
        return "ENTER: OPEN FOLDER OR IMPORT   F5: IMPORT ALL   ESC: BACK"

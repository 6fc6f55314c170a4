"""Copying, renaming and deleting the marked program: a name is asked for, or whether it is meant."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from app.desk import prompt_line
from app.desk.latest import Latest
from app.desk.persistence import Persistence
from app.desk.program_folder import ProgramFolders
from app.desk.program_loading import Loaded
from app.desk.sheet import Entry
from app.desk.translation import tr
from app.programs import file_changes
from app.programs.program_rows import Program
from core.executor.snapshot import Snapshot

UNDER_WAY = prompt_line.MOVING | prompt_line.INTERRUPTED
SAMPLE = "A SAMPLE IS LEFT AS IT IS: COPY IT FIRST (F4)"
NONE = "NO PROGRAM IS MARKED"
BUSY = "STILL AT IT: WAIT UNTIL IT IS DONE"
COPY, RENAME = "NAME OF THE COPY?", "NEW NAME?"


class FilesHost(Protocol):
    """What the list needs of the desk."""

    notice: str
    shelf: ProgramFolders

    def say(self, text: str) -> None: ...

    def ask(self, question: str, yes: Callable[[], None]) -> None: ...

    def clear(self) -> None: ...

    def snapshot(self) -> Snapshot: ...

    def choose(self, typed: str) -> bool: ...

    def may_choose(self) -> bool: ...


@dataclass(slots=True)
class Changer:
    """``here`` is the marked program; ``changed`` is told the name to mark when the list is read again."""

    desk: FilesHost
    own: Path
    keep: Persistence
    worker: Latest
    loaded: Callable[[], Loaded]
    here: Callable[[], Program | None]
    changed: Callable[[str], None]
    question: str = ""
    entry: Entry = field(default_factory=lambda: Entry(words=True))

    def ask(self, question: str) -> None:
        """Ask for the name of a copy, or for another name."""
        here = self.here()
        if here is None:
            self.desk.say(NONE)
        elif question == RENAME and self._fixed(here):
            self.desk.say(self._fixed(here))
        else:
            self.desk.clear()
            self.question, self.entry.text = question, here.name

    def _fixed(self, program: Program) -> str:
        """Why a program stays as it is; empty when it may be changed."""
        if program.sample:
            return SAMPLE
        found = self.desk.snapshot().interrupted
        if found is not None and found.program == program.name:
            words = tr("{name} IS INTERRUPTED: FINISH IT, OR GIVE IT UP, FIRST")
            return words.format(name=program.name)
        state = self.desk.snapshot().state
        if state in UNDER_WAY and self.loaded().path == program.path:
            return tr("{name} IS UNDER WAY: LET IT END FIRST").format(name=program.name)
        return ""

    def answer(self) -> None:
        """Return: what was typed is the name."""
        here, name, question = self.here(), self.entry.text, self.question
        if here is None:
            self.question = ""
        elif question == COPY:
            self._change(lambda: file_changes.copied(here.path, self.own, name), "{name} IS THERE NOW")
        else:
            self._change(lambda: file_changes.renamed(here.path, name, self.keep), "ITS NAME IS {name} NOW")

    def delete(self) -> None:
        """The marked program, after asking; its text stays among the versions."""
        here = self.here()
        if here is None or self._fixed(here):
            self.desk.say(self._fixed(here) if here else NONE)
            return
        asked = tr("PRESS Y TO DELETE {name} (ITS VERSIONS ARE KEPT), ESC TO LEAVE IT")
        self.desk.ask(asked.format(name=here.name), lambda: self._delete(here))

    def _delete(self, program: Program) -> None:
        if self._fixed(program):  # it was started meanwhile
            self.desk.say(self._fixed(program))
            return
        self._change(
            lambda: file_changes.deleted(program.path, self.keep), "{name} IS DELETED; ITS VERSIONS ARE KEPT"
        )

    def _change(self, work: Callable[[], str], words: str) -> None:
        if self.worker.busy:
            self.desk.say(BUSY)
            return

        def done(name: str) -> None:
            self.question = ""
            self.desk.say(tr(words).format(name=name))
            self.changed(name)

        self.worker.queue(work, done, self._failed)

    def _failed(self, why: str) -> None:
        self.desk.say(f"REFUSED: {why}")

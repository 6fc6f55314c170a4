"""The choice of the program that is loaded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from app.desk.pages.page_entry import program_barred
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import ProgramLoader
from app.desk.status import interrupted_notice
from app.desk.status.prompt_line import UNDER_WAY, PromptAnswers
from core.executor.snapshot import Snapshot

LAST_PROGRAM = "last_program"  # Setting with the path of the program that was loaded last.


@dataclass(frozen=True, slots=True)
class ProgramChoice:
    """Finds programs in ``folders`` and loads them with ``session``.

    ``save_path`` stores the path for the next start of TurnDesk.
    """

    folders: ProgramFolders
    session: ProgramLoader
    snapshot: Callable[[], Snapshot]
    answers: PromptAnswers
    save_path: Callable[[str], None]

    def can_choose(self) -> bool:
        """Return whether a program can be chosen now. The prompt line shows why not."""
        if why := program_barred(self.snapshot()):
            self.answers.say(why)
        return not why

    def choose(self, typed: str) -> bool:
        """Load the program that was typed or selected. Return False if no program has that name."""
        path = self.folders.find(typed)
        if path is None:
            return False
        self.load(path)
        return True

    def load(self, path: Path) -> None:
        """Load a program. Ask first if the program would replace an interrupted job."""
        found = self.snapshot().interrupted
        self.answers.take_back()
        if found is not None and found.program != path.name:
            self.answers.ask(interrupted_notice.instead(found, path.name), partial(self._load, path))
        else:
            self._load(path)

    def _load(self, path: Path) -> None:
        if self.can_choose():
            self.session.load(path, self.session.now.block_delete)
            self.save_path(str(path))

    def switch_block_delete(self) -> None:
        """Toggle Block Delete, and load the program again because Block Delete is part of the proved job."""
        loaded = self.session.now
        if loaded.path is None:
            self.answers.say("F2: CHOOSE A PROGRAM BEFORE CHANGING BLOCK DELETE")
        elif self.snapshot().state in UNDER_WAY:
            self.answers.say("CHANGE BLOCK DELETE ONLY BETWEEN CYCLES")
        else:
            self.answers.take_back()
            self.session.load(loaded.path, not loaded.block_delete)

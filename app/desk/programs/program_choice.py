"""Selection of the program to load."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from app.desk.pages.page_entry import find_program_refusal
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import ProgramLoader
from app.desk.status import interrupted_notice
from app.desk.status.prompt_line import ACTIVE_STATES, PromptLine
from core.executor.snapshot import Snapshot

LAST_PROGRAM_SETTING = "last_program"  # Setting with the path of the program that was loaded last.


@dataclass(frozen=True, slots=True)
class ProgramChoice:
    """Selection of a program from ``program_folders``. ``program_loader`` loads the selected program.

    ``save_path`` stores the path for the next start of TurnDesk.
    """

    program_folders: ProgramFolders
    program_loader: ProgramLoader
    read_snapshot: Callable[[], Snapshot]
    prompt_line: PromptLine
    save_path: Callable[[str], None]

    def can_choose_program(self) -> bool:
        """Return whether a program can currently be chosen. If not, show the reason on the prompt line."""
        if why := find_program_refusal(self.read_snapshot()):
            self.prompt_line.say(why)
        return not why

    def load_by_name(self, name: str) -> bool:
        """Load the program that the operator typed or selected, and return False if it does not exist."""
        path = self.program_folders.find_path(name)
        if path is None:
            return False
        self.load_path(path)
        return True

    def load_path(self, path: Path) -> None:
        """Load the program at this path. Ask the operator first if it would replace an interrupted job."""
        found = self.read_snapshot().interrupted
        self.prompt_line.withdraw_question()
        if found is not None and found.program != path.name:
            self.prompt_line.ask_question(
                interrupted_notice.make_replace_question(found, path.name), partial(self._load, path)
            )
        else:
            self._load(path)

    def _load(self, path: Path) -> None:
        if self.can_choose_program():
            self.program_loader.start_loading(path, self.program_loader.loaded_program.is_block_delete_on)
            self.save_path(str(path))

    def toggle_block_delete(self) -> None:
        """Toggle Block Delete and reload the program, because its proof depends on Block Delete."""
        loaded = self.program_loader.loaded_program
        if loaded.path is None:
            self.prompt_line.say("F2: CHOOSE A PROGRAM BEFORE CHANGING BLOCK DELETE")
        elif self.read_snapshot().state in ACTIVE_STATES:
            self.prompt_line.say("CHANGE BLOCK DELETE ONLY BETWEEN CYCLES")
        else:
            self.prompt_line.withdraw_question()
            self.program_loader.start_loading(loaded.path, not loaded.is_block_delete_on)

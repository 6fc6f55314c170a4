"""Folders, USB sticks and the programs in them, to go through by keys and fingers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from app.desk.pages.sheet import Row, Sheet
from app.desk.programs.program_folder import Takes, is_program
from app.desk.status import formats
from app.desk.translation import tr
from app.programs.removable_media import Medium, Stick, sticks, why_not
from app.programs.whole_file import FileError
from core.message import join_messages

UP = ".."
MOST = 2000


@dataclass(frozen=True, slots=True)
class FolderLine:
    """One line: a place, a folder, the way up, or a program."""

    name: str
    path: Path
    folder: bool
    size: int = 0
    locked: bool = False  # a place that takes nothing


@dataclass(slots=True)
class FolderChooser:
    """``at`` is the folder that is looked into, None: the list of places. ``look`` takes its time."""

    home: Path
    plugged: Callable[[], Sequence[Stick]] = sticks
    takes: Takes = is_program
    at: Path | None = None
    top: Path | None = None  # the place it belongs to; the way up ends there
    lines: tuple[FolderLine, ...] = ()
    marked: int = 0
    medium: Medium | None = None  # the place that is open, as it was when it was opened
    trouble: str = field(default="")

    def look(self) -> tuple[FolderLine, ...]:
        """What is there now; raises FileError when the folder cannot be read. On a worker."""
        if self.at is None:
            self.medium = None
            places = [FolderLine(s.label, s.path, True, s.free, s.locked) for s in self.plugged()]
            return (*places, FolderLine(tr("THIS CONTROL"), self.home, True))
        if self.medium is None:
            self.medium = Medium.of(self.top or self.at)
        self.medium.check()
        try:
            return (FolderLine(UP, self.at.parent, True), *_inside(self.at, self.takes))
        except OSError as error:
            raise FileError(why_not(error, self.at)) from error

    def show_lines(self, lines: tuple[FolderLine, ...]) -> None:
        """Take what ``look`` has found."""
        self.lines, self.trouble = lines, ""
        self.marked = min(self.marked, max(0, len(lines) - 1))

    def go(self, line: FolderLine) -> None:
        """Into a folder, or up; from the top of a place to the list of places."""
        self.marked = 0
        if line.name == UP and self.at == self.top:
            self.at = self.top = None
        else:
            if self.at is None:
                self.top = line.path
            self.at = line.path

    @property
    def marked_line(self) -> FolderLine | None:
        """The marked line; None where there is none."""
        return self.lines[self.marked] if self.marked < len(self.lines) else None

    @property
    def programs(self) -> tuple[Path, ...]:
        """The programs of the folder that is looked into."""
        return tuple(line.path for line in self.lines if not line.folder)


def _inside(folder: Path, takes: Takes) -> list[FolderLine]:
    paths = sorted(folder.iterdir(), key=lambda path: path.name.lower())[:MOST]
    seen = [path for path in paths if not path.name.startswith(".")]
    folders = [FolderLine(path.name, path, True) for path in seen if path.is_dir()]
    files = [path for path in seen if takes(path.name) and path.is_file()]
    return folders + [FolderLine(path.name, path, False, path.stat().st_size) for path in files]


def chooser_sheet(chooser: FolderChooser, title: str) -> Sheet:
    """Places, folders and programs."""
    rows = tuple(
        Row(
            (
                line.name,
                "READ-ONLY" if line.locked else "FOLDER" if line.folder else "PROGRAM",
                formats.file_size(line.size) if line.size else "",
            )
        )
        for line in chooser.lines
    )
    where = str(chooser.at) if chooser.at else "LOCATIONS"
    return Sheet(
        join_messages("  ·  ", (title, where)),
        ("NAME", "", "FREE" if chooser.at is None else "SIZE"),
        (0.64, 0.18, 0.18),
        rows,
        chooser.marked if rows else -1,
        notes=(chooser.trouble,) if chooser.trouble else (),
        raw=frozenset({2} if chooser.at is None else {0, 2}),
        figures=frozenset({2}),
    )

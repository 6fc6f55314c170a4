"""Programs of the list: their data, their sort order, and previews of the selected program."""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.desk.background_work import Latest, Watch
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import LISTED, ProgramFolders
from app.desk.programs.program_loading import LoadingSteps
from app.desk.status import formats
from core.executor.job import Job
from core.language.source import SourceError, load_source
from core.store.program_records import key_of_text
from core.store.store_rows import RunRow

if TYPE_CHECKING:
    from app.path.path_picture import Picture


@dataclass(frozen=True, slots=True)
class Program:
    """Program file with its size in bytes and its time in seconds since 1970.

    Samples are read-only.
    """

    name: str
    path: Path
    size: int
    changed: float
    sample: bool
    run: RunRow
    drawing: bool = False  # a drawing from which a program can be made

    @property
    def key(self) -> tuple[str, float, int]:
        """Key of the file content. Previews remain valid while the key is unchanged."""
        return str(self.path), self.changed, self.size


def list_programs(
    program_folders: ProgramFolders, own: Path, persistence: Persistence
) -> tuple[Program, ...]:
    """Return all programs and drawings of the folders, each with the record of its text.

    Files with unknown text are read, so call this function on a worker. Raises StoreError if the store cannot
    be read.
    """
    runs = persistence.runs.read_records_by_text()
    found = []
    for entry in (*program_folders.entries(), *program_folders.drawings()):
        if (status := _status(entry.path)) is not None:
            path, drawing = entry.path, program_folders.is_drawing(entry.name)
            key = "" if drawing else _key_in(path, status.st_mtime_ns, status.st_size)
            run = runs.get(key, RunRow(entry.name))
            sample = path.parent != own
            found.append(Program(entry.name, path, status.st_size, status.st_mtime, sample, run, drawing))
    return tuple(found)


@lru_cache(maxsize=2 * LISTED)
def _key_in(path: Path, _changed: int, _size: int) -> str:
    """Return the record key of the text in a file, or an empty string if the file is not program text."""
    try:
        return key_of_text(load_source(path).text)
    except SourceError:
        return ""


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except OSError:
        return None  # The file was deleted in the meantime.


Rank = tuple[float, str]
Order = Callable[[Program], Rank]
# Newest and largest first; equal programs are sorted by name.
ORDERS: Mapping[str, Order] = {
    "NAME": lambda p: (0.0, p.name.lower()),
    "DATE": lambda p: (-p.changed, p.name.lower()),
    "LAST RUN": lambda p: (_backwards(p.run.started), p.name.lower()),
    "PARTS": lambda p: (-p.run.parts, p.name.lower()),
    "SIZE": lambda p: (-p.size, p.name.lower()),
}


def _backwards(at: str | None) -> float:
    return -datetime.fromisoformat(at).timestamp() if at else 0.0


def sorted_by(order: str, found: Sequence[Program]) -> tuple[Program, ...]:
    """Return the programs in the order with this name."""
    return tuple(sorted(found, key=ORDERS[order]))


def minute_of(at: str | None) -> str:
    """Return a time of the store in local time to the minute, or a dash without a time."""
    return formats.local_time(at, seconds=False) if at else formats.NOTHING


def minute_of_file(seconds: float) -> str:
    """Return the time of a file in the same format."""
    return datetime.fromtimestamp(seconds).strftime("%Y-%m-%d %H:%M")


KEPT = 40
LARGEST = 5_000_000  # bytes; larger programs are drawn only when they are loaded
Key = tuple[str, float, int]


class Thumbnail(NamedTuple):
    """Small picture with 32 bits per pixel (alpha, red, green, blue from the highest), rows from the top."""

    pixels: bytes
    width: int
    height: int


DrawThumbnail = Callable[[Job, Watch], Thumbnail | None]


@dataclass(slots=True)
class Preview:
    """Preview of the selected program.

    ``workshop`` must not store anything, because a preview is not a run.
    """

    workshop: LoadingSteps
    thumbnail: DrawThumbnail | None = None  # None: parts are not drawn
    wanted: Key | None = None
    trouble: str = ""
    _made: OrderedDict[Key, Picture | str] = field(default_factory=OrderedDict)
    _worker: Latest = field(default_factory=lambda: Latest("editing-preview"))
    _parts: OrderedDict[Key, Thumbnail | None] = field(default_factory=OrderedDict)
    _drawing: Latest = field(default_factory=lambda: Latest("editing-thumbnail"))
    _asked: Key | None = None

    def of(self, program: Program | None) -> Picture | None:
        """Return the picture of a program once it is drawn, else None; called once per frame.

        Another program cancels the previous drawing.
        """
        self._worker.poll()
        self.trouble = ""
        key = program.key if program is not None else None
        if key != self.wanted:
            self.wanted = key
            self._worker.give_up()
        if program is None:
            return None
        made = self._made.get(program.key)
        if made is None and not self._worker.busy:
            self._begin(program)
        if isinstance(made, str):
            self.trouble = made
            return None
        return made

    def part_of(self, program: Program | None) -> Thumbnail | None:
        """Return the thumbnail of the finished part, or None without a thumbnail.

        The thumbnail is drawn after the path. Called once per frame.
        """
        self._drawing.poll()
        key = program.key if program is not None else None
        if key != self._asked and self._drawing.busy:
            self._drawing.give_up()
        if program is None or key is None or self.thumbnail is None:
            return None
        drawn = not isinstance(self._made.get(key), str | None)
        if key not in self._parts and drawn and not self._drawing.busy:
            self._asked = key
            work = partial(self._draw_part, self.thumbnail, program)
            self._drawing.ask(work, partial(self._keep_part, key), lambda _why: self._keep_part(key, None))
        return self._parts.get(key)

    def _draw_part(self, draw: DrawThumbnail, program: Program, watch: Watch) -> Thumbnail | None:
        source = self.workshop.read(program.path)
        return draw(self.workshop.make_job(source, False), watch)

    def _keep_part(self, key: Key, made: Thumbnail | None) -> None:
        self._parts[key] = made
        while len(self._parts) > KEPT:
            self._parts.popitem(last=False)

    @property
    def busy(self) -> bool:
        """Whether the requested picture is still being drawn."""
        return self.wanted is not None and self.wanted not in self._made

    def _begin(self, program: Program) -> None:
        done = partial(self._keep, program.key)
        if program.size > LARGEST:
            done("TOO LARGE FOR A PREVIEW")
        else:
            self._worker.ask(partial(self._draw, program), done, done)

    def _draw(self, program: Program, watch: Watch) -> Picture:
        source = self.workshop.read(program.path)
        return self.workshop.draw(self.workshop.make_job(source, False), watch)

    def _keep(self, key: Key, made: Picture | str) -> None:
        self._made[key] = made
        while len(self._made) > KEPT:
            self._made.popitem(last=False)

    def close(self) -> None:
        """Cancel the drawing and stop the workers."""
        self.wanted = None
        self._drawing.close()
        self._worker.close()

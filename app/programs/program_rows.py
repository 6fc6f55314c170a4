"""Rows of the program list with their data and sort order, and previews of the selected program."""

from __future__ import annotations

import os
import stat
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from app.desk.background_work import LatestRequestWorker, ProgressCallback
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import MAX_PROGRAM_COUNT, ProgramFolders
from app.desk.programs.program_loading import LoadingSteps
from app.desk.status import formats
from core.executor.job import Job
from core.language.source import Dialect, SourceError, decode_source, guess_dialect, load_source
from core.store.program_records import make_text_record_key
from core.store.store_rows import RunRow

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture

RecognizeControl = Callable[[Sequence[str]], str]
_RECOGNIZED_BYTES = 16 * 1024  # The beginning of a program shows its control.


@dataclass(frozen=True, slots=True)
class ListedFile:
    """Program file in the list, with its size in bytes and its modification time.

    The time is in seconds since 1970. Sample programs are read-only. ``is_outside`` is True for a file that
    is not in a program folder. ``missing_reason`` states why a recently loaded file cannot be read.
    """

    name: str
    path: Path
    size_bytes: int
    modified_time_s: float
    is_sample: bool
    run_row: RunRow
    is_drawing: bool = False  # a drawing from which a program can be made
    control_name: str = ""  # another control for which the program was written
    is_outside: bool = False
    missing_reason: str = ""

    @property
    def content_key(self) -> tuple[str, float, int]:
        """Return a key that changes when the content of the file changes.

        A preview remains valid until the key changes.
        """
        return str(self.path), self.modified_time_s, self.size_bytes


def list_programs(
    program_folders: ProgramFolders,
    own_folder: Path,
    persistence: Persistence,
    recognize_control: RecognizeControl | None = None,
) -> tuple[ListedFile, ...]:
    """Return all programs and drawings of the folders, each with its run record.

    ``recognize_control`` finds programs of other controls, unless it is None. A run record belongs to a
    program text. Files whose text is not yet known are therefore read. Call this function on a worker.
    Raise StoreError if the store cannot be read.
    """
    runs = persistence.runs.read_records_by_text()
    found = []
    for entry in (*program_folders.list_programs(), *program_folders.list_drawings()):
        if (status := _status(entry.path)) is not None:
            path, sample = entry.path, entry.path.parent != own_folder
            if program_folders.is_drawing_name(entry.name):
                run, size, changed = RunRow(entry.name), status.st_size, status.st_mtime
                found.append(ListedFile(entry.name, path, size, changed, sample, run, is_drawing=True))
            else:
                file = _describe_program(path, status, runs, recognize_control)
                found.append(replace(file, is_sample=sample))
    return tuple(found)


def list_recent_programs(
    paths: Sequence[Path],
    program_folders: ProgramFolders,
    own_folder: Path,
    persistence: Persistence,
    recognize_control: RecognizeControl | None = None,
) -> tuple[ListedFile, ...]:
    """Return the programs at the given paths in this order, each with its run record.

    ``recognize_control`` finds programs of other controls, unless it is None. A file that cannot be read is
    also returned, with the reason. Call this function on a worker. Raise StoreError if the store
    cannot be read.
    """
    runs = persistence.runs.read_records_by_text()
    found = []
    for path in paths:
        outside = path.parent not in program_folders.folders
        sample = not outside and path.parent != own_folder
        reason, status = find_missing_reason(path), _status(path)
        if reason or status is None:
            row = RunRow(path.name)
            missing = ListedFile(
                path.name, path, 0, 0.0, sample, row, is_outside=outside, missing_reason=reason
            )
            found.append(missing)
            continue
        file = _describe_program(path, status, runs, recognize_control)
        found.append(replace(file, is_sample=sample, is_outside=outside))
    return tuple(found)


def _describe_program(
    path: Path,
    status: os.stat_result,
    runs: Mapping[str, RunRow],
    recognize_control: RecognizeControl | None,
) -> ListedFile:
    """Return the row of a program with its run record and, if it is recognized, with its control."""
    run = runs.get(_find_run_row(path, status.st_mtime_ns, status.st_size), RunRow(path.name))
    control = ""
    if recognize_control is not None:
        control = _find_control(path, status.st_mtime_ns, status.st_size, recognize_control)
    return ListedFile(
        path.name, path, status.st_size, status.st_mtime, is_sample=False, run_row=run, control_name=control
    )


@lru_cache(maxsize=2 * MAX_PROGRAM_COUNT)
def _find_run_row(path: Path, _changed: int, _size: int) -> str:
    """Return the key of a file's run record, or an empty string if the file is not a program."""
    try:
        return make_text_record_key(load_source(path).text)
    except SourceError:
        return ""


def find_missing_reason(path: Path) -> str:
    """Return why a program file cannot be read, or an empty string if it is a file."""
    try:
        return "" if stat.S_ISREG(path.stat().st_mode) else "IT IS NOT A FILE"
    except FileNotFoundError:
        return "THE FILE NO LONGER EXISTS"
    except OSError as error:
        return error.strerror or str(error)


@lru_cache(maxsize=2 * MAX_PROGRAM_COUNT)
def _find_control(path: Path, _changed: int, size: int, recognize_control: RecognizeControl) -> str:
    """Return the name of another control for which a file was written, or an empty string.

    The function reads only the beginning of the file. SINUMERIK and Klartext files have their own extensions.
    """
    if guess_dialect(path.name) is not Dialect.OMNITURN:
        return ""
    try:
        with path.open("rb") as file:
            lines = decode_source(path.name, file.read(_RECOGNIZED_BYTES)).lines
    except (OSError, SourceError):
        return ""
    return recognize_control(lines[:-1] if size > _RECOGNIZED_BYTES else lines)


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except OSError:
        return None  # The file was deleted in the meantime.


RECENT = "RECENT"  # View of the recently loaded programs, newest first.
SortKey = tuple[float, str]
SortOrder = Callable[[ListedFile], SortKey]
# Newest and largest first; equal programs are sorted by name.
SORT_ORDERS: Mapping[str, SortOrder] = {
    "NAME": lambda p: (0.0, p.name.lower()),
    "DATE": lambda p: (-p.modified_time_s, p.name.lower()),
    "LAST RUN": lambda p: (_backwards(p.run_row.started), p.name.lower()),
    "PARTS": lambda p: (-p.run_row.parts, p.name.lower()),
    "SIZE": lambda p: (-p.size_bytes, p.name.lower()),
}
LIST_VIEWS = ("NAME", RECENT, *(order for order in SORT_ORDERS if order != "NAME"))
"""Views of the list in the order in which the key F2 selects them."""


def _backwards(at: str | None) -> float:
    return -datetime.fromisoformat(at).timestamp() if at else 0.0


def sort_programs(order: str, programs: Sequence[ListedFile]) -> tuple[ListedFile, ...]:
    """Return the programs, sorted by the criterion with the name ``order``."""
    return tuple(sorted(programs, key=SORT_ORDERS[order]))


def format_stored_time(utc_time: str | None) -> str:
    """Return a time from the store in local time to the minute, or a dash if no time is stored."""
    return formats.format_local_time(utc_time, with_seconds=False) if utc_time else formats.NO_VALUE


def format_file_time(unix_time_s: float) -> str:
    """Return the modification time of a file in local time to the minute."""
    return datetime.fromtimestamp(unix_time_s).strftime("%Y-%m-%d %H:%M")


MAX_PREVIEWS = 40
MAX_PREVIEW_BYTES = 5_000_000  # bytes; larger programs are drawn only when they are loaded
ContentKey = tuple[str, float, int]


class Thumbnail(NamedTuple):
    """Small picture with 32 bits per pixel (alpha, red, green, blue, starting at the highest bits).

    The first row is at the top.
    """

    pixels: bytes
    width_px: int
    height_px: int


DrawThumbnail = Callable[[Job, ProgressCallback], Thumbnail | None]


@dataclass(slots=True)
class ProgramPreview:
    """Preview of the selected program.

    ``loading_steps`` must not store anything, because showing a preview does not count as a run.
    """

    loading_steps: LoadingSteps
    draw_thumbnail: DrawThumbnail | None = None  # None: parts are not drawn
    requested_key: ContentKey | None = None
    error_text: str = ""
    _made: OrderedDict[ContentKey, ProgramPicture | str] = field(default_factory=OrderedDict)
    _worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-preview"))
    _parts: OrderedDict[ContentKey, Thumbnail | None] = field(default_factory=OrderedDict)
    _drawing: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-thumbnail"))
    _asked: ContentKey | None = None

    def find_picture(self, program: ListedFile | None) -> ProgramPicture | None:
        """Return the picture of a program, or None until it is drawn.

        This is called once a frame. A request for another program cancels the previous drawing.
        """
        self._worker.deliver_results()
        self.error_text = ""
        key = program.content_key if program is not None else None
        if key != self.requested_key:
            self.requested_key = key
            self._worker.cancel_request()
        if program is None:
            return None
        made = self._made.get(program.content_key)
        if made is None and not self._worker.is_busy:
            self._begin(program)
        if isinstance(made, str):
            self.error_text = made
            return None
        return made

    def find_thumbnail(self, program: ListedFile | None) -> Thumbnail | None:
        """Return the thumbnail of the finished part, or None if there is no thumbnail.

        This is called once a frame. The thumbnail is drawn after the path.
        """
        self._drawing.deliver_results()
        key = program.content_key if program is not None else None
        if key != self._asked and self._drawing.is_busy:
            self._drawing.cancel_request()
        if program is None or key is None or self.draw_thumbnail is None:
            return None
        drawn = not isinstance(self._made.get(key), str | None)
        if key not in self._parts and drawn and not self._drawing.is_busy:
            self._asked = key
            work = partial(self._draw_part, self.draw_thumbnail, program)
            self._drawing.request_work(
                work, partial(self._keep_part, key), lambda _why: self._keep_part(key, None)
            )
        return self._parts.get(key)

    def _draw_part(
        self, draw: DrawThumbnail, program: ListedFile, watch: ProgressCallback
    ) -> Thumbnail | None:
        source = self.loading_steps.read_source(program.path)
        return draw(self.loading_steps.make_job(source, False), watch)

    def _keep_part(self, key: ContentKey, made: Thumbnail | None) -> None:
        self._parts[key] = made
        while len(self._parts) > MAX_PREVIEWS:
            self._parts.popitem(last=False)

    @property
    def is_busy(self) -> bool:
        """Return whether the requested picture is still being drawn."""
        return self.requested_key is not None and self.requested_key not in self._made

    def _begin(self, program: ListedFile) -> None:
        done = partial(self._keep, program.content_key)
        if program.size_bytes > MAX_PREVIEW_BYTES:
            done("TOO LARGE FOR A PREVIEW")
        else:
            self._worker.request_work(partial(self._draw, program), done, done)

    def _draw(self, program: ListedFile, watch: ProgressCallback) -> ProgramPicture:
        source = self.loading_steps.read_source(program.path)
        return self.loading_steps.draw_path(self.loading_steps.make_job(source, False), watch)

    def _keep(self, key: ContentKey, made: ProgramPicture | str) -> None:
        self._made[key] = made
        while len(self._made) > MAX_PREVIEWS:
            self._made.popitem(last=False)

    def close(self) -> None:
        """Cancel the drawing and stop the workers."""
        self.requested_key = None
        self._drawing.close()
        self._worker.close()

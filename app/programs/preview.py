"""The pictures of the marked program, path and part: drawn on workers, kept while the text is the same."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from app.desk.background_work import Latest, Watch
from app.desk.programs.program_loading import LoadingSteps
from app.programs.program_rows import Program
from core.executor.job import Job

if TYPE_CHECKING:
    from app.path.path_picture import Picture

KEPT = 40
LARGEST = 5_000_000  # bytes: a larger program is drawn when it is loaded
Key = tuple[str, float, int]


class Thumbnail(NamedTuple):
    """A small picture: 32 bits a pixel, alpha, red, green, blue from the highest; rows from the top."""

    pixels: bytes
    width: int
    height: int


DrawThumbnail = Callable[[Job, Watch], Thumbnail | None]


@dataclass(slots=True)
class Preview:
    """``workshop`` must keep nothing: looking at a program is no run of it."""

    workshop: LoadingSteps
    thumbnail: DrawThumbnail | None = None  # None: nobody draws the part
    wanted: Key | None = None
    trouble: str = ""
    _made: OrderedDict[Key, Picture | str] = field(default_factory=OrderedDict)
    _worker: Latest = field(default_factory=lambda: Latest("editing-preview"))
    _parts: OrderedDict[Key, Thumbnail | None] = field(default_factory=OrderedDict)
    _drawing: Latest = field(default_factory=lambda: Latest("editing-thumbnail"))
    _asked: Key | None = None

    def of(self, program: Program | None) -> Picture | None:
        """Its picture, when it is drawn; once a frame. Another one than before gives the old one up."""
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
        """Its finished part, when that is drawn; once a frame, behind the path. None: none, or not yet."""
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
        """Whether the wanted picture is still being drawn."""
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
        """Give up what is being drawn and end the worker."""
        self.wanted = None
        self._drawing.close()
        self._worker.close()

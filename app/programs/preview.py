"""The picture of the marked program: drawn on a worker, remembered while the text is the same."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from app.desk.latest import Latest, Watch
from app.desk.program_loading import LoadingSteps
from app.programs.program_rows import Program

if TYPE_CHECKING:
    from app.path.path_picture import Picture

KEPT = 40
LARGEST = 5_000_000  # bytes: a larger program is drawn when it is loaded
Key = tuple[str, float, int]


@dataclass(slots=True)
class Preview:
    """``workshop`` must keep nothing: looking at a program is no run of it."""

    workshop: LoadingSteps
    wanted: Key | None = None
    trouble: str = ""
    _made: OrderedDict[Key, Picture | str] = field(default_factory=OrderedDict)
    _worker: Latest = field(default_factory=lambda: Latest("editing-preview"))

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
        self._worker.close()

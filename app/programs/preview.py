"""The picture of the marked program: drawn on a worker, remembered while the text is the same."""

from __future__ import annotations

from collections import OrderedDict
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.latest import AbandonedError, Watch
from app.desk.session import Workshop
from app.programs.program_rows import Program

if TYPE_CHECKING:
    from app.desk.picture import Picture

KEPT = 40
LARGEST = 5_000_000  # bytes: a larger program is drawn when it is loaded
Key = tuple[str, float, int]


@dataclass(slots=True)
class Preview:
    """``workshop`` must keep nothing: looking at a program is no run of it."""

    workshop: Workshop
    wanted: Key | None = None
    trouble: str = ""
    _made: OrderedDict[Key, Picture | str] = field(default_factory=OrderedDict)
    _future: Future[Picture] | None = None
    _drawing: Key | None = None
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="editing-preview")
    )

    def of(self, program: Program | None) -> Picture | None:
        """Its picture, when it is drawn; once a frame. Another one than before gives the old one up."""
        self.wanted = program.key if program is not None else None
        self._take()
        self.trouble = ""
        if program is None or self.wanted is None:
            return None
        made = self._made.get(self.wanted)
        if made is None and self._future is None:
            self._begin(program, self.wanted)
        if isinstance(made, str):
            self.trouble = made
            return None
        return made

    @property
    def busy(self) -> bool:
        """Whether the wanted picture is still being drawn."""
        return self.wanted is not None and self.wanted not in self._made

    def _begin(self, program: Program, key: Key) -> None:
        if program.size > LARGEST:
            self._made[key] = "TOO LARGE FOR A PREVIEW"
            return
        self._drawing = key
        self._future = self._pool.submit(self._draw, program, self._watch(key))

    def _draw(self, program: Program, watch: Watch) -> Picture:
        source = self.workshop.read(program.path)
        return self.workshop.draw(self.workshop.make_job(source, False), watch)

    def _watch(self, key: Key) -> Watch:
        def watch(_count: float) -> None:
            if self.wanted != key:
                raise AbandonedError

        return watch

    def _take(self) -> None:
        future, key = self._future, self._drawing
        if future is None or key is None or not future.done():
            return
        self._future = None
        error = future.exception()
        if error is None:
            self._made[key] = future.result()
        elif not isinstance(error, AbandonedError):
            self._made[key] = str(error) or type(error).__name__
        while len(self._made) > KEPT:
            self._made.popitem(last=False)

    def close(self) -> None:
        """Give up what is being drawn and end the worker."""
        self.wanted = None
        self._pool.shutdown(wait=True, cancel_futures=True)

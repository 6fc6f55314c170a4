"""Proving while one types: on a worker, the latest text only, and never in the way of the next key."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from app.desk.latest import AbandonedError, Watch
from app.desk.session import Workshop
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Source

if TYPE_CHECKING:
    from app.desk.picture import Picture

QUIET = 0.008  # seconds without a key after which proving begins
LONGEST = 0.03  # seconds that typing may put it off
PATIENCE = 0.2  # seconds of work after which a newer text takes the worker
_WEIGHT = {Severity.ERROR: 2, Severity.WARNING: 1, Severity.NOTE: 0}


@dataclass(frozen=True, slots=True)
class Findings:
    """What proving says of the text with this number; ``picture`` may still be that of an older one."""

    number: int = 0
    diagnostics: tuple[Diagnostic, ...] = ()
    by_line: dict[int, Diagnostic] = field(default_factory=dict)  # the weightiest of each line
    picture: Picture | None = None
    cycle_time: float = 0.0
    blocks: int = 0
    trouble: str = ""  # why it could not be proved at all

    @property
    def errors(self) -> int:
        """How many keep the program from running."""
        return sum(d.severity is Severity.ERROR for d in self.diagnostics)

    @property
    def warnings(self) -> int:
        """How many are only to be looked at."""
        return sum(d.severity is Severity.WARNING for d in self.diagnostics)


def by_line(diagnostics: tuple[Diagnostic, ...]) -> dict[int, Diagnostic]:
    """The weightiest finding of each line, of equals the first; line 0 speaks of the whole file."""
    found: dict[int, Diagnostic] = {}
    for one in diagnostics:
        there = found.get(one.line)
        if there is None or _WEIGHT[one.severity] > _WEIGHT[there.severity]:
            found[one.line] = one
    return found


@dataclass(slots=True)
class Checker:
    """``submit`` and ``now`` never wait. A text that a newer one has overtaken is not proved."""

    workshop: Workshop
    clock: Callable[[], float] = time.monotonic
    _now: Findings = field(default_factory=Findings)
    _number: int = 0
    _wanted: tuple[int, Source, bool] | None = None
    _asked: float = 0.0
    _working: bool = False
    _closing: bool = False
    _future: Future[None] | None = None
    _wake: threading.Condition = field(default_factory=threading.Condition)
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="editing-proof")
    )

    @property
    def now(self) -> Findings:
        """The latest that is known. A worker that has failed shows as trouble."""
        future = self._future
        if future is not None and future.done():
            self._future = None
            error = future.exception()
            if error is not None and not isinstance(error, AbandonedError):
                self._now = Findings(self._number, trouble=f"PROVING FAILED: {error or type(error).__name__}")
        return self._now

    @property
    def behind(self) -> bool:
        """Whether a newer text than that of ``now`` is waiting or being proved."""
        with self._wake:
            return self._working or self._wanted is not None

    def submit(self, name: str, text: str, block_delete: bool = False) -> int:
        """This is the text now; answers its number."""
        with self._wake:
            self._number += 1
            self._wanted, self._asked = (self._number, Source(name, text), block_delete), self.clock()
            self._wake.notify_all()
            if not self._working and not self._closing:
                self._working = True
                self._future = self._pool.submit(self._work)
            return self._number

    def settled(self, timeout: float) -> Findings:
        """Wait until everything is proved and look; for scripts and tests, never for the screen."""
        future = self._future
        if future is not None:
            wait([future], timeout)
        return self.now

    def close(self) -> None:
        """Give up what is being proved and end the worker."""
        with self._wake:
            self._closing, self._wanted = True, None
            self._wake.notify_all()
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _work(self) -> None:
        while (wanted := self._rested()) is not None:
            try:
                self._prove(*wanted)
            except AbandonedError:
                continue
            except BaseException:
                with self._wake:
                    self._working = False
                raise

    def _rested(self) -> tuple[int, Source, bool] | None:
        """The latest text once the keys rest, or have been waited for long enough; None: nothing to do."""
        with self._wake:
            end = self.clock() + LONGEST
            while self._wanted is not None and not self._closing:
                left = min(self._asked + QUIET, end) - self.clock()
                if left <= 0:
                    wanted, self._wanted = self._wanted, None
                    return wanted
                self._wake.wait(left)
            self._working = False
            return None

    def _prove(self, number: int, source: Source, block_delete: bool) -> None:
        watch = self._watch()
        job = self.workshop.make_job(source, block_delete)
        proved = self.workshop.prove(job, watch)
        found, proof = proved.diagnostics, proved.proof
        before = self._now.picture
        self._now = Findings(number, found, by_line(found), before, proof.cycle_time, proof.blocks)
        self._now = replace(self._now, picture=self.workshop.draw(job, watch))

    def _watch(self) -> Watch:
        began = self.clock()

        def watch(_count: float) -> None:
            late = self._wanted is not None and self.clock() - began > PATIENCE
            if self._closing or late:
                raise AbandonedError

        return watch

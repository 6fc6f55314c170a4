"""Proves a job of the queue while another one runs: on a worker of the desk, never in the executor's way."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

from app.desk.latest import Latest, Watch
from app.jobs.job_setup import ProvedJob

Prove = Callable[[str, Watch], ProvedJob]
"""A program by its name, with the offsets of now; on the worker. Raises ValueError with a sentence."""
KEPT = 20


@dataclass(slots=True)
class JobProofs:
    """``want`` and ``of`` never wait. A proof is of a program and the offsets that it was made with."""

    prove: Prove
    worker: Latest = field(default_factory=lambda: Latest("editing-jobs"))
    _made: dict[tuple[str, int], ProvedJob | str] = field(default_factory=dict)
    _asked: tuple[str, int] | None = None

    def want(self, programs: Sequence[str], offsets: int) -> None:
        """Once a frame: these are to be proved, the first one first; ``offsets`` tells one state of tables
        from another. What is being proved and is wanted no longer is given up.
        """
        self.worker.poll()
        keys = [(program, offsets) for program in programs[:KEPT]]
        wanted = next((key for key in keys if key not in self._made), None)
        if wanted is None or wanted == self._asked:
            return
        self._asked = wanted
        done = partial(self._keep, wanted)
        self.worker.ask(partial(self.prove, wanted[0]), done, done)

    def of(self, program: str, offsets: int) -> ProvedJob | str | None:
        """What is known of it: its proof, why there is none, None: it is not proved yet."""
        return self._made.get((program, offsets))

    def anew(self) -> None:
        """Files and shapes may have changed: everything is proved again."""
        self._made.clear()
        self._asked = None

    def _keep(self, key: tuple[str, int], made: ProvedJob | str) -> None:
        self._made[key] = made
        self._asked = None
        while len(self._made) > KEPT:
            del self._made[next(iter(self._made))]

    def close(self) -> None:
        """Give up what is being proved and end the worker."""
        self.worker.close()

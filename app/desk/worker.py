"""Files and versions are read and written on one worker; what comes of it is taken up once a frame."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from typing import TypeVar

T = TypeVar("T")
Failed = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class _Asked:
    """One thing that was asked for: whether it is done, waiting for it, and giving the answer."""

    done: Callable[[], bool]
    wait: Callable[[float], object]
    answer: Callable[[], None]


@dataclass(slots=True)
class Worker:
    """One thing after the other, in the order of asking; the answers are given on the asking thread."""

    _waiting: list[_Asked] = field(default_factory=list)
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="editing-files")
    )

    @property
    def busy(self) -> bool:
        """Whether an answer is still to come."""
        return bool(self._waiting)

    def ask(self, work: Callable[[], T], done: Callable[[T], None], failed: Failed) -> None:
        """Have ``work`` done; ``poll`` then calls ``done`` with its answer or ``failed`` with a sentence."""
        future = self._pool.submit(work)

        def answer() -> None:
            error = future.exception()
            if error is None:
                done(future.result())
            else:
                failed(str(error) or type(error).__name__)

        self._waiting.append(_Asked(future.done, lambda limit: wait([future], limit), answer))

    def poll(self) -> None:
        """Give the answers that have come."""
        while self._waiting and self._waiting[0].done():
            self._waiting.pop(0).answer()

    def settle(self, timeout: float) -> None:
        """Wait for the answers; for scripts and tests, never for the screen."""
        while self._waiting:
            self._waiting[0].wait(timeout)
            self.poll()

    def close(self) -> None:
        """End the worker; what is being written is written to its end."""
        self._pool.shutdown(wait=True)

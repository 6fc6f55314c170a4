"""A job is a program under fixed circumstances; a proof belongs to one job and to no other."""

from __future__ import annotations

from dataclasses import dataclass

from core.interpreter.setup import Setup
from core.language.source import Source


@dataclass(frozen=True, slots=True)
class Job:
    """What is going to run: text, offsets and switches, by value. ``digest`` names exactly this job."""

    source: Source
    setup: Setup
    digest: str
    tools_set: frozenset[int] = frozenset()  # numbers of the tool offsets that somebody has entered


@dataclass(frozen=True, slots=True)
class Proof:
    """What proving said of the job with this digest."""

    digest: str
    errors: tuple[str, ...]
    blocks: int = 0
    cycle_time: float = 0.0
    tools: tuple[int, ...] = ()  # offsets the program asks for

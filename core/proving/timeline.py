"""A program laid out in time: every elementary block with its start and end, by the law that a run obeys."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from core.interpreter.actions import (
    Collet,
    Dwell,
    ProgramStop,
    SpindleRun,
    SpindleStop,
    WaitInput,
)
from core.interpreter.blocks import Block

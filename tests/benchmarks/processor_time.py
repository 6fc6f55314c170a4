"""What a process costs: processor time of its own, user and system, which a busy machine stretches little."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

ROUNDS = 7
BARE = (sys.executable, "-c", "")
QT = (sys.executable, "-c", "import PySide6.QtWidgets")


class Cost(NamedTuple):
    """Median processor time of some runs, s, and the most memory of one, MiB."""

    seconds: float
    memory: float


def spent(command: Sequence[str], around: Mapping[str, str]) -> Cost:
    """One run. Raises CalledProcessError for a status that is neither 0 nor that of a refused program, 1."""
    with Path(os.devnull).open("wb") as nowhere:
        child = subprocess.Popen(command, stdout=nowhere, stderr=nowhere, env=dict(around))
        _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode not in (0, 1):
        raise subprocess.CalledProcessError(child.returncode, list(command))
    return Cost(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def compared(
    commands: Mapping[str, Sequence[str]], around: Mapping[str, str], rounds: int = ROUNDS
) -> dict[str, Cost]:
    """The costs of commands, run by turns: A B A B …; a first run of each, which compiles, does not count."""
    for command in commands.values():
        spent(command, around)
    runs = [{name: spent(command, around) for name, command in commands.items()} for _ in range(rounds)]
    return {
        name: Cost(
            statistics.median(each[name].seconds for each in runs), max(each[name].memory for each in runs)
        )
        for name in commands
    }

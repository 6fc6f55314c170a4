"""What a process costs: processor time of its own, user and system, which a busy machine stretches little."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
from collections.abc import Mapping, Sequence
from typing import NamedTuple

ROUNDS = 7
BARE = (sys.executable, "-c", "")
# A process is told to have had the memory of whoever started it: a small one does.
_STARTER = """
import json, os, subprocess, sys
child = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
_, status, used = os.wait4(child.pid, 0)
print(json.dumps([os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, used.ru_maxrss]))
"""
QT = (sys.executable, "-c", "import PySide6.QtWidgets")


class Cost(NamedTuple):
    """Median processor time of some runs, s, and the most memory of one, MiB."""

    seconds: float
    memory: float


def spent(command: Sequence[str], around: Mapping[str, str]) -> Cost:
    """One run. Raises CalledProcessError for a status that is neither 0 nor that of a refused program, 1."""
    starter = [sys.executable, "-I", "-S", "-c", _STARTER, *command]
    told = subprocess.run(starter, env=dict(around), check=True, capture_output=True, text=True)
    status, seconds, kilobytes = json.loads(told.stdout)
    if status not in (0, 1):
        raise subprocess.CalledProcessError(status, list(command))
    return Cost(seconds, kilobytes / 1024)


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

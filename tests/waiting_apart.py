"""Which worker of the tests runs what: three in five what waits first, the others what calculates.

What waits, for a machine in real time or for another process, leaves a core to what calculates. In any other
mixture all workers wait now and all calculate then. A worker with nothing left of its own kind helps the
others.
"""

from __future__ import annotations

import random
import re
from collections import Counter
from collections.abc import Sequence
from itertools import groupby
from operator import itemgetter

import pytest

_OF_EXTRA = re.compile(r"^tests/extras/\w+/")
STORIES = "tests/stories/"
WAIT = (
    STORIES,
    "tests/control/",
    "tests/killed/",
    "tests/shopfloor/",
    "tests/extras/mtconnect/",
    "tests/extras/office/",
    "tests/drivers/driver_host/",
    "tests/drivers/grblhal/",
    "tests/drivers/hal/",
    "tests/drivers/transfer/",
)
_WAITERS = (1, 3, 4)  # of five workers
KINDER = 3  # how much less of a core who reckons claims than who has a machine in real time
URGENT = 10  # how much more who has a machine in real time claims, where that is allowed
_MOST = 50  # tests that a worker is given at once
_SHARES = 8  # at least so many portions for each worker


def waits(nodeid: str) -> bool:
    """Whether a test mostly waits."""
    return _place(nodeid).startswith(WAIT)


def _place(nodeid: str) -> str:
    """A folder of an optional feature counts as the folder of that name in ``tests``."""
    return _OF_EXTRA.sub("tests/", nodeid)


def waits_first(worker: int) -> bool:
    """Whether the worker of this number, from 0, begins with what waits."""
    return worker % 5 in _WAITERS


class PortionQueue:
    """The portions that no worker has been given, in their order. A test is its number in the order."""

    def __init__(self, nodeids: Sequence[str], workers: int) -> None:
        names = portions(nodeids, workers)
        self._left: dict[str, list[int]] = {}
        for number, nodeid in enumerate(nodeids):
            self._left.setdefault(names[nodeid], []).append(number)

    def take(self, *, waiting: bool) -> list[int]:
        """Remove the next portion of its kind; of the other kind where none is left; empty at the end."""
        if not self._left:
            return []
        name = next((each for each in self._left if waits(each) is waiting), next(iter(self._left)))
        return self._left.pop(name)


def portions(nodeids: Sequence[str], workers: int) -> dict[str, str]:
    """The name of its portion for each test."""
    most = max(1, min(_MOST, len(nodeids) // (_SHARES * workers)))
    seen: Counter[str] = Counter()
    named: dict[str, str] = {}
    for nodeid in nodeids:
        unit = _unit(nodeid)
        named[nodeid] = unit if waits(nodeid) else f"{unit} {seen[unit] // most}"
        seen[unit] += 1
    return named


def in_order(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """What waits first, each folder of ``WAIT`` at even distances among the others, then what reckons.

    HAL is one for a whole computer: a worker that wants it while another has it stands still.
    """
    places: list[tuple[float, list[pytest.Item]]] = []
    for folder in WAIT:
        here = [item for item in items if _place(item.nodeid).startswith(folder)]
        groups = [list(group) for _, group in groupby(here, key=lambda item: _unit(item.nodeid))]
        places += [((number + 0.5) / len(groups), group) for number, group in enumerate(groups)]
    waiting = [item for _, group in sorted(places, key=itemgetter(0)) for item in group]
    return [*waiting, *(item for item in items if not waits(item.nodeid))]


def shuffled(items: Sequence[pytest.Item], seed: int) -> list[pytest.Item]:
    """Return the files in an order drawn by ``seed``, and the tests of each file in another."""
    draw = random.Random(seed)
    files = [list(group) for _, group in groupby(items, key=lambda item: item.nodeid.partition("::")[0])]
    draw.shuffle(files)
    for file in files:
        draw.shuffle(file)
    return [item for file in files for item in file]


def _unit(nodeid: str) -> str:
    """A story is one for itself; all others lie together in a file, which makes what it needs once."""
    return nodeid if _place(nodeid).startswith(STORIES) else nodeid.partition("::")[0]

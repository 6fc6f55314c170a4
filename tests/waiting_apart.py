"""Which worker of ``pytest -n`` runs what: three in five what waits first, the others what calculates.

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
from xdist.scheduler.loadscope import LoadScopeScheduling
from xdist.workermanage import WorkerController

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


def waits_first(worker: str) -> bool:
    """Whether a worker, ``gw0`` and so on, begins with what waits."""
    return int(worker.removeprefix("gw")) % 5 in _WAITERS


class WaitingApart(LoadScopeScheduling):
    """Portions: a story, a file of other tests that wait, some tests in succession of a file that reckons."""

    _portions: dict[str, str]
    _places: dict[str, int]

    def schedule(self) -> None:
        """All workers have collected the same: begin."""
        if self.collection is None and self.registered_collections:
            nodeids = next(iter(self.registered_collections.values()))
            self._places = {nodeid: place for place, nodeid in enumerate(nodeids)}
            self._portions = portions(nodeids, len(self.nodes))
            self.config.option.loadscopereorder = False
        super().schedule()

    def mark_test_complete(self, node: WorkerController, item_index: int, _duration: float = 0) -> None:
        """It is over; the worker is given more when it has nothing behind its next one."""
        nodeid = self.registered_collections[node][item_index]
        portion, given = self._portions[nodeid], self.assigned_work[node]
        del given[portion][nodeid]
        if not given[portion]:
            del given[portion]
        self._reschedule(node)

    def _split_scope(self, nodeid: str) -> str:
        return self._portions[nodeid]

    def _reschedule(self, node: WorkerController) -> None:
        # A worker begins a test when it knows the one behind it.
        if not self.workqueue or self._pending_of(self.assigned_work[node]) < 2:
            super()._reschedule(node)

    def _assign_work_unit(self, node: WorkerController) -> None:
        portion = self._next_for(node)
        given = self.workqueue.pop(portion)
        self.assigned_work[node][portion] = given
        node.send_runtest_some([self._places[nodeid] for nodeid in given])

    def _next_for(self, node: WorkerController) -> str:
        """The next portion of its kind; of the other kind where none is left."""
        own = waits_first(node.gateway.id)
        left: list[str] = list(self.workqueue)
        return next((each for each in left if waits(each) is own), left[0])


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

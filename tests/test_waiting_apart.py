"""Which worker runs what: each test once, what waits on every second worker, help at the end."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest

from tests.waiting_apart import STORIES, WaitingApart, in_order, portions, shuffled, waits

HAL = [f"tests/drivers/hal/test_{name}.py::test_{number}" for name in "ab" for number in range(3)]
TOLD = [f"{STORIES}test_stops.py::test_{number}" for number in range(4)]
RECKON = [f"tests/store/test_{name}.py::test_{number}" for name in "ab" for number in range(40)]


class Worker:
    """Runs what it is given, in this order, as xdist's does: the last only when it is told to end."""

    def __init__(self, number: int, nodeids: list[str]) -> None:
        self.gateway, self.shutting_down = SimpleNamespace(id=f"gw{number}"), False
        self.nodeids, self.given, self.ran = nodeids, list[int](), list[str]()

    def send_runtest_some(self, indices: list[int]) -> None:
        self.given += indices

    def shutdown(self) -> None:
        self.shutting_down = True

    def run_one(self, scheduler: WaitingApart) -> bool:
        if len(self.given) < (1 if self.shutting_down else 2):
            return False
        place = self.given.pop(0)
        self.ran.append(self.nodeids[place])
        scheduler.mark_test_complete(self, place)
        return True


def begun(pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch, workers: int,
          nodeids: list[str]) -> tuple[WaitingApart, list[Worker]]:  # fmt: skip
    monkeypatch.setattr(pytestconfig.option, "tx", [f"{workers}*popen"])
    monkeypatch.setattr(pytestconfig.option, "loadscopereorder", True, raising=False)
    scheduler = WaitingApart(pytestconfig)
    made = [Worker(number, nodeids) for number in range(workers)]
    for each in made:
        scheduler.add_node(each)
        scheduler.add_node_collection(each, nodeids)
    scheduler.schedule()
    return scheduler, made


@pytest.mark.parametrize("workers", [1, 2, 3, 4])
@pytest.mark.parametrize("nodeids", [HAL + TOLD + RECKON, RECKON, TOLD, HAL[:1]], ids=len)
def test_every_test_runs_once_for_any_worker_speed(
    pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch, workers: int, nodeids: list[str]
) -> None:
    scheduler, made = begun(pytestconfig, monkeypatch, workers, nodeids)
    while sum(each.run_one(scheduler) for each in made):
        pass
    assert sorted(name for each in made for name in each.ran) == sorted(nodeids)
    assert not scheduler.has_pending
    assert all(each.shutting_down for each in made)


def test_worker_for_waiting_tests_starts_with_them_and_then_helps(
    pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch
) -> None:
    scheduler, (reckons, waiting) = begun(pytestconfig, monkeypatch, 2, HAL + TOLD + RECKON)
    while waiting.run_one(scheduler):
        pass
    assert waiting.ran[: len(HAL + TOLD)] == HAL + TOLD
    assert len(waiting.ran) > len(HAL + TOLD)
    assert not any(waits(waiting.nodeids[place]) for place in reckons.given)


def test_tests_not_run_by_a_dead_worker_are_run_by_the_other(
    pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch
) -> None:
    scheduler, (reckons, waiting) = begun(pytestconfig, monkeypatch, 2, TOLD + RECKON)
    died: Any = waiting
    assert scheduler.remove_node(died) == TOLD[0]
    while reckons.run_one(scheduler):
        pass
    assert set(reckons.ran) >= set(TOLD[1:] + RECKON)


def test_waiting_file_is_not_split_and_computing_file_is() -> None:
    named = portions(HAL + TOLD + RECKON, 2)
    assert len({named[each] for each in HAL}) == 2
    assert len({named[each] for each in TOLD}) == len(TOLD)
    assert 2 < len({named[each] for each in RECKON}) < len(RECKON)


def test_hal_test_files_are_spread_apart() -> None:
    items: list[Any] = [SimpleNamespace(nodeid=each) for each in RECKON + HAL + TOLD]
    ordered = [item.nodeid for item in in_order(items)]
    assert ordered[:4] == [TOLD[0], *HAL[:3]]
    assert ordered[4:10] == [TOLD[1], TOLD[2], *HAL[3:], TOLD[3]][:6]
    assert ordered[len(HAL + TOLD) :] == RECKON


def test_random_order_leaves_files_together_and_includes_every_test() -> None:
    items: list[Any] = [SimpleNamespace(nodeid=each) for each in RECKON + HAL + TOLD]
    drawn = [item.nodeid for item in shuffled(items, 7)]
    assert sorted(drawn) == sorted(RECKON + HAL + TOLD)
    assert drawn != RECKON + HAL + TOLD
    assert drawn == [item.nodeid for item in shuffled(items, 7)]
    files = [name.partition("::")[0] for name in drawn]
    changes = sum(one != other for one, other in pairwise(files))
    assert changes == len(set(files)) - 1

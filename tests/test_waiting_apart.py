"""Which worker runs what: each test once, what waits on every second worker, help at the end."""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import pytest

from tests.waiting_apart import STORIES, PortionQueue, in_order, portions, shuffled, waits, waits_first

HAL = [f"tests/drivers/hal/test_{name}.py::test_{number}" for name in "ab" for number in range(3)]
TOLD = [f"{STORIES}test_stops.py::test_{number}" for number in range(4)]
RECKON = [f"tests/store/test_{name}.py::test_{number}" for name in "ab" for number in range(40)]


def drained(nodeids: list[str], workers: int, kinds: list[bool]) -> list[list[str]]:
    """The tests that each worker gets, by whether it begins with what waits, if all are equally fast."""
    queue = PortionQueue(nodeids, workers)
    ran: list[list[str]] = [[] for _ in kinds]
    while sum(_gets(queue, nodeids, waiting, got) for waiting, got in zip(kinds, ran, strict=True)):
        pass
    return ran


def _gets(queue: PortionQueue, nodeids: list[str], waiting: bool, got: list[str]) -> int:
    portion = queue.take(waiting=waiting)
    got += [nodeids[number] for number in portion]
    return len(portion)


@pytest.mark.parametrize("workers", [1, 2, 3, 4])
@pytest.mark.parametrize("nodeids", [HAL + TOLD + RECKON, RECKON, TOLD, HAL[:1]], ids=len)
def test_every_test_runs_once_for_any_number_of_workers(workers: int, nodeids: list[str]) -> None:
    ran = drained(nodeids, workers, [bool(number % 2) for number in range(workers)])
    assert sorted(name for each in ran for name in each) == sorted(nodeids)


def test_worker_for_waiting_tests_starts_with_them_and_then_helps() -> None:
    reckons, waiting = drained(HAL + TOLD + RECKON, 2, [False, True])
    assert waiting[: len(HAL + TOLD)] == HAL + TOLD
    assert len(waiting) > len(HAL + TOLD)
    assert not any(waits(name) for name in reckons)


def test_worker_for_computing_tests_takes_waiting_tests_when_no_other_is_left() -> None:
    (reckons,) = drained(HAL + RECKON, 1, [False])
    assert reckons == RECKON + HAL


def test_empty_queue_gives_no_test() -> None:
    assert PortionQueue([], 5).take(waiting=True) == []


def test_three_of_five_workers_begin_with_waiting_tests() -> None:
    assert [waits_first(number) for number in range(6)] == [False, True, False, True, True, False]


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

"""docs/safety.md tells the truth: each rule has a module and a test, and both exist.

That the tests also ran is looked at when the whole suite is over: ``tests/conftest.py``.
"""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Literal, cast

import pytest

from tests import late_computer
from tests.conftest import MOST_LATE, SafetyRan
from tests.named import (
    LATE,
    NAMED,
    ROOT,
    SAFETY,
    all_named,
    file_of,
    functions_of,
    is_left_out,
    named_in,
    not_run,
)

MODULE = re.compile(r"`((?:app|core|drivers)/[\w/]+(?:\.py)?)`")


def rows() -> list[list[str]]:
    """The cells of every hazard: number, what can happen, rule, where, shown by, hardware."""
    text = SAFETY.read_text(encoding="utf-8")
    found = [line.strip().strip("|").split("|") for line in text.splitlines()]
    return [[cell.strip() for cell in cells] for cells in found if re.fullmatch(r"\s*[A-Z]\d+\s*", cells[0])]


def test_each_hazard_has_its_own_number() -> None:
    numbers = [row[0] for row in rows()]
    assert len(numbers) == len(set(numbers)) >= 40


@pytest.mark.parametrize("row", rows(), ids=lambda row: str(row[0]))
def test_every_hazard_has_rule_location_test_and_hardware_note(row: list[str]) -> None:
    assert len(row) == 6
    assert all(row)
    places = MODULE.findall(row[3])
    assert places, "no module is named"
    assert [place for place in places if not (ROOT / place).exists() and not is_left_out(place)] == []
    assert NAMED.search(row[4]), "no test is named"


def parts() -> list[list[str]]:
    """The cells of every part: its name, and what happens when it is late, stopped or killed."""
    found = [line.strip("|").split("|") for line in LATE.read_text(encoding="utf-8").splitlines()]
    return [[cell.strip() for cell in cells] for cells in found if cells[0].startswith(" **")]


@pytest.mark.parametrize("row", parts(), ids=lambda row: str(row[0]))
def test_each_cell_of_a_part_describes_a_reaction_and_names_its_test(row: list[str]) -> None:
    assert len(row) == 4
    for cell in row[1:]:
        assert NAMED.search(cell), cell
        assert NAMED.sub("", cell).strip(" ,`"), cell


def test_all_parts_of_the_system_are_in_the_table() -> None:
    assert [row[0].strip("*") for row in parts()] == [
        *("screen", "control", "key watcher", "driver host", "HAL bridge", "store", "network"),
    ]


@pytest.mark.parametrize(
    ("file", "test"),
    named_in(all_named()),
    ids=str,
)
def test_what_is_named_exists(file: str, test: str) -> None:
    found = file_of(file)
    assert found is not None, f"no file {file} below tests or tests/drivers"
    assert test in functions_of(found)


def test_test_that_did_not_run_is_detected() -> None:
    text = "`test_safety.py::test_what_is_named_exists` `test_safety.py::test_nobody` `nowhere.py::test_x`"
    ran = {"tests/test_safety.py::test_what_is_named_exists", "tests/elsewhere.py::test_nobody"}
    assert not_run(text, ran) == ["nowhere.py::test_x", "test_safety.py::test_nobody"]


def names_of_all() -> list[str]:
    """Return pytest's name of every test that the two documents name."""
    files = ((file_of(file), test) for file, test in named_in(all_named()))
    return [f"{path.relative_to(ROOT).as_posix()}::{test}" for path, test in files if path is not None]


def report(name: str, outcome: Literal["passed", "skipped"], reason: str = "") -> pytest.TestReport:
    return pytest.TestReport(name, ("", 1, name), {}, outcome, ("", 1, reason) if reason else None, "call")


@pytest.mark.parametrize(
    ("count", "reason", "status"),
    [
        (0, "", pytest.ExitCode.OK),
        (MOST_LATE, late_computer.NO_VERDICT, pytest.ExitCode.OK),
        (MOST_LATE + 1, late_computer.NO_VERDICT, pytest.ExitCode.TESTS_FAILED),
        (1, "Skipped: no halrun here", pytest.ExitCode.TESTS_FAILED),
    ],
)
def test_few_tests_without_verdict_do_not_fail_the_session(count: int, reason: str, status: int) -> None:
    names = sorted(names_of_all(), key=lambda name: name.partition("::")[2])
    seen, session = SafetyRan(), SimpleNamespace(exitstatus=pytest.ExitCode.OK)
    for number, name in enumerate(names):
        seen.pytest_runtest_logreport(
            report(name, "skipped", reason) if number < count else report(name, "passed")
        )
    seen.pytest_sessionfinish(cast(pytest.Session, session), pytest.ExitCode.OK)
    assert session.exitstatus == status

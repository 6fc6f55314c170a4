"""Only what has changed is told; samples by more than their band."""

from __future__ import annotations

import pytest

from app.extras.mtconnect.driver.agent_links import (
    ActiveCondition,
    ItemValue,
    MachineReport,
    SentMachineState,
)
from tests.extras.mtconnect.bench import lathe

A, B = "2026-01-01T00:00:00.000Z", "2026-01-01T00:00:00.100Z"


def told_after(*values: dict[str, ItemValue]) -> str:
    """What the last of these reports makes."""
    told, said = SentMachineState(tuple(lathe().iterate_items())), ""
    for each in values:
        said = told.make_change_lines(MachineReport(each, {}), A)
    return said


def test_initial_state_is_entirely_unavailable() -> None:
    lines = SentMachineState(tuple(lathe().iterate_items())).make_complete_state_lines(A).splitlines()
    values, *conditions = (line.split("|") for line in lines)
    assert set(values[2::2]) == {"UNAVAILABLE"}
    assert {parts[2] for parts in conditions} == {"UNAVAILABLE"}
    assert len(conditions) == 9
    assert all(len(parts) == 7 for parts in conditions)  # time, key, level and four empty fields


@pytest.mark.parametrize(
    ("key", "before", "now", "said"),
    [
        ("Xabs", 10.0, 10.0025, ""),  # a slide that stands: two counts to and fro
        ("Xabs", 10.0, 10.004, "Xabs|10.0040"),
        ("Xabs", 0.002, 0.0, "Xabs|0.0000"),  # exactly home is worth knowing
        ("Srpm", 3000.0, 3010.0, ""),  # half a per cent
        ("Srpm", 3000.0, 3017.0, "Srpm|3017.0"),
        ("Srpm", 3.0, 0.0, "Srpm|0.0"),  # standing still always
        ("Fact", 6.35, 6.40, ""),
        ("Fact", 0.0, 0.3, "Fact|0.300"),
        ("Sovr", 100.0, 99.5, "Sovr|99.5"),
        ("Xabs", 10.0, None, "Xabs|UNAVAILABLE"),
        ("Xabs", None, 10.0, "Xabs|10.0000"),
        ("execution", "ACTIVE", "ACTIVE", ""),
        ("execution", "ACTIVE", "READY", "execution|READY"),
        ("block", "X1", "X1 ", ""),  # nobody could see the difference
    ],
)
def test_only_significant_changes_are_sent(key: str, before: ItemValue, now: ItemValue, said: str) -> None:
    line = told_after({key: before}, {key: now})
    assert line == (f"{A}|{said}\n" if said else "")


def test_slow_drift_is_sent_when_it_leaves_the_band() -> None:
    """Each step is within the band of the one before, not of what was told."""
    steps: list[dict[str, ItemValue]] = [{"Xabs": 10.0 + 0.0008 * i} for i in range(5)]
    assert told_after(*steps) == f"{A}|Xabs|10.0032\n"


def test_item_missing_from_a_report_becomes_unavailable() -> None:
    told = SentMachineState(tuple(lathe().iterate_items()))
    told.make_change_lines(
        MachineReport({"Xabs": 1.0}, {"Xservo": (ActiveCondition("FAULT", "101", "tripped"),)}), A
    )
    lines = told.make_change_lines(MachineReport({"avail": "UNAVAILABLE"}, {}), B).splitlines()
    assert lines == [f"{B}|Xabs|UNAVAILABLE", f"{B}|Xservo|UNAVAILABLE||||"]


def test_unknown_item_keys_are_not_sent() -> None:
    assert told_after({"Yabs": 1.0}) == ""


def test_new_text_of_the_same_fault_replaces_the_old_text() -> None:
    told = SentMachineState(tuple(lathe().iterate_items()))
    told.make_change_lines(MachineReport({}, {"system": (ActiveCondition("WARNING", "hold", "ONE"),)}), A)
    said = told.make_change_lines(
        MachineReport({}, {"system": (ActiveCondition("WARNING", "hold", "TWO"),)}), B
    )
    assert said == f"{B}|system|WARNING|hold|||TWO\n"
    assert told.make_complete_state_lines(B).count("hold") == 1

"""The catalogue of alarms: whole, in words for an operator, and nothing is raised beside it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal, get_args, get_origin

import pytest

from core.alarms import ALARM_SUBJECTS, CATALOG, AlarmEntry, AlarmReaction
from core.alarms.alarm_entry import AlarmCode, ControlAlarmCode
from core.faults import FaultCode

pytestmark = pytest.mark.long

HOUSE = Path(__file__).parents[2]
# Words of whoever wrote the control. An operator has slides, drives, blocks and keys.
OURS = re.compile(r"\b(splice|queue|tick|commit|snapshot|exception|None|Error|executor|socket|ms)\b")
ENTRIES = pytest.mark.parametrize("code", sorted(CATALOG))


def codes_of(alias: object) -> set[str]:
    """The words of a Literal, and of the Literals in it."""
    assert get_origin(alias) is Literal
    return set(get_args(alias))


def test_every_alarm_code_has_exactly_one_catalog_entry() -> None:
    assert codes_of(AlarmCode) == codes_of(FaultCode) | codes_of(ControlAlarmCode) == set(CATALOG)
    assert not codes_of(FaultCode) & codes_of(ControlAlarmCode)


def test_alarm_codes_and_numbers_are_unique() -> None:
    codes = Counter(code for _, entries in ALARM_SUBJECTS for code in entries)
    numbers = Counter(entry.number for entry in CATALOG.values())
    assert [
        each for each, count in (codes + Counter(map(str, numbers.elements()))).items() if count > 1
    ] == []


def test_published_alarm_numbers_do_not_change() -> None:
    """Written on notes at machines and in status files."""
    known = {
        **{"axis": 101, "following": 102, "in-position": 103, "driver": 104, "spindle": 201, "at-speed": 202},
        **{"ignores-stop": 203, "spindle-still": 204, "thread-lost": 205, "c-is-spindle": 206},
        **{"collet-open": 301, "unclamp": 302, "collet": 303, "collet-lost": 304},
        **{"program": 401, "travel": 402, "internal": 901},
    }
    assert {code: entry.number for code, entry in CATALOG.items() if code in known} == known


@ENTRIES
def test_catalog_entry_has_short_text_causes_and_remedy(code: AlarmCode) -> None:
    entry = CATALOG[code]
    assert [each for each in CATALOG.values() if each.number == entry.number] == [entry]
    assert 100 <= entry.number <= 999
    assert entry.causes
    for text in (entry.text, entry.remedy, *entry.causes):
        assert len(text.strip()) > 3
        assert text == text.strip().rstrip(".")
        assert not OURS.search(text), text
    assert len(entry.text) <= 48, "readable from two metres, in one line of the smallest screen"


@ENTRIES
def test_remedy_names_cycle_start_for_hold_and_reset_for_stop(code: AlarmCode) -> None:
    """What stops with an alarm is acknowledged by Reset, what holds goes on by Cycle Start."""
    entry = CATALOG[code]
    if entry.reaction is AlarmReaction.HOLD:
        assert "Cycle Start" in entry.remedy


def raised(tree: ast.AST) -> Iterator[tuple[str, int]]:
    """Every code that a source hands to an alarm, a fault or a driver's refusal, as a plain word."""
    place = {"AlarmError": 0, "Fault": 1, "DriverError": 1, "code_of": 1}
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in place:
            at = place[node.func.id]
            codes = [*node.args[at : at + 1], *(k.value for k in node.keywords if k.arg == "code")]
            for code in codes:
                if isinstance(code, ast.Constant) and isinstance(code.value, str):
                    yield code.value, node.lineno


@dataclass(frozen=True)
class Told:
    """What a source says of alarms."""

    raises: list[tuple[str, int]]
    words: set[str]  # of its strings
    makes: int  # alarms by hand


@cache
def house() -> dict[Path, Told]:
    """All sources of the product, read once."""
    told = {}
    for path in (each for room in ("core", "drivers", "app") for each in (HOUSE / room).rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        nodes = list(ast.walk(tree))
        strings = {node.value for node in nodes if isinstance(node, ast.Constant)}
        calls = [node.func for node in nodes if isinstance(node, ast.Call)]
        makes = sum(isinstance(called, ast.Name) and called.id == "Alarm" for called in calls)
        told[path] = Told(list(raised(tree)), {each for each in strings if isinstance(each, str)}, makes)
    return told


def test_every_raised_alarm_code_is_in_catalog() -> None:
    found = 0
    for path, told in house().items():
        for code, line in told.raises:
            found += 1
            assert code in CATALOG, f"{path.relative_to(HOUSE)}:{line} raises {code!r}"
    assert found > 60


def test_every_entry_is_raised_somewhere() -> None:
    """An entry that nothing raises is a promise that nobody keeps."""
    catalogue = {HOUSE / "core" / "faults.py", *(HOUSE / "core" / "alarms").iterdir()}
    said = {word for path, told in house().items() if path not in catalogue for word in told.words}
    unused = [code for code, entry in CATALOG.items() if not {code, entry.text.upper()} & said]
    assert unused == []


def test_alarm_objects_are_created_in_one_module_only() -> None:
    """Whoever makes an Alarm by hand goes round the catalogue."""
    makers = {str(path.relative_to(HOUSE)): told.makes for path, told in house().items() if told.makes}
    assert makers == {"core/executor/raised_alarm.py": 1}


def test_alarm_entry_does_not_show_detail_by_default() -> None:
    assert AlarmEntry(999, "text", ("cause",), "remedy", AlarmReaction.STOP).shows_detail is False

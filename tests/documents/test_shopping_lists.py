"""The sums and terminals on the page of shopping lists agree with its tables and with the sample files."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tests.documents.pages import DOCS, ROOT

PAGE = (DOCS / "integrator" / "shopping-lists.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"\d(?:[\d .]*\d)?")


def numbers(cell: str) -> list[float]:
    return [float(each.replace(" ", "")) for each in NUMBER.findall(cell)]


def wrong_totals(text: str) -> Iterator[str]:
    """Yield each table with a total whose rows do not add up to it."""
    for table in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        cells = [line.strip("|\n").rpartition("|")[2].strip() for line in table.splitlines()]
        if "**" in cells[-1]:
            rows = [numbers(each) for each in cells[2:-1]]
            if [sum(column) for column in zip(*rows, strict=True)] != numbers(cells[-1]):
                yield table


def chapter(title: str) -> str:
    return PAGE.partition(f"\n## {title}")[2].partition("\n## ")[0]


def test_tables_add_up() -> None:
    assert PAGE.count("**total**") == 11
    assert list(wrong_totals(PAGE)) == []


@pytest.mark.parametrize("total", ["8", "4 to 10", "3 to 11"])
def test_wrong_total_is_detected(total: str) -> None:
    rows = ("1 to 4", "2 to 6") if "to" in total else ("3", "6")
    lines = ["a | cost", "-|-", *(f"x | {row}" for row in rows), f"**total** | **{total}**"]
    text = "".join(f"| {line} |\n" for line in lines)
    assert len(list(wrong_totals(text))) == 1


@pytest.mark.parametrize(("title", "wires", "low", "high"), [
    ("List 1", 87, 2600, 7000),
    ("List 2", 100, 3800, 12600),
    ("List 3", 71, 4800, 17000),
])  # fmt: skip
def test_comparison_states_the_sums_of_each_list(title: str, wires: int, low: int, high: int) -> None:
    """By hand: 27 wires and 1310 to 3600 dollars of every machine, plus the totals of the list."""
    own = re.findall(r"\*\*total\*\*.*\*\*([\d .to]+)\*\*", chapter(title))
    assert 27 + numbers(own[0])[0] == wires
    assert [round(a + b, -2) for a, b in zip((1310, 3600), numbers(own[1]), strict=True)] == [low, high]
    column = int(title[-1])
    rows = {line.split("|")[1].strip(): line.split("|")[column + 1] for line in chapter("Choose").splitlines()
            if line.startswith("|")}  # fmt: skip
    assert numbers(rows["wires to connect"]) == [wires]
    assert numbers(rows["cost, in US dollars"]) == [low, high]
    assert numbers(rows["time, in working days"]) == numbers(own[2])


@pytest.mark.parametrize(("title", "board"), [("List 1", "mesa-7i76e"), ("List 2", "mesa-7i97")])
def test_terminals_are_those_of_the_sample_hal_file(title: str, board: str) -> None:
    wiring = (ROOT / "resources" / "machines" / f"gt75-{board}.hal").read_text(encoding="utf-8")
    terminals = re.findall(r"\b(?:IN|OUT)PUT\d+", chapter(title))
    assert len(terminals) >= 4
    assert [each for each in terminals if not re.search(rf"{each}\b", wiring)] == []
